// SPDX-License-Identifier: Apache-2.0
// What a UART's driver puts between the line and the program: marks of damaged characters, and one's own echo.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/character.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::live {

/// Undoes PARMRK (termios(3)): FF FF is an octet FF, FF 00 x a character x with a parity or framing error.
class ParityMarks {
public:
    /// Calls `take(octet, faults)` for every character that is complete with `raw`.
    template <class Take>
    void feed(std::uint8_t raw, Take&& take) {
        switch (state_) {
        case State::plain:
            if (raw == 0xFF) state_ = State::escape;
            else take(raw, std::uint8_t{fdl::fault_none});
            return;
        case State::escape:
            state_ = raw == 0x00 ? State::damaged : State::plain;
            if (raw == 0x00) return;
            take(std::uint8_t{0xFF}, std::uint8_t{fdl::fault_none});
            if (raw != 0xFF) take(raw, std::uint8_t{fdl::fault_none});  // not a mark after all
            return;
        case State::damaged:
            state_ = State::plain;
            take(raw, std::uint8_t{fdl::fault_parity});
            return;
        }
    }

private:
    enum class State : std::uint8_t { plain, escape, damaged };
    State state_ = State::plain;
};

/// Drops the echo of what was sent: an RS-485 adapter whose receiver is always on hears itself.
class EchoFilter {
public:
    /// These octets have just been sent; their echo is expected until `until`.
    void sent(std::span<const std::uint8_t> octets, core::Ticks until) {
        size_ = octets.size() < expected_.size() ? octets.size() : expected_.size();
        for (std::size_t i = 0; i < size_; ++i) expected_[i] = octets[i];
        at_ = 0;
        until_ = until;
    }
    /// True when `octet`, received at `now`, is the echo. The first octet that differs ends it: whatever came before
    /// was an echo, the rest is somebody else's.
    bool drops(std::uint8_t octet, core::Ticks now) {
        if (at_ >= size_ || now > until_ || octet != expected_[at_]) {
            size_ = at_ = 0;
            return false;
        }
        ++at_;
        return true;
    }

private:
    std::array<std::uint8_t, fdl::kMaxTelegram> expected_{};
    std::size_t size_{}, at_{};
    core::Ticks until_{};
};

}  // namespace dpchip::live
