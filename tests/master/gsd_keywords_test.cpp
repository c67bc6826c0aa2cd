// SPDX-License-Identifier: Apache-2.0
// Each DP-V1 keyword of a GSD and what it switches on, seen from the master (GSD rev. 5; reference 5, 7.1):
//   DPV1_Slave, C1_Read_Write_supp, C2_Read_Write_supp, Ident_Maintenance_supp   on_or_off
//   C1_Max_Data_Len, C2_Max_Data_Len, Max_Initiate_PDU_Length                    limits_of_length
//   C2_Max_Count_Channels                                                        so_many_connections
//   C1_Response_Timeout, C2_Response_Timeout                                     response_timeouts
//   *_Alarm_supp, *_Alarm_required, Extra_Alarm_SAP_supp                         alarms
//   Alarm_Type_Mode_supp, Alarm_Sequence_Mode_Count                              alarm_modes
//   Check_Cfg_Mode                                                               check_cfg_mode
//   WD_Base_1ms_supp: the chip does it by itself, see chip C049 to C053
#include <set>

#include "master/acyclic_plant.hpp"

namespace {

using namespace dpchip;
using namespace dpchip::core::literals;
using Kind = master::ServiceResult::Kind;
using test::Octets;

/// One slave of a changed GSD, exchanging data with DP-V1 enabled.
struct Keywords {
    explicit Keywords(const std::function<void(gsd::Gsd&)>& change, std::uint8_t alarms = 0xFC, std::uint8_t alarm_mode = 0) : gsd{test::dpv1_io()} {
        change(gsd);
        setup.address = 5;
        setup.modules = {"8 DI / 8 DO"};
        setup.records = test::records();
        slave = std::make_unique<slave::VirtualSlave>(gsd, setup);
        EXPECT_TRUE(plant.line.attach(*slave));
        config = master::slave_config(gsd, gsd::configure(gsd, setup.modules), 5);
        master::enable_dpv1(config, gsd.dpv1, false, alarms, alarm_mode);
        EXPECT_TRUE(plant.master.add(config));
        plant.master.attach(ms1);
        plant.master.attach(ms2);
        EXPECT_TRUE(plant.start());
        plant.run(5_ms);
    }
    ~Keywords() {
        plant.master.detach(ms1);
        plant.master.detach(ms2);
    }
    Kind ms1_read(std::uint8_t slot, std::uint8_t index) {
        EXPECT_TRUE(ms1.read(slot, index));
        return plant.finish(ms1).kind;
    }
    Kind ms2_open() {
        EXPECT_TRUE(ms2.open());
        return plant.finish(ms2).kind;
    }

    gsd::Gsd gsd;
    test::AcyclicPlant plant;
    slave::SlaveSetup setup;
    std::unique_ptr<slave::VirtualSlave> slave;
    master::SlaveConfig config;
    master::Ms1 ms1{{.address = 5}};
    master::Ms2 ms2{{.address = 5}};
};

// proves: VPC3C 7.2.2-01
TEST(GsdKeywords, on_or_off) {
    struct Case {
        const char* what;
        std::function<void(gsd::Gsd&)> change;
        Kind ms1, ms2;
    };
    const Case cases[]{
        {"all of it", [](gsd::Gsd&) {}, Kind::done, Kind::done},
        {"DPV1_Slave = 0", [](gsd::Gsd& g) { g.dpv1.slave = false; }, Kind::not_taken, Kind::not_taken},
        {"C2_Read_Write_supp = 0", [](gsd::Gsd& g) { g.dpv1.c2_read_write = false; }, Kind::done, Kind::not_taken},
        {"C1_Read_Write_supp = 0 and no alarms",
         [](gsd::Gsd& g) {
             const bool c2 = g.dpv1.c2_read_write;
             g.dpv1 = {};
             g.dpv1.slave = true;
             g.dpv1.c2_read_write = c2;
             g.dpv1.c2_max_data_len = 240;
         },
         Kind::not_taken, Kind::done},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.what);
        Keywords k{c.change, 0};
        EXPECT_EQ(k.ms1_read(1, 2), c.ms1) << master::text(k.ms1.result());
        EXPECT_EQ(k.ms2_open(), c.ms2) << master::text(k.ms2.result());
    }
    for (const bool im : {true, false}) {
        Keywords k{[im](gsd::Gsd& g) { g.dpv1.ident_maintenance = im; }};
        master::ImReader reader{k.ms1};
        ASSERT_TRUE(reader.start(dp::kIm0));
        ASSERT_TRUE(k.plant.until([&] { reader.step(); return reader.finished(); }));
        EXPECT_EQ(reader.result().done(), im) << master::text(reader.result());
    }
}

