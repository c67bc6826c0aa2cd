// SPDX-License-Identifier: Apache-2.0
// The driver against scripted registers: the order of its accesses, its decisions, its queue of diagnoses.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <dpchip/driver/vpc3.hpp>

#include "driver/fake_bus.hpp"

namespace dpchip::driver {
namespace {

using testing::Access;
using testing::FakeBus;
using testing::FakeChip;
namespace irq = regmap::interrupt;

struct App : Events {
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

constexpr std::uint8_t kCfg[]{0x11, 0x21};

Config station() {
    Config c;
    c.address = 8;
    c.ident = 0x4711;
    c.cfg = kCfg;
    c.max_prm = 20;
    c.max_diag = 20;
    return c;
}

class Driver : public ::testing::Test {
protected:
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App> drv{FakeBus{&chip}, app};

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

TEST_F(Driver, InitialisesInTheOrderThatFirmwareUses) {
    ASSERT_EQ(drv.configure(station()), ConfigError::none);
    std::vector<std::uint16_t> order;
    for (const Access& a : chip.registers('w')) order.push_back(a.address);
    EXPECT_EQ(order, (std::vector<std::uint16_t>{0x0C, 0x01, 0x00, 0x03, 0x02, 0x09, 0x07, 0x06, 0x12, 0x05, 0x04, 0x0A, 0x0B}));
    EXPECT_EQ(chip.registers('r'), (std::vector<Access>{{'r', 0x04, 0x00}}));
    chip.log.clear();
    ASSERT_TRUE(drv.start());
    EXPECT_EQ(chip.registers('w').back(), (Access{'w', 0x04, 0xF0})) << "Start, then the masks";
    EXPECT_EQ(drv.state(), State::online);
    EXPECT_FALSE(drv.start());
}

TEST_F(Driver, WritesTheCellsOfTheManual) {
    Config c = station();
    c.user_watchdog = 0x1234;
    c.set_slave_add = true;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    const auto& m = chip.ram;
    EXPECT_EQ(m[0x16], 8);
    EXPECT_EQ(m[m[0x17] * 8u], 0xFF);
    EXPECT_EQ(m[0x18], 0x34);
    EXPECT_EQ(m[0x19], 0x12);
    EXPECT_EQ(m[0x1A], 2);
    EXPECT_EQ(m[0x1E], 2);
    EXPECT_EQ(m[0x24], 6);
    EXPECT_EQ(m[0x25], 6);
    EXPECT_EQ(m[0x28], 20);
    EXPECT_EQ(m[0x2A], 0x06);
    EXPECT_EQ(m[0x33], 2);
    EXPECT_EQ(m[m[0x34] * 8u], 0x11);
    EXPECT_EQ(m[m[0x34] * 8u + 1u], 0x21);
    EXPECT_EQ(m[0x39], 0x00);
    EXPECT_EQ(m[0x3A], 0x11);
    EXPECT_EQ(m[0x3B], 0x47);
    EXPECT_EQ(m[0x22], 0);
}

TEST_F(Driver, SwapsTheWordRegistersInMotorolaMode) {
    Config c = station();
    c.bus_mode = BusMode::motorola;
    c.user_watchdog = 0x1234;
    chip.value[0x04] = 0xCF;
    chip.value[0x05] = 0x00;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    std::vector<std::uint16_t> order;
    for (const Access& a : chip.registers('w')) order.push_back(a.address);
    EXPECT_EQ(order, (std::vector<std::uint16_t>{0x0C, 0x00, 0x01, 0x02, 0x03, 0x09, 0x06, 0x07, 0x12, 0x04, 0x05, 0x0A, 0x0B}));
    EXPECT_EQ(chip.ram[0x18], 0x12);
    EXPECT_EQ(chip.ram[0x19], 0x34);
    EXPECT_EQ(chip.registers('r').front().address, 0x05);
}

TEST_F(Driver, LeavesAnApc3sReservedAddressesAlone) {
    Config c = station();
    c.variant = Variant::apc3;
    c.ram = RamSize::bytes_1536;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    for (const Access& a : chip.log) {
        EXPECT_LT(a.address, 1536);
        if (a.kind == 'w') { EXPECT_FALSE(a.address >= 0x0C && a.address < 0x16) << a.address; }
    }
    for (const unsigned cell : {0x22u, 0x23u, 0x35u, 0x36u, 0x37u, 0x38u}) EXPECT_EQ(chip.ram[cell], 0);
}

struct ModeRow {
    const char* what;
    void (*change)(Config&);
    std::uint16_t address;
    std::uint8_t value;
};

TEST_F(Driver, ModeRegistersSayWhatTheConfigSays) {
    const ModeRow rows[]{
        {"plain", [](Config&) {}, 0x06, 0xC0},
        {"plain", [](Config&) {}, 0x07, 0x01},
        {"plain", [](Config&) {}, 0x0C, 0x01},
        {"plain", [](Config&) {}, 0x12, 0x00},
        {"plain", [](Config&) {}, 0x05, 0xC0},
        {"plain", [](Config&) {}, 0x04, 0xF0},
        {"plain", [](Config&) {}, 0x0A, 0x10},
        {"plain", [](Config&) {}, 0x0B, 0x0B},
        {"no sync", [](Config& c) { c.sync_supported = false; }, 0x06, 0x80},
        {"no freeze", [](Config& c) { c.freeze_supported = false; }, 0x06, 0x40},
        {"polarity", [](Config& c) { c.int_polarity = IntPolarity::high; }, 0x06, 0xD0},
        {"wd base", [](Config& c) { c.wd_base = WdTimeBase::ms_1; }, 0x06, 0xC4},
        {"dis stop", [](Config& c) { c.dis_stop_control = true; }, 0x06, 0xC2},
        {"dis start", [](Config& c) { c.dis_start_control = true; }, 0x06, 0xC1},
        {"fail safe", [](Config& c) { c.fail_safe = true; }, 0x07, 0x21},
        {"special buffer", [](Config& c) { c.spec_prm_buf_mode = true; }, 0x07, 0x11},
        {"SAP 53", [](Config& c) { c.set_ext_prm = true; }, 0x07, 0x09},
        {"PrmCmd", [](Config& c) { c.prm_cmd_supported = true; }, 0x07, 0x41},
        {"isochron", [](Config& c) { c.sync_ena = true; }, 0x0C, 0x11},
        {"SAP 53", [](Config& c) { c.set_ext_prm = true; }, 0x04, 0xB0},
        {"timer", [](Config& c) { c.user_timer = UserTimer::ms_10; }, 0x07, 0x05},
        {"timer", [](Config& c) { c.user_timer = UserTimer::ms_1; }, 0x04, 0xE0},
        {"eoi", [](Config& c) { c.eoi_time = EoiTime::ms_1; }, 0x07, 0x03},
        {"4 KB", [](Config& c) { c.ram = RamSize::bytes_4096; }, 0x0C, 0x81},
        {"dx always", [](Config& c) { c.dx_int = DxInt::always; }, 0x0C, 0x05},
        {"dx change", [](Config& c) { c.dx_int = DxInt::on_change; }, 0x12, 0x02},
        {"gc changed", [](Config& c) { c.gc_int = GcInt::changed; }, 0x0C, 0x00},
        {"gc command", [](Config& c) { c.gc_int = GcInt::changed_command; }, 0x12, 0x01},
        {"no prm check", [](Config& c) { c.check_prm_reserved = false; }, 0x0C, 0x41},
        {"no gc check", [](Config& c) { c.check_gc_reserved = false; }, 0x0C, 0x03},
        {"polled", [](Config& c) { c.service = Service::polled; }, 0x05, 0xFF},
        {"masked", [](Config& c) { c.masked = irq::dx_out; }, 0x05, 0xE0},
        {"baud", [](Config& c) { c.wd_baud_control = 0x1E; }, 0x0A, 0x1E},
        {"tsdr", [](Config& c) { c.min_tsdr = 36; }, 0x0B, 36},
    };
    for (const ModeRow& row : rows) {
        Config c = station();
        row.change(c);
        chip.log.clear();
        ASSERT_EQ(drv.configure(c), ConfigError::none) << row.what;
        for (const Access& a : chip.registers('w'))
            if (a.address == row.address) { EXPECT_EQ(a.value, row.value) << row.what << " at " << row.address; }
    }
}

TEST_F(Driver, FindsABrokenRamCellAndARunningChip) {
    chip.broken_cell = 0x3A3;
    EXPECT_EQ(drv.configure(station()), ConfigError::ram_fault);
    EXPECT_FALSE(drv.start());
    chip.broken_cell = 0;
    chip.value[0x04] = 0x01;
    EXPECT_EQ(drv.configure(station()), ConfigError::running);
    chip.value[0x04] = 0x00;
    EXPECT_EQ(drv.configure(station()), ConfigError::none);
}

TEST_F(Driver, AWrongConfigurationDoesNotTouchTheChip) {
    Config c = station();
    c.max_diag = 245;
    EXPECT_EQ(drv.configure(c), ConfigError::diag_length);
    EXPECT_TRUE(chip.log.empty());
}

TEST_F(Driver, OneReadOfTheRequestsIsAllThatAnIdlePollNeedsWhenPolled) {
    Config c = station();
    c.service = Service::polled;
    bring_up(c);
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_EQ(chip.log, (std::vector<Access>{{'r', 0x01, 0}, {'r', 0x00, 0}}));
}

TEST_F(Driver, EndOfInterruptIsTheLastAccess) {
    bring_up(station());
    chip.request(irq::dx_out | irq::new_gc_command);
    chip.ram[org::r_gc_command] = 2;
    EXPECT_EQ(drv.on_interrupt(), irq::dx_out | irq::new_gc_command);
    EXPECT_EQ(app.heard, (std::vector<std::string>{"dx_out", "gc 2"}));
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x02}));
    EXPECT_EQ(chip.registers('w').front(), (Access{'w', 0x03, 0x21})) << "acknowledged before it is served";
}

TEST_F(Driver, PollMasksTheInterruptWhileItWorks) {
    bring_up(station());
    drv.poll();
    const auto writes = chip.registers('w');
    ASSERT_EQ(writes.size(), 4u);
    EXPECT_EQ(writes[0], (Access{'w', 0x05, 0xFF}));
    EXPECT_EQ(writes[1], (Access{'w', 0x04, 0xFF}));
    EXPECT_EQ(writes[2], (Access{'w', 0x05, 0xC0}));
    EXPECT_EQ(writes[3], (Access{'w', 0x04, 0xF0}));
}

TEST_F(Driver, FeedsTheUserWatchdogOnlyWhenItIsUsed) {
    Config c = station();
    c.service = Service::polled;
    c.user_watchdog = 100;
    bring_up(c);
    drv.poll();
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x20}));
}

