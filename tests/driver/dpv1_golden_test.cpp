// SPDX-License-Identifier: Apache-2.0
// The handshake of manual figures 7-5 and 7-6 as golden traces: chip and driver, one fact a line (VPC3+C 7.2.1).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <dpchip/trace/fact_text.hpp>

#include "driver/dpv1_bench.hpp"
#include "support/golden.hpp"

namespace dpchip::driver {
namespace {

using testing::Dpv1Bench;
using testing::Octets;

/// Records from power-up on, so that the baud rate is known; what is kept begins at mark().
class Recording {
public:
    Recording() : memory_(1u << 18) { t.chip.trace().attach(memory_); }

    void mark() {
        first_ = t.chip.trace().count;
        origin_ = t.chip.now();
    }
    /// Time counts from mark().
    std::string text() {
        std::string out;
        trace::FactText render{regmap::Variant::vpc3c};
        const auto& trace = t.chip.trace();
        EXPECT_LT(trace.count, memory_.size()) << "nothing has been overwritten";
        for (std::uint64_t i = 0; i < trace.count; ++i) {
            core::TraceRecord record = memory_[i];
            record.at = record.at - origin_;
            const std::string line = render.line(record);
            if (i >= first_) out += line + '\n';
        }
        return out;
    }
    Dpv1Bench t;

private:
    std::vector<core::TraceRecord> memory_;
    std::uint64_t first_ = 0;
    core::Ticks origin_{};
};

Config quiet(const Dpv1Bench& t) {
    Config c = t.dpv1_config();
    c.user_timer = UserTimer::off;
    c.test_ram = false;
    return c;
}

// proves: VPC3C 7.2.1-06, VPC3C 7.2.1-07, VPC3C 7.2.1-08
// proves: VPC3C 7.2.1-38..54, VPC3C 5.3.1-12, VPC3C 5.3.1-13
TEST(GoldenTrace, ARequestIsTakenWorkedOnAndAnsweredAsInFigures75And76) {
    Recording r;
    r.t.to_dpv1(quiet(r.t));
    r.t.app.later = true;
    r.mark();
    EXPECT_TRUE(r.t.ms1({0x5E, 1, 0x10, 4}).empty()) << "request and a poll: SC both";
    EXPECT_TRUE(r.t.poll(51, 51).empty());
    EXPECT_TRUE(r.t.drv.complete(r.t.app.handle, answered(), Octets{1, 2, 3, 4}));
    EXPECT_EQ(r.t.poll(51, 51), (Octets{0x5E, 1, 0x10, 4, 1, 2, 3, 4}));
    r.t.run(core::microseconds(10));
    EXPECT_TRUE(test::matches_golden("driver/sap_list_handshake.trace", r.text()));
}

TEST(GoldenTrace, AnInitiateIsAnsweredInTheSameCycle) {
    Recording r;
    r.t.to_dpv1(quiet(r.t));
    r.mark();
    EXPECT_EQ(r.t.open(), 48);
    r.t.run(core::microseconds(10));
    EXPECT_TRUE(test::matches_golden("driver/sap_list_initiate.trace", r.text()));
}

}  // namespace
}  // namespace dpchip::driver
