// SPDX-License-Identifier: Apache-2.0
// Bus Interface Unit: from strobes on pins to accesses of the chip, and back to DB and ready (8.1.2, 10.7.2 to 10.7.5;
// hardware reference 2, 3, 5).
//
// One strobe is one access, however long it is. An access begins when strobe and select are both there, is synchronised to
// CLK, and acts at a fixed time after that edge; so does ready, whatever is accessed. A read that is given up before its
// value was taken is carried out all the same, because the request was latched; a strobe that no edge of CLK saw is none.
// Address lines are taken at the internal access or at the end of the strobe, whichever is first.
//
// Not modelled: what DB shows between the strobe and valid data. It stays high-resistance until then.
#pragma once

#include <cstdint>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/pins/clk.hpp>
#include <dpchip/pins/timing_check.hpp>
#include <dpchip/regmap/pin_rules.hpp>

namespace dpchip::pins {

/// The levels at the input pins, one bit each at the pin's number.
struct InputLevels {
    std::uint64_t high{};

    constexpr bool is_high(PinId pin) const { return ((high >> static_cast<unsigned>(pin)) & 1u) != 0; }
    constexpr void set(PinId pin, bool level) {
        const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(pin);
        high = level ? high | bit : high & ~bit;
    }
    template <std::size_t N>
    constexpr std::uint16_t number(const std::array<PinId, N>& bus) const {
        unsigned value = 0;
        for (std::size_t i = 0; i < N; ++i) value |= (is_high(bus[i]) ? 1u : 0u) << i;
        return static_cast<std::uint16_t>(value);
    }
};

/// An access of the chip inside.
struct Access {
    Ticks at{};
    bool write{};
    std::uint16_t address{};
    std::uint8_t value{};  ///< of a write
};

/// What the Biu cannot know by itself.
struct BiuContext {
    bool in_reset{};
    bool early_ready{};
    bool has_ab11{};  ///< the chip in the package has the pin function
};

class Biu {
public:
    /// Takes the straps. Whatever was going on is forgotten; a strobe that is active now is ignored until it ends.
    void configure(ProcessorMode mode, Supply supply, const InputLevels& in);
    ProcessorMode mode() const { return mode_; }

    /// A bus pin has changed, `in` is what they are now.
    void pins_changed(const InputLevels& in, const Clk& clk, const BiuContext& context, Ticks now, TimingCheck& timing);
    /// ALE has fallen: DB is the low address.
    void latch(const InputLevels& in) { ale_latch_ = static_cast<std::uint8_t>(in.number(kDataBus)); }

    Ticks next() const;
    /// True and `access` filled when one is due at or before `now`; `in` for the address.
    bool take(Ticks now, const InputLevels& in, bool has_ab11, Access& access);
    /// The value that the access take() gave has read.
    void read_value(std::uint8_t value) { value_ = value; }
    /// Moves DB and ready on to `now`; take() first.
    void outputs_until(Ticks now);

    bool drives_data() const { return drives_data_; }
    /// It does so because the strobe is active, and not for a few nanoseconds more.
    bool answers_strobe() const { return drives_data_ && release_at_ == core::kNever; }
    std::uint8_t data() const { return value_; }
    PinLevel ready() const { return ready_; }
    /// The strobe of a selected access is active.
    bool busy() const { return phase_ == Phase::open; }
    /// What it did not like, since it was asked last.
    core::FixedQueue<regmap::PinRule, 8>& complaints() { return complaints_; }

private:
    enum class Phase : std::uint8_t {
        idle,     ///< no strobe
        waiting,  ///< a strobe, but no select yet
        open,     ///< an access
        ended,    ///< the select went before the strobe did
        dead,     ///< nothing until all strobes are gone
    };
    enum class Strobe : std::uint8_t { none, read, write, both };

    Strobe strobe(const InputLevels& in) const;
    bool selected(const InputLevels& in) const;
    std::uint16_t address(const InputLevels& in, bool has_ab11) const;
    void open(const Clk& clk, const BiuContext& context, Strobe strobe, Ticks now, TimingCheck& timing);
    void end(const InputLevels& in, const Clk& clk, const BiuContext& context, Ticks now);
    void release(Ticks now);
    void drop(TimingCheck& timing, Ticks now);

    ProcessorMode mode_{};
    Supply supply_{};
    Phase phase_{};
    bool write_ = false;
    bool drives_data_ = false;
    bool address_held_ = false;        ///< the address of a write has been taken
    PinLevel ready_ = PinLevel::high;
    std::uint8_t ale_latch_ = 0, value_ = 0;
    std::uint16_t address_ = 0;
    Ticks strobe_began_{}, clk_edge_{};
    Ticks access_at_ = core::kNever;   ///< a read acts, the address of a write is taken
    Ticks data_at_ = core::kNever, ready_at_ = core::kNever;
    Ticks release_at_ = core::kNever, unready_at_ = core::kNever;
    core::FixedQueue<Access, 4> latched_;  ///< accesses whose strobe is over; at least one CLK apart
    core::FixedQueue<regmap::PinRule, 8> complaints_;
};

}  // namespace dpchip::pins
