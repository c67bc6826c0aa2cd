// SPDX-License-Identifier: Apache-2.0
// Conformance checks of the watchdog state machine: C019 to C027 (reference 8.4).
#include "checks.hpp"

#include <array>
#include <vector>

namespace dpchip::checks {
namespace {

constexpr core::TraceRecord kNoRecord{};

/// Default probe times of the search, in the order of the codes (reference 4.10).
constexpr std::array<Ticks, fdl::kBaudRates> kProbe{100_ms, 100_ms, 100_ms, 100_ms,   100_ms,
                                                    100_ms, 100_ms, 132_ms, 312.5_ms, 625_ms};

Recipe at_rate(Recipe s, std::size_t code, const regmap::Options& options = {}) {
    s.baud = static_cast<BaudCode>(code);
    s.options = options;
    return s;
}

// proves: VPC3C 1-05, VPC3C 2.1-16, VPC3C 5.2-02, VPC3C 5.2-21..31, VPC3C 5.4-01..02, VPC3C 5.4.1-01..02, APC3 1-09,
//   APC3 4.2-13, APC3 4.2-17..26, APC3 4.4.1-01..02
TEST_P(Checks, C019_the_search_tries_all_rates_from_the_fastest_on_and_begins_again) {
    Ticks begin{};
    for (std::size_t i = 0; i <= fdl::kBaudRates; ++i) {
        const std::size_t code = i % fdl::kBaudRates;
        SCOPED_TRACE(fdl::kBaud[code].name);
        Bench b{at_rate(recipe(), code), Stage::searching};
        b.run_to(begin + Ticks{kProbe[code].n / 2});
        EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, 0x0F);
        EXPECT_EQ(b.wd_state(), kBaudSearch);
        b.tell(kFdlStatus);
        b.run(4_clk);
        EXPECT_EQ(b.wd_state(), kBaudControl);
        EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, static_cast<int>(code));
        begin += kProbe[code];
    }
}

TEST_P(Checks, C019_a_telegram_at_another_rate_than_the_one_tried_proves_nothing) {
    Ticks begin{};
    for (std::size_t i = 0; i < fdl::kBaudRates; ++i) {
        const std::size_t other = (i + 1) % fdl::kBaudRates;
        SCOPED_TRACE(fdl::kBaud[i].name);
        Bench b{at_rate(recipe(), other), Stage::searching};
        b.run_to(begin + Ticks{kProbe[i].n / 2});
        b.tell(kFdlStatus);
        b.run(4_clk);
        EXPECT_EQ(b.wd_state(), kBaudSearch);
        EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, 0x0F);
        begin += kProbe[i];
    }
}

