// SPDX-License-Identifier: Apache-2.0
// `dpchip decode`: telegrams in words, from a capture, a text with hex octets, or the command line.
#include <cstdio>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/input.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/cli/units.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/trace/dialogue.hpp>
#include <dpchip/trace/gsd_texts.hpp>
#include <dpchip/trace/hex_text.hpp>
#include <dpchip/trace/pcapng.hpp>

namespace dpchip::cli {
namespace {

using Octets = std::span<const std::uint8_t>;

struct Arguments {
    std::vector<std::string> inputs, gsds;
    bool details = false, json = false;
};

/// Learns from ident numbers which device a station is, and explains.
class Decoder {
public:
    explicit Decoder(const Arguments& a) : arguments_{a} {
        for (const std::string& path : a.gsds) {
            const gsd::Gsd& gsd = shelf_.get(path);
            by_ident_[gsd.ident_number] = &gsd;
        }
        if (by_ident_.size() == 1)
            for (std::uint8_t station = 0; station < 127; ++station) texts_.set(station, by_ident_.begin()->second);
    }

    void packet(const trace::CapturedPacket& p);
    void octets(Octets octets, const std::vector<std::size_t>& lines);
    void finish(bool many) const;

private:
    void learn(const fdl::Telegram& t);
    void show(const std::string& where, const std::int64_t* ns, Octets octets, bool good, const trace::Explanation& e, std::string_view comment = {});
    std::string times(const trace::CapturedPacket& p);

