// SPDX-License-Identifier: Apache-2.0
// A station with a chip, the driver and the parts of DP-V2 as its firmware, for the scenarios of DP-V2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/chip/chip.hpp>
#include <dpchip/core/clock.hpp>
#include <dpchip/driver/dxb_subscriber.hpp>
#include <dpchip/driver/isochron.hpp>
#include <dpchip/driver/slave_clock.hpp>
#include <dpchip/driver/vpc3.hpp>
#include <dpchip/master/config.hpp>

namespace dpchip::test {

using core::Ticks;
using Octets = std::vector<std::uint8_t>;

/// What a station is made of.
struct Dpv2Recipe {
    std::uint8_t address = 10;
    Octets cfg{0x17, 0x20};      ///< eight octets of inputs, one of outputs
    driver::DxbConfig dxb{};
    bool isochron = false;
    bool clock = false;
    bool clock_rate = true;      ///< the crystal's drift is learnt
    std::int32_t crystal_ppb = 0;
};

/// A station of a segment. Its firmware runs at the tick at which X/INT becomes active.
class Dpv2Station {
    struct Bus {
        chip::Chip<core::NoTrace>* chip;
        std::uint8_t read(std::uint16_t a) { return chip->read(a); }
        void write(std::uint16_t a, std::uint8_t v) { chip->write(a, v); }
        void read_block(std::uint16_t a, std::span<std::uint8_t> out) { chip->read_block(a, out); }
        void write_block(std::uint16_t a, std::span<const std::uint8_t> in) { chip->write_block(a, in); }
    };

public:
    /// What has come over one link.
    struct Received {
        std::uint64_t samples = 0, misplaced = 0, lost = 0;
        std::uint32_t last = 0;
    };

    explicit Dpv2Station(const Dpv2Recipe& recipe) : recipe_{recipe}, crystal_{recipe.crystal_ppb} {
        chip_.options().baud_probe_ms.fill(1);
        app_.station = this;
        driver::Config c;
        c.address = recipe.address;
        c.ident = 0x4711;
        c.cfg = recipe_.cfg;
        c.max_prm = 200;
        c.sync_ena = c.fail_safe = recipe.isochron;
        configured_ = driver_.configure(c) == driver::ConfigError::none;
        const driver::Layout& l = driver_.layout();
        const auto end = static_cast<std::uint16_t>(l.ram_bytes - (recipe.clock ? driver::SlaveClock<Bus>::kRoom : 0));
        configured_ = configured_ && dxb_.configure(recipe.dxb, l, l.used_bytes, end);
        if (recipe.clock) configured_ = configured_ && clock_.configure(l, c.bus_mode);
        clock_.correct_rate(recipe.clock_rate);
        driver::write_isochron(bus_, {});
        if (recipe.isochron) chip_.watch(1u << static_cast<unsigned>(chip::Pin::xdataexch_sync));
        configured_ = configured_ && driver_.start();
    }
    Dpv2Station(const Dpv2Station&) = delete;
    Dpv2Station& operator=(const Dpv2Station&) = delete;

    // ---- a segment::Station
    Ticks next() const { return chip_.next(); }
    void advance(Ticks to) {
        while (chip_.next() <= to) {
            chip_.advance(std::max(chip_.next(), chip_.now()));
            serve();
            if (chip_.next() <= chip_.now()) break;  // an answer waits to be taken
        }
        chip_.advance(to);
        serve();
    }
    void hear(const fdl::Transmission& t) { chip_.hear(t); }
    void hear_character(const fdl::Character& c) { chip_.hear_character(c); }
    void carrier(Ticks at) { chip_.carrier(at); }
    bool take(fdl::Transmission& t) { return chip_.take(t); }
    bool hears_all() const { return chip_.hears_all(); }
    std::uint8_t address() const { return chip_.address(); }

