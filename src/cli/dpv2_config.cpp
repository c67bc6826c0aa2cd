// SPDX-License-Identifier: Apache-2.0
// TOML to DP-V2, and from there to slaves, masters and blocks of parameters.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/dpv2_config.hpp>
#include <dpchip/master/prm_blocks.hpp>

namespace dpchip::cli {
namespace {

/// 2026-01-01 00:00:00, where the time of a simulated time master begins.
constexpr dp::NetworkTime kTimeBegins = dp::NetworkTime::from_wire(0xED003780, 0);
constexpr Ticks kSyncUnit = core::milliseconds(10);
/// Isochronous slaves of Simple Sync Mode are members of group 8, which the SYNCH selects.
constexpr std::uint8_t kGroup8 = 0x80;

std::optional<std::uint8_t> octet(TomlReader& t, std::string_view key, std::int64_t min, std::int64_t max) {
    const auto value = t.integer(key, min, max);
    if (!value) return std::nullopt;
    return static_cast<std::uint8_t>(*value);
}

LinkEntry read_link(const toml::table& table, const std::string& file) {
    TomlReader t{table, file, "[[slave.link]]"};
    LinkEntry l;
    l.at = t.place();
    const auto publisher = octet(t, "publisher", 0, dp::kMaxPublisher);
    if (!publisher) refuse(l.at, "[[slave.link]] without publisher, its address");
    l.publisher = *publisher;
    l.length = octet(t, "length", 1, dp::kMaxPublished);
    l.offset = octet(t, "offset", 0, dp::kMaxPublished - 1).value_or(0);
    l.octets = octet(t, "octets", 1, dp::kMaxPublished);
    t.finish();
    return l;
}

void insist(const master::BlockAdded& added, const Place& at, const char* what) {
    if (!added) refuse(at, fmt::format("{}: {}", what, master::name(added.error())));
}

dp::DxbLink link(const LinkEntry& l, std::optional<std::uint8_t> inputs) {
    const auto length = l.length ? l.length : inputs;
    if (!length || *length == 0) refuse(l.at, fmt::format("slave {} publishes nothing, or is not in this file; say its length", l.publisher));
    if (l.offset + l.octets.value_or(1) > *length) refuse(l.at, fmt::format("slave {} publishes {} octets only", l.publisher, *length));
    return {l.publisher, *length, l.offset, l.octets.value_or(static_cast<std::uint8_t>(*length - l.offset))};
}

}  // namespace

Dpv2Entry read_dpv2(TomlReader& slave, const std::string& file) {
    Dpv2Entry e;
    e.at = slave.place();
    e.publisher = slave.boolean("publisher").value_or(false);
    for (const toml::table* table : slave.tables("link")) e.links.push_back(read_link(*table, file));
    e.simple_sync = slave.boolean("simple_sync").value_or(false);
    e.clock_rate = slave.boolean("clock_rate").value_or(true);
    if (const auto role = slave.word("prm_cmd", {"backup", "primary"})) e.prm_cmd = *role == 0 ? driver::Role::backup : driver::Role::primary;
    return e;
}

MasterDpv2Entry read_master_dpv2(TomlReader& master) {
    MasterDpv2Entry e;
    e.isochron = master.duration("isochron").value_or(Ticks{});
    e.jitter = master.duration("jitter").value_or(Ticks{});
    if (e.jitter != Ticks{} && e.jitter >= e.isochron) master.refuse_key("jitter", "needs isochron, and must be shorter");
    e.clock_sync = master.duration("clock_sync").value_or(Ticks{});
    if (e.clock_sync.n % kSyncUnit.n != 0 || e.clock_sync / kSyncUnit > 0xFFFF)
        master.refuse_key("clock_sync", "multiples of 10 ms up to 655.35 s are possible");
    return e;
}

void apply_dpv2(slave::SlaveSetup& setup, const Dpv2Entry& entry) {
    setup.isochron.simple_sync = entry.simple_sync;
    setup.clock_rate = entry.clock_rate;
}

void apply_dpv2(master::MasterConfig& config, const MasterDpv2Entry& entry) {
    config.isochron.cycle = entry.isochron;
    config.isochron.jitter = entry.jitter;
    config.time = {entry.clock_sync, kTimeBegins};
}

void apply_dpv2(master::SlaveConfig& config, const gsd::Gsd& gsd, const Dpv2Entry& entry, const MasterDpv2Entry& master,
                const std::function<std::optional<std::uint8_t>(std::uint8_t address)>& inputs_of) {
    if (entry.publisher && !gsd.dpv2.publisher) refuse(entry.at, gsd.model_name + " can be no publisher (Publisher_supp)");
    if (!entry.links.empty() && !gsd.dpv2.subscriber) refuse(entry.at, gsd.model_name + " takes no links (Subscriber_supp)");
    if (entry.prm_cmd && !gsd.dpv2.prm_cmd) refuse(entry.at, gsd.model_name + " takes no PrmCmd (PrmCmd_supp)");
    config.publisher = entry.publisher;
    if (entry.simple_sync) config.group |= kGroup8;
    std::vector<dp::DxbLink> links;
    for (const LinkEntry& l : entry.links) links.push_back(link(l, inputs_of(l.publisher)));
    if (!links.empty()) insist(master::add_links(config, links), entry.at, "links");
    if (master.isochron != Ticks{} && gsd.dpv2.isochron_mode)
        insist(master::add_isochron(config, master::isochron_times(gsd.dpv2, master.isochron)), entry.at, "isochron (a multiple of TBASE_DP from TDP_MIN to TDP_MAX)");
    if (master.clock_sync != Ticks{} && gsd.dpv2.time_sync)
        insist(master::add_clock(config, {.interval = static_cast<std::uint16_t>(master.clock_sync / kSyncUnit)}), entry.at, "clock_sync");
    if (!entry.prm_cmd) return;
    const bool primary = *entry.prm_cmd == driver::Role::primary;
    insist(master::add_prm_cmd(config, {.backup_request = !primary, .primary_request = primary}), entry.at, "prm_cmd");
}

}  // namespace dpchip::cli