    const Arguments& arguments_;
    GsdShelf shelf_;
    std::map<std::uint16_t, const gsd::Gsd*> by_ident_;
    trace::GsdTexts texts_;
    trace::Dialogue dialogue_{&texts_};
    std::optional<std::int64_t> first_ns_;
    nlohmann::ordered_json json_ = nlohmann::ordered_json::array();
    std::uint64_t good_ = 0, damaged_ = 0, octets_ = 0;
};

void Decoder::learn(const fdl::Telegram& t) {
    if (by_ident_.empty() || !t.has_fc() || !t.saps_present()) return;
    std::optional<std::uint16_t> ident;
    std::uint8_t station = t.destination();
    if (trace::requested_service(t) == dp::Service::set_prm) {
        if (const auto prm = dp::decode_set_prm(t.data())) ident = prm->ident;
    } else if (dialogue_.open_request().service == dp::Service::slave_diag && trace::answers(t, dialogue_.open_request())) {
        station = t.source();
        if (const auto header = dp::decode_diag_header(t.data())) ident = header->ident;
    }
    if (!ident) return;
    const auto found = by_ident_.find(*ident);
    texts_.set(station, found == by_ident_.end() ? nullptr : found->second);
}

std::string Decoder::times(const trace::CapturedPacket& p) {
    if (!p.has_time) return {};
    if (!first_ns_) first_ns_ = p.time_ns;
    const std::int64_t ns = p.time_ns - *first_ns_;
    return fmt::format("{}{}.{:09}", ns < 0 ? "-" : "", std::abs(ns) / 1'000'000'000, std::abs(ns) % 1'000'000'000);
}

void Decoder::packet(const trace::CapturedPacket& p) {
    std::string where = times(p);
    if (p.direction == trace::Direction::inbound) where += " <";
    if (p.direction == trace::Direction::outbound) where += " >";
    const auto telegram = fdl::decode(p.octets);
    const bool good = telegram && telegram->size == p.octets.size() && p.comment.empty();
    if (telegram) learn(*telegram);
    show(where, p.has_time ? &p.time_ns : nullptr, p.octets, good, dialogue_.next(p.octets), p.comment);
}

void Decoder::octets(Octets all, const std::vector<std::size_t>& lines) {
    for (const trace::Utterance& u : trace::split(all)) {
        const std::string where = lines.empty() || lines.back() == 1 ? std::string{} : fmt::format("line {}", lines[u.offset]);
        if (!u.good) {
            show(where, nullptr, u.octets, false, trace::explain_reject(u.reason, u.octets));
            continue;
        }
        const auto telegram = fdl::decode(u.octets);
        learn(*telegram);
        show(where, nullptr, u.octets, true, dialogue_.next(*telegram));
    }
}

void Decoder::show(const std::string& where, const std::int64_t* ns, Octets octets, bool good, const trace::Explanation& e, std::string_view comment) {
    ++(good ? good_ : damaged_);
    octets_ += octets.size();
    if (arguments_.json) {
        nlohmann::ordered_json j;
        if (ns) j["time_ns"] = *ns;
        j["octets"] = hex_text(octets, 65536);
        j["good"] = good;
        j["text"] = e.line;
        if (!comment.empty()) j["comment"] = comment;
        if (arguments_.details) j["details"] = e.details;
        json_.push_back(std::move(j));
        return;
    }
    std::printf("%s%s%s%s%.*s%s\n", where.c_str(), where.empty() ? "" : "  ", e.line.c_str(), comment.empty() ? "" : "  [", static_cast<int>(comment.size()),
                comment.data(), comment.empty() ? "" : "]");
    if (!arguments_.details) return;
    std::printf("    %s\n", hex_text(octets, 65536).c_str());
    for (const std::string& detail : e.details) std::printf("    %s\n", detail.c_str());
}

void Decoder::finish(bool many) const {
    if (arguments_.json) std::printf("%s\n", json_.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
    std::fflush(stdout);
    if (many) spdlog::info("{} telegrams, {} damaged, {} octets", good_, damaged_, octets_);
}

bool is_file(const std::string& input) {
    std::error_code error;
    return input == "-" || std::filesystem::is_regular_file(input, error);
}

/// Complains about all that is wrong with it and goes on; false when something was.
bool decode_text(Decoder& decoder, const std::string& text, const std::string& name) {
    const trace::HexText hex = trace::read_hex(text);
    decoder.octets(hex.octets, hex.lines);
    for (const trace::HexError& e : hex.errors) std::fprintf(stderr, "%s:%zu:%zu: error: \"%s\" is no octet\n", name.c_str(), e.line, e.column, e.text.c_str());
    return hex.errors.empty();
}

bool decode_file(Decoder& decoder, const std::string& path) {
    const std::string text = read_all(path);
    const Octets octets{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
    if (!trace::is_pcapng(octets)) return decode_text(decoder, text, path);
    const trace::Capture capture = trace::read_pcapng(octets);
    for (const trace::CapturedPacket& p : capture.packets) decoder.packet(p);
    if (capture.error == trace::PcapngError::none) return true;
    std::fprintf(stderr, "%s: error: octet %llu: %s\n", path.c_str(), static_cast<unsigned long long>(capture.offset), trace::name(capture.error));
    return false;
}

ExitCode run(const Arguments& a) {
    Decoder decoder{a};
    bool good = true;
    const bool files = is_file(a.inputs.front());
    if (files) {
        for (const std::string& path : a.inputs) good = decode_file(decoder, path) && good;
    } else {
        std::string text;
        for (const std::string& piece : a.inputs) text += (text.empty() ? "" : " ") + piece;
        // Neither a file nor octets: most likely a name that was misspelt.
        if (a.inputs.size() == 1 && trace::read_hex(text).octets.empty()) refuse({text, 0, 0}, "no such file, and no octets either");
        good = decode_text(decoder, text, "command line");
    }
    decoder.finish(files);
    return good ? ExitCode::ok : files ? ExitCode::input : ExitCode::usage;
}

}  // namespace

void add_decode(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("decode", "explain telegrams: a pcapng capture, a text with hex octets, or octets");
    const auto a = std::make_shared<Arguments>();
    c->add_option("inputs", a->inputs, "FILE.pcapng, a text file, - for stdin, or the octets themselves")->type_name("FILE|HEX")->required();
    c->add_option("--gsd", a->gsds, "texts of a device's own diagnosis; several are possible")->type_name("FILE")->expected(1)->take_all();
    c->add_flag("--details", a->details, "octet by octet");
    c->add_flag("--json", a->json, "as JSON");
    c->footer(footer("  dpchip decode 68 05 05 68 82 E3 6D 3C 3E 4C 16\n"
                     "  dpchip decode start.pcapng --gsd builtin:remote_io --details\n"
                     "Damaged telegrams are named and do not end the decoding. Times are seconds since the first telegram."));
    c->callback([a, &job] { job = [a] { return run(*a); }; });
}

}  // namespace dpchip::cli
