// SPDX-License-Identifier: Apache-2.0
// The driver on the model of the chip, a firmware that repeats outputs as inputs, and a master played by hand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/chip/chip.hpp>
#include <dpchip/driver/vpc3.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::driver::testing {

using chip::Chip;
using core::Ticks;
using Octets = std::vector<std::uint8_t>;

struct ChipBus {
    Chip<>* chip;
    std::uint8_t read(std::uint16_t a) { return chip->read(a); }
    void write(std::uint16_t a, std::uint8_t v) { chip->write(a, v); }
    void read_block(std::uint16_t a, std::span<std::uint8_t> out) { chip->read_block(a, out); }
    void write_block(std::uint16_t a, std::span<const std::uint8_t> in) { chip->write_block(a, in); }
};

struct App;
using Drv = Vpc3<ChipBus, App>;

/// Inputs repeat outputs; everything heard is counted.
struct App : Events {
    Drv* drv = nullptr;
    Octets outputs = Octets(244);
    Outputs last = Outputs::unchanged;
    int entered = 0, left = 0, prms = 0, ext_prms = 0, cfgs = 0, wd = 0, ssa = 0, offlines = 0, cleared = 0, fresh = 0, gc = -1;
    int baud = -1, new_address = -1, prm_faults = 0, cfg_faults = 0, timers = 0;
    bool no_add_chg = false;

    Verdict set_prm(const dp::SetPrm&) { ++prms; return Verdict::accept; }
    void prm_refused(PrmFault) { ++prm_faults; }
    Verdict set_ext_prm(std::span<const std::uint8_t>) { ++ext_prms; return Verdict::accept; }
    Verdict chk_cfg(std::span<const std::uint8_t>, std::uint8_t, std::uint8_t) { ++cfgs; return Verdict::accept; }
    void cfg_refused() { ++cfg_faults; }
    void data_exch_entered() { ++entered; }
    void data_exch_left() { ++left; }
    void dx_out() {
        const Outputs now = drv->fetch_outputs(outputs);
        if (now == Outputs::unchanged) return;
        last = now;
        ++(now == Outputs::fresh ? fresh : cleared);
        drv->write_inputs(std::span{outputs}.first(drv->outputs()));
    }
    void wd_dp_control_timeout() { ++wd; }
    void baud_rate_detect(std::uint8_t code) { baud = code; }
    void new_gc_command(std::uint8_t command) { gc = command; }
    void new_ssa_data(const dp::SetSlaveAdd& s) { ++ssa; new_address = s.address; no_add_chg = s.no_add_chg; }
    void user_timer_clock() { ++timers; }
    void offline() { ++offlines; }
};

inline constexpr std::uint8_t kCfg[]{0x11, 0x21};

struct Kind {
    const char* name;
    Variant variant;
    RamSize ram;
    Service service;
    BusMode bus_mode;
};

/// A chip with the firmware `Driver` and the application `Application` on it.
template <class Application, class Driver>
class Bench {
public:
    Chip<> chip;
    Application app;
    Driver drv{ChipBus{&chip}, app};
    bool serving = true;  // the firmware runs; else it is stuck
    std::uint8_t master = 2, slave = 8, fc = 0x6D;

    explicit Bench(const Kind& kind) : chip{kind.variant, fast_search()}, kind_{kind} {
        app.drv = &drv;
        chip.set_bus_mode(kind.bus_mode == BusMode::motorola ? chip::BusMode::motorola : chip::BusMode::intel);
    }

    Config config() const {
        Config c;
        c.variant = kind_.variant;
        c.ram = kind_.ram;
        c.service = kind_.service;
        c.bus_mode = kind_.bus_mode;
        c.address = slave;
        c.ident = 0x4711;
        c.cfg = kCfg;
        c.max_prm = 20;
        c.max_diag = 16;
        return c;
    }
    void power_up(const Config& c) {
        ASSERT_EQ(drv.configure(c), ConfigError::none);
        ASSERT_TRUE(drv.start());
        serve();
        for (int i = 0; i < 200 && app.baud < 0; ++i) fdl_status();
        ASSERT_EQ(app.baud, static_cast<int>(fdl::BaudCode::mbit_1_5));
    }
    void to_data_exch(const Config& c) {
        power_up(c);
        ASSERT_EQ(set_prm({0x88, 2, 5, 11, 0x47, 0x11, 0}), sc());
        ASSERT_EQ(chk_cfg({0x11, 0x21}), sc());
        ASSERT_EQ(diag(), (Octets{0x00, 0x0C, 0x00, master, 0x47, 0x11}));
        ASSERT_EQ(app.entered, 1);
    }

