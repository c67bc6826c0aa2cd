// SPDX-License-Identifier: Apache-2.0
// Virtual slaves: identity and modules from a GSD, behaviour, errors, time of the firmware and of the crystal.
#include <gtest/gtest.h>

#include <string>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/segment/station.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "slave/allocations.hpp"
#include "slave/bench_master.hpp"

namespace dpchip::slave {
namespace {

using testing::BenchMaster;
using testing::Octets;
static_assert(segment::Station<VirtualSlave>);

const gsd::Gsd& station() {
    static const gsd::Gsd g = gsd::parse(R"(#Profibus_DP
GSD_Revision = 3
Vendor_Name = "dpchip"
Model_Name = "Bench station"
Revision = "1"
Ident_Number = 0x4711
Protocol_Ident = 0
Station_Type = 0
Hardware_Release = "1"
Software_Release = "1"
1.5M_supp = 1
MaxTsdr_1.5M = 150
Freeze_Mode_supp = 1
Sync_Mode_supp = 1
Set_Slave_Add_supp = 1
Auto_Baud_supp = 1
Fail_Safe = 1
Max_Diag_Data_Len = 32
Modular_Station = 1
Max_Module = 16
Max_Input_Len = 244
Max_Output_Len = 244
Max_Data_Len = 488
Slave_Family = 3
ExtUserPrmData = 1 "Filter"
Unsigned16 100 10-1000
EndExtUserPrmData
ExtUserPrmData = 2 "Mode"
BitArea(4-6) 2 0,2,5-6
EndExtUserPrmData
ExtUserPrmData = 3 "Offset"
Signed8 0 -10-10
EndExtUserPrmData
Max_User_Prm_Data_Len = 200
Ext_User_Prm_Data_Const(0) = 0x00,0x00,0x00,0xAA,0x00,0x64,0x20
Ext_User_Prm_Data_Ref(4) = 1
Ext_User_Prm_Data_Ref(6) = 2
Module = "3 out, 5 in" 0x22,0x14
Ext_Module_Prm_Data_Len = 1
Ext_User_Prm_Data_Const(0) = 0x00
Ext_User_Prm_Data_Ref(0) = 3
EndModule
Module = "2 in" 0x11
EndModule
Module = "2 out" 0x21
EndModule
Module = "64 in, 64 out" 0xC0,0x3F,0x3F
EndModule
)").gsd;
    return g;
}

SlaveSetup setup(std::vector<std::string> modules = {"3 out, 5 in"}) {
    SlaveSetup s;
    s.modules = std::move(modules);
    s.address = 8;
    s.options.baud_probe_ms.fill(1);
    return s;
}

Octets good_prm(const VirtualSlave& s) { return gsd::user_prm_data(station(), s.plan().configuration).octets; }

struct Bench {
    VirtualSlave s;
    BenchMaster m;
    explicit Bench(const SlaveSetup& how) : s{station(), how}, m{s, how.address} {}

