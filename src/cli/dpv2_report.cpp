// SPDX-License-Identifier: Apache-2.0
// DP-V2 of slaves in words, of a simulation also as JSON.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/dpv2_report.hpp>

namespace dpchip::cli {
namespace {

const char* name(driver::Role role) {
    switch (role) {
    case driver::Role::none: return "none";
    case driver::Role::backup: return "backup";
    case driver::Role::primary: return "primary";
    }
    return "none";
}

double in_us(std::uint64_t ticks) { return static_cast<double>(ticks) / static_cast<double>(core::kTicksPerNs) / 1e3; }

/// The slave's time minus that of the time master; nothing without either.
std::optional<std::int64_t> clock_error_ns(const Simulation& s, const slave::VirtualSlave& slave) {
    const auto time = slave.time();
    const master::TimeMaster& master = s.master().config().time;
    if (!time || master.interval == Ticks{}) return std::nullopt;
    return time->minus_ns(master.start.plus_ns(core::to_ns(s.now())));
}

std::string words(const Dpv2Entry& entry, const slave::VirtualSlave& slave, std::optional<std::int64_t> clock_error_ns) {
    const slave::Dpv2Counters& c = slave.dpv2_counters();
    std::string text;
    const auto say = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
    if (entry.publisher) say("publisher");
    if (!slave.links().empty()) say(fmt::format("{} samples over {} links, {} times broken", c.samples, slave.links().size(), c.link_errors));
    if (const driver::SynchMeter& m = slave.synch_meter(); slave.plan().driver.sync_ena && m.synchs() != 0)
        say(fmt::format("{} SYNCHs, {:.6f} to {:.6f} us apart, {} late, {} missing", m.synchs(), in_us(m.shortest()), in_us(m.longest()), m.late(), m.missing()));
    else if (entry.simple_sync) say(fmt::format("{} times outputs with a SYNCH", c.synchs));
    if (clock_error_ns)
        say(fmt::format("clock {:+.3f} us, set {} times, crystal {:+d} ppb", static_cast<double>(*clock_error_ns) / 1e3, c.times_set, -slave.clock_rate_ppb()));
    if (slave.redundancy().role() != driver::Role::none) say(name(slave.redundancy().role()));
    return text;
}

}  // namespace

void report_dpv2(const SlaveEntry& entry, const slave::VirtualSlave& slave, std::optional<std::int64_t> clock_error_ns) {
    const std::string text = words(entry.dpv2, slave, clock_error_ns);
    if (!text.empty()) std::printf("%s: %s\n", title(entry).c_str(), text.c_str());
}

void report_dpv2(const Simulation& s) {
    for (const Simulation::Member& m : s.members())
        if (m.on) report_dpv2(m.entry, *m.slave, clock_error_ns(s, *m.slave));
}

void report_dpv2(const Simulation& s, std::size_t n, nlohmann::ordered_json& entry) {
    const Simulation::Member& m = s.members()[n];
    if (!m.on || words(m.entry.dpv2, *m.slave, clock_error_ns(s, *m.slave)).empty()) return;
    const slave::Dpv2Counters& c = m.slave->dpv2_counters();
    const driver::SynchMeter& meter = m.slave->synch_meter();
    nlohmann::ordered_json j{{"samples", c.samples}, {"links", m.slave->links().size()}, {"link_errors", c.link_errors}, {"synchs", c.synchs}};
    if (m.slave->plan().driver.sync_ena)
        j["synch_ticks"] = {{"min", meter.shortest()}, {"max", meter.longest()}, {"late", meter.late()}, {"missing", meter.missing()}};
    if (const auto error = clock_error_ns(s, *m.slave)) j["clock"] = {{"error_ns", *error}, {"times_set", c.times_set}, {"crystal_ppb", -m.slave->clock_rate_ppb()}};
    j["role"] = name(m.slave->redundancy().role());
    entry["dpv2"] = std::move(j);
}

}  // namespace dpchip::cli