TEST_F(Driver, JudgesSetPrmByItsRulesAndThenAsksTheApplication) {
    static constexpr PrmConstant constants[]{{0, 0xFF, 0x00}};
    static constexpr PrmValue values[]{{.offset = 1, .octets = 1, .min = 1, .max = 3}};
    Config c = station();
    c.prm_rules = {2, 2, constants, values};
    bring_up(c);
    const auto given = [&](const std::vector<std::uint8_t>& octets) {
        chip.log.clear();
        prm_arrives(octets);
        drv.poll();
        return acknowledgements();
    };
    const std::vector<int> okay{0x0E}, not_okay{0x0F};
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2}), okay);
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00}), not_okay) << "too short";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2, 2}), not_okay) << "too long";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x01, 2}), not_okay) << "constant";
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 4}), not_okay) << "range";
    EXPECT_EQ(app.prms.size(), 1u);
    app.prm = Verdict::refuse;
    EXPECT_EQ(given({0x88, 2, 5, 11, 0x47, 0x11, 0, 0x00, 2}), not_okay) << "application";
    EXPECT_EQ(std::count(app.heard.begin(), app.heard.end(), "prm_refused"), 4);
    for (const Access& a : chip.registers('w'))
        if (a.address == 0x03) { EXPECT_EQ(a.value & 0x0C, 0) << "Prm and Cfg are not the IAR's"; }
}

