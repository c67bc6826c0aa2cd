// SPDX-License-Identifier: Apache-2.0
// A line with its slaves, masters and events, as LINE.toml, SCENARIO.toml or the command line describe it (docs/config.md).
// Plain values; every entry knows where it stands, for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/cli/dpv2_config.hpp>
#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/record_config.hpp>
#include <dpchip/cli/units.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/live/line.hpp>
#include <dpchip/master/config.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/regmap/variant.hpp>
#include <dpchip/segment/fault.hpp>
#include <dpchip/trace/pcapng.hpp>

namespace dpchip::cli {

struct SlaveEntry {
    Place at{};
    std::string name;                   ///< empty: the GSD's Model_Name
    std::string gsd;                    ///< path, or a built-in name
    std::vector<std::string> modules;
    std::optional<int> address{};
    regmap::Variant chip = regmap::Variant::vpc3c;
    std::optional<std::string> io{};    ///< nothing: echo, and a master does not check it
    regmap::Options options{};
    std::vector<gsd::PrmSetting> parameters;
    std::optional<std::uint8_t> min_tsdr{};
    bool no_add_change = false;
    bool follow_master = false;         ///< takes any configuration that fits
    std::int32_t crystal_ppb = 0;
    Ticks firmware_delay{};
    std::uint16_t user_watchdog = 0;
    std::vector<slave::Record> records;                       ///< DP-V1
    std::optional<IdentificationEntry> identification{};
    // What its master does with it.
    std::optional<std::uint32_t> watchdog_ms{};
    std::uint8_t group = 0;
    bool sync = false, freeze = false;
    Dpv2Entry dpv2{};
    std::uint8_t alarms = 0;            ///< types it enables and acknowledges: bits of DPV1_Status_2
    bool all_alarms = false;            ///< of these, whatever the GSD supports
    std::uint8_t alarm_mode = 0;        ///< Alarm_Mode: 0 one of each type at a time, 1..7 see dp::alarm_limit()
    Place alarms_at{};
};

struct MasterEntry {
    Place at{};
    std::string name = "master";
    std::uint8_t address = 1;
    Ticks min_cycle{};
    std::uint8_t max_retry = 1;
    std::uint8_t gap_factor = 0;
    master::Mode mode = master::Mode::operate;
    MasterDpv2Entry dpv2{};
};

enum class EventKind : std::uint8_t { power_off, power_on, unplug, plug, diagnosis, alarm, status, global_control, fault, mode, io, switch_over };
inline constexpr std::size_t kEventKinds = 12;
const char* name(EventKind kind);
/// What the slave's own side does: possible on a live line, too.
constexpr bool is_of_the_slave(EventKind kind) {
    return kind == EventKind::diagnosis || kind == EventKind::alarm || kind == EventKind::status || kind == EventKind::io;
}

struct EventEntry {
    Place at{};
    Ticks when{};
    EventKind kind{};
    std::size_t slave{};              ///< index into LineConfig::slaves
    std::vector<std::uint8_t> octets; ///< diagnosis; user data of an alarm or status
    dp::AlarmStatus alarm{};          ///< alarm, status; its data are `octets`
    bool ext_diag = true, stat_diag = false;
    std::uint8_t command = 0, groups = 0;
    segment::Fault fault{};
    std::uint32_t count = 1;          ///< fault: so many transmissions in a row
    std::optional<std::size_t> sender{};  ///< fault: only what this slave sends; SIZE_MAX: the master
    master::Mode mode{};
    std::string io;
};
inline constexpr std::size_t kMasterSends = SIZE_MAX;

struct LineConfig {
    std::string file;  ///< empty: from the command line
    std::optional<std::string> line{};
    Place line_at{};
    std::optional<fdl::BaudCode> baud{};
    bool baud_auto = false;
    std::optional<SlotTime> slot_time{};
    live::Pace pace = live::Pace::prompt;
    std::optional<std::string> trace{};
    trace::LinkType link_type = trace::LinkType::user0;
    std::optional<std::string> state_dir{};
    std::optional<Ticks> duration{};  ///< sim: how long
    std::optional<std::uint64_t> cycles{};
    std::vector<SlaveEntry> slaves;
    std::vector<MasterEntry> masters;
    std::vector<EventEntry> events;
};

/// Reads LINE.toml or SCENARIO.toml; `path` "-" is stdin. Throws Failure{input} with file:line:column.
LineConfig read_line_config(const std::string& path);
/// The same from text. Relative paths resolve against the folder of `file`.
LineConfig parse_line_config(const std::string& text, const std::string& file);

/// Every slave has an address of 0..126, no two the same, none of `master_address`. Throws Failure.
void check_addresses(const LineConfig& config, std::optional<std::uint8_t> master_address = {});

/// How messages call a slave: "slave 5 (Pump)".
std::string title(const SlaveEntry& slave);

}  // namespace dpchip::cli
