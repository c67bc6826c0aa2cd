// SPDX-License-Identifier: Apache-2.0
// What a virtual slave's inputs do: repeat or invert the outputs, count, or hold a constant.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dpchip::slave {

/// An I/O behaviour, from "echo", "invert", "counter" or "hold:HEX". A plain value without heap.
class IoBehaviour {
public:
    enum class Kind : std::uint8_t {
        echo,     ///< inputs repeat outputs, cut or filled with zeros to their length
        invert,   ///< as echo, every bit of an output octet inverted
        counter,  ///< the inputs are one number, most significant octet first, one more after each answer
        hold,     ///< constant octets, the rest zero
    };

    IoBehaviour() = default;
    /// Hexadecimal digits in pairs; blanks between them do not matter. Throws SlaveError.
    explicit IoBehaviour(std::string_view text);

    Kind kind() const { return kind_; }
    std::span<const std::uint8_t> held() const { return {held_.data(), held_octets_}; }
    /// As the constructor takes it.
    std::string text() const;

    /// Fills `inputs` from the present outputs. `answers`: how many input answers have been given.
    void fill(std::span<std::uint8_t> inputs, std::span<const std::uint8_t> outputs, std::uint64_t answers) const;

private:
    Kind kind_ = Kind::echo;
    std::uint8_t held_octets_ = 0;
    std::array<std::uint8_t, 244> held_{};
};

}  // namespace dpchip::slave