TEST_F(Driver, JudgesAgainAfterAPrmConflict) {
    bring_up(station());
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.answers[0x0E] = {0x01, 0x00};
    chip.request(irq::new_prm_data);
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x0E}));
    EXPECT_EQ(app.prms.size(), 2u);
}

TEST_F(Driver, APrmConflictMayBringTheOtherService) {
    Config c = station();
    c.set_ext_prm = true;
    bring_up(c);
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.answers[0x0E] = {0x01, 0x00};
    chip.request(irq::new_ext_prm_data);
    drv.poll();
    EXPECT_EQ(app.prms.size(), 1u);
    EXPECT_EQ(app.heard, (std::vector<std::string>{"set_ext_prm"}));
}

TEST_F(Driver, JudgesNoMoreThanAFewConflictsInOneCall) {
    bring_up(station());
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0xAA});
    chip.value[0x0E] = 0x01;
    for (int i = 0; i < 20; ++i) chip.request(irq::new_prm_data);
    drv.poll();
    EXPECT_LE(acknowledgements().size(), 4u);
}

// proves: VPC3C 6.2.3-01
TEST_F(Driver, ChkCfgMustEqualThePluggedModules) {
    bring_up(station());
    chip.value[0x04] = 0x11;
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    chip.log.clear();
    cfg_arrives({0x11, 0x22});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    EXPECT_EQ(app.heard, std::vector<std::string>{"cfg_refused"});
    chip.log.clear();
    app.cfg = Verdict::refuse;
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
}