TEST(GsdKeywords, limits_of_length) {
    Keywords k{[](gsd::Gsd& g) {
        g.dpv1.c1_max_data_len = 20;
        g.dpv1.c2_max_data_len = 60;
        g.dpv1.max_initiate_pdu_length = 30;
    }};
    EXPECT_EQ(k.ms1_read(1, 4), Kind::done);  // a record of 240
    EXPECT_EQ(k.ms1.data().size(), 20u);
    ASSERT_TRUE(k.ms1.write(1, 1, Octets(20)));
    EXPECT_EQ(k.plant.finish(k.ms1).kind, Kind::done);
    master::Ms1 once{{.address = 5, .response_timeout = 50_ms}};
    k.plant.master.attach(once);
    ASSERT_TRUE(once.write(1, 1, Octets(21)));
    EXPECT_FALSE(k.plant.finish(once).done()) << "longer than any buffer";
    k.plant.master.detach(once);
    ASSERT_EQ(k.ms2_open(), Kind::done);
    EXPECT_EQ(k.ms2.max_length(), 60);
    ASSERT_TRUE(k.ms2.read(1, 4));
    EXPECT_EQ(k.plant.finish(k.ms2).kind, Kind::done);
    EXPECT_EQ(k.ms2.data().size(), 60u);
    ASSERT_TRUE(k.ms2.write(1, 4, Octets(61)));
    EXPECT_EQ(k.ms2.result().kind, Kind::invalid);
    for (const std::size_t size : {30u, 31u}) {
        Octets initiate{0x57, 0, 0, 0, 0, 100, 1, 0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(size - 18), 0, 2};
        initiate.resize(size);
        master::Job job = master::Job::service(5, dp::kSapResourceManager, initiate);
        job.ssap = dp::kMasterSapMs2;
        ASSERT_TRUE(k.plant.master.submit(job));
        ASSERT_TRUE(k.plant.until([&] { return job.finished(); }));
        EXPECT_EQ(job.outcome, size == 30 ? master::Job::Outcome::data : master::Job::Outcome::refused);
        EXPECT_TRUE(size == 30 || job.response.response() == fdl::Response::rr);
    }
}

TEST(GsdKeywords, so_many_connections) {
    for (const unsigned channels : {1u, 3u, 8u}) {
        Keywords k{[channels](gsd::Gsd& g) { g.dpv1.c2_max_count_channels = channels; }};
        std::vector<std::unique_ptr<master::Ms2>> all;
        for (unsigned n = 0; n <= channels; ++n) {
            all.push_back(std::make_unique<master::Ms2>(master::Ms2Config{.address = 5}));
            k.plant.master.attach(*all.back());
            ASSERT_TRUE(all.back()->open());
            EXPECT_EQ(k.plant.finish(*all.back()).done(), n < channels) << n;
        }
        for (auto& c : all) k.plant.master.detach(*c);
    }
}

/// Never answers.
struct Sleeper : slave::RecordHandler {
    Answer read(const driver::RecordCall&, std::span<std::uint8_t>) override { return driver::answer_later(); }
};

