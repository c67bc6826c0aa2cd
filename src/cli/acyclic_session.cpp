// SPDX-License-Identifier: Apache-2.0
// From options to an open relation.
#include <dpchip/cli/acyclic_session.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <dpchip/cli/log.hpp>
#include <dpchip/dp/cfg.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/master/from_gsd.hpp>

namespace dpchip::cli {
namespace {

constexpr std::uint32_t kWatchdogMs = 5000;

/// The line of the arguments with this program's one master on it, and no slaves: they are added when they are known.
LineConfig line_of(const AcyclicArguments& a) {
    LineConfig config = line_config(a.line, {});
    config.slaves.clear();
    if (config.masters.empty()) config.masters.emplace_back();
    if (a.own_address >= 0) config.masters[0].address = static_cast<std::uint8_t>(a.own_address);
    if (config.masters[0].address == a.address) throw Failure{ExitCode::usage, fmt::format("address {} is the master's", a.address)};
    return config;
}

/// What is known of the slave: from --gsd, or from the file's [[slave]] with this address.
SlaveEntry entry_of(const AcyclicArguments& a) {
    SlaveEntry entry;
    entry.gsd = a.gsd;
    entry.modules = a.modules;
    if (a.gsd.empty() && !a.line.file.empty())
        for (const SlaveEntry& s : line_config(a.line, {}).slaves)
            if (s.address == a.address) entry = s;
    entry.address = a.address;
    entry.alarms = 0;  // nobody would acknowledge them but `alarms`, which says which it wants
    if (entry.gsd.empty() && !a.modules.empty()) throw Failure{ExitCode::usage, "--module needs --gsd"};
    return entry;
}

}  // namespace

void add_acyclic_arguments(CLI::App& command, AcyclicArguments& a, ChooseClass choose_class) {
    add_line_arguments(command, a.line);
    command.add_option("--address", a.address, "the slave's station address")->type_name("N")->check(CLI::Range(0, 125))->required()->group("Slave");
    command.add_option("--gsd", a.gsd, "its GSD file; without, class 1 asks the slave for ident number and configuration")->type_name("FILE")->group("Slave");
    command.add_option("--module", a.modules, "plugged module; several in slot order")->type_name("NAME")->expected(1)->take_all()->group("Slave");
    if (choose_class == ChooseClass::yes)
        command.add_option("--class", a.service_class, "1: as the master that exchanges data (default); 2: over a connection")->check(CLI::IsMember({1, 2}));
    command.add_option("--timeout", a.patience, "give up after (10)")->type_name("S")->check(CLI::Range(0.0, 1e6));
    command.add_option("--master-address", a.own_address, "own address (1, or [[master]])")->type_name("N")->check(CLI::Range(0, 125));
}

AcyclicSession::AcyclicSession(const AcyclicArguments& a, std::uint8_t alarms)
    : address_{static_cast<std::uint8_t>(a.address)}, class_{a.service_class}, alarms_{alarms},
      patience_{static_cast<std::int64_t>(a.patience * static_cast<double>(core::kTicksPerSecond))}, entry_{entry_of(a)},
      live_{line_of(a), {.mode = master::Mode::stop}} {
    if (entry_.gsd.empty()) return;
    gsd_ = &shelf_.get(entry_.gsd, entry_.at);
    texts_.set(address_, gsd_);
    const bool possible = class_ == 1 ? gsd_->dpv1.slave && (gsd_->dpv1.c1_read_write || alarms != 0) : gsd_->dpv1.c2_read_write;
    if (!possible)
        throw Failure{ExitCode::failed, fmt::format("{}: {} has no acyclic services of class {}", entry_.gsd, gsd_->model_name, class_)};
}

AcyclicSession::~AcyclicSession() {
    try {
        leave();
    } catch (const std::exception& e) {
        spdlog::debug("leaving slave {}: {}", address_, e.what());  // what went wrong before has been said
    }
    if (relation_ != nullptr) live_.master().detach(*relation_);
}

void AcyclicSession::fail(const std::string& why) const { throw Failure{ExitCode::failed, fmt::format("slave {}: {}", address_, why)}; }

/// Asks again and again: a slave that searches the baud rate leaves the first requests unanswered.
master::Job AcyclicSession::ask(master::Job job, const char* what) {
    live_.master().submit(job);
    const auto answered = [&] {
        if (job.finished() && job.outcome == master::Job::Outcome::unanswered) live_.master().submit(job);
        return job.finished();
    };
    if (live_.run_until(answered, patience_) && job.outcome == master::Job::Outcome::data) return job;
    const bool silent = !job.finished() || job.outcome == master::Job::Outcome::unanswered;
    live_.master().cancel(job);
    fail(silent ? "does not answer" : fmt::format("{} is not answered with data", what));
}

void AcyclicSession::open() {
    const master::Job diagnosis = ask(master::Job::slave_diag(address_), "Slave_Diag");
    const auto header = dp::decode_diag_header(diagnosis.data());
    if (!header) fail(fmt::format("its diagnosis is none: {}", dp::name(header.error())));
    ident_ = header->ident;
    if (gsd_ != nullptr && gsd_->ident_number != ident_)
        fail(fmt::format("it is another device: ident number 0x{:04X} instead of 0x{:04X}", ident_, gsd_->ident_number));
    if (class_ == 2) return open_class_2();
    const std::uint8_t own = live_.master().config().address;
    if (header->master_add != dp::kNoMaster && header->master_add != own)
        fail(fmt::format("belongs to master {}: as class 2 (--class 2) it can be asked all the same", header->master_add));
    open_class_1();
}

master::SlaveConfig AcyclicSession::config_from_gsd() const {
    master::SlaveConfig c = master_config(*gsd_, entry_, kWatchdogMs);
    master::enable_dpv1(c, gsd_->dpv1, gsd_->fail_safe, alarms_);
    return c;
}

/// The slave tells its configuration; what its parameters ought to be nobody knows: only DP-V1 is asked for.
master::SlaveConfig AcyclicSession::config_from_slave() {
    const master::Job cfg = ask(master::Job::get_cfg(address_), "Get_Cfg");
    const dp::CfgTotals totals = dp::cfg_totals(cfg.data(), dp::CfgUse::get_cfg);
    if (!totals.ok()) fail(fmt::format("its configuration is damaged: {}", dp::name(totals.error)));
    master::SlaveConfig c;
    c.address = address_;
    c.ident = ident_;
    c.cfg.assign(cfg.data().begin(), cfg.data().end());
    c.input_octets = static_cast<std::uint16_t>(totals.input_octets);
    c.output_octets = static_cast<std::uint16_t>(totals.output_octets);
    c.watchdog_ms = kWatchdogMs;
    gsd::DpV1 every{};
    every.diagnostic_alarm = every.process_alarm = every.pull_plug_alarm = every.status_alarm = every.update_alarm = every.manufacturer_specific_alarm = true;
    master::enable_dpv1(c, every, false, alarms_);
    return c;
}

void AcyclicSession::open_class_1() {
    const master::SlaveConfig config = gsd_ != nullptr ? config_from_gsd() : config_from_slave();
    if (const auto added = live_.master().add(config); !added) fail(master::name(added.error()));
    live_.master().set_mode(master::Mode::clear);
    const master::SlaveHandler& slave = live_.master().slave(0);
    if (!live_.run_until([&] { return slave.exchanging() && slave.counters().exchanges > 1; }, patience_)) {
        const bool parameters = slave.fault() == master::SlaveFault::prm_fault || slave.fault() == master::SlaveFault::not_supported;
        fail(trouble(slave) + (parameters && gsd_ == nullptr ? "; --gsd FILE tells what it wants" : ""));
    }
    master::Ms1Config relation{.address = address_, .response_timeout = patience_};
    if (gsd_ != nullptr) relation.response_timeout = std::max(patience_, master::ms1_config(*gsd_, address_).response_timeout);
    ms1_ = std::make_unique<master::Ms1>(relation);
    relation_ = ms1_.get();
    live_.master().attach(*relation_);
}

void AcyclicSession::open_class_2() {
    ms2_ = std::make_unique<master::Ms2>(gsd_ != nullptr ? master::ms2_config(*gsd_, address_) : master::Ms2Config{.address = address_});
    relation_ = ms2_.get();
    live_.master().attach(*relation_);
    ms2_->open();
    finish("connection");
}

void AcyclicSession::finish(const std::string& what) {
    finish(what, [this] { return !relation_->busy(); }, relation_->result());
}

void AcyclicSession::leave() {
    live_.line().resume();
    if (ms2_) {
        ms2_->close();
        live_.run_until([this] { return ms2_->state() == master::Ms2State::closed; }, core::seconds(1));
    }
    if (ms1_ && slave().state() > master::SlaveState::parameters) {
        live_.master().set_mode(master::Mode::stop);
        const auto high = static_cast<std::uint8_t>(ident_ >> 8), low = static_cast<std::uint8_t>(ident_);
        const std::array<std::uint8_t, dp::kSetPrmHeader> unlock{dp::kUnlockReq, 1, 1, 0, high, low, 0};
        master::Job release = master::Job::service(address_, dp::kSapSetPrm, unlock);
        live_.master().submit(release);
        live_.run_until([&] { return release.finished(); }, core::seconds(1));
        live_.master().cancel(release);
    }
}

}  // namespace dpchip::cli
