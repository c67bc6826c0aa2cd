// SPDX-License-Identifier: Apache-2.0
// `dpchip master alarms`: waits for alarms and status messages of a DP-V1 slave, acknowledges them, says what they mean.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/acyclic_session.hpp>
#include <dpchip/cli/alarm_desk.hpp>
#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_verbs.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {
namespace {

constexpr std::uint8_t kAllAlarms = dp::kEnablePullPlugAlarm | dp::kEnableProcessAlarm | dp::kEnableDiagnosticAlarm |
                                    dp::kEnableManufacturerSpecificAlarm | dp::kEnableStatusAlarm | dp::kEnableUpdateAlarm;

struct Arguments {
    AcyclicArguments acyclic;
    double seconds = 0;
    std::uint64_t count = 0;
    bool json = false;
};

void tell(const master::ReceivedAlarm& r, AcyclicSession& session, bool json) {
    const dp::AlarmStatus alarm = alarm_of(r);
    const auto texts = alarm_details(alarm, session.address(), session.texts());
    if (json) {
        nlohmann::ordered_json j;
        j["kind"] = r.status ? "status" : "alarm";
        j["type"] = r.type;
        j["slot"] = r.slot;
        if (!r.status) j["seq_nr"] = r.seq_nr;
        j["specifier"] = r.specifier;
        j["octets"] = hex_text(r.data(), dp::kMaxDeviceBlock);
        j["text"] = trace::alarm_text(alarm);
        j["details"] = texts;
        std::printf("%s\n", j.dump().c_str());
    } else {
        std::printf("%s\n", trace::alarm_text(alarm).c_str());
        for (const std::string& text : texts) std::printf("  %s\n", text.c_str());
    }
    std::fflush(stdout);
}

ExitCode run(const Arguments& a) {
    AcyclicSession session{a.acyclic, kAllAlarms};
    const Interrupt interrupt{session.live().line()};
    session.open();
    master::AlarmReceiver receiver{session.slave(), session.ms1()};
    struct Look {
        master::AlarmReceiver* receiver;
        void operator()(master::Master&) { receiver->look(); }
    } look{&receiver};
    session.live().master().on_cycle(look);
    spdlog::info("slave {} exchanges data, its alarms are enabled", session.address());
    std::uint64_t told = 0;
    const auto done = [&] {
        while (const auto alarm = receiver.take()) {
            tell(*alarm, session, a.json);
            ++told;
        }
        return (a.count != 0 && told >= a.count && session.ms1().acknowledgements_waiting() == 0) || !session.slave().exchanging();
    };
    const Ticks limit = a.seconds > 0 ? Ticks{static_cast<std::int64_t>(a.seconds * static_cast<double>(core::kTicksPerSecond))} : core::seconds(1'000'000);
    session.live().run_until(done, limit);
    session.live().master().on_cycle(nullptr, nullptr);
    if (!session.slave().exchanging()) session.fail(trouble(session.slave()));
    if (receiver.lost() != 0) spdlog::warn("{} alarms came faster than they could be told", receiver.lost());
    if (a.count != 0 && told < a.count && !session.live().line().stopped()) session.fail(fmt::format("{} of {} alarms have come", told, a.count));
    return ExitCode::ok;
}

}  // namespace

void add_master_alarms(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("alarms", "wait for alarms of a DP-V1 slave and acknowledge them");
    const auto a = std::make_shared<Arguments>();
    add_acyclic_arguments(*c, a->acyclic, ChooseClass::no);
    c->add_option("--for", a->seconds, "end after so many seconds")->type_name("S")->check(CLI::Range(0.0, 1e6));
    c->add_option("--count", a->count, "end after so many alarms and status messages")->type_name("N");
    c->add_flag("--json", a->json, "a JSON object on each line");
    c->footer(footer("  dpchip master alarms --line pty:dp0 --gsd examples/dpv1_io.gsd --module \"8 DI / 8 DO\" --address 5 --count 1\n"
                     "The slave is parameterised with all its alarms enabled; outputs are 0. Runs until SIGINT without --for and --count."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
