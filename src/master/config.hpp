// SPDX-License-Identifier: Apache-2.0
// What a master is told before it starts: itself, the bus, its slaves (reference 1.6, 3.4.1).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <dpchip/core/ticks.hpp>
#include <dpchip/dp/clock.hpp>
#include <dpchip/dp/global_control.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/bus_times.hpp>

namespace dpchip::master {

using core::Ticks;

/// What the master does on the bus.
enum class Mode : std::uint8_t {
    offline,  ///< silent
    stop,     ///< token and jobs only; the slaves are left alone
    clear,    ///< slaves are parameterised and exchange data, outputs are 0
    operate,  ///< as clear, with the outputs of the image
};
const char* name(Mode mode);

/// One slave of a master.
struct SlaveConfig {
    std::string name;                        ///< for people
    std::uint8_t address{};                  ///< 0..125
    std::uint16_t ident{};
    std::vector<std::uint8_t> user_prm;      ///< Set_Prm octet 7 on: DPV1_Status and user parameters; at most 237
    std::vector<std::uint8_t> cfg;           ///< Chk_Cfg; at most 244
    std::uint16_t input_octets{};            ///< slave to master (Din), at most 244
    std::uint16_t output_octets{};           ///< master to slave (Dout), at most 244
    std::uint32_t watchdog_ms = 0;           ///< 0: off. Rounded up to what two factors can say
    std::uint8_t min_tsdr = 11;              ///< bit times; 0 leaves the slave's value
    std::uint8_t group = 0;                  ///< Group_Ident
    bool sync = false;                       ///< Sync_Req
    bool freeze = false;                     ///< Freeze_Req
    bool fail_safe = false;                  ///< in Mode::clear it gets no outputs at all, instead of zeroes
    Ticks min_slave_interval{};              ///< least time between two polls
    bool publisher = false;                  ///< polled with function code 7: its inputs go to everybody. Publisher_Enable
                                             ///< and the minTSDR that it takes are set by Master::add()
};

/// The whole data unit of Set_Prm, Lock_Req set.
std::vector<std::uint8_t> set_prm_data(const SlaveConfig& slave);

/// Isochronous bus cycles (VPC3+C 7.3.2): SYNCH, cyclic part, acyclic part, token, and spare time until the next SYNCH.
/// The SYNCHs come on a grid by the master's own crystal: how far that is off is the business of its tap on the line.
struct IsochronCycle {
    Ticks cycle{};                           ///< T_DP; 0: cycles follow each other as fast as they can
    dp::GlobalControl synch{0x00, 0x80};     ///< what the slaves' compare registers hold
    Ticks jitter{};                          ///< a SYNCH comes up to so much after its time, each anew
    std::uint64_t seed = 1;                  ///< of the jitter
};

/// Clock synchronisation (7.3.3): Time_Event and Clock_Value in every `interval`.
struct TimeMaster {
    Ticks interval{};                        ///< Clock_Sync_Interval; 0: no time master
    dp::NetworkTime start{};                 ///< the time at local time 0
};

struct MasterConfig {
    std::uint8_t address = 2;                ///< 0..125
    fdl::BaudCode baud = fdl::BaudCode::mbit_12;
    fdl::BusTimes times{};                   ///< all 0: the default profile of the rate
    Ticks slot_time{};                       ///< 0: times.tsl bit times; for lines whose answers come late
    std::uint8_t max_retry = 1;              ///< repetitions of an unanswered request, 0..15
    std::uint8_t gap_factor = 0;             ///< one GAP poll every so many cycles; 0: none
    std::uint8_t hsa = 126;                  ///< highest address of GAP polls
    std::uint8_t absent_polls = 1;           ///< slaves known to be absent that are asked for in one cycle
    std::uint8_t acyclic_per_cycle = 1;      ///< requests of jobs and relations in one cycle, at least 1
    Ticks min_cycle{};                       ///< least time from token to token
    IsochronCycle isochron{};
    TimeMaster time{};
    Mode mode = Mode::operate;
};

/// Why a slave or a master cannot be configured so.
enum class ConfigError : std::uint8_t {
    address,        ///< not 0..125
    address_taken,  ///< a slave has it already, or the master itself
    too_long,       ///< more than 237 user parameters, 244 cfg octets, inputs or outputs
    no_cfg,         ///< there is no configuration octet
    watchdog,       ///< longer than the factors can say; none, and links that need one
    block,          ///< a block of parameters that cannot be, or parameters without Prm_Structure before it
};
const char* name(ConfigError error);

}  // namespace dpchip::master