TEST_F(Driver, JudgesAgainAfterACfgConflict) {
    bring_up(station());
    cfg_arrives({0x11, 0x21});
    chip.answers[0x10] = {0x01, 0x00};
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x10, 0x10}));
}

TEST_F(Driver, PrmIsAnsweredBeforeCfg) {
    bring_up(station());
    put(drv.layout().prm, {0x88, 2, 5, 11, 0x47, 0x11, 0, 0});
    chip.ram[org::r_len_prm_data] = 8;
    put(drv.layout().cfg, {0x11, 0x21});
    chip.ram[org::r_len_cfg_data] = 2;
    chip.request(irq::new_cfg_data | irq::new_prm_data);
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x10}));
}

TEST_F(Driver, AMissingUserPrmIsNoticedAtChkCfg) {
    Config c = station();
    c.prm_rules.min_octets = 3;
    bring_up(c);
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    chip.log.clear();
    prm_arrives({0x88, 2, 5, 11, 0x47, 0x11, 0, 0, 0, 0});
    drv.poll();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), (std::vector<int>{0x0E, 0x10}));
}

TEST_F(Driver, FollowsTheMasterWhenToldTo) {
    Config c = station();
    c.cfg_policy = CfgPolicy::follow_master;
    c.max_inputs = 4;
    c.max_outputs = 8;
    c.max_cfg = 6;
    bring_up(c);
    for (const std::uint8_t s : drv.layout().dout) put(s, {9, 9, 9, 9, 9, 9, 9, 9});
    cfg_arrives({0x10, 0x27});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    EXPECT_EQ(drv.inputs(), 1);
    EXPECT_EQ(drv.outputs(), 8);
    EXPECT_EQ(chip.ram[org::r_len_din_buf], 1);
    EXPECT_EQ(chip.ram[org::r_len_dout_buf], 8);
    EXPECT_EQ(chip.ram[org::r_len_read_cfg_data], 2);
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().read_cfg) + 1u], 0x27);
    const unsigned dout = drv.layout().address(drv.layout().dout[0]);
    EXPECT_EQ(chip.ram[dout + 1], 9) << "old octets stay";
    for (unsigned i = 2; i < 8; ++i) EXPECT_EQ(chip.ram[dout + i], 0) << "gained octets are cleared";
    // In DATA-EXCH only the same again.
    chip.value[0x04] = 0x21;
    chip.log.clear();
    cfg_arrives({0x10, 0x27});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    chip.log.clear();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    // Too long for the buffers, damaged, or a wildcard: refused.
    chip.value[0x04] = 0x11;
    for (const auto& bad : std::vector<std::vector<std::uint8_t>>{{0x17}, {0x40}, {0x0F}, {0x70, 0x70, 0x70}, {}}) {
        chip.log.clear();
        cfg_arrives(bad);
        drv.poll();
        EXPECT_EQ(acknowledgements(), std::vector<int>{0x11});
    }
    // And back to the plugged one.
    chip.log.clear();
    cfg_arrives({0x11, 0x21});
    drv.poll();
    EXPECT_EQ(acknowledgements(), std::vector<int>{0x10});
    EXPECT_EQ(drv.inputs(), 2);
    EXPECT_EQ(drv.outputs(), 2);
}