// proves: VPC3C 5.1.2-17, VPC3C 5.4.1-01..02, APC3 4.4.1-02
TEST_P(Checks, C019_the_trace_names_the_rates_in_the_order_of_the_search) {
    std::array<core::TraceRecord, 4096> ring;
    ring.fill(kNoRecord);
    Bench b{at_rate(recipe(), 0), Stage::configured};
    b.chip().trace().attach(ring);
    b.start();
    b.run(1750_ms);
    ASSERT_LE(b.chip().trace().count, ring.size());
    std::vector<std::uint32_t> probes;
    for (std::uint64_t i = 0; i < b.chip().trace().count; ++i)
        if (ring[i].what == static_cast<std::uint16_t>(regmap::Fact::baud_probe)) probes.push_back(ring[i].b);
    if (!probes.empty() && probes.front() == 0) probes.erase(probes.begin());  // Start may name the first one
    EXPECT_EQ(probes, (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    b.run(50_ms);
    EXPECT_EQ(b.wd_state(), kBaudSearch);
}

// proves: VPC3C 5.2-03, VPC3C 5.3.1-07, VPC3C 5.4-04, VPC3C 5.4.1-03, VPC3C 5.4.1-06, APC3 4.2-14, APC3 4.3-19,
//   E030
TEST_P(Checks, C020_the_telegram_that_proves_the_rate_is_not_answered_the_next_one_is) {
    Bench b{at_rate(recipe(), static_cast<std::size_t>(BaudCode::kbit_500)), Stage::searching};
    b.acknowledge();
    for (int i = 0; i < 200 && b.wd_state() == kBaudSearch; ++i) {
        EXPECT_EQ(b.irr(), 0);
        b.run(5_ms);
        EXPECT_EQ(b.ask("10 08 02 49 53 16"), kSilence);
    }
    EXPECT_EQ(b.irr(), irq::baud_rate_detect);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    EXPECT_EQ(b.peek(control::status_reg_high), traits().release << 4 | 4);
    b.acknowledge();
    for (int i = 0; i < 4; ++i) {
        b.run(5_ms);
        EXPECT_EQ(b.ask("10 08 02 49 53 16"), "10 02 08 00 0A 16");
        EXPECT_EQ(b.irr(), 0) << "Baud_Rate_Detect comes once";
    }
}

// proves: VPC3C 5.4.1-02, APC3 4.4.1-02
TEST_P(Checks, C021_tokens_and_short_acknowledgements_prove_no_rate) {
    Bench b{recipe(), Stage::searching};
    b.acknowledge();
    for (const Ticks limit = b.now() + 200_ms; b.now() < limit;) {
        EXPECT_EQ(b.ask("DC 05 02"), kSilence);
        EXPECT_EQ(b.ask("E5"), kSilence);
    }
    EXPECT_EQ(b.wd_state(), kBaudSearch);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 4.2-32, VPC3C 5.4-03, VPC3C 5.4-05, VPC3C 5.4.1-07, VPC3C 5.4.1-09, VPC3C 5.4.2-02..03, APC3 3.2-25,
//   APC3 4.4.1-01, APC3 4.4.1-03, APC3 4.4.1-05, APC3 4.4.2-02..03, E010
TEST_P(Checks, C022_silence_for_the_squared_register_value_brings_the_search_back) {
    Recipe s = recipe();
    s.baud_control = 0x10;
    Bench b{s, Stage::p0};
    EXPECT_EQ(b.ask(kFdlStatus), kFdlStatusOk);
    const Ticks last = b.request_end();
    b.run_to(last + 2550_ms - 1_clk);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    b.run_to(last + 2560_ms + 2_clk);
    EXPECT_EQ(b.wd_state(), kBaudSearch);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.peek(control::status_reg_high) & 0x0F, 0x0F);
}

// proves: VPC3C 5.4.2-05..06, APC3 4.4.2-05..06
TEST_P(Checks, C023_the_loss_of_the_rate_leaves_the_DP_state_alone_without_watchdog) {
    Recipe s = recipe();
    s.baud_control = 0x02;
    Bench b{s, Stage::p2};
    EXPECT_EQ(b.ask("68 0C 0C 68 88 82 5D 3D 3E 80 01 01 0B 47 11 00 C7 16"), kSc);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    b.run(50_ms);
    EXPECT_EQ(b.wd_state(), kBaudSearch);
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.chip().level(chip::Pin::xdataexch_sync), chip::Level::low);
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 5.2-04, VPC3C 5.3.1-06, VPC3C 5.4-08, VPC3C 5.4.3-02..03, VPC3C 5.4.3-06..08, VPC3C 2.1-13,
//   APC3 4.2-15, APC3 4.3-20, APC3 4.4.3-02, APC3 4.4.3-05..06, APC3 A.2-07, APC3 A.2-20, E013, E014
TEST_P(Checks, C024_the_watchdog_ends_data_exchange) {
    Bench b{recipe(), Stage::p2};
    b.run_to(b.request_end() + 100_ms + 2_clk);
    EXPECT_EQ(b.irr(), irq::wd_dp_control_timeout | irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
    EXPECT_EQ(b.chip().level(chip::Pin::xdataexch_sync), chip::Level::high);
    EXPECT_EQ(b.diag(), "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16");
}

// proves: VPC3C 5.4.3-02..03, VPC3C 6.2.2-18, APC3 4.4.3-02, APC3 A.2-17..18, E012
TEST_P(Checks, C025_the_watchdog_counts_milliseconds_when_octet_7_says_so) {
    Bench b{recipe(), Stage::p2};
    EXPECT_EQ(b.ask("68 0D 0D 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 04 D8 16"), kSc);
    EXPECT_EQ(b.irr(), irq::new_prm_data);
    EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    const Ticks loaded = b.request_end();
    b.run_to(loaded + 9_ms - 1_clk);
    EXPECT_EQ(b.wd_state(), kDpControl);
    EXPECT_EQ(b.irr(), 0);
    b.run_to(loaded + 10_ms + 2_clk);
    EXPECT_EQ(b.wd_state(), kBaudControl);
    EXPECT_EQ(b.irr(), irq::wd_dp_control_timeout | irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
}

// proves: VPC3C 5.4.3-01, APC3 4.4.3-01
TEST_P(Checks, C026_a_foreign_master_does_not_feed_the_watchdog) {
    Bench b{recipe(), Stage::p2};
    const Ticks last = b.request_end();
    for (int i = 1; i <= 4; ++i) {
        b.run_to(last + i * 20_ms);
        EXPECT_EQ(b.ask("68 05 05 68 88 83 6D 3C 3E F2 16"), "68 0B 0B 68 83 88 08 3E 3C 00 0C 00 02 47 11 F3 16");
    }
    b.run_to(last + 90_ms - 1_clk);
    EXPECT_EQ(b.wd_state(), kDpControl);
    b.run_to(last + 100_ms + 2_clk);
    EXPECT_EQ(b.irr(), irq::wd_dp_control_timeout | irq::go_leave_data_exch | irq::dx_out);
    EXPECT_EQ(b.dp_state(), kWaitPrm);
}

// proves: VPC3C 5.4.3-01, APC3 4.4.3-01
TEST_P(Checks, C027_any_service_of_the_owner_feeds_the_watchdog) {
    Bench b{recipe(), Stage::p2};
    for (int i = 0; i < 25; ++i) {
        EXPECT_EQ(b.ask_verbatim(i % 2 == 0 ? "68 05 05 68 88 82 5D 3C 3E E1 16" : "68 05 05 68 88 82 7D 3C 3E 01 16"),
                  kDiagDataExch);
        b.run(20_ms);
    }
    EXPECT_EQ(b.dp_state(), kDataExch);
    EXPECT_EQ(b.wd_state(), kDpControl);
    EXPECT_EQ(b.irr(), 0);
}

}  // namespace
}  // namespace dpchip::checks