TEST(GsdKeywords, response_timeouts) {
    Keywords k{[](gsd::Gsd& g) {
        g.dpv1.c1_response_timeout = 50;
        g.dpv1.c2_response_timeout = 250;
    }};
    const master::Ms1Config c1 = master::ms1_config(k.gsd, 5);
    const master::Ms2Config c2 = master::ms2_config(k.gsd, 5);
    EXPECT_EQ(c1.response_timeout, 1500_ms);  // and a second for the line
    EXPECT_EQ(c2.response_timeout, 3500_ms);
    Sleeper sleeper;
    k.slave->set_handler(&sleeper);
    master::Ms1 ms1{c1};
    master::Ms2 ms2{c2};
    k.plant.master.attach(ms1);
    k.plant.master.attach(ms2);
    core::Ticks asked = k.plant.line.now();
    ASSERT_TRUE(ms1.read(1, 1));
    EXPECT_EQ(k.plant.finish(ms1).kind, Kind::timeout);
    EXPECT_GE(k.plant.line.now() - asked, 1499_ms);
    EXPECT_LT(k.plant.line.now() - asked, 1510_ms);
    ASSERT_TRUE(ms2.open());
    ASSERT_TRUE(k.plant.finish(ms2).done());
    EXPECT_EQ(ms2.send_timeout(), 250) << "the slave does not cut off what the file promises";
    asked = k.plant.line.now();
    ASSERT_TRUE(ms2.read(1, 1));
    EXPECT_EQ(k.plant.finish(ms2).abort, dp::Abort{dp::AbortReason::timeout});
    EXPECT_GE(k.plant.line.now() - asked, 2490_ms);
    EXPECT_LT(k.plant.line.now() - asked, 2600_ms);
    k.plant.master.detach(ms1);
    k.plant.master.detach(ms2);
    gsd::Gsd silent = k.gsd;
    silent.dpv1.c1_response_timeout = silent.dpv1.c2_response_timeout = 0;
    EXPECT_EQ(master::ms1_config(silent, 5).response_timeout, master::Ms1Config{}.response_timeout);
    EXPECT_EQ(master::ms2_config(silent, 5).response_timeout, core::Ticks{}) << "three times Send_Timeout";
}

TEST(GsdKeywords, alarms) {
    struct Case {
        dp::AlarmType type;
        bool gsd::DpV1::*supported;
        bool gsd::DpV1::*required;
        std::uint8_t bit;
    };
    const Case cases[]{
        {dp::AlarmType::diagnostic, &gsd::DpV1::diagnostic_alarm, &gsd::DpV1::diagnostic_alarm_required, dp::kEnableDiagnosticAlarm},
        {dp::AlarmType::process, &gsd::DpV1::process_alarm, &gsd::DpV1::process_alarm_required, dp::kEnableProcessAlarm},
        {dp::AlarmType::pull, &gsd::DpV1::pull_plug_alarm, &gsd::DpV1::pull_plug_alarm_required, dp::kEnablePullPlugAlarm},
        {dp::AlarmType::plug, &gsd::DpV1::pull_plug_alarm, &gsd::DpV1::pull_plug_alarm_required, dp::kEnablePullPlugAlarm},
        {dp::AlarmType::status, &gsd::DpV1::status_alarm, &gsd::DpV1::status_alarm_required, dp::kEnableStatusAlarm},
        {dp::AlarmType::update, &gsd::DpV1::update_alarm, &gsd::DpV1::update_alarm_required, dp::kEnableUpdateAlarm},
        {dp::AlarmType{40}, &gsd::DpV1::manufacturer_specific_alarm, &gsd::DpV1::manufacturer_specific_alarm_required, dp::kEnableManufacturerSpecificAlarm},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(unsigned{core::to_underlying(c.type)});
        dp::AlarmStatus alarm{};
        alarm.type = core::to_underlying(c.type);
        Keywords with{[](gsd::Gsd&) {}};
        EXPECT_EQ(with.slave->raise(alarm).result, driver::AlarmResult::queued);
        Keywords without{[&](gsd::Gsd& g) { g.dpv1.*c.supported = false; }};
        EXPECT_EQ(without.slave->raise(alarm).result, driver::AlarmResult::not_enabled);
        EXPECT_EQ(without.config.user_prm[1] & c.bit, 0) << "the master does not ask for it either";
        Keywords required{[&](gsd::Gsd& g) { g.dpv1.*c.required = true; }, 0};
        EXPECT_EQ(required.config.user_prm[1], c.bit) << "the master enables it although nobody has asked";
        EXPECT_EQ(required.slave->raise(alarm).result, driver::AlarmResult::queued);
    }
    for (const bool extra : {true, false}) {
        Keywords k{[extra](gsd::Gsd& g) { g.dpv1.extra_alarm_sap = extra; }};
        master::Ms1 over_50{{.address = 5, .alarm_sap = true}};
        k.plant.master.attach(over_50);
        ASSERT_TRUE(over_50.acknowledge({1, 1, 0}));
        ASSERT_TRUE(k.plant.until([&] { return over_50.acknowledgements_waiting() == 0; }));
        EXPECT_EQ(over_50.acknowledgement().kind, extra ? Kind::refused : Kind::not_taken);
        k.plant.master.detach(over_50);
    }
}

