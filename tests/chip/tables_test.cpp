// SPDX-License-Identifier: Apache-2.0
// Holds the chip against the text tables under tables/: answers (reference 3.2), Lock and Unlock (3.4.2), the full
// check of Set_Prm (3.4.3), Data_Exchange (3.8) and Global_Control (3.9).
#include "checks.hpp"
#include "text_table.hpp"

#include <array>
#include <map>
#include <utility>

#include <dpchip/fdl/telegram.hpp>

namespace dpchip::checks {
namespace {

constexpr std::array<std::string_view, 3> kStates{"WAIT-PRM", "WAIT-CFG", "DATA-EXCH"};
constexpr std::array<Stage, 3> kStages{Stage::p0, Stage::p1, Stage::p2};

std::string path_of(const char* name) { return std::string{DPCHIP_SOURCE_DIR} + "/tests/chip/tables/" + name; }

unsigned number(const std::string& hexadecimal) { return static_cast<unsigned>(std::stoul(hexadecimal, nullptr, 16)); }

Octets octets(const std::string& cell) { return cell == "-" ? Octets{} : hex(cell); }

std::size_t state_index(std::string_view state) {
    const auto it = std::find(kStates.begin(), kStates.end(), state);
    if (it == kStates.end()) throw std::runtime_error{"no DP state " + std::string{state}};
    return static_cast<std::size_t>(it - kStates.begin());
}

bool applies(const std::string& chips, const regmap::Traits& t) {
    if (chips == "all") return true;
    if (chips == "vpc3") return regmap::kVpc3.has(t.variant);
    if (chips == "bc") return regmap::kStepBC.has(t.variant);
    if (chips == "plain") return !t.prm_reserved_checks;
    throw std::runtime_error{"no set of chips " + chips};
}

bool has_word(const std::string& cell, std::string_view word) {
    const std::vector<std::string> all = words(cell);
    return std::find(all.begin(), all.end(), word) != all.end();
}

std::uint16_t interrupt_bit(const std::string& name) {
    static const std::map<std::string, std::uint16_t> kNames{{"Go/Leave_DATA-EXCH", irq::go_leave_data_exch},
                                                             {"New_Ext_Prm_Data", irq::new_ext_prm_data},
                                                             {"New_GC_Command", irq::new_gc_command},
                                                             {"New_SSA_Data", irq::new_ssa_data},
                                                             {"New_Cfg_Data", irq::new_cfg_data},
                                                             {"New_Prm_Data", irq::new_prm_data},
                                                             {"DX_Out", irq::dx_out}};
    return kNames.at(name);
}

std::uint16_t interrupts(const std::string& cell) {
    std::uint16_t bits = 0;
    for (const std::string& word : words(cell)) bits |= interrupt_bit(word);
    return bits;
}

/// The header octets of the next Slave_Diag.
std::string diag_header(Bench& b, std::size_t count) {
    const Octets answer = hex(b.diag());
    return answer.size() < 9 + count ? std::string{"none"} : text(std::span{answer}.subspan(9, count));
}

/// What follows Next_Dout_Buffer_Cmd: "none", octets, or octets and "cleared".
std::string new_outputs(Bench& b) {
    const Outputs out = b.take_outputs();
    if ((out.command & regmap::next_dout::state_u_buffer) == 0) return "none";
    return (out.octets.empty() ? "empty" : text(out.octets)) +
           ((out.command & regmap::next_dout::u_buffer_cleared) != 0 ? " cleared" : "");
}

// ---- 3.2
// ----------------------------------------------------------------------------------------------------------------

/// The words of the table for an answer to `sa`.
std::string answer_word(const std::string& answer, std::uint8_t sa) {
    if (answer == kSilence) return "silence";
    if (answer == kSc) return "sc";
    const Octets o = hex(answer);
    if (o.size() < 6 || (o[o[0] == fdl::kSd2 ? 4 : 1] & 0x7F) != sa) return "not for the sender: " + answer;
    if (o[0] == fdl::kSd1) {
        if (o[3] == 0) return "ok";
        if (o[3] == 2) return "rr";
        if (o[3] == 3) return "rs";
    }
    if (o[0] == fdl::kSd2 && o[6] == 0x08) {
        const std::string unit = text(std::span{o}.subspan(7, o[1] - 3u));
        if (unit == "3E 3B 11 21") return "read_cfg";
        if (unit == "AB CD" || unit == "3E 38 AB CD") return "inputs";
        if (unit == "3E 39 00 00") return "outputs";
        if (unit.starts_with("3E 3C ") && unit.size() == 3 * 8 - 1) return "diagnosis";
    }
    return answer;
}

struct Expected {
    std::string answer;
    std::uint16_t irr = 0;
    std::size_t state;
};

Expected expected_of(const std::string& cell, std::size_t state) {
    Expected e{{}, 0, state};
    for (const std::string& word : words(cell)) {
        if (e.answer.empty()) e.answer = word;
        else if (std::find(kStates.begin(), kStates.end(), word) != kStates.end()) e.state = state_index(word);
        else e.irr |= interrupt_bit(word);
    }
    return e;
}

TEST_P(Checks, every_request_in_every_state_is_answered_as_table_3_2_says) {
    const TextTable table{path_of("answers.txt")};
    ASSERT_GT(table.rows().size(), 60u);
    for (const Row& row : table.rows()) {
        if (!applies(row["chips"], traits())) continue;
        for (std::size_t state = 0; state < kStates.size(); ++state) {
            SCOPED_TRACE("answers.txt:" + std::to_string(row.line()) + ": " + row["request"] + " in " +
                         std::string{kStates[state]});
            Recipe r = recipe();
            r.ssa = has_word(row["with"], "ssa");
            if (has_word(row["with"], "ext_prm")) r.mode0 |= regmap::mode0::set_ext_prm_supported;
            Bench b{r, kStages[state]};
            const std::uint8_t sa = row["sender"] == "owner" ? 2 : 3;
            std::optional<std::uint8_t> dsap;
            if (row["dsap"] != "-") dsap = static_cast<std::uint8_t>(std::stoul(row["dsap"]));
            const Expected e = expected_of(row[kStates[state]], state);
            EXPECT_EQ(
                answer_word(
                    b.ask(b.request(sa, static_cast<std::uint8_t>(number(row["fc"])), dsap, octets(row["data"]))), sa),
                e.answer);
            EXPECT_EQ(b.irr(), e.irr);
            EXPECT_EQ(b.dp_state(), e.state);
        }
    }
}

TEST_P(Checks, an_Aux_Buffer_occupied_by_one_service_refuses_another) {
    Recipe r = recipe();
    r.ssa = true;
    Bench b{r, Stage::p0};
    EXPECT_EQ(b.ask(kPrm10), kSc);
    EXPECT_EQ(b.ask(kPrm10), kSc);
    EXPECT_EQ(b.ask(kCfg), kRr);
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.read(control::user_prm_data_okay), regmap::acknowledge::conflict);
    EXPECT_EQ(b.ask(kCfg), kSc);
    EXPECT_EQ(b.irr(), irq::new_prm_data | irq::new_cfg_data);
}

// ---- 3.4
// ----------------------------------------------------------------------------------------------------------------

TEST_P(Checks, Lock_and_Unlock_act_as_table_3_4_2_says) {
    const TextTable table{path_of("lock_unlock.txt")};
    ASSERT_GT(table.rows().size(), 30u);
    for (const Row& row : table.rows()) {
        SCOPED_TRACE("lock_unlock.txt:" + std::to_string(row.line()));
        Bench b{recipe(), kStages[state_index(row["state"])]};
        const auto octet0 = static_cast<std::uint8_t>(number(row["octet 0"]));
        const std::uint8_t ident_low = row["ident"] == "right" ? 0x11 : 0x12, sa = row["sender"] == "owner" ? 2 : 3;
        EXPECT_EQ(b.ask(b.request(sa, 0x6D, 0x3D, {octet0, 0x02, 0x05, 0x0B, 0x47, ident_low, 0x00})), kSc);
        EXPECT_EQ(b.dp_state(), state_index(row["after"]));
        EXPECT_EQ(b.irr(), interrupts(row["interrupts"]));
        EXPECT_EQ(diag_header(b, 4), row["diagnosis"]);
    }
}

TEST_P(Checks, Set_Prm_is_checked_as_table_3_4_3_says) {
    const TextTable table{path_of("set_prm_check.txt")};
    ASSERT_GT(table.rows().size(), 30u);
    for (const Row& row : table.rows()) {
        if (!applies(row["chips"], traits())) continue;
        SCOPED_TRACE("set_prm_check.txt:" + std::to_string(row.line()) + ": " + row["check"]);
        Recipe r = recipe();
        r.mode0 = static_cast<std::uint16_t>(number(row["mode 0"]));
        if (row["mode 2"] != "-") r.mode2 = static_cast<std::uint8_t>(number(row["mode 2"]));
        Bench b{r, Stage::p0};
        const Octets data = octets(row["octets"]);
        EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x3D, data)), kSc);
        const bool good = row["result"] == "good";
        EXPECT_EQ(b.dp_state(), good ? kWaitCfg : kWaitPrm);
        EXPECT_EQ(b.irr(), good && data.size() > 7 ? irq::new_prm_data : 0);
        const std::string faults = row["result"] == "Prm_Fault" ? "42 05 00 FF" : "52 05 00 FF";
        EXPECT_EQ(diag_header(b, 4), !good ? faults : (data[0] & 0x08) != 0 ? "02 0C 00 02" : "02 04 00 02");
    }
}

