// SPDX-License-Identifier: Apache-2.0
// `dpchip master identify`: the I&M records of a DP-V1 slave in words.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/acyclic_session.hpp>
#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/master_verbs.hpp>
#include <dpchip/master/im_reader.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    AcyclicArguments acyclic;
    int slot = 0;
    bool json = false;
};

ExitCode run(const Arguments& a) {
    AcyclicSession session{a.acyclic};
    const Interrupt interrupt{session.live().line()};
    session.open();
    master::ImReader reader{session.relation()};
    unsigned supported = 1;
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (unsigned n = 0; n <= 4; ++n) {
        if ((supported >> n & 1u) == 0) continue;
        const auto index = static_cast<std::uint16_t>(dp::kIm0 + n);
        const std::string what = fmt::format("I&M{}", n);
        reader.start(index, static_cast<std::uint8_t>(a.slot));
        session.finish(what, [&] { reader.step(); return reader.finished(); }, reader.result());
        if (n == 0) supported = 1u | dp::decode_im0(reader.record())->im_supported;
        const auto lines = trace::im_record_text(index, reader.record());
        if (a.json) {
            json[what] = {{"octets", hex_text(reader.record(), dp::kImRecord)}, {"text", lines}};
            continue;
        }
        std::printf("%s\n", what.c_str());
        for (const std::string& line : lines) std::printf("  %s\n", line.c_str());
    }
    if (a.json) std::printf("%s\n", json.dump(2).c_str());
    return ExitCode::ok;
}

}  // namespace

void add_master_identify(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("identify", "read identification and maintenance records (I&M) in words");
    const auto a = std::make_shared<Arguments>();
    add_acyclic_arguments(*c, a->acyclic, ChooseClass::yes);
    c->add_option("--slot", a->slot, "slot (0)")->type_name("N")->check(CLI::Range(0, 254));
    c->add_flag("--json", a->json, "as JSON");
    c->footer(footer("  dpchip master identify --line pty:dp0 --address 5 --class 2"));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