TEST(GsdKeywords, alarm_modes) {
    const auto outstanding = [](unsigned count, std::uint8_t mode) {
        Keywords k{[count](gsd::Gsd& g) { g.dpv1.alarm_sequence_mode_count = count; }, 0xFC, mode};
        dp::AlarmStatus alarm{};
        alarm.type = 2;
        for (std::uint8_t n = 0; n < 12; ++n) {
            alarm.slot = n;
            EXPECT_EQ(k.slave->raise(alarm).result, driver::AlarmResult::queued);
        }
        // Nobody acknowledges: as many as may be outstanding appear in the diagnosis, one after the other.
        struct Look {
            std::set<std::uint8_t> numbers{};
            void operator()(master::Master& m) {
                dp::DiagBlockWalker walker{m.slave(0).diagnosis().subspan(dp::kDiagHeader)};
                for (dp::DiagBlock block{}; walker.next(block);)
                    if (const auto shown = dp::alarm_status(block)) numbers.insert(shown->seq_nr);
            }
        } look;
        k.plant.master.on_cycle(look);
        k.plant.run(200_ms);
        k.plant.master.on_cycle(nullptr, nullptr);
        return look.numbers.size();
    };
    EXPECT_EQ(outstanding(8, 0), 1u) << "Alarm_Type_Mode: one of each type";
    EXPECT_EQ(outstanding(8, 2), 4u);
    EXPECT_EQ(outstanding(8, 3), 8u);
    EXPECT_EQ(outstanding(4, 3), 4u) << "not more than Alarm_Sequence_Mode_Count, whatever the master allows";
    EXPECT_EQ(outstanding(0, 3), 1u) << "no sequence mode";
}

TEST(GsdKeywords, check_cfg_mode) {
    for (const bool mode : {false, true})
        for (const bool asked : {false, true}) {
            gsd::Gsd g = test::dpv1_io();
            g.dpv1.check_cfg_mode = mode;
            slave::SlaveSetup setup;
            setup.address = 5;
            setup.modules = {"8 DI / 8 DO"};
            slave::VirtualSlave slave{g, setup};
            test::AcyclicPlant plant;
            ASSERT_TRUE(plant.line.attach(slave));
            auto config = master::slave_config(g, gsd::configure(g, std::vector<std::string>{"16 DI / 16 DO"}), 5);
            master::enable_dpv1(config, g.dpv1, false);
            if (asked) config.user_prm[1] |= dp::kCheckCfgMode;
            ASSERT_TRUE(plant.master.add(config));
            const bool reached = plant.until([&] { return plant.master.all_exchanging(); }, 2_s);
            EXPECT_EQ(reached, mode && asked);
            EXPECT_EQ(slave.outputs().size(), mode && asked ? 2u : 1u);
        }
}

}  // namespace
