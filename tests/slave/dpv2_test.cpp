// SPDX-License-Identifier: Apache-2.0
// DP-V2 of virtual slaves: links, SYNCHs, a clock and PrmCmd as the GSD says, the rest refused or left alone (reference 6).
#include <gtest/gtest.h>

#include <string>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "slave/bench_master.hpp"

namespace dpchip::slave {
namespace {

using namespace core::literals;
using testing::BenchMaster;
using testing::Octets;

gsd::Gsd station(const std::string& abilities) {
    return gsd::parse(R"(#Profibus_DP
GSD_Revision = 5
Vendor_Name = "dpchip"
Model_Name = "Drive"
Revision = "1"
Ident_Number = 0x4711
Protocol_Ident = 0
Station_Type = 0
Hardware_Release = "1"
Software_Release = "1"
1.5M_supp = 1
MaxTsdr_1.5M = 150
Auto_Baud_supp = 1
Fail_Safe = 1
DPV1_Slave = 1
Max_Diag_Data_Len = 32
Max_User_Prm_Data_Len = 237
Ext_User_Prm_Data_Const(0) = 0xC0,0x00,0x08
Slave_Family = 3
)" + abilities + R"(
Module = "2 in, 2 out" 0x31
EndModule
)").gsd;
}

const char* const kSubscriber = "Subscriber_supp = 1\nDXB_Max_Link_Count = 4\nDXB_Max_Data_Length = 16\n";
const Octets kLink{9, 3, 0, 0, 1, 9, 4, 1, 2};

struct Told : Dpv2Handler {
    std::vector<Octets> samples;
    std::vector<core::Ticks> synchs;
    int broken = 0, times = 0;
    std::vector<dp::RedStatus> commands;
    void sample(const driver::DxbSample& s) override {
        samples.push_back({s.publisher});
        samples.back().insert(samples.back().end(), s.octets.begin(), s.octets.end());
    }
    void link_error() override { ++broken; }
    void synch(core::Ticks at) override { synchs.push_back(at); }
    void clock(driver::ClockEvent) override { ++times; }
    void redundancy(const dp::RedStatus& s) override { commands.push_back(s); }
};

struct Rig {
    explicit Rig(const std::string& abilities) : gsd{station(abilities)}, slave{gsd, {.modules = {"2 in, 2 out"}, .address = 8}} {
        slave.set_dpv2_handler(&told);
        slave.chip().options().baud_probe_ms.fill(1);
        EXPECT_TRUE(master.find_baud());
    }
    /// Set_Prm with Prm_Structure and these blocks, then Chk_Cfg; true when it came to DATA-EXCH.
    bool bring_up(const Octets& blocks, std::uint8_t status_1 = 0xC0, std::uint8_t status_3 = 0x08) {
        Octets user{status_1, 0x00, status_3};
        user.insert(user.end(), blocks.begin(), blocks.end());
        master.set_prm(user);
        master.chk_cfg({0x31});
        master.run(1_ms);
        return slave.dp_state() == chip::DpState::data_exch;
    }
    void broadcast(std::uint8_t sa, std::uint8_t fc, const Octets& data) { master.send({0x7F, sa, fc}, data); }

