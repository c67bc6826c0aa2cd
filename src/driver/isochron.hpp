// SPDX-License-Identifier: Apache-2.0
// Isochron Mode and Simple Sync Mode for the application: the registers, and how regular the SYNCH telegrams come
// (VPC3+C 7.3.2; reference 6.2). Stands beside Vpc3 as DxbSubscriber does, with more_mode2() = mode2(). Isochron Mode
// itself is Config::sync_ena, and wants Config::fail_safe.
#pragma once

#include <cstdint>

#include <dpchip/dp/isom_prm.hpp>
#include <dpchip/driver/bus_port.hpp>
#include <dpchip/driver/config.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::driver {

struct IsochronConfig {
    std::uint8_t sync_pw = 12;           ///< width of the SYNC pulse, 1/12 us; 0: none
    bool sync_pol = false;               ///< SYNC is high while active
    bool simple_sync = false;            ///< Simple Sync Mode: DX_Out waits for the SYNCH
    std::uint8_t control_command = 0x00; ///< what makes a Global_Control a SYNCH
    std::uint8_t group_select = 0x80;
};

/// The bits of Mode Register 2 that Vpc3 does not know of.
constexpr std::uint8_t mode2(const IsochronConfig& c) {
    return static_cast<std::uint8_t>((c.sync_pol ? regmap::mode2::sync_pol : 0u) | (c.simple_sync ? regmap::mode2::dx_int_port : 0u));
}

/// After Vpc3::configure().
template <BusPort Bus>
void write_isochron(Bus& bus, const IsochronConfig& c) {
    bus.write(regmap::control::sync_pw_reg, c.sync_pw);
    bus.write(regmap::control::control_command_reg, c.control_command);
    bus.write(regmap::control::group_select_reg, c.group_select);
}

/// What the SYNCH telegrams are worth, from the times at which they came. Any unit that is fine enough, the same for all.
class SynchMeter {
public:
    /// The cycle that is expected, and how far from it a SYNCH may come and still count as in time. Before, all are in time.
    void expect(std::uint64_t cycle, std::uint64_t window) { *this = {}; cycle_ = cycle; window_ = window; }

    /// A SYNCH came at `now`; true when it came in time, or is the first one.
    bool observe(std::uint64_t now) {
        const bool first = count_++ == 0;
        const std::uint64_t period = now - last_;
        last_ = now;
        if (first) return true;
        if (cycle_ != 0 && period > cycle_ + cycle_ / 2) return ++missing_, false;
        if (period < shortest_) shortest_ = period;
        if (period > longest_) longest_ = period;
        if (cycle_ == 0) return true;
        const std::uint64_t off = period > cycle_ ? period - cycle_ : cycle_ - period;
        if (off > window_) return ++late_, false;
        return true;
    }
    std::uint64_t synchs() const { return count_; }
    std::uint64_t late() const { return late_; }        ///< outside the window, early ones included
    std::uint64_t missing() const { return missing_; }  ///< gaps of more than one and a half cycles
    /// Longest minus shortest period, gaps excepted; 0 before the second SYNCH.
    std::uint64_t jitter() const { return longest_ >= shortest_ ? longest_ - shortest_ : 0; }
    std::uint64_t shortest() const { return longest_ >= shortest_ ? shortest_ : 0; }
    std::uint64_t longest() const { return longest_; }
    std::uint64_t last() const { return last_; }

private:
    std::uint64_t cycle_ = 0, window_ = 0, last_ = 0, count_ = 0, late_ = 0, missing_ = 0;
    std::uint64_t shortest_ = ~std::uint64_t{0}, longest_ = 0;
};

}  // namespace dpchip::driver
