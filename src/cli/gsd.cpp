// SPDX-License-Identifier: Apache-2.0
// `dpchip gsd`: what GSD files say.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/builtin_gsd.hpp>
#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/input.hpp>
#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/describe.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>

namespace dpchip::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
    std::vector<std::string> files, modules;
    bool json = false, list_modules = false, parameters = false, keywords = false;
    bool configured() const { return parameters || !modules.empty(); }
};

gsd::Parsed read(const std::string& path) {
    if (path == "-") return gsd::parse(read_all(path), path);
    if (const std::string_view text = builtin_gsd(path); !text.empty()) return gsd::parse(text, path);
    return gsd::read(path);
}

struct Station {
    gsd::Configuration configuration;
    gsd::UserPrmData prm;
};

Station station(const gsd::Gsd& g, const std::vector<std::string>& modules) {
    Station s;
    s.configuration = gsd::configure(g, modules);
    s.prm = gsd::user_prm_data(g, s.configuration);
    return s;
}

void print_text(const gsd::Gsd& g, const Arguments& a) {
    if (a.files.size() > 1) std::printf("%s\n", g.file.c_str());
    std::fputs(gsd::describe(g).c_str(), stdout);
    if (a.list_modules) std::fputs(gsd::describe_modules(g).c_str(), stdout);
    if (a.keywords) std::fputs(gsd::describe_keywords(g, gsd::KeywordChoice::all).c_str(), stdout);
    if (!a.configured()) return;
    const Station s = station(g, a.modules);
    for (std::size_t i = 0; i < s.configuration.modules.size(); ++i) {
        const gsd::Module& m = g.modules[s.configuration.modules[i]];
        std::printf("slot %-5zu%s (%s)\n", i + 1, m.name.c_str(), gsd::hex(m.cfg).c_str());
    }
    std::printf("Chk_Cfg    %s\n", gsd::hex(s.configuration.cfg).c_str());
    std::printf("inputs     %u octets\noutputs    %u octets\n", s.configuration.input_octets, s.configuration.output_octets);
    std::printf("User_Prm   %s\n", gsd::hex(s.prm.octets).c_str());
    std::fputs(gsd::describe_parameters(g, s.prm).c_str(), stdout);
}

Json module_json(const gsd::Module& m) {
    Json j{{"name", m.name}, {"cfg", gsd::hex(m.cfg)}, {"inputs", m.input_octets}, {"outputs", m.output_octets}, {"preset", m.preset}};
    if (m.reference) j["reference"] = *m.reference;
    if (m.prm.length) j["prm_octets"] = *m.prm.length;
    if (!m.info_text.empty()) j["info_text"] = m.info_text;
    return j;
}

Json parameter_json(const gsd::Gsd& g, const gsd::PrmField& f) {
    const gsd::Parameter& p = g.parameters[f.parameter];
    Json j{{"slot", f.slot}, {"offset", f.offset}, {"name", p.name}, {"type", gsd::name(p.type)}, {"value", f.value}};
    if (const auto text = g.value_text(p, f.value); !text.empty()) j["text"] = text;
    for (const gsd::ValueRange& r : p.allowed) j["allowed"].push_back({r.min, r.max});
    const gsd::PrmText* texts = p.text_ref ? g.prm_text(*p.text_ref) : nullptr;
    if (texts != nullptr)
        for (const auto& [value, words] : texts->texts) j["texts"][std::to_string(value)] = words;
    return j;
}

Json identity_json(const gsd::Gsd& g) {
    Json j{{"file", g.file}, {"vendor", g.vendor_name}, {"model", g.model_name}, {"ident", gsd::hex(g.ident_number)}, {"revision", g.revision},
           {"gsd_revision", g.gsd_revision}, {"order_number", g.order_number}, {"implementation", g.implementation_type}};
    for (std::size_t i = 0; i < gsd::kRates; ++i) {
        const auto rate = static_cast<gsd::Rate>(i);
        if (!g.rate(rate).supported) continue;
        Json r{{"rate", gsd::name(rate)}, {"bits_per_second", gsd::bits_per_second(rate)}};
        if (g.rate(rate).max_tsdr) r["max_tsdr"] = *g.rate(rate).max_tsdr;
        j["rates"].push_back(std::move(r));
    }
    j["freeze"] = g.freeze_mode;
    j["sync"] = g.sync_mode;
    j["auto_baud"] = g.auto_baud;
    j["set_slave_add"] = g.set_slave_add;
    j["fail_safe"] = g.fail_safe;
    j["dpv1"] = g.dpv1.slave;
    j["modular"] = g.modular_station;
    j["min_slave_interval_us"] = g.min_slave_intervall * 100;
    j["max_diag_octets"] = g.max_diag_data_len;
    if (g.max_module) j["max_modules"] = *g.max_module;
    if (g.max_input_len) j["max_input_octets"] = *g.max_input_len;
    if (g.max_output_len) j["max_output_octets"] = *g.max_output_len;
    if (g.max_data_len) j["max_data_octets"] = *g.max_data_len;
    return j;
}

