// SPDX-License-Identifier: Apache-2.0
// The parts of DP-V2 beside the driver, on the model of the chip: links from parameter blocks, samples, isochronous
// cycles, a clock that follows the time master, PrmCmd (reference 6; VPC3+C 7.3).
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include <dpchip/driver/dxb_subscriber.hpp>
#include <dpchip/driver/isochron.hpp>
#include <dpchip/driver/redundancy.hpp>
#include <dpchip/driver/slave_clock.hpp>

#include "driver/on_the_chip.hpp"

namespace dpchip::driver {
namespace {

using namespace core::literals;
using core::Ticks;
using testing::ChipBus;
using testing::Kind;
using testing::Octets;

struct V2App;
using V2Driver = Vpc3<ChipBus, V2App>;

struct V2App : Events {
    V2Driver* drv = nullptr;
    chip::Chip<>* chip = nullptr;
    std::optional<DxbSubscriber<ChipBus>> dxb;
    std::optional<SlaveClock<ChipBus>> clock;
    IsochronConfig isochron{};
    SynchMeter meter;
    RedundantHalf half;
    dp::DxbError fault = dp::DxbError::none;
    std::vector<Octets> samples;
    std::vector<ClockEvent> clock_events;
    int link_errors = 0, entered = 0, dx = 0, baud = -1;
    std::uint8_t link_octets_in_time = 0;  ///< R_Len_DXB_Link_Buf when New_Prm_Data had not been acknowledged yet

