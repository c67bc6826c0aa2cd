// SPDX-License-Identifier: Apache-2.0
// I/O behaviours: text to value, and what they do.
#include <dpchip/slave/io_behaviour.hpp>

#include <algorithm>
#include <cstddef>

#include <dpchip/slave/error.hpp>

namespace dpchip::slave {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

[[noreturn]] void refuse(std::string_view text, const char* why) {
    throw SlaveError{SlaveError::Kind::io_behaviour, "I/O behaviour '" + std::string{text} + "': " + why};
}

}  // namespace

IoBehaviour::IoBehaviour(std::string_view text) {
    if (text == "echo") { kind_ = Kind::echo; return; }
    if (text == "invert") { kind_ = Kind::invert; return; }
    if (text == "counter") { kind_ = Kind::counter; return; }
    if (!text.starts_with("hold:")) refuse(text, "expected echo, invert, counter or hold:HEX");
    kind_ = Kind::hold;
    int high = -1;
    for (const char c : text.substr(5)) {
        if (c == ' ' && high < 0) continue;
        const int digit = hex_digit(c);
        if (digit < 0) refuse(text, "hold: takes hexadecimal digits");
        if (high < 0) { high = digit; continue; }
        if (held_octets_ == held_.size()) refuse(text, "more than 244 octets");
        held_[held_octets_++] = static_cast<std::uint8_t>(high << 4 | digit);
        high = -1;
    }
    if (high >= 0) refuse(text, "hexadecimal digits come in pairs");
    if (held_octets_ == 0) refuse(text, "hold: needs at least one octet");
}

std::string IoBehaviour::text() const {
    switch (kind_) {
    case Kind::echo: return "echo";
    case Kind::invert: return "invert";
    case Kind::counter: return "counter";
    case Kind::hold: break;
    }
    constexpr char digits[] = "0123456789ABCDEF";
    std::string text = "hold:";
    for (const std::uint8_t o : held()) {
        text += digits[o >> 4];
        text += digits[o & 15];
    }
    return text;
}

void IoBehaviour::fill(std::span<std::uint8_t> inputs, std::span<const std::uint8_t> outputs, std::uint64_t answers) const {
    const std::span<const std::uint8_t> from = kind_ == Kind::hold ? held() : outputs;
    switch (kind_) {
    case Kind::counter:
        for (std::size_t i = inputs.size(); i-- > 0; answers >>= 8) inputs[i] = static_cast<std::uint8_t>(answers);
        return;
    case Kind::echo:
    case Kind::invert:
    case Kind::hold: break;
    }
    const std::uint8_t flip = kind_ == Kind::invert ? 0xFF : 0x00;
    const std::size_t n = std::min(inputs.size(), from.size());
    for (std::size_t i = 0; i < n; ++i) inputs[i] = from[i] ^ flip;
    std::fill(inputs.begin() + static_cast<std::ptrdiff_t>(n), inputs.end(), std::uint8_t{0});
}

}  // namespace dpchip::slave