Json to_json(const gsd::Gsd& g, const Arguments& a) {
    Json j = identity_json(g);
    const gsd::Summary s = gsd::summarize(g);
    j["counts"] = {{"modules", s.modules}, {"parameters", s.parameters}, {"parameter_texts", s.prm_texts}, {"diagnosis_texts", s.diag_texts},
                   {"keywords", s.keywords}, {"unknown_keywords", s.unknown_keywords}};
    j["modules"] = Json::array();
    for (const gsd::Module& m : g.modules) j["modules"].push_back(module_json(m));
    if (a.keywords)
        for (const gsd::Keyword& k : g.keywords) j["keywords"].push_back({{"line", k.at.line}, {"name", k.name}, {"value", k.value}, {"known", k.known}});
    if (!a.configured()) return j;
    const Station st = station(g, a.modules);
    j["station"] = {{"cfg", gsd::hex(st.configuration.cfg)}, {"inputs", st.configuration.input_octets}, {"outputs", st.configuration.output_octets},
                    {"user_prm", gsd::hex(st.prm.octets)}};
    for (const std::size_t m : st.configuration.modules) j["station"]["modules"].push_back(g.modules[m].name);
    j["station"]["parameters"] = Json::array();
    for (const gsd::PrmField& f : st.prm.fields) j["station"]["parameters"].push_back(parameter_json(g, f));
    return j;
}

ExitCode run(const Arguments& a) {
    bool bad = false;
    Json all = Json::array();
    for (const std::string& file : a.files) {
        try {
            const gsd::Parsed parsed = read(file);
            for (const gsd::Diagnostic& d : parsed.diagnostics) std::fprintf(stderr, "%s\n", gsd::to_string(d, file).c_str());
            bad = bad || !parsed.ok();
            if (a.json) all.push_back(to_json(parsed.gsd, a));
            else print_text(parsed.gsd, a);
        } catch (const gsd::GsdError& e) {
            std::fprintf(stderr, "%s\n", e.what());
            // A module that the user asked for and the file has not is the command line's fault.
            if (a.configured() && e.diagnostics().empty() && a.files.size() == 1 && !a.modules.empty()) return ExitCode::usage;
            bad = true;
        }
    }
    if (a.json) std::printf("%s\n", (a.files.size() == 1 && !all.empty() ? all[0] : all).dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return bad ? ExitCode::input : ExitCode::ok;
}

}  // namespace

void add_gsd(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("gsd", "say what GSD files say, and what is wrong with them");
    const auto a = std::make_shared<Arguments>();
    c->add_option("files", a->files, "GSD files; - reads stdin, builtin:remote_io and builtin:dpv1_io are inside the program")->type_name("FILE")->required();
    c->add_option("--module", a->modules, "plug this module, in slot order: configuration octets, lengths, parameters")->type_name("NAME")->expected(1)->take_all();
    c->add_flag("--modules", a->list_modules, "list the modules");
    c->add_flag("--parameters", a->parameters, "list the parameters of the station with the modules given, or its preset ones");
    c->add_flag("--keywords", a->keywords, "list the keywords that are kept but not interpreted");
    c->add_flag("--json", a->json, "as JSON");
    c->footer(footer("  dpchip gsd builtin:remote_io --modules\n"
                     "  dpchip gsd builtin:remote_io --module \"8 DI\" --module \"2 AI, consistent\"\n"
                     "Warnings and errors go to stderr as file:line:column; errors end in exit code 4."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
