// SPDX-License-Identifier: Apache-2.0
// The driver against scripted registers: the order of its accesses, what it writes, and how it is woken.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "driver/driver_fixture.hpp"

namespace dpchip::driver {
namespace {

using testing::Access;
using testing::station;
using Driver = testing::DriverFixture;
namespace irq = regmap::interrupt;

TEST_F(Driver, InitialisesInTheOrderThatFirmwareUses) {
    ASSERT_EQ(drv.configure(station()), ConfigError::none);
    std::vector<std::uint16_t> order;
    for (const Access& a : chip.registers('w')) order.push_back(a.address);
    EXPECT_EQ(order, (std::vector<std::uint16_t>{0x0C, 0x01, 0x00, 0x03, 0x02, 0x09, 0x07, 0x06, 0x12, 0x05, 0x04, 0x0A, 0x0B}));
    EXPECT_EQ(chip.registers('r'), (std::vector<Access>{{'r', 0x04, 0x00}}));
    chip.log.clear();
    ASSERT_TRUE(drv.start());
    EXPECT_EQ(chip.registers('w').back(), (Access{'w', 0x04, 0xF0})) << "Start, then the masks";
    EXPECT_EQ(drv.state(), State::online);
    EXPECT_FALSE(drv.start());
}

TEST_F(Driver, WritesTheCellsOfTheManual) {
    Config c = station();
    c.user_watchdog = 0x1234;
    c.set_slave_add = true;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    const auto& m = chip.ram;
    EXPECT_EQ(m[0x16], 8);
    EXPECT_EQ(m[m[0x17] * 8u], 0xFF);
    EXPECT_EQ(m[0x18], 0x34);
    EXPECT_EQ(m[0x19], 0x12);
    EXPECT_EQ(m[0x1A], 2);
    EXPECT_EQ(m[0x1E], 2);
    EXPECT_EQ(m[0x24], 6);
    EXPECT_EQ(m[0x25], 6);
    EXPECT_EQ(m[0x28], 20);
    EXPECT_EQ(m[0x2A], 0x06);
    EXPECT_EQ(m[0x33], 2);
    EXPECT_EQ(m[m[0x34] * 8u], 0x11);
    EXPECT_EQ(m[m[0x34] * 8u + 1u], 0x21);
    EXPECT_EQ(m[0x39], 0x00);
    EXPECT_EQ(m[0x3A], 0x11);
    EXPECT_EQ(m[0x3B], 0x47);
    EXPECT_EQ(m[0x22], 0);
}

TEST_F(Driver, SwapsTheWordRegistersInMotorolaMode) {
    Config c = station();
    c.bus_mode = BusMode::motorola;
    c.user_watchdog = 0x1234;
    chip.value[0x04] = 0xCF;
    chip.value[0x05] = 0x00;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    std::vector<std::uint16_t> order;
    for (const Access& a : chip.registers('w')) order.push_back(a.address);
    EXPECT_EQ(order, (std::vector<std::uint16_t>{0x0C, 0x00, 0x01, 0x02, 0x03, 0x09, 0x06, 0x07, 0x12, 0x04, 0x05, 0x0A, 0x0B}));
    EXPECT_EQ(chip.ram[0x18], 0x12);
    EXPECT_EQ(chip.ram[0x19], 0x34);
    EXPECT_EQ(chip.registers('r').front().address, 0x05);
}

TEST_F(Driver, LeavesAnApc3sReservedAddressesAlone) {
    Config c = station();
    c.variant = Variant::apc3;
    c.ram = RamSize::bytes_1536;
    ASSERT_EQ(drv.configure(c), ConfigError::none);
    for (const Access& a : chip.log) {
        EXPECT_LT(a.address, 1536);
        if (a.kind == 'w') { EXPECT_FALSE(a.address >= 0x0C && a.address < 0x16) << a.address; }
    }
    for (const unsigned cell : {0x22u, 0x23u, 0x35u, 0x36u, 0x37u, 0x38u}) EXPECT_EQ(chip.ram[cell], 0);
}

struct ModeRow {
    const char* what;
    void (*change)(Config&);
    std::uint16_t address;
    std::uint8_t value;
};

TEST_F(Driver, ModeRegistersSayWhatTheConfigSays) {
    const ModeRow rows[]{
        {"plain", [](Config&) {}, 0x06, 0xC0},
        {"plain", [](Config&) {}, 0x07, 0x01},
        {"plain", [](Config&) {}, 0x0C, 0x01},
        {"plain", [](Config&) {}, 0x12, 0x00},
        {"plain", [](Config&) {}, 0x05, 0xC0},
        {"plain", [](Config&) {}, 0x04, 0xF0},
        {"plain", [](Config&) {}, 0x0A, 0x10},
        {"plain", [](Config&) {}, 0x0B, 0x0B},
        {"no sync", [](Config& c) { c.sync_supported = false; }, 0x06, 0x80},
        {"no freeze", [](Config& c) { c.freeze_supported = false; }, 0x06, 0x40},
        {"polarity", [](Config& c) { c.int_polarity = IntPolarity::high; }, 0x06, 0xD0},
        {"wd base", [](Config& c) { c.wd_base = WdTimeBase::ms_1; }, 0x06, 0xC4},
        {"dis stop", [](Config& c) { c.dis_stop_control = true; }, 0x06, 0xC2},
        {"dis start", [](Config& c) { c.dis_start_control = true; }, 0x06, 0xC1},
        {"fail safe", [](Config& c) { c.fail_safe = true; }, 0x07, 0x21},
        {"special buffer", [](Config& c) { c.spec_prm_buf_mode = true; }, 0x07, 0x11},
        {"SAP 53", [](Config& c) { c.set_ext_prm = true; }, 0x07, 0x09},
        {"PrmCmd", [](Config& c) { c.prm_cmd_supported = true; }, 0x07, 0x41},
        {"isochron", [](Config& c) { c.sync_ena = true; }, 0x0C, 0x11},
        {"SAP 53", [](Config& c) { c.set_ext_prm = true; }, 0x04, 0xB0},
        {"timer", [](Config& c) { c.user_timer = UserTimer::ms_10; }, 0x07, 0x05},
        {"timer", [](Config& c) { c.user_timer = UserTimer::ms_1; }, 0x04, 0xE0},
        {"eoi", [](Config& c) { c.eoi_time = EoiTime::ms_1; }, 0x07, 0x03},
        {"4 KB", [](Config& c) { c.ram = RamSize::bytes_4096; }, 0x0C, 0x81},
        {"dx always", [](Config& c) { c.dx_int = DxInt::always; }, 0x0C, 0x05},
        {"dx change", [](Config& c) { c.dx_int = DxInt::on_change; }, 0x12, 0x02},
        {"gc changed", [](Config& c) { c.gc_int = GcInt::changed; }, 0x0C, 0x00},
        {"gc command", [](Config& c) { c.gc_int = GcInt::changed_command; }, 0x12, 0x01},
        {"no prm check", [](Config& c) { c.check_prm_reserved = false; }, 0x0C, 0x41},
        {"no gc check", [](Config& c) { c.check_gc_reserved = false; }, 0x0C, 0x03},
        {"polled", [](Config& c) { c.service = Service::polled; }, 0x05, 0xFF},
        {"masked", [](Config& c) { c.masked = irq::dx_out; }, 0x05, 0xE0},
        {"baud", [](Config& c) { c.wd_baud_control = 0x1E; }, 0x0A, 0x1E},
        {"tsdr", [](Config& c) { c.min_tsdr = 36; }, 0x0B, 36},
    };
    for (const ModeRow& row : rows) {
        Config c = station();
        row.change(c);
        chip.log.clear();
        ASSERT_EQ(drv.configure(c), ConfigError::none) << row.what;
        for (const Access& a : chip.registers('w'))
            if (a.address == row.address) { EXPECT_EQ(a.value, row.value) << row.what << " at " << row.address; }
    }
}

TEST_F(Driver, FindsABrokenRamCellAndARunningChip) {
    chip.broken_cell = 0x3A3;
    EXPECT_EQ(drv.configure(station()), ConfigError::ram_fault);
    EXPECT_FALSE(drv.start());
    chip.broken_cell = 0;
    chip.value[0x04] = 0x01;
    EXPECT_EQ(drv.configure(station()), ConfigError::running);
    for (const int nobody : {0xFF, 0x30, 0xC0, 0x31}) {
        chip.value[0x04] = static_cast<std::uint8_t>(nobody);
        EXPECT_EQ(drv.configure(station()), ConfigError::no_chip) << "codes 3 do not exist (5.2)";
    }
    chip.value[0x04] = 0x00;
    EXPECT_EQ(drv.configure(station()), ConfigError::none);
}

TEST_F(Driver, AWrongConfigurationDoesNotTouchTheChip) {
    Config c = station();
    c.max_diag = 245;
    EXPECT_EQ(drv.configure(c), ConfigError::diag_length);
    EXPECT_TRUE(chip.log.empty());
}

TEST_F(Driver, OneReadOfTheRequestsIsAllThatAnIdlePollNeedsWhenPolled) {
    Config c = station();
    c.service = Service::polled;
    bring_up(c);
    EXPECT_EQ(drv.poll(), 0);
    EXPECT_EQ(chip.log, (std::vector<Access>{{'r', 0x01, 0}, {'r', 0x00, 0}}));
}

TEST_F(Driver, EndOfInterruptIsTheLastAccess) {
    bring_up(station());
    chip.request(irq::dx_out | irq::new_gc_command);
    chip.ram[org::r_gc_command] = 2;
    EXPECT_EQ(drv.on_interrupt(), irq::dx_out | irq::new_gc_command);
    EXPECT_EQ(app.heard, (std::vector<std::string>{"dx_out", "gc 2"}));
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x02}));
    EXPECT_EQ(chip.registers('w').front(), (Access{'w', 0x03, 0x21})) << "acknowledged before it is served";
}

TEST_F(Driver, PollMasksTheInterruptWhileItWorks) {
    bring_up(station());
    drv.poll();
    const auto writes = chip.registers('w');
    ASSERT_EQ(writes.size(), 4u);
    EXPECT_EQ(writes[0], (Access{'w', 0x05, 0xFF}));
    EXPECT_EQ(writes[1], (Access{'w', 0x04, 0xFF}));
    EXPECT_EQ(writes[2], (Access{'w', 0x05, 0xC0}));
    EXPECT_EQ(writes[3], (Access{'w', 0x04, 0xF0}));
}

TEST_F(Driver, FeedsTheUserWatchdogOnlyWhenItIsUsed) {
    Config c = station();
    c.service = Service::polled;
    c.user_watchdog = 100;
    bring_up(c);
    drv.poll();
    EXPECT_EQ(chip.log.back(), (Access{'w', 0x08, 0x20}));
}

}  // namespace
}  // namespace dpchip::driver