// ---- 3.8
// ----------------------------------------------------------------------------------------------------------------

std::string exchange_word(const std::string& answer) {
    if (answer == kSc) return "sc";
    if (answer == kRr) return "rr";
    const Octets o = hex(answer);
    if (o.size() < 10 || o[0] != fdl::kSd2) return answer;
    const std::string data = text(std::span{o}.subspan(7, o[1] - 3u));
    return (o[6] == 0x08 ? "low " : o[6] == 0x0A ? "high " : "? ") + data;
}

TEST_P(Checks, Data_Exchange_acts_as_table_3_8_says) {
    const TextTable table{path_of("data_exchange.txt")};
    ASSERT_GT(table.rows().size(), 15u);
    for (const Row& row : table.rows()) {
        if (!applies(row["chips"], traits())) continue;
        SCOPED_TRACE("data_exchange.txt:" + std::to_string(row.line()) + ": " + row["case"]);
        Recipe r = recipe();
        r.dout = static_cast<std::uint8_t>(number(row["dout"]));
        r.din = static_cast<std::uint8_t>(number(row["din"]));
        if (has_word(row["with"], "clear")) r.mode0 |= regmap::mode0::spec_clear_mode;
        if (has_word(row["with"], "always")) r.mode2 = 0x01 | regmap::mode2::dx_int_mode;
        Bench b{r, Stage::p2};
        b.take_outputs();
        if (has_word(row["with"], "sync")) { EXPECT_EQ(b.ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"), kSilence); }
        if (has_word(row["with"], "diag")) b.give_diag(0x00);
        b.acknowledge();
        EXPECT_EQ(exchange_word(b.ask(b.request(2, 0x5D, std::nullopt, octets(row["data"])))), row["answer"]);
        EXPECT_EQ(b.dp_state(), row["after"] == "good" ? kDataExch : kWaitPrm);
        EXPECT_EQ(b.irr(), interrupts(row["interrupts"]));
        EXPECT_EQ(new_outputs(b), row["outputs"]);
        if (row["after"] != "good") { EXPECT_EQ(diag_header(b, 4), "06 05 00 FF"); }
    }
}

// ---- 3.9
// ----------------------------------------------------------------------------------------------------------------

std::string global_control(Bench& b, std::uint8_t command) {
    Octets telegram = hex("68 07 07 68 FF 82 46 3A 3E 00 00 00 16");
    telegram[9] = command;
    telegram[11] = static_cast<std::uint8_t>(0x3F + command);
    return b.ask(telegram);
}

TEST_P(Checks, Global_Control_acts_as_table_3_9_says) {
    const TextTable table{path_of("global_control.txt")};
    ASSERT_GT(table.rows().size(), 25u);
    for (const Row& row : table.rows()) {
        SCOPED_TRACE("global_control.txt:" + std::to_string(row.line()));
        Recipe r = recipe();
        r.mode0 = static_cast<std::uint16_t>(number(row["mode 0"]));
        Bench b{r, Stage::p2};
        b.take_outputs();
        if (has_word(row["before"], "sync")) { EXPECT_EQ(global_control(b, 0x20), kSilence); }
        if (has_word(row["before"], "pending")) { EXPECT_EQ(b.ask(kDx1234), kInputs); }
        if (has_word(row["before"], "freeze")) { EXPECT_EQ(global_control(b, 0x08), kSilence); }
        b.give_inputs("EF 01");
        b.acknowledge();
        const auto command = static_cast<std::uint8_t>(number(row["command"]));
        EXPECT_EQ(global_control(b, command), kSilence);
        EXPECT_EQ(b.irr() & ~irq::new_gc_command, row["DX_Out"] == "yes" ? irq::dx_out : 0);
        EXPECT_EQ(b.peek(org::r_gc_command), command);
        EXPECT_EQ(new_outputs(b), row["outputs"]);
        b.give_inputs("55 66");
        const Octets inputs = hex(b.ask("68 05 05 68 88 82 5D 38 3E DD 16"));
        ASSERT_EQ(inputs.size(), 13u);
        EXPECT_EQ(text(std::span{inputs}.subspan(9, 2)), row["inputs"]);
        const unsigned flags = number(diag_header(b, 2).substr(3));
        EXPECT_EQ((flags & 0x20) != 0, has_word(row["mode"], "sync"));
        EXPECT_EQ((flags & 0x10) != 0, has_word(row["mode"], "freeze"));
    }
}

}  // namespace
}  // namespace dpchip::checks