    // ---- the master's side
    static Octets sc() { return {0xE5}; }
    void fdl_status() { send({slave, master, 0x49}, {}); }
    Octets set_prm(Octets data) { return request(61, std::move(data)); }
    Octets chk_cfg(Octets data) { return request(62, std::move(data)); }
    Octets diag() { return answer_data(request(60, {})); }
    Octets get_cfg() { return answer_data(request(59, {})); }
    Octets exchange(Octets outputs) {
        const Octets answer = send({slave, master, next_fc()}, std::move(outputs));
        return answer.size() > 9 ? Octets(answer.begin() + 7, answer.end() - 2) : answer;
    }
    void global_control(std::uint8_t command, std::uint8_t group = 0) {
        send({0xFF, static_cast<std::uint8_t>(master | 0x80), 0x46}, {0x3A, 0x3E, command, group});
    }
    Octets request(std::uint8_t sap, Octets data) {
        data.insert(data.begin(), {sap, 0x3E});
        return send({static_cast<std::uint8_t>(slave | 0x80), static_cast<std::uint8_t>(master | 0x80), next_fc()}, data);
    }
    /// Behind DSAP and SSAP.
    static Octets answer_data(const Octets& a) {
        return a.size() > 11 ? Octets(a.begin() + 9, a.end() - 2) : Octets{};
    }
    Octets send(Octets head, const Octets& data) {
        head.insert(head.end(), data.begin(), data.end());
        std::uint8_t fcs = 0;
        for (const std::uint8_t o : head) fcs = static_cast<std::uint8_t>(fcs + o);
        const auto le = static_cast<std::uint8_t>(head.size());
        Octets t = data.empty() ? Octets{0x10} : Octets{0x68, le, le, 0x68};
        t.insert(t.end(), head.begin(), head.end());
        t.insert(t.end(), {fcs, 0x16});
        return transmit(t);
    }
    /// Function code of the next SRD request.
    std::uint8_t next_fc() {
        const std::uint8_t now = fc;
        fc = fc == 0x5D ? 0x7D : 0x5D;
        return now;
    }
    /// Sends whole telegrams as they are; the answer, or nothing.
    Octets transmit(const Octets& octets) {
        run(bit_ * 60);
        fdl::Transmission t;
        t.assign(chip.now(), bit_, octets);
        chip.carrier(t.start);
        run(t.end() - chip.now());
        chip.hear(t);
        const Ticks patience = chip.now() + bit_ * 400;
        fdl::Transmission answer;
        while (chip.next() <= patience) {
            step(chip.next());
            if (!chip.take(answer)) continue;
            run(answer.end() - chip.now());
            return {answer.bytes().begin(), answer.bytes().end()};
        }
        step(patience);
        return {};
    }
    /// Lets time pass while the firmware runs.
    void run(Ticks duration) {
        const Ticks end = chip.now() + duration;
        while (chip.next() <= end) step(chip.next());
        step(end);
    }
    /// The firmware sets this diagnosis at a moment while the master goes on.
    void say_later(Ticks at, Octets ext_diag) {
        say_at_ = at;
        said_ = std::move(ext_diag);
    }
    void serve() {
        if (!serving) return;
        for (int i = 0; i < 10; ++i) {
            if (kind_.service == Service::polled) {
                if (drv.poll() == 0) return;
            } else {
                if (!chip.interrupt_active()) return;
                drv.on_interrupt();
            }
        }
    }

private:
    static regmap::Options fast_search() {
        regmap::Options o;
        o.baud_probe_ms.fill(1);
        return o;
    }
    void step(Ticks to) {
        if (say_at_ <= to) {
            chip.advance(std::max(std::exchange(say_at_, core::kNever), chip.now()));
            drv.set_diagnosis(said_, {.ext_diag = true});
        }
        chip.advance(to);
        serve();
    }
    Kind kind_;
    Ticks say_at_ = core::kNever;
    Octets said_;
    Ticks bit_ = fdl::baud(fdl::BaudCode::mbit_1_5).bit;
};
using OnTheChip = Bench<App, Drv>;

inline constexpr Kind kKinds[]{
    {"vpc3c_2k", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::intel},
    {"vpc3c_4k_polled", Variant::vpc3c, RamSize::bytes_4096, Service::polled, BusMode::intel},
    {"vpc3c_motorola", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::motorola},
    {"vpc3b_4k", Variant::vpc3b, RamSize::bytes_4096, Service::interrupt, BusMode::intel},
    {"vpc3a", Variant::vpc3a, RamSize::bytes_2048, Service::interrupt, BusMode::intel},
    {"apc3", Variant::apc3, RamSize::bytes_1536, Service::interrupt, BusMode::intel},
    {"apc3_polled_motorola", Variant::apc3, RamSize::bytes_1536, Service::polled, BusMode::motorola},
    {"spc3", Variant::spc3, RamSize::bytes_1536, Service::interrupt, BusMode::intel},
};

}  // namespace dpchip::driver::testing
