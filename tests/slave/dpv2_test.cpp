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
    explicit Rig(const std::string& abilities, const driver::IsochronConfig& isochron = {})
        : gsd{station(abilities)}, slave{gsd, {.modules = {"2 in, 2 out"}, .address = 8, .isochron = isochron}} {
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
    /// A second and more of exchanges: the monitoring time of the links is over; `also` happens every 20 ms.
    template <class F>
    void monitoring_time(F&& also) {
        for (int i = 0; i < 52; ++i) {
            master.exchange({1, 2});
            also();
            master.run(20_ms);
        }
    }
    void monitoring_time() { monitoring_time([] {}); }
    void synch() { master.send({0xFF, 0x82, 0x46}, {0x3A, 0x3E, 0x00, 0x80}); }
    void broadcast(std::uint8_t sa, std::uint8_t fc, const Octets& data) { master.send({0x7F, sa, fc}, data); }

    gsd::Gsd gsd;
    VirtualSlave slave;
    BenchMaster master{slave, 8};
    Told told;
};

// proves: VPC3C 7.3.1-15, VPC3C 7.3.1-17
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

// ---- DXB_Link_Status in the diagnosis -----------------------------------------------------------------------------

const Octets kTwoLinks{13, 3, 0, 0, 1, 9, 4, 1, 2, 10, 1, 0, 1};
const Octets kNoBlocks{};

/// Ext_Diag_Data.
Octets ext_diag(Rig& r) {
    const Octets d = r.master.diag();
    return d.size() > 6 ? Octets(d.begin() + 6, d.end()) : Octets{};
}

// proves: VPC3C 7.2.2-04
// proves: VPC3C 7.3.1-28..29
TEST(VirtualSlaveDpv2, a_broken_link_stands_in_the_diagnosis_until_all_links_are_active_again) {
    Rig r{kSubscriber};
    ASSERT_TRUE(r.bring_up(kTwoLinks));
    const Octets four{1, 2, 3, 4};
    const auto both = [&] { r.broadcast(9, 0x08, four), r.broadcast(10, 0x08, {7}); };
    const auto one = [&] { r.broadcast(9, 0x08, four); };
    r.monitoring_time(both);
    EXPECT_EQ(ext_diag(r), kNoBlocks) << "all is well";
    r.monitoring_time(one);
    r.monitoring_time(one);
    EXPECT_EQ(ext_diag(r), (Octets{8, 0x83, 0, 0, 9, 0x80, 10, 0x00})) << "publisher 10 is silent";
    r.monitoring_time();
    r.monitoring_time();
    EXPECT_EQ(ext_diag(r), (Octets{8, 0x83, 0, 0, 9, 0x00, 10, 0x00})) << "and so is 9";
    r.monitoring_time(one);
    r.monitoring_time(one);
    EXPECT_EQ(ext_diag(r), (Octets{8, 0x83, 0, 0, 9, 0x80, 10, 0x00}));
    r.monitoring_time(both);
    r.monitoring_time(both);
    EXPECT_EQ(ext_diag(r), kNoBlocks);
    EXPECT_EQ(r.slave.dp_state(), chip::DpState::data_exch);
}

// proves: VPC3C 7.3.1-26..28
TEST(VirtualSlaveDpv2, DXB_Link_Status_stands_behind_the_diagnosis_of_the_process_and_is_no_fault) {
    Rig r{kSubscriber};
    ASSERT_TRUE(r.bring_up(kLink));
    r.broadcast(9, 0x08, {1, 2});  // the wrong length
    r.monitoring_time();
    EXPECT_EQ(r.told.broken, 1);
    const Octets own{3, 0xA1, 0x55};
    EXPECT_EQ(r.slave.set_diagnosis(own, {.ext_diag = true}), driver::DiagResult::handed_over);
    Octets d = r.master.diag();
    EXPECT_EQ(Octets(d.begin() + 6, d.end()), (Octets{3, 0xA1, 0x55, 6, 0x83, 0, 0, 9, 0x00}));
    EXPECT_EQ(d[0] & 0x08, 0x08);
    EXPECT_EQ(r.slave.set_diagnosis({}), driver::DiagResult::handed_over);
    d = r.master.diag();
    EXPECT_EQ(Octets(d.begin() + 6, d.end()), (Octets{6, 0x83, 0, 0, 9, 0x00}));
    EXPECT_EQ(d[0] & 0x08, 0x00) << "status information: Ext_Diag belongs to the process";
}

TEST(VirtualSlaveDpv2, DXB_Link_Status_goes_with_its_links_and_is_left_out_without_room) {
    Rig r{kSubscriber};
    ASSERT_TRUE(r.bring_up(kLink));
    r.broadcast(9, 0x08, {1, 2});
    r.monitoring_time();
    const Octets long_one(26, 26);  // Max_Diag_Data_Len is 32
    EXPECT_EQ(r.slave.set_diagnosis(long_one), driver::DiagResult::handed_over);
    EXPECT_EQ(ext_diag(r), long_one);
    EXPECT_EQ(r.slave.set_diagnosis(Octets(27, 27)), driver::DiagResult::too_long);
    EXPECT_EQ(r.slave.set_diagnosis({}), driver::DiagResult::handed_over);
    EXPECT_EQ(ext_diag(r), (Octets{6, 0x83, 0, 0, 9, 0x00}));
    ASSERT_TRUE(r.bring_up({}));
    EXPECT_EQ(ext_diag(r), kNoBlocks);
}

