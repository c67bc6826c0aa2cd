// SPDX-License-Identifier: Apache-2.0
// `dpchip master diag`: asks for diagnosis without touching parameters or outputs, and says in words what it means.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/interrupt.hpp>
#include <dpchip/cli/live_master.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_verbs.hpp>
#include <dpchip/cli/slave_arguments.hpp>
#include <dpchip/trace/service_text.hpp>

namespace dpchip::cli {
namespace {

struct Arguments {
    LineArguments line;
    LineConfig slaves;
    std::vector<int> stations;
    double patience = 5;
    bool json = false;
};

struct Asked {
    std::uint8_t address{};
    master::Job job{};
    bool answered = false;
};

/// Asks again and again: a slave that searches the baud rate leaves the first requests unanswered.
void ask(LiveMaster& live, std::vector<Asked>& all, Ticks patience) {
    const auto open = [](const Asked& a) { return !a.answered; };
    for (Asked& a : all) {
        a.job = master::Job::slave_diag(a.address);
        live.master().submit(a.job);
    }
    const auto look = [&] {
        for (Asked& a : all) {
            if (a.answered || !a.job.finished()) continue;
            a.answered = a.job.good();
            if (a.answered) continue;
            a.job = master::Job::slave_diag(a.address);
            live.master().submit(a.job);
        }
        return std::none_of(all.begin(), all.end(), open);
    };
    live.run_until(look, patience);
    for (Asked& a : all)
        if (!a.answered) live.master().cancel(a.job);
}

nlohmann::ordered_json to_json(const Asked& a, const trace::DeviceTexts& texts) {
    nlohmann::ordered_json j;
    j["address"] = a.address;
    j["answered"] = a.answered;
    if (!a.answered) return j;
    const auto header = dp::decode_diag_header(a.job.data());
    const trace::DataText text = trace::diag_text(a.job.data(), a.address, &texts);
    j["octets"] = hex_text(a.job.data(), 244);
    if (header) {
        j["ident"] = fmt::format("0x{:04X}", header->ident);
        j["master"] = header->master_add;
        j["ready"] = header->ready();
    }
    j["text"] = text.words;
    j["details"] = text.details;
    return j;
}

void print_text(const Asked& a, const trace::DeviceTexts& texts, const std::string& name) {
    const std::string head = fmt::format("slave {}{}{}", a.address, name.empty() ? "" : " ", name);
    if (!a.answered) {
        spdlog::error("{} does not answer", head);
        return;
    }
    const trace::DataText text = trace::diag_text(a.job.data(), a.address, &texts);
    std::printf("%s: %s\n", head.c_str(), text.words.c_str());
    for (const std::string& detail : text.details) std::printf("  %s\n", detail.c_str());
}

ExitCode run(const Arguments& a) {
    const LineConfig config = line_config(a.line, a.slaves);
    LineConfig line = config;
    line.slaves.clear();  // nobody is to be parameterised
    LiveMaster live{line, {.mode = master::Mode::stop}};
    GsdShelf shelf;
    trace::GsdTexts texts;
    std::vector<Asked> all;
    std::vector<std::string> names;
    check_addresses(config);
    for (const SlaveEntry& s : config.slaves) {
        const gsd::Gsd& gsd = shelf.get(s.gsd, s.at);
        all.push_back({static_cast<std::uint8_t>(*s.address), {}, false});
        names.push_back(s.name.empty() ? gsd.model_name : s.name);
        texts.set(all.back().address, &gsd);
    }
    for (const int station : a.stations) {
        all.push_back({static_cast<std::uint8_t>(station), {}, false});
        names.emplace_back();
    }
    if (all.empty()) throw Failure{ExitCode::usage, "whose diagnosis? Give --station N, --gsd FILE --address N, or a LINE.toml"};
    const Interrupt interrupt{live.line()};
    const Ticks patience{static_cast<std::int64_t>(a.patience * static_cast<double>(core::kTicksPerSecond))};
    for (std::size_t first = 0; first < all.size(); first += 16) {  // the master takes 16 jobs at a time
        std::vector<Asked> some(all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), first + 16)));
        ask(live, some, patience);
        std::copy(some.begin(), some.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
    }
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (a.json) json.push_back(to_json(all[i], texts));
        else print_text(all[i], texts, names[i]);
    }
    if (a.json) std::printf("%s\n", json.dump(2).c_str());
    return std::all_of(all.begin(), all.end(), [](const Asked& asked) { return asked.answered; }) ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_master_diag(CLI::App& master, Job& job) {
    CLI::App* const c = master.add_subcommand("diag", "ask for diagnosis and explain it");
    const auto a = std::make_shared<Arguments>();
    add_slave_arguments(*c, a->slaves);
    add_line_arguments(*c, a->line);
    c->add_option("--station", a->stations, "a station without GSD; several are possible")->type_name("N")->check(CLI::Range(0, 126))->expected(1)->take_all();
    c->add_option("--timeout", a->patience, "give up after (5)")->type_name("S")->check(CLI::Range(0.0, 1e6));
    c->add_flag("--json", a->json, "as JSON");
    c->footer(footer("  dpchip master diag --line pty:dp0 --station 5\n"
                     "  dpchip master diag --line pty:dp0 --gsd builtin:remote_io --address 5\n"
                     "Texts of the device's own bits come from its GSD. Slaves are only asked, not parameterised."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