    // ---- to look at
    bool configured() const { return configured_; }
    const Dpv2Recipe& recipe() const { return recipe_; }
    bool exchanging() const { return chip_.dp_state() == chip::DpState::data_exch; }
    /// How the master knows it. `blocks`: structured parameters.
    master::SlaveConfig config(const Octets& blocks = {}) const {
        master::SlaveConfig c;
        c.address = recipe_.address;
        c.ident = 0x4711;
        c.cfg = recipe_.cfg;
        c.input_octets = driver_.inputs();
        c.output_octets = driver_.outputs();
        c.watchdog_ms = 200;
        c.user_prm = {0xC0, 0x00, static_cast<std::uint8_t>(0x08 | (recipe_.isochron ? 0x10 : 0x00))};
        c.user_prm.insert(c.user_prm.end(), blocks.begin(), blocks.end());
        return c;
    }
    std::uint64_t exchanges = 0, cleared = 0, left = 0, link_errors = 0;
    std::uint8_t output = 0;
    std::array<Received, 128> received{};
    Ticks oldest{};                      ///< age of the oldest sample when it was fetched, from the end of its telegram
    std::vector<Ticks> sync;             ///< beginnings of SYNC pulses, line time
    std::vector<driver::ClockEvent> clock_events;
    const driver::SlaveClock<Bus>& clock() const { return clock_; }
    std::uint64_t local_ns() const { return static_cast<std::uint64_t>(core::to_ns(chip_.now())); }

private:
    struct App : driver::Events {
        Dpv2Station* station = nullptr;
        std::uint16_t own_interrupts() const {
            return static_cast<std::uint16_t>(driver::DxbSubscriber<Bus>::kInterrupts | (station->recipe_.clock ? driver::SlaveClock<Bus>::kInterrupts : 0));
        }
        std::uint16_t more_mode0() const { return station->recipe_.clock ? driver::SlaveClock<Bus>::kMode0 : std::uint16_t{0}; }
        void serve_own(std::uint16_t irr) { station->serve_own(irr); }
        driver::Verdict set_prm(const dp::SetPrm& prm) { return station->parameters(prm) ? driver::Verdict::accept : driver::Verdict::refuse; }
        void data_exch_left() { ++station->left; }
        void dx_out() { station->exchanged(); }
    };

    void serve() {
        while (chip_.interrupt_active()) driver_.on_interrupt();
        while (!chip_.edges().empty()) {
            const chip::Edge edge = chip_.edges().pop();
            if (edge.level == chip::Level::low) sync.push_back(crystal_.line(edge.at));
        }
    }
    bool parameters(const dp::SetPrm& prm) {
        dxb_.forget();
        dp::PrmBlockWalker walker{prm.behind_dpv1_status()};
        for (dp::PrmBlock b; walker.next(b);) {
            if (dxb_.add(b, prm.wd_on()) != dp::DxbError::none) return false;
            if (const auto time = dp::decode_time_ar(b); time && recipe_.clock) clock_.start(*time, true);
        }
        return walker.error() == dp::PrmBlockError::none;
    }
    /// Inputs: address, a number that counts up with every exchange (four octets), and three octets that follow from both.
    void exchanged() {
        std::array<std::uint8_t, 1> out{};
        const driver::Outputs what = driver_.fetch_outputs(out);
        if (what == driver::Outputs::unchanged) return;
        if (what == driver::Outputs::cleared) {
            if (exchanges != 0) ++cleared;
            return;
        }
        output = out[0];
        ++exchanges;
        std::array<std::uint8_t, 8> in{};
        fill(in, recipe_.address, static_cast<std::uint32_t>(exchanges));
        driver_.write_inputs(in);
    }
    static void fill(std::span<std::uint8_t, 8> in, std::uint8_t address, std::uint32_t count) {
        in[0] = address;
        for (unsigned i = 0; i < 4; ++i) in[1 + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
        for (unsigned i = 5; i < 8; ++i) in[i] = static_cast<std::uint8_t>(address ^ count ^ i);
    }
    void serve_own(std::uint16_t irr) {
        if ((dxb_.serve(irr) & regmap::interrupt::dxb_link_error) != 0) ++link_errors;
        for (driver::DxbSample s; dxb_.fetch(s);) check(s);
        if (!recipe_.clock) return;
        const auto event = clock_.serve(irr, [this] { return local_ns(); });
        if (event != driver::ClockEvent::none) clock_events.push_back(event);
    }
    /// The links of these scenarios begin with octet 1, the number.
    void check(const driver::DxbSample& s) {
        Received& r = received[s.publisher & 0x7Fu];
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < 4 && i < s.octets.size(); ++i) count = count << 8 | s.octets[i];
        std::array<std::uint8_t, 8> expected{};
        fill(expected, s.publisher, count);
        const bool right = s.octets.size() >= 4 && std::equal(s.octets.begin(), s.octets.end(), expected.begin() + 1);
        if (!right) ++r.misplaced;
        if (r.samples != 0 && count != r.last + 1) ++r.lost;
        r.last = count;
        ++r.samples;
        oldest = std::max(oldest, chip_.now() - chip_.state().request_end);
    }

    Dpv2Recipe recipe_;
    core::Clock crystal_;
    bool configured_ = false;
    chip::Chip<core::NoTrace> chip_;
    Bus bus_{&chip_};
    App app_;
    driver::Vpc3<Bus, App> driver_{bus_, app_};
    driver::DxbSubscriber<Bus> dxb_{bus_};
    driver::SlaveClock<Bus> clock_{bus_};
};

}  // namespace dpchip::test