TEST_F(Driver, FetchesOutputsOnlyWhenTheChipHasNewOnes) {
    bring_up(station());
    std::vector<std::uint8_t> out(2, 0xEE);
    chip.answers[0x0B] = {0x02};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::unchanged);
    EXPECT_EQ(chip.log.size(), 1u);
    EXPECT_EQ(out[0], 0xEE);
    put(drv.layout().dout[2], {0x12, 0x34});
    chip.answers[0x0B] = {0x07};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::fresh);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0x12, 0x34}));
    put(drv.layout().dout[0], {0, 0});
    chip.answers[0x0B] = {0x0D};
    EXPECT_EQ(drv.fetch_outputs(out), Outputs::cleared);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0, 0}));
    std::vector<std::uint8_t> one(1);
    chip.answers[0x0B] = {0x07};
    EXPECT_EQ(drv.fetch_outputs(one), Outputs::fresh);
    EXPECT_EQ(one[0], 0x12);
}

TEST_F(Driver, WritesInputsIntoTheUsersBufferAndFollowsTheExchange) {
    bring_up(station());
    const auto din = [&](int n) { return drv.layout().address(drv.layout().din[static_cast<std::size_t>(n - 1)]); };
    chip.answers[0x09] = {0x03, 0x01};
    const std::uint8_t in[]{0xAB, 0xCD, 0xEF};
    drv.write_inputs(in);  // E1H: the user owns buffer 2
    EXPECT_EQ(chip.ram[din(2)], 0xAB);
    EXPECT_EQ(chip.ram[din(2) + 1u], 0xCD);
    EXPECT_EQ(chip.ram[din(2) + 2u], 0) << "what is too much is dropped";
    chip.ram[din(3) + 1u] = 0x77;
    drv.write_inputs(std::span{in, 1});
    EXPECT_EQ(chip.ram[din(3)], 0xAB);
    EXPECT_EQ(chip.ram[din(3) + 1u], 0) << "what lacks is zero";
}

TEST_F(Driver, DiagnosisGoesIntoTheUsersBuffer) {
    bring_up(station());
    const std::uint8_t ext[]{0x03, 0xAA, 0x55};
    EXPECT_EQ(drv.set_diagnosis(ext, {.ext_diag = true}), DiagResult::handed_over);
    const unsigned buffer = drv.layout().address(drv.layout().diag[0]);
    EXPECT_EQ(chip.ram[buffer], 0x01);
    EXPECT_EQ(chip.ram[buffer + 6], 0x03);
    EXPECT_EQ(chip.ram[buffer + 8], 0x55);
    EXPECT_EQ(chip.ram[org::r_len_diag_buf1], 9);
    EXPECT_EQ(chip.registers('r').back().address, 0x0D);
    chip.value[0x0C] = 0x06;  // now buffer 2 is the user's
    EXPECT_EQ(drv.set_diagnosis({}, {.stat_diag = true, .ext_diag_overflow = true}), DiagResult::handed_over);
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[1])], 0x06);
    EXPECT_EQ(chip.ram[org::r_len_diag_buf2], 6);
    const std::vector<std::uint8_t> long_one(15);
    EXPECT_EQ(drv.set_diagnosis(long_one), DiagResult::too_long);
}

TEST_F(Driver, DiagnosisWaitsForABufferAndTheLatestIsNeverLost) {
    bring_up(station());
    chip.value[0x0C] = 0x0E;  // no user buffer: one is being sent
    const auto say = [&](std::uint8_t what) { return drv.set_diagnosis(std::span{&what, 1}, {.ext_diag = true}); };
    EXPECT_EQ(say(1), DiagResult::queued);
    EXPECT_EQ(say(2), DiagResult::replaced);
    EXPECT_EQ(say(3), DiagResult::replaced);
    drv.poll();
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 6u], 0);
    chip.value[0x0C] = 0x09;
    chip.request(irq::diag_buffer_changed);
    drv.poll();
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 6u], 3);
    EXPECT_EQ(app.heard, std::vector<std::string>{"diag"});
}

