// SPDX-License-Identifier: Apache-2.0
// Records by slot and index, identification from a GSD, and what a GSD's DP-V1 keywords switch on.
#include <gtest/gtest.h>

#include <algorithm>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/slave/error.hpp>
#include <dpchip/slave/record_table.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::slave {
namespace {

using dp::ErrorCode1;
using Octets = std::vector<std::uint8_t>;

RecordTable table() {
    return RecordTable{{{2, 9, RecordAccess::rw, {1, 2, 3}, 0}, {1, 1, RecordAccess::ro, {7}, 0}, {1, 5, RecordAccess::wo, {}, 4}}};
}

TEST(RecordTable, GivesWhatMayBeRead) {
    const RecordTable t = table();
    ASSERT_EQ(t.error(), RecordTable::Error::none);
    ASSERT_TRUE(t.read(2, 9));
    EXPECT_TRUE(std::ranges::equal(*t.read(2, 9), Octets{1, 2, 3}));
    EXPECT_EQ(t.read(1, 5).error(), ErrorCode1::access_denied);
    EXPECT_EQ(t.read(1, 2).error(), ErrorCode1::invalid_index);
    EXPECT_EQ(t.read(0, 2).error(), ErrorCode1::invalid_index);
    EXPECT_EQ(t.read(3, 1).error(), ErrorCode1::invalid_slot);
}

TEST(RecordTable, TakesWhatMayBeWritten) {
    RecordTable t = table();
    EXPECT_EQ(*t.write(2, 9, Octets{8, 9}), 2u);
    EXPECT_TRUE(std::ranges::equal(*t.read(2, 9), Octets{8, 9}));
    EXPECT_EQ(*t.write(2, 9, Octets{8, 9, 10}), 3u);
    EXPECT_EQ(t.write(2, 9, Octets(4)).error(), ErrorCode1::write_length_error);
    EXPECT_EQ(*t.write(1, 5, Octets{1, 2, 3, 4}), 4u);
    EXPECT_TRUE(std::ranges::equal(t.octets(1, 5), Octets{1, 2, 3, 4}));
    EXPECT_EQ(t.write(1, 1, Octets{1}).error(), ErrorCode1::access_denied);
    EXPECT_EQ(t.write(9, 1, Octets{1}).error(), ErrorCode1::invalid_slot);
    EXPECT_TRUE(t.set(1, 1, Octets{5}));  // the process may
    EXPECT_FALSE(t.set(1, 2, Octets{5}));
    EXPECT_TRUE(std::ranges::equal(*t.read(1, 1), Octets{5}));
}

TEST(RecordTable, SaysWhatIsWrongWithIt) {
    using Error = RecordTable::Error;
    EXPECT_EQ(RecordTable({{1, 1, RecordAccess::rw, {1}, 0}, {1, 1, RecordAccess::ro, {2}, 0}}).error(), Error::twice);
    EXPECT_EQ(RecordTable({{1, 1, RecordAccess::rw, Octets(241), 0}}).error(), Error::too_long);
    EXPECT_EQ(RecordTable({{1, 1, RecordAccess::rw, {}, 0}}).error(), Error::empty);
    for (const auto e : {Error::none, Error::twice, Error::too_long, Error::empty}) EXPECT_STRNE(name(e), "unknown");
}

const gsd::Gsd& dpv1_io() {
    static const gsd::Gsd gsd = gsd::load(DPCHIP_SOURCE_DIR "/examples/dpv1_io.gsd");
    return gsd;
}

SlaveSetup setup() {
    SlaveSetup s;
    s.address = 5;
    s.modules = {"8 DI / 8 DO"};
    return s;
}

TEST(Dpv1FromTheGsd, SwitchesOnWhatTheKeywordsSay) {
    const StationPlan plan{dpv1_io(), setup()};
    const driver::AcyclicConfig& a = plan.driver.dpv1;
    EXPECT_TRUE(a.ms1 && a.alarm_sap && a.identification);
    EXPECT_EQ(a.ms1_max_data, 240);
    EXPECT_EQ(a.connections, 4);
    EXPECT_EQ(a.ms2_max_data, 240);
    EXPECT_EQ(a.max_initiate, 52);
    EXPECT_EQ(a.alarms, 0xFC);
    EXPECT_EQ(a.alarm_sequence, 8);
    EXPECT_EQ(a.max_alarm, 27);
}

TEST(Dpv1FromTheGsd, IsOffInAChipWithoutIt) {
    for (const regmap::Variant v : {regmap::Variant::vpc3a, regmap::Variant::apc3, regmap::Variant::spc3}) {
        SlaveSetup s = setup();
        s.variant = v;
        EXPECT_FALSE((StationPlan{dpv1_io(), s}.driver.dpv1.any()));
    }
}

TEST(Dpv1FromTheGsd, GivesUpConnectionsThatTheRamHasNoRoomFor) {
    gsd::Gsd greedy = dpv1_io();
    greedy.dpv1.c2_max_count_channels = 49;
    const StationPlan plan{greedy, setup()};
    EXPECT_GT(plan.driver.dpv1.connections, 8);
    EXPECT_LT(plan.driver.dpv1.connections, 49);
    const VirtualSlave slave{greedy, setup()};
    EXPECT_EQ(slave.plan().driver.dpv1.connections, plan.driver.dpv1.connections);
}

TEST(Dpv1FromTheGsd, TellsWhoItIs) {
    const Identification id = identification(dpv1_io());
    EXPECT_EQ(std::string(id.im0.order_id.data(), 20), "DPCHIP-V1           ");
    EXPECT_EQ(id.im0.software_revision, (std::array<char, 4>{'V', 1, 2, 3}));
    Identification changed = id;
    EXPECT_FALSE(changed.write(dp::kIm0, dp::encode(dp::Im0{})));
    EXPECT_TRUE(changed.write(dp::kIm4, dp::encode(dp::Im4{})));
    EXPECT_FALSE(changed.record(dp::kIm4 + 1));
}

TEST(Dpv1FromTheGsd, RefusesRecordsThatCannotBe) {
    SlaveSetup s = setup();
    s.records = {{1, 1, RecordAccess::rw, {1}, 0}, {1, 1, RecordAccess::rw, {1}, 0}};
    try {
        const VirtualSlave slave{dpv1_io(), s};
        FAIL();
    } catch (const SlaveError& e) {
        EXPECT_EQ(e.kind(), SlaveError::Kind::records);
        EXPECT_STREQ(e.what(), "two records have the same slot and index");
    }
}

}  // namespace
}  // namespace dpchip::slave
