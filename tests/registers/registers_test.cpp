// SPDX-License-Identifier: Apache-2.0
// Register conformance, exhaustively: every variant, bus mode, address 000H..FFFH, direction and value against the
// table typed from the manuals (tests/oracle/register_table.txt; VPC3+C 4.1 to 4.3, 5.1 to 5.3; APC3 3.1 to 3.3, 4.1
// to 4.3).
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <dpchip/chip/chip.hpp>

namespace {

using dpchip::chip::BusMode;
using dpchip::regmap::Variant;
using Chip = dpchip::chip::Chip<dpchip::core::NoTrace>;
using Word = std::uint16_t;
using Byte = std::uint8_t;

struct ReadRow {
    unsigned reset = 0;
    bool present = false, command = false;
};
struct WriteRow {
    unsigned mask = 0;
    int target = -1;
    bool offline_only = false, present = false;
    std::string effect;
};
struct Table {
    std::array<ReadRow, 0x16> read;
    std::array<WriteRow, 0x16> write;
};

Table load_table(char chip) {
    Table table;
    std::ifstream in{DPCHIP_SOURCE_DIR "/tests/oracle/register_table.txt"};
    EXPECT_TRUE(in.good());
    for (std::string line; std::getline(in, line);) {
        std::istringstream words{line};
        std::string address, direction, chips, first, second, target, when;
        if (!(words >> address) || address[0] == '#') continue;
        words >> direction >> chips >> first >> second;
        if (chips.find(chip) == std::string::npos) continue;
        const std::size_t a = std::stoul(address, nullptr, 16);
        const auto number = static_cast<unsigned>(std::stoul(first, nullptr, 16));
        if (direction == "read") {
            EXPECT_FALSE(table.read.at(a).present) << "two read rows for " << address;
            table.read.at(a) = {number, true, second == "command"};
        } else {
            words >> target >> when;
            EXPECT_FALSE(table.write.at(a).present) << "two write rows for " << address;
            table.write.at(a) = {number, target == "-" ? -1 : std::stoi(target, nullptr, 16), when == "offline", true,
                                 second};
        }
    }
    for (std::size_t a = 0; a < 0x16; ++a)
        EXPECT_TRUE(table.read[a].present && table.write[a].present) << "no row for " << a;
    return table;
}

/// One chip as it is looked at: variant, bus mode, 2K or 4K.
struct Case {
    Variant variant;
    char letter;
    BusMode mode;
    bool big;
};

std::vector<Case> all_cases() {
    std::vector<Case> out;
    static constexpr char kLetters[] = "ABCPS";
    for (unsigned v = 0; v < 5; ++v)
        for (const BusMode mode : {BusMode::intel, BusMode::motorola}) {
            out.push_back({static_cast<Variant>(v), kLetters[v], mode, false});
            if (v == 1 || v == 2) out.push_back({static_cast<Variant>(v), kLetters[v], mode, true});
        }
    return out;
}
std::string case_name(const testing::TestParamInfo<Case>& p) {
    static constexpr const char* kNames[]{"vpc3a", "vpc3b", "vpc3c", "apc3", "spc3"};
    return std::string{kNames[static_cast<unsigned>(p.param.variant)]} +
           (p.param.mode == BusMode::intel ? "_intel" : "_motorola") + (p.param.big ? "_4k" : "");
}

/// Where an Intel address appears on this bus: word registers and R_User_WD_Value are swapped (4.2; reference 4.1).
Word bus(Word a, BusMode mode) { return mode == BusMode::motorola && (a < 8 || a == 0x18 || a == 0x19) ? a ^ 1u : a; }

/// The cell behind a bus address before swapping: 2K wraps at 800H, 1.5K folds 600H..7FFH by 400H (APC3 3.1).
struct Place {
    Word address;
    bool violation;
};
Place fold(Word a, const Case& c) {
    const bool spc3_class = c.letter == 'P' || c.letter == 'S';
    a &= c.big ? 0xFFFu : 0x7FFu;
    if (spc3_class && a >= 0x600) return {static_cast<Word>(a - 0x400), true};
    return {a, false};
}

class Registers : public testing::TestWithParam<Case> {
protected:
    Registers() : c{GetParam()}, table{load_table(c.letter)}, chip{c.variant, {}, c.mode} {
        if (c.big) chip.write(0x0C, 0x81);
        end = c.big ? 0x1000 : (c.letter == 'P' || c.letter == 'S') ? 0x600 : 0x800;
    }
    bool unchanged(const dpchip::chip::State& before) const {
        return std::memcmp(&before, &chip.state(), sizeof before) == 0;
    }
    std::vector<Byte> space() const {
        std::vector<Byte> out(end);
        for (Word a = 0; a < end; ++a) out[a] = chip.peek(bus(a, c.mode));
        return out;
    }
    void put(Word a, unsigned value) { chip.write(bus(a, c.mode), static_cast<Byte>(value)); }

