// SPDX-License-Identifier: Apache-2.0
// Raw edges on RXD and XCTS into a UART and its chip, with good telegrams between them. Whatever comes: no crash, no
// standstill, TXD is driven exactly while RTS is high, what is sent is a good telegram in good characters, and only a
// request that was heard since the last answer is answered, not before 11 bit times are over.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/chip/chip.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/pins/uart.hpp>
#include <dpchip/regmap/address.hpp>

namespace {

using namespace dpchip;
using core::Ticks;
using pins::PinLevel;
namespace control = regmap::control;
namespace org = regmap::org;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

constexpr std::array<std::uint8_t, 6> kStatus{0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
constexpr std::array<std::uint8_t, 11> kDiag{0x68, 0x05, 0x05, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E, 0xF1, 0x16};

/// What the chip sends, read back from the levels of TXD in the middle of its bits.
class Listener {
public:
    void level(Ticks at, PinLevel level, Ticks bit) {
        look(at);
        if (line_ && level == PinLevel::low && !receiving_) {
            receiving_ = true;
            start_ = at;
            bit_ = bit;
            frame_ = 0;
            slot_ = 0;
        }
        line_ = level != PinLevel::low;
    }
    /// Takes the bits whose middle lies before `now`.
    void look(Ticks now) {
        while (receiving_ && start_ + bit_ * slot_ + Ticks{bit_.n / 2} < now) {
            frame_ |= line_ ? 1u << slot_ : 0u;
            if (++slot_ < 11) continue;
            receiving_ = false;
            const auto octet = static_cast<std::uint8_t>(frame_ >> 1);
            require(frame_ == pins::transmitter::frame(octet) && count_ < octets_.size());
            octets_[count_++] = octet;
        }
    }
    void over(bool given_up) {
        if (count_ != 0) {
            const auto telegram = fdl::decode({octets_.data(), count_});
            require(telegram && telegram->size == count_);
        } else {
            require(given_up);
        }
        count_ = 0;
        receiving_ = false;
    }
    void forget() { count_ = 0; receiving_ = false; line_ = true; }

private:
    bool line_ = true, receiving_ = false;
    Ticks start_{}, bit_{};
    unsigned frame_ = 0;
    int slot_ = 0;
    std::array<std::uint8_t, 256> octets_{};
    std::size_t count_ = 0;
};

class Run {
public:
    explicit Run(std::uint8_t how) : chip_{static_cast<regmap::Variant>(how % regmap::kVariants), options()} {
        chip_.write(control::mode_reg1_r, 0xFF);
        chip_.write(control::mode_reg0_low, static_cast<std::uint8_t>(how >> 6));  // start and stop control
        chip_.write(control::mode_reg0_high, 0x01);
        for (std::uint16_t a = org::first; a < 0x40; ++a) chip_.write(a, 0);
        chip_.write(org::r_ts_adr, 8);
        chip_.write(org::r_diag_buf_ptr1, 0x20);
        chip_.write(org::r_diag_buf_ptr2, 0x28);
        chip_.write(org::r_len_diag_buf1, 6);
        chip_.write(org::r_len_diag_buf2, 6);
        chip_.write(control::mode_reg1_s, regmap::mode1::start_vpc3);
    }

    void step(std::uint8_t op, std::uint8_t value) {
        switch (op & 7) {
        case 0:
        case 1: return edge(Ticks{bit().n * value / ((op & 8) != 0 ? 4 : 61)}, (op & 16) != 0);
        case 2: return octet(value);
        case 3: return telegram((op & 8) != 0 ? std::span<const std::uint8_t>{kStatus} : kDiag);
        case 4: return xcts((value & 1) != 0);
        case 5: return to(chip_.now() + bit() * (value * ((op & 8) != 0 ? 16 : 1)));
        case 6: return processor(value);
        case 7: return snapshot();
        default: return;
        }
    }

private:
    static regmap::Options options() {
        regmap::Options o;
        o.baud_probe_ms = {1, 1, 1, 1, 2, 4, 8, 16, 31, 59};
        return o;
    }
    Ticks bit() const { return uart_.quarter() * 4; }

    void to(Ticks until) {
        for (int events = 0; uart_.next(chip_) <= until; ++events) {
            require(events < 200'000);
            const Ticks before = chip_.now();
            uart_.advance(chip_, uart_.next(chip_));
            require(chip_.now() >= before);
            look();
        }
        uart_.advance(chip_, until);
        look();
    }
    void look() {
        while (!uart_.edges().empty()) {
            const pins::PinEdge e = uart_.edges().pop();
            if (e.level == PinLevel::low && !sending_) begins(e.at);
            if (e.level == PinLevel::z) {
                if (!reset_) listener_.over(!sending_);
                sending_ = reset_ = false;
                listener_.forget();
            } else {
                listener_.level(e.at, e.level, chip_.state().answer_bit);
            }
        }
        listener_.look(chip_.now());
        require((uart_.txd() != PinLevel::z) == (chip_.state().rts != 0));
        require(uart_.edges().overflows() == 0);
        require(pins::plausible(uart_.state()));
    }
    void begins(Ticks at) {
        sending_ = true;
        const Ticks request = chip_.state().request_end;
        require(request > answered_ && at - request >= chip_.state().answer_bit * 11);
        answered_ = request;
    }

    void edge(Ticks after, bool high) {
        to(chip_.now() + after);
        uart_.set_rxd(chip_, chip_.now(), pins::to_level(high));
        look();
    }
    void octet(std::uint8_t value) {
        const unsigned frame = pins::transmitter::frame(value);
        const Ticks start = chip_.now();
        for (unsigned n = 0; n < 11; ++n) {
            to(std::max(chip_.now(), start + bit() * n));  // the rate may have changed
            uart_.set_rxd(chip_, chip_.now(), pins::to_level(pins::transmitter::bit_of(frame, n)));
        }
        to(std::max(chip_.now(), start + bit() * 11));
    }
    void telegram(std::span<const std::uint8_t> octets) {
        uart_.set_rxd(chip_, chip_.now(), PinLevel::high);
        to(chip_.now() + bit() * 40);
        for (const std::uint8_t o : octets) octet(o);
    }
    void xcts(bool high) {
        uart_.set_xcts(chip_, chip_.now(), pins::to_level(high));
        look();
    }
    void processor(std::uint8_t value) {
        switch (value & 3) {
        case 0: chip_.write(control::mode_reg1_s, regmap::mode1::go_offline); break;
        case 1: chip_.write(control::mode_reg1_s, regmap::mode1::start_vpc3); break;
        case 2: static_cast<void>(chip_.read(value >> 2)); break;
        case 3:
            reset_ = uart_.txd() != PinLevel::z;
            chip_.reset();
            uart_.reset(chip_);
            answered_ = Ticks{-1};
            break;
        default: break;
        }
        look();
    }
    /// A copy of both goes on where they stopped.
    void snapshot() {
        const chip::State state = chip_.state();
        const pins::UartState uart = uart_.state();
        chip_.restore(state);
        uart_.restore(uart);
    }

    chip::Chip<core::NoTrace> chip_;
    pins::Uart<core::NoTrace> uart_;
    Listener listener_;
    Ticks answered_{-1};  ///< end of the request that was answered last
    bool sending_ = false, reset_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    Run run{data[0]};
    for (std::size_t i = 1; i + 1 < std::min<std::size_t>(size, 512); i += 2) run.step(data[i], data[i + 1]);
    return 0;
}
