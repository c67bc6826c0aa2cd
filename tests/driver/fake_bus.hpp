// SPDX-License-Identifier: Apache-2.0
// A chip that does nothing by itself: plain RAM, registers that answer what the test wrote down, and a log of every access.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include <dpchip/driver/bus_port.hpp>

namespace dpchip::driver::testing {

struct Access {
    char kind;  // 'r' or 'w'
    std::uint16_t address;
    std::uint8_t value;
    bool operator==(const Access&) const = default;
};

struct FakeChip {
    std::array<std::uint8_t, 0x1000> ram{};
    std::array<std::deque<std::uint8_t>, 0x16> answers;      // one after the other; then `value`
    std::array<std::uint8_t, 0x16> value{};
    std::vector<Access> log;
    std::uint16_t broken_cell = 0;                           // this cell has bit 0 stuck at 1

    FakeChip() {
        value[0x05] = 0xCF;
        value[0x08] = value[0x0A] = 0xE1;
        value[0x0C] = 0x09;
    }
    std::uint8_t read(std::uint16_t a) {
        std::uint8_t v = a < 0x16 ? value[a] : ram[a];
        if (a < 0x16 && !answers[a].empty()) {
            v = answers[a].front();
            answers[a].pop_front();
        }
        if (a == broken_cell && a != 0) v |= 1;
        log.push_back({'r', a, v});
        return v;
    }
    void write(std::uint16_t a, std::uint8_t v) {
        if (a >= 0x16) ram[a] = v;
        log.push_back({'w', a, v});
    }
    /// Accesses to 00H..15H only, of one kind.
    std::vector<Access> registers(char kind) const {
        std::vector<Access> found;
        for (const Access& a : log)
            if (a.kind == kind && a.address < 0x16) found.push_back(a);
        return found;
    }
    void request(std::uint16_t irr) {
        answers[0x01].push_back(static_cast<std::uint8_t>(irr >> 8));
        answers[0x00].push_back(static_cast<std::uint8_t>(irr));
    }
};

struct FakeBus {
    FakeChip* chip;
    std::uint8_t read(std::uint16_t a) { return chip->read(a); }
    void write(std::uint16_t a, std::uint8_t v) { chip->write(a, v); }
    void read_block(std::uint16_t a, std::span<std::uint8_t> out) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = chip->read(static_cast<std::uint16_t>(a + i));
    }
    void write_block(std::uint16_t a, std::span<const std::uint8_t> in) {
        for (std::size_t i = 0; i < in.size(); ++i) chip->write(static_cast<std::uint16_t>(a + i), in[i]);
    }
};
static_assert(BusPort<FakeBus>);

}  // namespace dpchip::driver::testing