    void to_data_exch() {
        ASSERT_TRUE(m.find_baud());
        ASSERT_EQ(m.set_prm(good_prm(s)), Octets{0xE5});
        ASSERT_EQ(m.chk_cfg(s.plan().configuration.cfg), Octets{0xE5});
        ASSERT_TRUE(m.is_ready());
        ASSERT_EQ(s.dp_state(), chip::DpState::data_exch);
    }
};

TEST(VirtualSlave, TakesItsIdentityAndItsModulesFromTheGsd) {
    Bench b{setup({"3 out, 5 in", "2 in"})};
    EXPECT_EQ(b.s.name(), "Bench station");
    b.to_data_exch();
    EXPECT_EQ(b.m.get_cfg(), (Octets{0x22, 0x14, 0x11}));
    EXPECT_EQ(b.s.inputs().size(), 7u);
    EXPECT_EQ(b.s.outputs().size(), 3u);
    EXPECT_EQ(b.s.owner(), 2);
    const Octets d = b.m.diag();
    EXPECT_EQ((Octets{d[4], d[5]}), (Octets{0x47, 0x11}));
}

TEST(VirtualSlave, EchoRepeatsTheOutputsAndFillsUpWithZeros) {
    Bench b{setup()};
    b.to_data_exch();
    EXPECT_EQ(b.m.exchange({1, 2, 3}), (Octets{1, 2, 3, 0, 0}));
    EXPECT_EQ(b.m.exchange({9, 8, 7}), (Octets{9, 8, 7, 0, 0}));
    EXPECT_EQ(Octets(b.s.outputs().begin(), b.s.outputs().end()), (Octets{9, 8, 7}));
    EXPECT_EQ(Octets(b.s.inputs().begin(), b.s.inputs().end()), (Octets{9, 8, 7, 0, 0}));
    EXPECT_TRUE(b.s.outputs_valid());
    EXPECT_EQ(b.s.counters().exchanges, 2u);
}

TEST(VirtualSlave, EchoIsCutToTheInputs) {
    Bench b{setup({"3 out, 5 in", "2 out", "2 out"})};
    b.to_data_exch();
    EXPECT_EQ(b.m.exchange({1, 2, 3, 4, 5, 6, 7}), (Octets{1, 2, 3, 4, 5}));
}

TEST(VirtualSlave, InvertCounterAndHoldDoWhatTheirNamesSay) {
    struct Row { const char* io; Octets first, second; } const rows[]{
        {"invert", {0xFE, 0xFD, 0xFC, 0, 0}, {0xF6, 0xF7, 0xF8, 0, 0}},
        {"counter", {0, 0, 0, 0, 0}, {0, 0, 0, 0, 1}},
        {"hold:0AfF", {0x0A, 0xFF, 0, 0, 0}, {0x0A, 0xFF, 0, 0, 0}},
        {"hold:01 02 03 04 05", {1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}},
    };
    for (const Row& row : rows) {
        SlaveSetup how = setup();
        how.io = row.io;
        Bench b{how};
        b.to_data_exch();
        EXPECT_EQ(b.m.exchange({1, 2, 3}), row.first) << row.io;
        EXPECT_EQ(b.m.exchange({9, 8, 7}), row.second) << row.io;
    }
}

TEST(VirtualSlave, ACounterCarries) {
    SlaveSetup how = setup({"2 in"});
    how.io = "counter";
    Bench b{how};
    b.to_data_exch();
    Octets last;
    for (int i = 0; i <= 258; ++i) last = b.m.exchange({});
    EXPECT_EQ(last, (Octets{0x01, 0x02}));
    EXPECT_EQ(b.s.counters().exchanges, 259u);
}

TEST(VirtualSlave, OutputsAloneAreCountedToo) {
    Bench b{setup({"2 out"})};
    b.to_data_exch();
    EXPECT_EQ(b.m.exchange({1, 2}), Octets{0xE5});
    EXPECT_EQ(b.m.exchange({3, 4}), Octets{0xE5});
    EXPECT_EQ(b.s.counters().exchanges, 2u);
    EXPECT_EQ(b.s.outputs()[1], 4);
}

TEST(VirtualSlave, BehavesTheSameOnEveryChip) {
    for (const regmap::Traits& t : regmap::kTraits) {
        SlaveSetup how = setup();
        how.variant = t.variant;
        Bench b{how};
        b.to_data_exch();
        EXPECT_EQ(b.m.exchange({1, 2, 3}), (Octets{1, 2, 3, 0, 0})) << t.name;
        EXPECT_EQ(b.s.chip().findings().size(), 0u) << t.name;
    }
}

TEST(VirtualSlave, AcceptsWhatTheGsdAllowsAndRefusesTheRest) {
    Bench b{setup()};
    ASSERT_TRUE(b.m.find_baud());
    const Octets good = good_prm(b.s);
    ASSERT_EQ(good, (Octets{0, 0, 0, 0xAA, 0, 0x64, 0x20, 0}));
    const auto with = [&](std::size_t at, std::uint8_t value) {
        Octets o = good;
        o[at] = value;
        return o;
    };
    const Octets accepted[]{good, with(5, 10), with(6, 0x50), with(6, 0x60), with(6, 0x00), with(7, 0xF6), with(7, 10)};
    for (const Octets& o : accepted) {
        EXPECT_EQ(b.m.set_prm(o), Octets{0xE5});
        EXPECT_EQ(b.m.diag().at(0), 0x02);
    }
    Octets short_one = good, long_one = good;
    short_one.pop_back();
    long_one.push_back(0);
    const Octets refused[]{with(3, 0xAB), with(5, 9), with(4, 0x04), with(6, 0x10), with(6, 0x21), with(7, 0xF5), with(7, 11), short_one, long_one};
    std::uint64_t count = 0;
    for (const Octets& o : refused) {
        EXPECT_EQ(b.m.set_prm(o), Octets{0xE5});
        EXPECT_EQ(b.m.diag().at(0), 0x42) << "row " << count;
        ++count;
    }
    EXPECT_EQ(b.s.counters().prm_refused, count);
    EXPECT_EQ(b.s.counters().set_prm, std::size(accepted) + std::size(refused));
}

TEST(VirtualSlave, RefusesAConfigurationThatIsNotPlugged) {
    Bench b{setup()};
    ASSERT_TRUE(b.m.find_baud());
    b.m.set_prm(good_prm(b.s));
    b.m.chk_cfg({0x22});
    EXPECT_EQ(b.m.diag().at(0), 0x06);
    EXPECT_EQ(b.s.counters().cfg_refused, 1u);
    b.to_data_exch();
}

TEST(VirtualSlave, FollowsTheMasterWhenAsked) {
    SlaveSetup how = setup();
    how.cfg_policy = driver::CfgPolicy::follow_master;
    Bench b{how};
    ASSERT_TRUE(b.m.find_baud());
    b.m.set_prm(good_prm(b.s));
    b.m.chk_cfg({0x27, 0x12});
    ASSERT_TRUE(b.m.is_ready());
    EXPECT_EQ(b.m.exchange({1, 2, 3, 4, 5, 6, 7, 8}), (Octets{1, 2, 3}));
}

TEST(VirtualSlave, DiagnosisReachesTheMaster) {
    Bench b{setup()};
    b.to_data_exch();
    const std::uint8_t ext[]{0x03, 0x12, 0x34};
    EXPECT_EQ(b.s.set_diagnosis(ext, {.ext_diag = true}), driver::DiagResult::handed_over);
    EXPECT_EQ(b.m.diag(), (Octets{0x08, 0x0C, 0x00, 0x02, 0x47, 0x11, 0x03, 0x12, 0x34}));
    EXPECT_EQ(b.s.set_diagnosis(Octets(27)), driver::DiagResult::too_long);
}

TEST(VirtualSlave, ANewAddressIsKeptForTheNextPowerUp) {
    SlaveSetup how = setup();
    how.address = 126;
    Bench b{how};
    ASSERT_TRUE(b.m.find_baud());
    EXPECT_EQ(b.m.request(55, {9, 0x47, 0x11, 0xFF}), Octets{0xE5});
    EXPECT_EQ(b.s.stored_address().address, 9);
    EXPECT_TRUE(b.s.stored_address().no_add_change);
    b.m.slave = 9;
    EXPECT_EQ(b.s.address(), 9);
    EXPECT_EQ(b.m.diag().size(), 6u);
    EXPECT_EQ(b.s.counters().set_slave_add, 1u);
}

TEST(VirtualSlave, NoticesThatTheMasterIsGone) {
    Bench b{setup()};
    b.to_data_exch();
    b.m.exchange({1, 2, 3});
    b.m.run(core::seconds(2));
    EXPECT_EQ(b.s.counters().watchdog_timeouts, 1u);
    EXPECT_EQ(b.s.counters().data_exch_left, 1u);
    EXPECT_FALSE(b.s.outputs_valid());
    EXPECT_EQ(b.s.outputs()[0], 0);
    EXPECT_EQ(b.s.owner(), 255);
}

TEST(VirtualSlave, RestartAndLeaveMasterWork) {
    Bench b{setup()};
    b.to_data_exch();
    b.s.leave_master();
    b.m.run(core::microseconds(100));
    EXPECT_EQ(b.s.dp_state(), chip::DpState::wait_prm);
    b.to_data_exch();
    b.s.restart();
    b.m.run(core::milliseconds(1));
    EXPECT_FALSE(b.s.baud().has_value());
    b.m.fc = 0x6D;
    b.to_data_exch();
    EXPECT_EQ(b.m.exchange({1, 2, 3}), (Octets{1, 2, 3, 0, 0}));
}

TEST(VirtualSlave, ASlowFirmwareAnswersOneCycleLater) {
    SlaveSetup how = setup();
    how.firmware_delay = core::microseconds(300);
    Bench b{how};
    ASSERT_TRUE(b.m.find_baud());
    b.m.set_prm(good_prm(b.s));
    b.m.run(core::milliseconds(1));
    b.m.chk_cfg(b.s.plan().configuration.cfg);
    EXPECT_EQ(b.s.dp_state(), chip::DpState::wait_cfg) << "nobody has looked at it yet";
    b.m.run(core::milliseconds(1));
    EXPECT_EQ(b.s.dp_state(), chip::DpState::data_exch);
    EXPECT_EQ(b.m.exchange({1, 2, 3}), (Octets{0, 0, 0, 0, 0}));
    b.m.run(core::milliseconds(1));
    EXPECT_EQ(b.m.exchange({4, 5, 6}), (Octets{1, 2, 3, 0, 0}));
}

TEST(VirtualSlave, TheFirmwareRunsExactlyItsDelayAfterTheInterrupt) {
    SlaveSetup how = setup();
    how.firmware_delay = core::microseconds(500);
    Bench b{how};
    ASSERT_TRUE(b.m.find_baud());
    b.m.set_prm(good_prm(b.s));
    b.m.run(core::milliseconds(2));
    b.m.chk_cfg(b.s.plan().configuration.cfg);
    b.m.run(core::milliseconds(2));
    b.m.exchange({1, 2, 3});
    const Ticks due = b.m.last_request_end + core::kClk + core::microseconds(500);
    const auto before = b.s.counters().interrupts;
    b.m.run(due - Ticks{1} - b.m.now);
    EXPECT_EQ(b.s.counters().interrupts, before);
    b.m.run(Ticks{1});
    EXPECT_EQ(b.s.counters().interrupts, before + 1);
}

TEST(VirtualSlave, ADriftingCrystalChangesNothingButTheMoment) {
    for (const std::int32_t ppb : {-100'000, 100'000}) {
        SlaveSetup how = setup();
        how.clock = core::Clock{ppb, core::milliseconds(3)};
        Bench b{how};
        b.m.now = core::milliseconds(3);
        b.to_data_exch();
        for (int i = 0; i < 2000; ++i) {
            const auto v = static_cast<std::uint8_t>(i);
            ASSERT_EQ(b.m.exchange({v, 2, 3}), (Octets{v, 2, 3, 0, 0})) << i;
            const Ticks tsdr = b.m.last_answer_start - b.m.last_request_end, nominal = b.m.bit * 11;
            ASSERT_NEAR(static_cast<double>(tsdr.n), static_cast<double>(nominal.n), static_cast<double>(nominal.n) / 5'000);
            ASSERT_EQ(ppb > 0, tsdr < nominal);
        }
    }
}

TEST(VirtualSlave, AFedUserWatchdogStaysQuiet) {
    SlaveSetup how = setup();
    how.user_watchdog = 3;
    Bench b{how};
    b.to_data_exch();
    for (std::uint8_t i = 0; i < 50; ++i) b.m.exchange({i, 0, 0});
    EXPECT_EQ(b.s.counters().data_exch_left, 0u);
}

TEST(VirtualSlave, DataExchangeDoesNotAllocate) {
    Bench b{setup()};
    b.to_data_exch();
    const Octets telegram{0x68, 0x06, 0x06, 0x68, 0x08, 0x02, 0x5D, 1, 2, 3, 0x6D, 0x16};
    b.m.prepare(telegram);
    b.m.transmit();
    const std::uint64_t exchanges = b.s.counters().exchanges;
    const std::size_t before = testing::allocations();
    for (int i = 0; i < 100; ++i) {
        b.m.telegram.octets[6] = i % 2 != 0 ? 0x5D : 0x7D;
        b.m.telegram.octets[10] = i % 2 != 0 ? 0x6D : 0x8D;
        b.m.transmit();
    }
    const std::size_t after = testing::allocations();
    EXPECT_EQ(after, before);
    EXPECT_EQ(b.s.counters().exchanges, exchanges + 100);
}

struct BadSetup {
    const char* what;
    void (*change)(SlaveSetup&);
    SlaveError::Kind kind;
    const char* words;
};

TEST(VirtualSlave, WhatCannotBeBuiltIsRefusedInWords) {
    const BadSetup rows[]{
        {"address", [](SlaveSetup& s) { s.address = 127; }, SlaveError::Kind::address, "127"},
        {"io", [](SlaveSetup& s) { s.io = "echoes"; }, SlaveError::Kind::io_behaviour, "echoes"},
        {"empty hold", [](SlaveSetup& s) { s.io = "hold:"; }, SlaveError::Kind::io_behaviour, "at least one"},
        {"odd hold", [](SlaveSetup& s) { s.io = "hold:123"; }, SlaveError::Kind::io_behaviour, "pairs"},
        {"no hex", [](SlaveSetup& s) { s.io = "hold:0G"; }, SlaveError::Kind::io_behaviour, "hexadecimal"},
        {"long hold", [](SlaveSetup& s) { s.io = "hold:010203040506"; }, SlaveError::Kind::io_behaviour, "5 octets"},
        {"RAM",
         [](SlaveSetup& s) {
             s.variant = regmap::Variant::apc3;
             s.modules.assign(3, "64 in, 64 out");
             s.modules.insert(s.modules.end(), 6, "3 out, 5 in");
         },
         SlaveError::Kind::ram, "RAM is too small"},
    };
    for (const BadSetup& row : rows) {
        SlaveSetup how = setup();
        row.change(how);
        try {
            const VirtualSlave s{station(), how};
            ADD_FAILURE() << row.what;
        } catch (const SlaveError& e) {
            EXPECT_EQ(e.kind(), row.kind) << row.what << ": " << e.what();
            EXPECT_NE(std::string{e.what()}.find(row.words), std::string::npos) << e.what();
        }
    }
    SlaveSetup no_module = setup({"7 in"});
    EXPECT_THROW((VirtualSlave{station(), no_module}), gsd::GsdError);
    gsd::Gsd no_ssa = station();
    no_ssa.set_slave_add = false;
    SlaveSetup default_address = setup();
    default_address.address = 126;
    EXPECT_THROW((VirtualSlave{no_ssa, default_address}), SlaveError);
}

TEST(IoBehaviour, SaysItselfAsItWasGiven) {
    for (const char* text : {"echo", "invert", "counter", "hold:00FF1A"}) EXPECT_EQ(IoBehaviour{text}.text(), text);
    EXPECT_EQ(IoBehaviour{"hold: 0a 0b"}.text(), "hold:0A0B");
    EXPECT_EQ(IoBehaviour{"hold:" + std::string(488, '1')}.held().size(), 244u);
    EXPECT_THROW(IoBehaviour{"hold:" + std::string(490, '1')}, SlaveError);
    EXPECT_THROW(IoBehaviour{""}, SlaveError);
    EXPECT_THROW(IoBehaviour{"hold:1 1"}, SlaveError);
}

}  // namespace
}  // namespace dpchip::slave