// proves: VPC3C 7.1-03
TEST(VirtualSlaveDpv2, blocks_are_looked_for_only_with_Prm_Structure) {
    Rig r{kSubscriber};
    ASSERT_TRUE(r.bring_up(kLink, 0xC0, 0x00));
    EXPECT_TRUE(r.slave.links().empty()) << "user parameters that happen to look like a link table";
    ASSERT_TRUE(r.bring_up(kLink, 0xC0, 0x08));
    EXPECT_EQ(r.slave.links().size(), 1u);
}

// proves: VPC3C 7.1-07, VPC3C 7.3.1-15
TEST(VirtualSlaveDpv2, links_may_come_with_Set_Ext_Prm_which_consists_of_blocks_only) {
    const auto with_ext_prm = [](Rig& r, const Octets& octets) {
        r.master.set_prm({0xC0, 0x00, 0x00});
        r.master.run(1_ms);
        r.master.request(53, octets);
        r.master.run(1_ms);
        r.master.chk_cfg({0x31});
        r.master.run(1_ms);
        return r.slave.dp_state() == chip::DpState::data_exch;
    };
    const std::string abilities = std::string{kSubscriber} + "X_Prm_SAP_supp = 1\nX_Max_User_Prm_Data_Len = 100\n";
    Rig good{abilities}, bad{abilities};
    ASSERT_TRUE(with_ext_prm(good, kLink));
    ASSERT_EQ(good.slave.links().size(), 1u);
    good.broadcast(9, 0x08, {0x11, 0x22, 0x33, 0x44});
    EXPECT_EQ(good.told.samples, (std::vector<Octets>{{9, 0x22, 0x33}}));
    EXPECT_FALSE(with_ext_prm(bad, {1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(bad.master.diag()[0] & 0x40, 0x40) << "Prm_Fault: these are no blocks";
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

// proves: VPC3C 7.3.2-20..21
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

// ---- Simple Sync Mode -----------------------------------------------------------------------------------------------

// proves: VPC3C 7.3.2-03, VPC3C 7.3.2-10..12
TEST(VirtualSlaveDpv2, in_Simple_Sync_Mode_outputs_wait_for_the_SYNCH) {
    Rig r{"", {.simple_sync = true}};
    r.master.group = 0x80;
    ASSERT_TRUE(r.bring_up({}));
    r.synch();
    r.told.synchs.clear();
    r.master.exchange({0x11, 0x22});
    r.master.run(5_ms);
    EXPECT_NE(Octets(r.slave.outputs().begin(), r.slave.outputs().end()), (Octets{0x11, 0x22}));
    EXPECT_TRUE(r.told.synchs.empty());
    const std::uint64_t commands = r.slave.counters().global_control;
    r.synch();
    const Ticks end = r.master.last_request_end;
    r.master.run(1_ms);
    EXPECT_EQ(Octets(r.slave.outputs().begin(), r.slave.outputs().end()), (Octets{0x11, 0x22}));
    ASSERT_EQ(r.told.synchs.size(), 1u);
    EXPECT_LT(r.told.synchs[0] - end, 1_us) << "pin 13 with DX_Out";
    EXPECT_EQ(r.slave.counters().global_control, commands + 1) << "an ordinary Global_Control, too";
    r.synch();
    r.master.run(1_ms);
    EXPECT_EQ(r.told.synchs.size(), 1u) << "no Data_Exchange before it, no signal";
    EXPECT_EQ(r.slave.counters().global_control, commands + 2);
}

TEST(VirtualSlaveDpv2, what_is_a_SYNCH_and_how_the_pin_looks_is_configured) {
    Rig r{"", {.sync_pol = true, .simple_sync = true, .control_command = 0x08, .group_select = 0x81}};
    r.master.group = 0x80;
    ASSERT_TRUE(r.bring_up({}));
    r.master.send({0xFF, 0x82, 0x46}, {0x3A, 0x3E, 0x08, 0x81});
    r.told.synchs.clear();
    r.master.exchange({0x11, 0x22});
    r.synch();
    r.master.run(1_ms);
    EXPECT_TRUE(r.told.synchs.empty()) << "another Global_Control";
    r.master.send({0xFF, 0x82, 0x46}, {0x3A, 0x3E, 0x08, 0x81});
    r.master.run(1_ms);
    EXPECT_EQ(r.told.synchs.size(), 1u);
    EXPECT_EQ(r.slave.outputs()[0], 0x11);
}

TEST(VirtualSlaveDpv2, Simple_Sync_Mode_is_refused_where_it_means_nothing) {
    const SlaveSetup simple{.modules = {"2 in, 2 out"}, .address = 8, .isochron = {.simple_sync = true}};
    EXPECT_THROW(VirtualSlave(station("Isochron_Mode_supp = 1\n"), simple), SlaveError);
    SlaveSetup other = simple;
    other.variant = regmap::Variant::apc3;
    EXPECT_THROW(VirtualSlave(station(""), other), SlaveError);
    EXPECT_NO_THROW(VirtualSlave(station(""), simple));
}

// proves: VPC3C 7.3.3-14
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
