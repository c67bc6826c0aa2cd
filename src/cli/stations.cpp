// SPDX-License-Identifier: Apache-2.0
// Building stations, and errors of the layers below as refusals that name the entry.
#include <dpchip/cli/builtin_gsd.hpp>
#include <dpchip/cli/input.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/master/from_gsd.hpp>
#include <dpchip/slave/error.hpp>

namespace dpchip::cli {
namespace {

gsd::Gsd insist(gsd::Parsed parsed) {
    if (!parsed.ok()) throw gsd::GsdError{parsed.gsd.file, std::move(parsed.diagnostics)};
    return std::move(parsed.gsd);
}

gsd::Gsd load(const std::string& path) {
    if (path == "-") return insist(gsd::parse(read_all(path), path));
    if (!path.starts_with("builtin:")) return gsd::load(path);
    const std::string_view text = builtin_gsd(path);
    if (text.empty()) throw gsd::GsdError{path + ": only " + std::string{kBuiltinRemoteIo} + " and " + std::string{kBuiltinDpv1Io} + " are inside the program"};
    return insist(gsd::parse(text, path));
}

/// Alarms that the GSD does not support are refused, unless it is all that are asked for.
void enable_alarms(master::SlaveConfig& c, const gsd::Gsd& gsd, const SlaveEntry& entry) {
    const std::uint8_t supported = gsd.dpv1.slave ? master::supported_alarms(gsd.dpv1) : std::uint8_t{0};
    if (supported == 0) refuse(entry.alarms_at, "alarms: " + gsd.model_name + " supports none");
    if (!entry.all_alarms && (entry.alarms & ~unsigned{supported}) != 0) refuse(entry.alarms_at, "alarms: " + gsd.model_name + " does not support all of these");
    if (dp::alarm_limit(entry.alarm_mode) > gsd.dpv1.alarm_sequence_mode_count)
        refuse(entry.alarms_at, "alarm_sequence: " + gsd.model_name + " has " + std::to_string(gsd.dpv1.alarm_sequence_mode_count) + " at a time (Alarm_Sequence_Mode_Count)");
    master::enable_dpv1(c, gsd.dpv1, gsd.fail_safe, entry.alarms, entry.alarm_mode);
}

}  // namespace

const gsd::Gsd& GsdShelf::get(const std::string& path, const Place& at) {
    auto& file = files_[path];
    if (file != nullptr) return *file;
    try {
        file = std::make_unique<gsd::Gsd>(load(path));
    } catch (const gsd::GsdError& e) {
        const std::string from = at.file.empty() ? std::string{} : "\n" + to_string(at) + ": note: wanted here";
        throw Failure{ExitCode::input, e.what() + from};
    }
    return *file;
}

gsd::Configuration configure(const gsd::Gsd& gsd, const SlaveEntry& entry) {
    try {
        return gsd::configure(gsd, entry.modules);
    } catch (const gsd::GsdError& e) {
        refuse(entry.at, e.what());
    }
}

std::unique_ptr<slave::VirtualSlave> make_slave(const gsd::Gsd& gsd, const SlaveEntry& entry, Ticks at,
                                                const slave::StoredAddress* stored) {
    slave::SlaveSetup setup;
    setup.name = entry.name;
    setup.modules = entry.modules;
    setup.address = static_cast<std::uint8_t>(entry.address.value_or(126));
    setup.no_add_change = entry.no_add_change;
    if (stored != nullptr) {
        setup.address = stored->address;
        setup.no_add_change = stored->no_add_change;
    }
    setup.variant = entry.chip;
    setup.options = entry.options;
    setup.io = entry.io.value_or("echo");
    setup.min_tsdr = entry.min_tsdr;
    if (entry.follow_master) setup.cfg_policy = driver::CfgPolicy::follow_master;
    setup.clock = core::Clock{entry.crystal_ppb, at};
    setup.firmware_delay = entry.firmware_delay;
    setup.user_watchdog = entry.user_watchdog;
    setup.records = entry.records;
    apply_dpv2(setup, entry.dpv2);
    if (entry.identification) setup.identification = identification(gsd, *entry.identification);
    try {
        return std::make_unique<slave::VirtualSlave>(gsd, setup);
    } catch (const gsd::GsdError& e) {
        refuse(entry.at, e.what());
    } catch (const slave::SlaveError& e) {
        refuse(entry.at, gsd.model_name + ": " + e.what());
    }
}

master::SlaveConfig master_config(const gsd::Gsd& gsd, const SlaveEntry& entry, std::uint32_t watchdog_ms) {
    const gsd::Configuration configuration = configure(gsd, entry);
    try {
        master::SlaveConfig c = master::slave_config(gsd, configuration, static_cast<std::uint8_t>(entry.address.value_or(126)), entry.parameters);
        if (!entry.name.empty()) c.name = entry.name;
        c.watchdog_ms = entry.watchdog_ms.value_or(watchdog_ms);
        c.group = entry.group;
        c.sync = entry.sync;
        c.freeze = entry.freeze;
        if (entry.min_tsdr) c.min_tsdr = *entry.min_tsdr;
        if (entry.alarms != 0) enable_alarms(c, gsd, entry);
        return c;
    } catch (const gsd::GsdError& e) {
        refuse(entry.at, e.what());
    }
}

std::string rate_text(const slave::VirtualSlave& slave) {
    const auto rate = slave.baud();
    return rate && *rate != fdl::BaudCode::not_found ? std::string{fdl::baud(*rate).name} : std::string{"searching"};
}

}  // namespace dpchip::cli
