// SPDX-License-Identifier: Apache-2.0
// Blocks behind the DPV1_Status octets of a Set_Prm, and the bits that go with them (VPC3+C 7.1, 7.3).
#include <vector>

#include <gtest/gtest.h>

#include <dpchip/dp/structured_prm.hpp>
#include <dpchip/master/prm_blocks.hpp>

namespace dpchip::master {
namespace {

using Octets = std::vector<std::uint8_t>;

/// Types of the blocks in the parameters.
Octets types(const SlaveConfig& slave) {
    Octets out;
    dp::PrmBlockWalker walker{std::span{slave.user_prm}.subspan(3)};
    for (dp::PrmBlock b; walker.next(b);) out.push_back(b.type);
    EXPECT_EQ(walker.error(), dp::PrmBlockError::none);
    return out;
}

SlaveConfig slave() {
    SlaveConfig s;
    s.watchdog_ms = 100;
    return s;
}

const std::vector<dp::DxbLink> kLinks{{9, 4, 1, 2}, {10, 2, 0, 2}};

TEST(PrmBlocks, stand_behind_each_other_and_set_their_bits) {
    SlaveConfig s = slave();
    ASSERT_TRUE(add_links(s, kLinks));
    EXPECT_EQ(s.user_prm, (Octets{0x80, 0, 0x08, 13, 3, 0, 0, 1, 9, 4, 1, 2, 10, 2, 0, 2}));
    ASSERT_TRUE(add_clock(s, {.interval = 1000}));
    EXPECT_FALSE(s.fail_safe);
    ASSERT_TRUE(add_isochron(s, {.version = 1, .tbase_dp = 1500, .t_dp = 8}));
    EXPECT_TRUE(s.fail_safe);
    const auto octets = add_prm_cmd(s, {.seq_nr = 3, .primary_request = true});
    ASSERT_TRUE(octets);
    EXPECT_EQ(*octets, 3u + 13 + 6 + 28 + 8);
    EXPECT_EQ(types(s), (Octets{3, 8, 4, 2}));
    EXPECT_EQ(Octets(s.user_prm.begin(), s.user_prm.begin() + 3), (Octets{0xC0, 0x00, 0x98}));
}

// proves: VPC3C 7.3.2-06, VPC3C 7.3.2-21..24
TEST(PrmBlocks, of_an_isochronous_slave_make_the_Set_Prm_of_figure_7_18) {
    SlaveConfig s = slave();
    s.ident = 0x4711;
    s.sync = s.freeze = true;
    s.group = 0x83;
    ASSERT_TRUE(add_isochron(s, {.version = 1, .tbase_dp = 1500, .t_dp = 8}));
    const Octets prm = set_prm_data(s);
    ASSERT_EQ(prm.size(), 10u + dp::kIsoMBlock);
    EXPECT_EQ(prm[0], 0x88) << "Lock_Req and WD_On; Sync_Req = Freeze_Req = 0";
    EXPECT_EQ(prm[6], 0x03) << "Group_8 = 0";
    EXPECT_EQ(prm[7] & 0x40, 0x40) << "Fail_Safe";
    EXPECT_EQ(prm[9], 0x18) << "IsoM_Req and Prm_Structure";
    EXPECT_EQ(prm[11], 4) << "Structure_Type";
}

TEST(PrmBlocks, that_cannot_be_change_nothing) {
    const auto refused = [](SlaveConfig s, auto add) {
        const Octets before = s.user_prm;
        const BlockAdded added = add(s);
        EXPECT_EQ(s.user_prm, before);
        EXPECT_FALSE(added);
        return added.error();
    };
    EXPECT_EQ(refused(slave(), [](SlaveConfig& s) { return add_links(s, {}); }), ConfigError::block);
    const std::vector<dp::DxbLink> bad{{126, 4, 1, 2}}, thirty(30, kLinks[0]);
    EXPECT_EQ(refused(slave(), [&](SlaveConfig& s) { return add_links(s, bad); }), ConfigError::block);
    EXPECT_EQ(refused(slave(), [&](SlaveConfig& s) { return add_links(s, thirty); }), ConfigError::block);
    EXPECT_EQ(refused({}, [](SlaveConfig& s) { return add_links(s, kLinks); }), ConfigError::watchdog);
    EXPECT_EQ(refused(slave(), [](SlaveConfig& s) { return add_isochron(s, {}); }), ConfigError::block);
    EXPECT_EQ(refused(slave(), [](SlaveConfig& s) { return add_prm_cmd(s, {.seq_nr = 32}); }), ConfigError::block);
    SlaveConfig plain = slave();
    plain.user_prm = {0, 0, 0, 0x11};
    EXPECT_EQ(refused(plain, [](SlaveConfig& s) { return add_clock(s, {}); }), ConfigError::block) << "user parameters without structure";
    SlaveConfig full = slave();
    full.user_prm = Octets(233, 0);
    full.user_prm[2] = 0x08;
    EXPECT_EQ(refused(full, [](SlaveConfig& s) { return add_clock(s, {}); }), ConfigError::too_long);
    full.user_prm.resize(231);
    EXPECT_TRUE(add_clock(full, {}));
}

TEST(IsochronTimes, follow_the_GSD) {
    const gsd::DpV2 v2{.tbase_dp = 1500, .tdp_min = 8, .tdp_max = 256, .t_pll_w_max = 12, .tbase_io = 375, .ti_min = 4, .to_min = 5};
    const dp::IsoMPrm times = isochron_times(v2, core::milliseconds(1));
    EXPECT_EQ(times, (dp::IsoMPrm{.version = 1, .tbase_dp = 1500, .t_dp = 8, .t_mapc = 1, .tbase_io = 375, .t_i = 4, .t_o = 5, .t_pll_w = 12}));
    EXPECT_EQ(times.cycle(), 12'000u);
    for (const core::Ticks cycle : {core::microseconds(1'001), core::microseconds(875), core::milliseconds(33), core::Ticks{}})
        EXPECT_EQ(isochron_times(v2, cycle).t_dp, 0u);
    EXPECT_EQ(isochron_times({}, core::milliseconds(1)).t_dp, 0u) << "no TBASE_DP, no isochronous cycle";
}

}  // namespace
}  // namespace dpchip::master