TEST(DriverQueue, EachDiagnosisWaitsUntilTheOneBeforeIsFetched) {
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App, 3> drv{FakeBus{&chip}, app};
    Config c = station();
    c.diag_delivery = DiagDelivery::each;
    c.service = Service::polled;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    ASSERT_TRUE(drv.start());
    const auto say = [&](std::uint8_t what) { return drv.set_diagnosis(std::span{&what, 1}, {.ext_diag = true}); };
    EXPECT_EQ(say(1), DiagResult::handed_over);
    chip.value[0x04] = 0x25;  // Diag_Flag
    EXPECT_EQ(say(2), DiagResult::queued);
    EXPECT_EQ(say(3), DiagResult::queued);
    EXPECT_EQ(say(4), DiagResult::queued);
    EXPECT_EQ(say(5), DiagResult::replaced);
    const unsigned first = drv.layout().address(drv.layout().diag[0]) + 6u;
    std::vector<int> seen;
    for (int i = 0; i < 4; ++i) {
        chip.answers[0x04] = {0x21};  // fetched once
        drv.poll();
        seen.push_back(chip.ram[first]);
    }
    EXPECT_EQ(seen, (std::vector<int>{2, 3, 5, 5}));
}

TEST_F(Driver, AnAddressChangeIsTakenOverAndTheBufferFreed) {
    Config c = station();
    c.set_slave_add = true;
    bring_up(c);
    put(drv.layout().ssa, {0x09, 0x47, 0x11, 0x00});
    chip.ram[org::r_len_ssa_data] = 4;
    chip.request(irq::new_ssa_data);
    drv.poll();
    EXPECT_EQ(app.heard, std::vector<std::string>{"ssa 9"});
    EXPECT_EQ(drv.address(), 9);
    EXPECT_EQ(chip.registers('r').back().address, 0x14);
}

TEST_F(Driver, GoesOfflineAndComesBackWithItsDiagnosis) {
    bring_up(station());
    const std::uint8_t ext[]{0x02, 0x77};
    drv.set_diagnosis(ext, {.ext_diag = true});
    drv.restart();
    EXPECT_EQ(drv.state(), State::going_offline);
    drv.poll();
    EXPECT_EQ(drv.state(), State::going_offline) << "the status still says Passive_Idle";
    chip.value[0x04] = 0x00;
    chip.ram[drv.layout().address(drv.layout().diag[0]) + 7u] = 0;
    chip.log.clear();
    drv.poll();
    EXPECT_EQ(drv.state(), State::online);
    EXPECT_EQ(app.heard, std::vector<std::string>{"offline"});
    EXPECT_EQ(chip.ram[drv.layout().address(drv.layout().diag[0]) + 7u], 0x77);
    // A MAC_Reset of then, seen only now, changes nothing.
    chip.value[0x04] = 0x01;
    chip.request(irq::mac_reset);
    drv.poll();
    EXPECT_EQ(drv.state(), State::online);
    drv.go_offline();
    chip.value[0x04] = 0x00;
    chip.request(irq::mac_reset);
    drv.poll();
    EXPECT_EQ(drv.state(), State::offline);
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_TRUE(drv.start());
}

TEST_F(Driver, EverythingElseIsToldToTheApplication) {
    Config c = station();
    c.user_timer = UserTimer::ms_1;
    bring_up(c);
    chip.value[0x04] = 0x21;
    chip.value[0x05] = 0xC3;
    chip.request(irq::go_leave_data_exch | irq::baud_rate_detect | irq::wd_dp_control_timeout | irq::user_timer_clock);
    drv.poll();
    EXPECT_EQ(app.heard, (std::vector<std::string>{"entered", "wd", "baud 3", "timer"}));
    chip.value[0x04] = 0x01;
    chip.request(irq::go_leave_data_exch);
    drv.poll();
    EXPECT_EQ(app.heard.back(), "left");
    EXPECT_EQ(drv.dp_state(), 0);
    drv.leave_master();
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x08}));
}

TEST(DriverUnconfigured, DoesNothing) {
    FakeChip chip;
    App app;
    Vpc3<FakeBus, App> drv{FakeBus{&chip}, app};
    std::uint8_t octet = 0;
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_EQ(drv.on_interrupt(), 0);
    EXPECT_EQ(drv.fetch_outputs({&octet, 1}), Outputs::unchanged);
    EXPECT_EQ(drv.set_diagnosis({}), DiagResult::not_ready);
    drv.write_inputs({&octet, 1});
    drv.go_offline();
    drv.restart();
    drv.leave_master();
    EXPECT_FALSE(drv.start());
    EXPECT_TRUE(chip.log.empty());
}

}  // namespace
}  // namespace dpchip::driver
