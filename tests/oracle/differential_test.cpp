// SPDX-License-Identifier: Apache-2.0
// Property: the model and the naive slave cannot be told apart, whatever comes over the line and the processor bus.
//
// DPCHIP_STEPS steps per variant (default 20000), DPCHIP_SEED the seed, DPCHIP_FAILURES differences before it gives up
// (1). A difference is shrunk by leaving steps out and printed with its history. The coverage that the tables of the
// reference allow is required in full.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "differential.hpp"

namespace {

using namespace oracle;

constexpr int kStepsPerEpisode = 400;

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 0);
}

/// What goes wrong when the steps are done from reset; how many it took.
std::string replay(Variant variant, bool motorola, const std::vector<Step>& steps, std::size_t& used) {
    Pair pair{variant, motorola};
    for (used = 0; used < steps.size(); ++used) {
        std::string difference = pair.run(steps[used]);
        if (!difference.empty()) {
            ++used;
            return difference;
        }
    }
    return {};
}

/// Leaves out ever smaller pieces as long as something still differs.
std::vector<Step> shrink(Variant variant, bool motorola, std::vector<Step> steps, std::string& difference) {
    for (std::size_t piece = steps.size() / 2; piece > 0; piece /= 2) {
        for (std::size_t at = 0; at + piece <= steps.size();) {
            std::vector<Step> fewer = steps;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at),
                        fewer.begin() + static_cast<std::ptrdiff_t>(at + piece));
            std::size_t used = 0;
            std::string still = replay(variant, motorola, fewer, used);
            if (still.empty()) {
                at += piece;
                continue;
            }
            fewer.resize(used);
            steps = std::move(fewer);
            difference = std::move(still);
        }
    }
    return steps;
}

std::string history(const std::vector<Step>& steps) {
    std::string out;
    const std::size_t first = steps.size() > 30 ? steps.size() - 30 : 0;
    for (std::size_t i = first; i < steps.size(); ++i)
        out += "  " + std::to_string(i) + ". " + describe(steps[i]) + '\n';
    return out;
}

/// One row of table 3.2: what may be answered, and must have been answered at least once.
struct AnswerRow {
    const char* service;
    const char* wait_prm;  ///< nobody owns the slave
    const char *wait_cfg_owner, *wait_cfg_other;
    const char *data_exch_owner, *data_exch_other;
};

// clang-format off
constexpr AnswerRow kAnswers[]{
    //service              WAIT-PRM     WAIT-CFG owner  other     DATA-EXCH owner  other
    {"FDL_Status",         "OK",        "OK",           "OK",         "OK",            "OK"},
    {"Ident",              "RS",        "RS",           "RS",         "RS",            "RS"},
    {"reserved function",  "-",         "-",            "-",          "-",             "-"},
    {"SDA",                "RS",        "RS",           "RS",         "RS",            "RS"},
    {"SDN",                "-",         "-",            "-",          "-",             "-"},
    {"Global_Control",     "-",         "-",            "-",          "-",             "-"},
    {"SRD to 58",          "RS",        "RS",           "RS",         "RS",            "RS"},
    {"other SAP",          "RS",        "RS",           "RS",         "RS",            "RS"},
    {"Slave_Diag",         "DL",        "DL",           "DL",         "DL",            "DL"},
    {"Get_Cfg",            "DL",        "DL",           "DL",         "DL",            "DL"},
    {"Set_Prm",            "SC RR",     "SC RR",        "SC RR",      "SC RR",         "SC RR"},
    {"Chk_Cfg",            "SC RR",     "SC RR",        "SC RR",      "SC RR",         "SC RR"},
    {"Set_Slave_Add",      "SC RR RS",  "SC RR RS",     "SC RR RS",   "SC RR RS",      "SC RR RS"},
    {"RD_Input",           "RS",        "RS",           "RS",         "DL SC",         "DL SC"},
    {"RD_Output",          "RS",        "RS",           "RS",         "DL SC",         "DL SC"},
    {"Data_Exchange",      "RS",        "RS",           "RS",         "DL DH SC RR",   "RS"},
};
constexpr AnswerRow kExtPrm{"Set_Ext_Prm", "RS", "SC RR RS", "SC RR RS", "RS", "RS"};
constexpr AnswerRow kNoExtPrm{"Set_Ext_Prm", "RS", "RS", "RS", "RS", "RS"};
constexpr AnswerRow kPublisher{"MSRD", "-", "- RS", "- RS", "- DL DH SC RR", "- RS"};
constexpr AnswerRow kNoPublisher{"MSRD", "-", "-", "-", "-", "-"};

/// What each command returns (4.5 to 4.7).
constexpr const char* kEffects[]{
    "09 -> 01", "09 -> 02", "09 -> 03",
    "0B -> 01", "0B -> 02", "0B -> 03", "0B -> 05", "0B -> 06", "0B -> 07",
    "0B -> 09", "0B -> 0A", "0B -> 0B", "0B -> 0D", "0B -> 0E", "0B -> 0F",
    "0D -> 00", "0D -> 01", "0D -> 02",
    "0E -> 00", "0E -> 01", "0E -> 03", "0F -> 00", "0F -> 01", "0F -> 03",
    "10 -> 00", "10 -> 01", "10 -> 03", "11 -> 00", "11 -> 01", "11 -> 03",
    "14 -> 00",
};
// clang-format on