    Case c;
    Table table;
    Chip chip;
    Word end;
};

TEST_P(Registers, read_their_reset_value_and_peek_changes_nothing) {
    const dpchip::chip::State reset = chip.state();
    for (unsigned i = 0; i < 0x1000; ++i) {
        const auto a = static_cast<Word>(i);
        const Place place = fold(a, c);
        const unsigned intel = bus(place.address, c.mode);
        const unsigned seen = chip.peek(a);
        ASSERT_TRUE(unchanged(reset)) << "peek " << std::hex << a;
        if (intel < 0x16) { ASSERT_EQ(seen, table.read[intel].reset) << "peek " << std::hex << a; }
        ASSERT_EQ(chip.read(a), seen) << "read " << std::hex << a;
        const bool acts = intel < 0x16 && table.read[intel].command;
        if (!acts && !place.violation) { ASSERT_TRUE(unchanged(reset)) << "read " << std::hex << a; }
        if (place.violation) { ASSERT_EQ(chip.peek(bus(4, c.mode)), 0x08) << "read " << std::hex << a; }
        if (acts || place.violation) chip.restore(reset);
    }
}

TEST_P(Registers, every_RAM_cell_takes_every_value_and_no_other_cell_moves) {
    for (const bool online : {false, true}) {
        if (online) put(0x08, 1);
        const dpchip::chip::State before = chip.state();
        for (unsigned i = 0; i < 0x1000; ++i) {
            const auto a = static_cast<Word>(i);
            const Place place = fold(a, c);
            if (bus(place.address, c.mode) < 0x16) continue;
            const Byte old = chip.peek(place.address);
            for (unsigned v = 0; v < 256; ++v) {
                chip.write(a, static_cast<Byte>(v));
                ASSERT_EQ(chip.peek(place.address), v) << std::hex << a;
                ASSERT_EQ(chip.peek(a), v) << std::hex << a;
                if (place.violation) {
                    ASSERT_EQ(chip.peek(bus(4, c.mode)) & 0x08, 0x08) << std::hex << a;
                    chip.restore(before);
                    continue;
                }
                chip.write(a, old);
                ASSERT_TRUE(unchanged(before)) << "write " << std::hex << a << " = " << v;
            }
        }
    }
}

/// What the table says about the space after a write; false when the write starts something (Mode-Reg 1).
bool expect_write(const Table& table, bool mode1_readable, unsigned a, unsigned v, bool online, unsigned imr,
                  std::vector<Byte>& space) {
    const WriteRow& row = table.write[a];
    const auto target = static_cast<std::size_t>(row.target < 0 ? 0 : row.target);
    if (row.offline_only && online) return true;
    if (row.effect == "set") space[target] = static_cast<Byte>(space[target] | (v & row.mask));
    if (row.effect == "clear") space[target] = static_cast<Byte>(space[target] & ~(v & row.mask));
    if (row.effect == "store") space[target] = static_cast<Byte>(v & row.mask);
    if (row.effect == "mask") imr = a == 4 ? (imr & 0xFF00u) | v : (imr & 0x00FFu) | v << 8;
    space[0x02] = static_cast<Byte>(space[0x00] & ~imr);
    space[0x03] = static_cast<Byte>(space[0x01] & ~(imr >> 8));
    if (row.effect == "mode1_set") {
        if (!online && (v & 1) != 0) return false;    // Start_VPC3
        if (online && (v & 0x0C) != 0) return false;  // Go_Offline, User_LEAVE-MASTER
        if (mode1_readable) space[target] = static_cast<Byte>(space[target] | (v & 0x30));
    }
    if (row.effect == "mode1_reset" && mode1_readable)
        space[target] = static_cast<Byte>(space[target] & ~(v & row.mask));
    return true;
}

TEST_P(Registers, every_write_of_a_control_parameter_does_what_the_table_says_and_nothing_else) {
    const bool mode1_readable = c.letter != 'P' && c.letter != 'S';
    for (const bool online : {false, true})
        for (const bool loaded : {false, true}) {
            Chip fresh{c.variant, {}, c.mode};
            chip = fresh;
            if (c.big) put(0x0C, 0x81);
            if (online) put(0x08, 1);
            if (online) chip.write(bus(0x00, c.mode), 0);
            unsigned imr = 0xFFFF;
            if (loaded) {
                imr = 0x5AC3;
                put(0x04, imr & 0xFF), put(0x05, imr >> 8);
                put(0x00, 0xFF), put(0x01, 0xFF), put(0x08, 0x30);
            }
            // Two clk later: an acknowledgement in the clk of the event would lose against it (4.4).
            chip.advance(chip.now() + 2 * dpchip::core::kClk);
            const dpchip::chip::State before = chip.state();
            const std::vector<Byte> space_before = space();
            for (unsigned a = 0; a < 0x16; ++a)
                for (unsigned v = 0; v < 256; ++v) {
                    std::vector<Byte> expected = space_before;
                    const bool predictable = expect_write(table, mode1_readable, a, v, online, imr, expected);
                    put(static_cast<Word>(a), v);
                    const bool size_changed = a == 0x0C && !online;
                    if (predictable && !size_changed) {
                        ASSERT_EQ(space(), expected) << "write " << std::hex << a << " = " << v << " online " << online;
                    }
                    if (!predictable && !online) { ASSERT_EQ(chip.peek(bus(4, c.mode)) & 1, 1) << "Start"; }
                    chip.restore(before);
                }
        }
}

TEST_P(Registers, the_RAM_size_changes_in_Offline_only_and_where_4KB_Mode_exists) {
    const bool has_4k = c.letter == 'B' || c.letter == 'C';
    put(0x0C, c.big ? 0x01 : 0x81);
    EXPECT_EQ(chip.ram_bytes(), has_4k && !c.big ? 0x1000 : has_4k ? 0x800 : end);
    put(0x0C, c.big ? 0x81 : 0x01);
    put(0x08, 1);
    put(0x0C, c.big ? 0x01 : 0x81);
    EXPECT_EQ(chip.ram_bytes(), end);
}

INSTANTIATE_TEST_SUITE_P(all, Registers, testing::ValuesIn(all_cases()), case_name);

}  // namespace