    std::uint16_t own_interrupts() const { return DxbSubscriber<ChipBus>::kInterrupts | (clock ? SlaveClock<ChipBus>::kInterrupts : 0); }
    std::uint16_t more_mode0() const { return clock ? SlaveClock<ChipBus>::kMode0 : std::uint16_t{0}; }
    std::uint8_t more_mode2() const { return mode2(isochron); }
    void serve_own(std::uint16_t irr) {
        const std::uint16_t mine = dxb->serve(irr);
        for (DxbSample s; dxb->fetch(s);) {
            samples.push_back({s.publisher});
            samples.back().insert(samples.back().end(), s.octets.begin(), s.octets.end());
        }
        if ((mine & regmap::interrupt::dxb_link_error) != 0) ++link_errors;
        if (!clock) return;
        const ClockEvent event = clock->serve(irr, [&] { return static_cast<std::uint64_t>(core::to_ns(chip->now())); });
        if (event != ClockEvent::none) clock_events.push_back(event);
    }
    Verdict set_prm(const dp::SetPrm& prm) {
        dxb->forget();
        const Verdict verdict = blocks(prm.behind_dpv1_status(), prm.wd_on());
        if ((chip->state().irr & regmap::interrupt::new_prm_data) != 0) link_octets_in_time = chip->peek(regmap::org::r_len_dxb_link_buf);
        return verdict;
    }
    Verdict blocks(std::span<const std::uint8_t> octets, bool wd_on) {
        dp::PrmBlockWalker walker{octets};
        for (dp::PrmBlock b; walker.next(b);) {
            if (const dp::DxbError e = dxb->add(b, wd_on); e != dp::DxbError::none) return fault = e, Verdict::refuse;
            if (const auto time = dp::decode_time_ar(b); time && clock) clock->start(*time);
            if (const auto cmd = dp::decode_prm_cmd(b)) {
                std::array<std::uint8_t, dp::kRedStatus> ack{};
                EXPECT_TRUE(dp::encode(half.command(*cmd), ack));
                drv->set_diagnosis(ack, {.ext_diag = false});
            }
        }
        return walker.error() == dp::PrmBlockError::none ? Verdict::accept : Verdict::refuse;
    }
    void data_exch_entered() { ++entered; half.set_data_exchange(true); }
    void dx_out() { ++dx; }
    void new_gc_command(std::uint8_t) { meter.observe(static_cast<std::uint64_t>(core::to_ns(chip->now()))); }
    void baud_rate_detect(std::uint8_t code) { baud = code; half.set_baud_found(true); }
};

class V2 : public testing::Bench<V2App, V2Driver> {
public:
    explicit V2(const Kind& kind) : Bench{kind} {
        app.chip = &chip;
        app.dxb.emplace(ChipBus{&chip});
        app.dxb->set_bus_mode(kind.bus_mode);
    }
    Config v2_config() const {
        Config c = config();
        c.max_prm = 200;
        c.max_diag = 70;
        c.prm_cmd_supported = true;
        return c;
    }
    void to_data_exch_with(const Config& c, const DxbConfig& links, const Octets& prm, bool with_clock = false) {
        if (with_clock) app.clock.emplace(ChipBus{&chip});
        ASSERT_EQ(drv.configure(c), ConfigError::none);
        ASSERT_TRUE(!with_clock || app.clock->configure(drv.layout(), c.bus_mode));
        const std::uint16_t end = static_cast<std::uint16_t>(drv.layout().ram_bytes - (with_clock ? SlaveClock<ChipBus>::kRoom : 0));
        ASSERT_TRUE(app.dxb->configure(links, drv.layout(), drv.layout().used_bytes, end));
        ChipBus bus{&chip};
        write_isochron(bus, app.isochron);
        ASSERT_TRUE(drv.start());
        serve();
        for (int i = 0; i < 200 && app.baud < 0; ++i) fdl_status();
        ASSERT_EQ(set_prm(prm), sc());
        ASSERT_EQ(chk_cfg({0x11, 0x21}), sc());
        run(1_ms);
    }
    void broadcast(std::uint8_t function, std::uint8_t sa, const Octets& data) { send({0x7F, sa, function}, data); }
    void synch() { send({0xFF, 0x82, 0x46}, {0x3A, 0x3E, 0x00, 0x80}); }
};

/// Set_Prm with DPV1_Status octets, Prm_Structure, and these blocks; the watchdog is 100 ms.
Octets prm_with(const Octets& blocks, bool wd_on = true, std::uint8_t status_3 = 0x08) {
    Octets d{static_cast<std::uint8_t>(wd_on ? 0x88 : 0x80), 2, 5, 11, 0x47, 0x11, 0, 0xC0, 0, status_3};
    d.insert(d.end(), blocks.begin(), blocks.end());
    return d;
}

constexpr Kind kV2Kinds[]{
    {"vpc3c_2k", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::intel},
    {"vpc3c_4k_polled", Variant::vpc3c, RamSize::bytes_4096, Service::polled, BusMode::intel},
    {"vpc3c_motorola", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::motorola},
};
class DriverDpv2 : public ::testing::TestWithParam<Kind> {
protected:
    V2 t{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Each, DriverDpv2, ::testing::ValuesIn(kV2Kinds), [](const auto& p) { return std::string{p.param.name}; });

const Octets kTwoLinks{13, 3, 0, 0, 1, 9, 4, 1, 2, 10, 1, 0, 1};

// proves: VPC3C 7.3.1-15..17, VPC3C 7.3.1-23..24, VPC3C 7.3.1-36
TEST_P(DriverDpv2, takes_links_from_the_parameters_and_hands_their_samples_to_the_application) {
    t.to_data_exch_with(t.v2_config(), {29, 8}, prm_with(kTwoLinks));
    ASSERT_EQ(t.app.entered, 1);
    ASSERT_EQ(t.app.dxb->links().size(), 2u);
    t.broadcast(0x08, 9, {0x11, 0x22, 0x33, 0x44});
    t.run(100_us);
    t.broadcast(0x08, 10, {0x55});
    t.run(100_us);
    t.broadcast(0x08, 11, {0x66});
    t.run(100_us);
    EXPECT_EQ(t.app.samples, (std::vector<Octets>{{9, 0x22, 0x33}, {10, 0x55}}));
    std::array<std::uint8_t, 62> status{};
    ASSERT_EQ(t.app.dxb->status_message(status), 8u);
    EXPECT_EQ(Octets(status.begin(), status.begin() + 8), (Octets{8, 0x83, 0, 0, 9, dp::kDataExist, 10, dp::kDataExist}));
}

// proves: VPC3C 7.3.1-25
TEST_P(DriverDpv2, has_the_links_in_their_buffers_before_it_acknowledges_the_parameters) {
    t.to_data_exch_with(t.v2_config(), {29, 8}, prm_with(kTwoLinks));
    EXPECT_EQ(t.app.link_octets_in_time, 8);
}

TEST_P(DriverDpv2, tells_of_broken_links) {
    t.to_data_exch_with(t.v2_config(), {29, 8}, prm_with(kTwoLinks));
    t.broadcast(0x08, 9, {0x11, 0x22, 0x33, 0x44});
    for (int i = 0; i < 12; ++i) {
        t.exchange({1, 2});
        t.run(20_ms);
    }
    EXPECT_EQ(t.app.link_errors, 1);
    EXPECT_EQ(t.app.dxb->link_status(0), 0);
}

// proves: VPC3C 7.3.1-15, VPC3C 7.3.1-21, VPC3C 7.3.1-23
TEST_P(DriverDpv2, takes_links_of_a_subscribertable_without_its_destinations) {
    t.to_data_exch_with(t.v2_config(), {29, 8}, prm_with({11, 7, 0, 0, 1, 9, 4, 1, 3, 16, 2}));
    t.broadcast(0x08, 9, {0x11, 0x22, 0x33, 0x44});
    t.run(100_us);
    EXPECT_EQ(t.app.samples, (std::vector<Octets>{{9, 0x22, 0x33}}));
    EXPECT_EQ(t.app.dxb->links()[0].dest_slot, 3);
    EXPECT_EQ(t.app.dxb->links()[0].offset_data_area, 16);
}

// proves: VPC3C 7.3.1-18
TEST_P(DriverDpv2, refuses_links_that_can_never_work) {
    struct Row { Octets prm; dp::DxbError error; };
    Octets thirty{125, 3, 0, 0, 1};
    for (int i = 0; i < 30; ++i) thirty.insert(thirty.end(), {9, 4, 0, 1});
    for (const Row& row : {Row{prm_with({9, 3, 0, 0, 1, 126, 4, 1, 2}), dp::DxbError::publisher}, Row{prm_with({9, 3, 0, 0, 1, 9, 4, 3, 2}), dp::DxbError::sample},
                           Row{prm_with({9, 3, 0, 0, 1, 9, 20, 0, 9}), dp::DxbError::sample}, Row{prm_with({9, 3, 0, 0, 2, 9, 4, 1, 2}), dp::DxbError::version},
                           Row{prm_with(kTwoLinks, false), dp::DxbError::watchdog}, Row{prm_with(thirty), dp::DxbError::length}}) {
        V2 other{GetParam()};
        other.to_data_exch_with(other.v2_config(), {29, 8}, row.prm);
        EXPECT_EQ(other.app.fault, row.error);
        EXPECT_EQ(other.app.entered, 0);
        EXPECT_EQ(other.diag()[0] & 0x40, 0x40) << "Prm_Fault";
        EXPECT_TRUE(other.app.dxb->links().empty());
    }
}

TEST_P(DriverDpv2, a_new_Set_Prm_replaces_the_links) {
    t.to_data_exch_with(t.v2_config(), {29, 8}, prm_with(kTwoLinks));
    t.set_prm(prm_with({9, 3, 0, 0, 1, 12, 1, 0, 1}));
    t.run(100_us);
    t.broadcast(0x08, 9, {0x11, 0x22, 0x33, 0x44});
    t.run(100_us);
    t.broadcast(0x08, 12, {0x77});
    t.run(100_us);
    EXPECT_EQ(t.app.samples, (std::vector<Octets>{{12, 0x77}}));
}

TEST_P(DriverDpv2, gives_the_buffers_no_room_that_is_not_there) {
    Config c = t.v2_config();
    ASSERT_EQ(t.drv.configure(c), ConfigError::none);
    DxbSubscriber<ChipBus> dxb{ChipBus{&t.chip}};
    const Layout& l = t.drv.layout();
    const std::uint16_t room = DxbSubscriber<ChipBus>::room({29, 8}, l.shift);
    EXPECT_TRUE(dxb.configure({29, 8}, l, l.used_bytes, static_cast<std::uint16_t>(l.used_bytes + room)));
    EXPECT_FALSE(dxb.configure({29, 8}, l, l.used_bytes, static_cast<std::uint16_t>(l.used_bytes + room - 1)));
    EXPECT_FALSE(dxb.configure({30, 8}, l, l.used_bytes, l.ram_bytes));
    EXPECT_FALSE(dxb.configure({29, 0}, l, l.used_bytes, l.ram_bytes));
    EXPECT_TRUE(dxb.configure({0, 0}, l, l.ram_bytes, l.ram_bytes));
}

// ---- isochronous cycles -------------------------------------------------------------------------------------------

TEST_P(DriverDpv2, an_isochronous_application_measures_its_SYNCHs) {
    Config c = t.v2_config();
    c.sync_ena = c.fail_safe = true;
    t.to_data_exch_with(c, {}, prm_with({}, true, 0x18));
    ASSERT_EQ(t.app.entered, 1);
    t.app.meter.expect(1'000'000, 1'000);
    const Ticks begin = t.chip.now();
    for (const int at_us : {1000, 2000, 3000, 4010, 5000, 8000, 9000}) {
        t.run(begin + core::microseconds(at_us) - t.chip.now());
        t.synch();
    }
    EXPECT_EQ(t.app.meter.synchs(), 7u);
    EXPECT_EQ(t.app.meter.late(), 2u) << "one came 10 us late, and the next one early after it";
    EXPECT_EQ(t.app.meter.missing(), 1u);
    EXPECT_NEAR(static_cast<double>(t.app.meter.jitter()), 20'000.0, 100.0);
}

// proves: VPC3C 7.3.2-10
TEST_P(DriverDpv2, in_Simple_Sync_Mode_outputs_are_told_of_at_the_SYNCH) {
    t.app.isochron.simple_sync = true;
    Octets prm = prm_with({}, true, 0x00);
    prm[6] = 0x80;
    t.to_data_exch_with(t.v2_config(), {}, prm);
    const int before = t.app.dx;
    t.exchange({1, 2});
    EXPECT_EQ(t.app.dx, before);
    t.synch();
    EXPECT_EQ(t.app.dx, before + 1);
}

// ---- clock --------------------------------------------------------------------------------------------------------

constexpr dp::NetworkTime kNoon = dp::NetworkTime::from_wire(0xC3123456, 0);

void time_event(V2& t, const dp::NetworkTime& now, const dp::NetworkTime& before) {
    t.send({0x7F, 0x02, 0x40}, {});
    std::array<std::uint8_t, 18> value{};
    ASSERT_TRUE(dp::encode(dp::ClockValue{.time_event = now, .previous = before}, value));
    t.run(500_us);
    t.broadcast(0xC0, 2, Octets(value.begin(), value.end()));
    t.run(1_ms);
}

// proves: VPC3C 7.3.3-13, VPC3C 7.3.3-15, VPC3C 7.3.3-49
TEST_P(DriverDpv2, the_clock_of_the_slave_follows_the_time_master) {
    t.to_data_exch_with(t.v2_config(), {}, prm_with({14, 8, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0}), true);
    ASSERT_EQ(t.app.entered, 1);
    EXPECT_FALSE(t.app.clock->valid());
    // send() waits 60 bits, then SD1 lasts 66: the end of the Time_Event.
    const Ticks event = t.chip.now() + 126 * fdl::baud(fdl::BaudCode::mbit_1_5).bit;
    time_event(t, kNoon, {});
    ASSERT_EQ(t.app.clock_events, std::vector{ClockEvent::set});
    const auto local = static_cast<std::uint64_t>(core::to_ns(t.chip.now()));
    const std::int64_t elapsed = t.app.clock->now(local).minus_ns(kNoon);
    EXPECT_LT(std::abs(elapsed - core::to_ns(t.chip.now() - event)), 2'000) << "two microseconds";
    EXPECT_TRUE(t.app.clock->value().synchronised);
}

// proves: VPC3C 7.3.3-14..15
TEST_P(DriverDpv2, CS_Delay_Time_is_part_of_the_system_time) {
    // 2^26 / 2^32 s = 15.625 ms
    t.to_data_exch_with(t.v2_config(), {}, prm_with({14, 8, 0, 0, 0, 100, 0, 0, 0, 2, 4, 0, 0, 0}), true);
    const Ticks event = t.chip.now() + 126 * fdl::baud(fdl::BaudCode::mbit_1_5).bit;
    time_event(t, kNoon, {});
    const auto local = static_cast<std::uint64_t>(core::to_ns(t.chip.now()));
    const std::int64_t expected = 2'015'625'000 + core::to_ns(t.chip.now() - event);
    EXPECT_LT(std::abs(t.app.clock->now(local).minus_ns(kNoon) - expected), 2'000);
}

TEST_P(DriverDpv2, the_clock_learns_its_rate_unless_it_is_told_not_to) {
    for (const bool correct : {true, false}) {
        V2 other{GetParam()};
        other.to_data_exch_with(other.v2_config(), {}, prm_with({6, 8, 0, 0, 0, 100}, false), true);
        other.app.clock->correct_rate(correct);
        const Ticks begin = other.chip.now();
        for (int i = 0; i < 3; ++i) {  // the time master's second is 100 ppm shorter than that of the chip
            other.run(begin + 1_s * i - other.chip.now());
            time_event(other, kNoon.plus_us(static_cast<std::uint64_t>(i) * 999'900), {});
        }
        EXPECT_EQ(other.app.clock->rate_known(), correct);
        EXPECT_NEAR(other.app.clock->rate_ppb(), correct ? -100'000.0 : 0.0, 2'000.0);
    }
}

TEST_P(DriverDpv2, the_clock_counts_violations_and_goes_on) {
    t.to_data_exch_with(t.v2_config(), {}, prm_with({6, 8, 0, 0, 0, 100}), true);
    time_event(t, kNoon, {});
    t.broadcast(0xC0, 2, Octets(18));
    t.broadcast(0xC0, 2, Octets(8));
    EXPECT_EQ(t.app.clock_events, (std::vector{ClockEvent::set, ClockEvent::violation, ClockEvent::violation}));
    time_event(t, kNoon.plus_us(5'000'000), kNoon);
    EXPECT_EQ(t.app.clock_events.back(), ClockEvent::set);
    EXPECT_NE(t.app.clock->correction_ns(), 0);
}

TEST_P(DriverDpv2, Offline_is_noticed_without_MAC_Reset) {
    t.to_data_exch_with(t.v2_config(), {}, prm_with({6, 8, 0, 0, 0, 100}), true);
    t.drv.go_offline();
    t.run(1_ms);
    t.drv.poll();
    EXPECT_EQ(t.drv.state(), State::offline);
}

// ---- redundancy ---------------------------------------------------------------------------------------------------

TEST_P(DriverDpv2, a_PrmCmd_is_acknowledged_by_a_status_message) {
    t.to_data_exch_with(t.v2_config(), {}, prm_with({8, 2, 0, 0x28, 0x01, 0, 0, 0}, true, 0x88));
    ASSERT_EQ(t.app.entered, 1);
    EXPECT_EQ(t.app.half.role(), Role::backup);
    t.set_prm(prm_with({8, 2, 0, 0x30, 0x02, 0, 0, 0}, true, 0x88));
    t.run(1_ms);
    EXPECT_EQ(t.app.half.role(), Role::primary);
    const Octets diag = t.diag();
    ASSERT_EQ(diag.size(), 14u);
    const auto ack = dp::decode_red_status(std::span{diag}.subspan(6));
    ASSERT_TRUE(ack);
    EXPECT_TRUE(ack->acknowledges);
    EXPECT_EQ(ack->seq_nr, 6);
    EXPECT_EQ(ack->function, 0x02);
    EXPECT_EQ(ack->red_state_1, dp::kRedPrimary | dp::kRedDataExchange | dp::kRedBaudrateFound);
}

}  // namespace
}  // namespace dpchip::driver
