// SPDX-License-Identifier: Apache-2.0
// DP-V2 of a virtual slave, as far as its GSD says so: who is told of samples, SYNCHs and the time, and what was counted
// (VPC3+C 7.3; reference 6).
#pragma once

#include <cstdint>

#include <dpchip/core/ticks.hpp>
#include <dpchip/dp/dxb_prm.hpp>
#include <dpchip/dp/redundancy.hpp>
#include <dpchip/driver/dxb_subscriber.hpp>
#include <dpchip/driver/slave_clock.hpp>

namespace dpchip::slave {

/// The application of DP-V2. It is called while the slave is advanced and must not move it.
class Dpv2Handler {
public:
    virtual ~Dpv2Handler() = default;
    /// Data of a publisher, cut to the link.
    virtual void sample(const driver::DxbSample&) {}
    /// A link broke: at least one of them.
    virtual void link_error() {}
    /// A SYNC pulse began at `local`, by the station's own crystal (VirtualSlave::crystal()); in Simple Sync Mode: a SYNCH
    /// let outputs through.
    virtual void synch(core::Ticks /*local*/) {}
    virtual void clock(driver::ClockEvent) {}
    /// A PrmCmd was obeyed; this is the acknowledgement that went into the diagnosis.
    virtual void redundancy(const dp::RedStatus&) {}
};

struct Dpv2Counters {
    std::uint64_t samples{}, link_errors{};
    std::uint64_t synchs{};          ///< SYNC pulses
    std::uint64_t times_set{}, clock_violations{};
    std::uint64_t prm_cmds{};
    std::uint64_t blocks_refused{};  ///< Set_Prm and Set_Ext_Prm refused for a block of theirs
};

}  // namespace dpchip::slave