std::set<std::string> allowed_answers(const Kind& kind) {
    std::set<std::string> out;
    std::vector<AnswerRow> rows(std::begin(kAnswers), std::end(kAnswers));
    rows.push_back(kind.ext_prm ? kExtPrm : kNoExtPrm);
    rows.push_back(kind.dpv1_status ? kPublisher : kNoPublisher);
    for (const AnswerRow& row : rows) {
        const std::pair<const char*, const char*> cells[]{{"WAIT-PRM nobody's ", row.wait_prm},
                                                          {"WAIT-CFG owner ", row.wait_cfg_owner},
                                                          {"WAIT-CFG other ", row.wait_cfg_other},
                                                          {"DATA-EXCH owner ", row.data_exch_owner},
                                                          {"DATA-EXCH other ", row.data_exch_other}};
        for (const auto& [who, answers] : cells) {
            std::istringstream in{answers};
            for (std::string answer; in >> answer;) out.insert(std::string{who} + row.service + ' ' + answer);
        }
    }
    return out;
}

/// Every answer of the tables and every returned value was seen.
bool complete(const Kind& kind, const Coverage& seen) {
    const auto found = [](const std::set<std::string>& in) {
        return [&in](const std::string& row) { return in.count(row) != 0; };
    };
    const std::set<std::string> allowed = allowed_answers(kind);
    return std::all_of(allowed.begin(), allowed.end(), found(seen.answers)) &&
           std::all_of(std::begin(kEffects), std::end(kEffects), found(seen.effects));
}

class Differential : public testing::TestWithParam<int> {};

void require_coverage(const Kind& kind, const Coverage& seen, bool in_full) {
    const std::set<std::string> allowed = allowed_answers(kind);
    std::size_t hit = 0, effects = 0;
    for (const std::string& row : allowed) {
        const bool found = seen.answers.count(row) != 0;
        hit += found ? 1 : 0;
        if (in_full && !found) ADD_FAILURE() << "never seen: " << row;
    }
    for (const std::string& row : seen.answers)
        if (row.find(" retry ") == std::string::npos && allowed.count(row) == 0)
            ADD_FAILURE() << "table 3.2 does not allow: " << row;
    for (const char* effect : kEffects) {
        const bool found = seen.effects.count(effect) != 0;
        effects += found ? 1 : 0;
        if (in_full && !found) ADD_FAILURE() << "never seen: read " << effect;
    }
    std::printf("  coverage: %zu of %zu (DP state, sender, service, answer), %zu of %zu (command, value returned)\n",
                hit, allowed.size(), effects, std::size(kEffects));
}

TEST_P(Differential, model_and_naive_slave_cannot_be_told_apart) {
    const auto variant = static_cast<Variant>(GetParam());
    const Kind& kind = kKind[static_cast<std::size_t>(GetParam())];
    const std::uint64_t steps = from_environment("DPCHIP_STEPS", 20'000), seed = from_environment("DPCHIP_SEED", 1);
    std::printf("  %s: %llu steps, DPCHIP_SEED=%llu\n", kind.name, static_cast<unsigned long long>(steps),
                static_cast<unsigned long long>(seed));
    std::uint64_t failures = from_environment("DPCHIP_FAILURES", 1);
    Coverage coverage;
    std::uint64_t steps_done = 0;
    // A rare row of the tables may need more steps than were asked for: up to four times as many.
    const auto enough = [&](std::uint64_t done) {
        return done >= steps && (done >= 4 * steps || complete(kind, coverage));
    };
    for (std::uint64_t episode = 0; !enough(episode * kStepsPerEpisode); ++episode) {
        const bool motorola = episode % 4 == 3;
        Generator generator{kind, seed * 1'000'003 + episode};
        Pair pair{variant, motorola};
        std::vector<Step> done;
        for (int i = 0; i < kStepsPerEpisode; ++i) {
            ++steps_done;
            done.push_back(i == 0 ? generator.setup() : generator.next(pair.naive));
            std::string difference = pair.run(done.back(), &coverage);
            if (difference.empty()) continue;
            const std::size_t length = done.size();
            done = shrink(variant, motorola, std::move(done), difference);
            ADD_FAILURE() << kind.name << (motorola ? ", Motorola" : ", Intel") << ", episode " << episode << ", step "
                          << length << ", shrunk to " << done.size() << " steps:\n"
                          << history(done) << "=> " << difference;
            if (--failures == 0) return;
            break;
        }
    }
    std::printf("  %llu steps done\n", static_cast<unsigned long long>(steps_done));
    require_coverage(kind, coverage, steps >= 20'000);
}

std::string variant_name(const testing::TestParamInfo<int>& p) {
    static constexpr const char* kNames[]{"vpc3a", "vpc3b", "vpc3c", "apc3", "spc3"};
    return kNames[p.param];
}
INSTANTIATE_TEST_SUITE_P(all, Differential, testing::Range(0, kKinds), variant_name);

}  // namespace
