// SPDX-License-Identifier: Apache-2.0
// The driver with scripted registers under it and an application above it that writes down what it hears.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/driver/vpc3.hpp>

#include "driver/fake_bus.hpp"

namespace dpchip::driver::testing {

namespace irq = regmap::interrupt;

struct ListeningApp : Events {
    std::vector<std::string> heard;
    std::vector<std::vector<std::uint8_t>> prms, cfgs;
    Verdict prm = Verdict::accept, cfg = Verdict::accept;

    Verdict set_prm(const dp::SetPrm& p) {
        prms.emplace_back(p.user_prm.begin(), p.user_prm.end());
        return prm;
    }
    void prm_refused(PrmFault) { heard.push_back("prm_refused"); }
    Verdict set_ext_prm(std::span<const std::uint8_t>) { heard.push_back("set_ext_prm"); return Verdict::accept; }
    Verdict chk_cfg(std::span<const std::uint8_t> c, std::uint8_t, std::uint8_t) {
        cfgs.emplace_back(c.begin(), c.end());
        return cfg;
    }
    void cfg_refused() { heard.push_back("cfg_refused"); }
    void data_exch_entered() { heard.push_back("entered"); }
    void data_exch_left() { heard.push_back("left"); }
    void dx_out() { heard.push_back("dx_out"); }
    void diag_buffer_changed() { heard.push_back("diag"); }
    void wd_dp_control_timeout() { heard.push_back("wd"); }
    void baud_rate_detect(std::uint8_t code) { heard.push_back("baud " + std::to_string(code)); }
    void new_gc_command(std::uint8_t command) { heard.push_back("gc " + std::to_string(command)); }
    void new_ssa_data(const dp::SetSlaveAdd& s) { heard.push_back("ssa " + std::to_string(s.address)); }
    void user_timer_clock() { heard.push_back("timer"); }
    void offline() { heard.push_back("offline"); }
};

inline constexpr std::uint8_t kPlugged[]{0x11, 0x21};

inline Config station() {
    Config c;
    c.address = 8;
    c.ident = 0x4711;
    c.cfg = kPlugged;
    c.max_prm = 20;
    c.max_diag = 20;
    return c;
}

class DriverFixture : public ::testing::Test {
protected:
    FakeChip chip;
    ListeningApp app;
    Vpc3<FakeBus, ListeningApp> drv{FakeBus{&chip}, app};

    void bring_up(const Config& c) {
        ASSERT_EQ(drv.configure(c), ConfigError::none);
        ASSERT_TRUE(drv.start());
        chip.value[0x04] = 0x01;
        chip.log.clear();
    }
    void put(std::uint8_t segment, const std::vector<std::uint8_t>& octets) {
        std::uint16_t a = drv.layout().address(segment);
        for (const std::uint8_t o : octets) chip.ram[a++] = o;
    }
    void prm_arrives(const std::vector<std::uint8_t>& octets) {
        put(drv.layout().prm, octets);
        chip.ram[org::r_len_prm_data] = static_cast<std::uint8_t>(octets.size());
        chip.request(irq::new_prm_data);
    }
    void cfg_arrives(const std::vector<std::uint8_t>& octets) {
        put(drv.layout().cfg, octets);
        chip.ram[org::r_len_cfg_data] = static_cast<std::uint8_t>(octets.size());
        chip.request(irq::new_cfg_data);
    }
    /// The command cells 0EH..11H that were read, in order.
    std::vector<int> acknowledgements() const {
        std::vector<int> found;
        for (const Access& a : chip.registers('r'))
            if (a.address >= 0x0E && a.address <= 0x11) found.push_back(a.address);
        return found;
    }
};

}  // namespace dpchip::driver::testing