    gsd::Gsd gsd;
    VirtualSlave slave;
    BenchMaster master{slave, 8};
    Told told;
};

TEST(VirtualSlaveDpv2, a_subscriber_takes_links_and_hands_samples_over) {
    Rig r{kSubscriber};
    ASSERT_TRUE(r.bring_up(kLink));
    ASSERT_EQ(r.slave.links().size(), 1u);
    r.broadcast(9, 0x08, {0x11, 0x22, 0x33, 0x44});
    EXPECT_EQ(r.told.samples, (std::vector<Octets>{{9, 0x22, 0x33}}));
    EXPECT_EQ(r.slave.link_status(0), dp::kDataExist);
    EXPECT_EQ(r.slave.dpv2_counters().samples, 1u);
    r.broadcast(9, 0x08, {0x11, 0x22});
    EXPECT_EQ(r.slave.link_status(0), dp::kLinkError);
    for (int i = 0; i < 70; ++i) {  // the watchdog time is a second
        r.master.exchange({1, 2});
        r.master.run(20_ms);
    }
    EXPECT_EQ(r.told.broken, 1);
}

TEST(VirtualSlaveDpv2, links_that_the_GSD_has_no_room_for_are_refused) {
    for (const Octets& bad : {Octets{25, 3, 0, 0, 1, 9, 4, 1, 2, 10, 4, 1, 2, 11, 4, 1, 2, 12, 4, 1, 2, 13, 4, 1, 2}, Octets{9, 3, 0, 0, 1, 9, 40, 0, 17},
                              Octets{9, 3, 0, 0, 1, 126, 4, 1, 2}, Octets{9, 3, 0, 0, 1, 9}}) {
        Rig r{kSubscriber};
        EXPECT_FALSE(r.bring_up(bad));
        EXPECT_EQ(r.slave.dpv2_counters().blocks_refused, 1u);
    }
}

TEST(VirtualSlaveDpv2, Publisher_supp_decides_whether_it_can_be_a_publisher) {
    Rig yes{"Publisher_supp = 1\n"}, no{kSubscriber};
    EXPECT_TRUE(yes.bring_up({}, 0xE0));
    EXPECT_FALSE(no.bring_up({}, 0xE0));
    const Octets answer = yes.master.send({8, 2, 0x67}, {1, 2});
    ASSERT_GT(answer.size(), 6u);
    EXPECT_EQ(answer[4], 0x7F) << "to everybody";
}

TEST(VirtualSlaveDpv2, an_isochronous_drive_tells_of_every_SYNCH) {
    Rig r{"Isochron_Mode_supp = 1\n"};
    Octets block(dp::kIsoMBlock);
    ASSERT_TRUE(dp::encode(dp::IsoMPrm{.version = 1, .tbase_dp = 1500, .t_dp = 8, .t_mapc = 1, .tbase_io = 1500, .t_pll_w = 12}, block));
    ASSERT_TRUE(r.bring_up(block, 0xC0, 0x18));
    const Ticks begin = r.master.now + 1_ms;
    for (int i = 0; i < 5; ++i) {
        r.master.run(begin + core::milliseconds(2 * i) - r.master.now);
        r.master.send({0xFF, 0x82, 0x46}, {0x3A, 0x3E, 0x00, 0x80});
    }
    r.master.run(1_ms);
    ASSERT_EQ(r.told.synchs.size(), 5u);
    EXPECT_EQ(r.slave.synch_meter().synchs(), 5u);
    EXPECT_EQ(r.slave.synch_meter().missing(), 4u) << "it was told of a millisecond";
    EXPECT_EQ(r.told.synchs[1] - r.told.synchs[0], 2_ms);
}

TEST(VirtualSlaveDpv2, a_slave_with_Time_Sync_follows_the_time) {
    Rig r{"Time_Sync_supp = 1\n"};
    ASSERT_TRUE(r.bring_up({6, 8, 0, 0, 0x03, 0xE8}));
    EXPECT_FALSE(r.slave.time());
    const dp::NetworkTime noon = dp::NetworkTime::from_wire(0xC3123456, 0);
    r.master.send({0x7F, 2, 0x40}, {});
    const Ticks event = r.master.last_request_end;
    Octets value(18);
    ASSERT_TRUE(dp::encode(dp::ClockValue{.time_event = noon}, value));
    r.broadcast(2, 0xC0, value);
    ASSERT_TRUE(r.slave.time());
    const std::int64_t off = r.slave.time()->minus_ns(noon) - core::to_ns(r.master.now - event);
    EXPECT_LT(off < 0 ? -off : off, 2'000);
    EXPECT_EQ(r.slave.dpv2_counters().times_set, 1u);
    EXPECT_EQ(r.told.times, 1);
}

TEST(VirtualSlaveDpv2, a_PrmCmd_is_obeyed_and_acknowledged_in_the_diagnosis) {
    Rig r{"PrmCmd_supp = 1\n"};
    ASSERT_TRUE(r.bring_up({8, 2, 0, 0x28, 0x02, 0, 0, 0}, 0xC0, 0x88));
    EXPECT_EQ(r.slave.redundancy().role(), driver::Role::primary);
    const Octets diag = r.master.diag();
    ASSERT_EQ(diag.size(), 14u);
    EXPECT_EQ(diag[7], dp::kPrmCmdAckType);
    ASSERT_EQ(r.told.commands.size(), 1u);
    EXPECT_EQ(r.told.commands[0].seq_nr, 5);
}

TEST(VirtualSlaveDpv2, a_slave_without_DPV2_leaves_blocks_alone_and_hears_no_samples) {
    Rig r{""};
    ASSERT_TRUE(r.bring_up({}));
    r.broadcast(9, 0x08, {0x11, 0x22, 0x33, 0x44});
    EXPECT_TRUE(r.told.samples.empty());
    EXPECT_TRUE(r.slave.links().empty());
    EXPECT_FALSE(r.slave.time());
}

}  // namespace
}  // namespace dpchip::slave
