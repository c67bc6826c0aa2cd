// SPDX-License-Identifier: Apache-2.0
// A clock that follows the time master: the firmware's part of clock synchronisation (VPC3+C 7.3.3, figure 7-24;
// reference 6.3). Stands beside Vpc3 as DxbSubscriber does, with own_interrupts() = kInterrupts and more_mode0() = kMode0.
// MAC_Reset does not exist then: Offline is noticed by poll().
//
// Besides the time the rate is corrected: correct_rate(false) leaves the local clock as fast as it is.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/clock.hpp>
#include <dpchip/driver/bus_port.hpp>
#include <dpchip/driver/corrected_time.hpp>
#include <dpchip/driver/layout.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::driver {

enum class ClockEvent : std::uint8_t {
    none,       ///< nothing for the clock
    set,        ///< the time was set
    violation,  ///< a wrong telegram, or none within two intervals
    overflow,   ///< the time came more than 71 minutes ago
};

template <BusPort Bus>
class SlaveClock {
public:
    static constexpr std::uint16_t kInterrupts = regmap::interrupt::clock_sync;
    static constexpr std::uint16_t kMode0 = regmap::mode0::cs_supported;
    /// Octets at the end of RAM that belong to the Clock_Sync-Buffer.
    static constexpr std::uint16_t kRoom = 0x20;

    explicit SlaveClock(Bus bus) : bus_{bus} {}

    /// After Vpc3::configure(). False when the layout reaches into the Clock_Sync-Buffer.
    bool configure(const Layout& layout, BusMode mode) {
        base_ = static_cast<std::uint16_t>(layout.ram_bytes - kRoom);
        acknowledge_ = mode == BusMode::motorola ? regmap::control::int_ack_reg_high : regmap::control::int_ack_reg_low;
        time_.reset();
        return layout.used_bytes <= base_;
    }
    /// Whether the drift of the local clock is learnt and allowed for (it is at first). Costs a few integer operations.
    void correct_rate(bool on) { time_.correct_rate(on); }
    /// Starts the time receiver as a Time_AR block wants it, within the handling of its Set_Prm. `check_previous`: a
    /// Clock_Value must name the time of the sequence before.
    void start(const dp::TimeAr& t, bool check_previous = false, bool ignore_cyclic = false) {
        stop();
        delay_ = t.has_delay ? t.delay : dp::NetworkTime{};
        bus_.write(at(kCommand), static_cast<std::uint8_t>((check_previous ? 4u : 0u) | (ignore_cyclic ? 2u : 0u)));
        bus_.write(at(kInterval), core::high(t.interval));
        bus_.write(static_cast<std::uint16_t>(at(kInterval) + 1), core::low(t.interval));
    }
    void stop() { bus_.write(at(kCommand), 0x01); }

    /// Figure 7-24, on Clock_Sync: Status, the buffer when it holds a time, and the acknowledgement last. `local_ns` is
    /// asked for the local time right after Receive_Delay_Time was read: what follows is the process delay time.
    template <class LocalNs>
    ClockEvent serve(std::uint16_t irr, LocalNs&& local_ns) {
        if ((irr & kInterrupts) == 0) return ClockEvent::none;
        const std::uint8_t status = bus_.read(at(kStatus));
        if ((status & 0x01u) != 0) take(static_cast<LocalNs&&>(local_ns));
        bus_.write(acknowledge_, core::low(kInterrupts));
        if ((status & 0x01u) != 0) return ClockEvent::set;
        return (status & 0x02u) != 0 ? ClockEvent::violation : ClockEvent::overflow;
    }

    /// True once the time was set.
    bool valid() const { return time_.valid(); }
    /// The system time at local time `local_ns`, which is not before that of the last setting.
    dp::NetworkTime now(std::uint64_t local_ns) const { return time_.at(local_ns); }
    /// What came with the last setting: time zone, summer time, whether the time master is synchronised.
    const dp::ClockValue& value() const { return value_; }
    /// How far the local clock was off when it was set last, in ns (new time minus old); 0 at the first setting.
    std::int64_t correction_ns() const { return time_.correction_ns(); }
    /// By how much the local clock is slow, in parts per billion; known from the second setting on.
    std::int32_t rate_ppb() const { return time_.rate_ppb(); }
    bool rate_known() const { return time_.rate_known(); }

private:
    static constexpr std::uint16_t kStatus = 0, kCommand = 1, kCvStatus = 2, kTimeEvent = 4, kDelay = 12, kPrevious = 16, kInterval = 24;
    std::uint16_t at(std::uint16_t offset) const { return static_cast<std::uint16_t>(base_ + offset); }

    template <class LocalNs>
    void take(LocalNs&& local_ns) {
        std::uint32_t delay_us = 0;
        for (std::uint16_t i = 0; i < 4; ++i) delay_us = delay_us << 8 | bus_.read(static_cast<std::uint16_t>(at(kDelay) + i));
        const std::uint64_t local = local_ns();
        std::array<std::uint8_t, dp::kClockValueOctets> octets{};
        const std::span<std::uint8_t> all{octets};
        bus_.read_block(at(kTimeEvent), all.subspan(0, 8));
        bus_.read_block(at(kPrevious), all.subspan(8, 8));
        bus_.read_block(at(kCvStatus), all.subspan(16, 2));
        value_ = *dp::decode_clock_value(octets);
        // The moment of the Time_Event by the local clock: so the delay is subject to the correction, too.
        time_.set(value_.time_event.plus(delay_), local - std::uint64_t{delay_us} * 1'000);
    }

    Bus bus_;
    std::uint16_t base_ = 0, acknowledge_ = regmap::control::int_ack_reg_low;
    dp::NetworkTime delay_{};
    CorrectedTime time_{};
    dp::ClockValue value_{};
};

}  // namespace dpchip::driver
