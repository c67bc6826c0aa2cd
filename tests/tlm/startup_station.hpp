// SPDX-License-Identifier: Apache-2.0
// The station of the start-up scenario with its firmware: as a chip behind a socket, and as a package on a pin board.
#pragma once

#include "support/startup_firmware.hpp"
#include "tlm/pin_board.hpp"

namespace dpchip::tlm::test {

namespace startup = dpchip::test::startup;

/// ChipSettings or PackageSettings with variant and options of the scenario.
template <class Settings>
Settings startup_settings() {
    Settings s;
    s.variant = startup::kVariant;
    for (const auto& [name, value] : startup::kOptions) s.options.emplace_back(name, value);
    return s;
}

struct SocketStation {
    SocketStation(const sc_core::sc_module_name& name, const ChipSettings& settings, Line& line, startup::Service service)
        : board{name, settings, &line}, firmware{{this, &read, &write}, service} {
        board.program = [this] { serve(); };
    }
    static std::uint8_t read(void* self, std::uint16_t address) { return static_cast<SocketStation*>(self)->board.read(address); }
    static void write(void* self, std::uint16_t address, std::uint8_t value) { static_cast<SocketStation*>(self)->board.write(address, value); }

    /// The processor that waits for X/INT.
    void serve() {
        EXPECT_TRUE(firmware.begin());
        for (;;) {
            sc_core::wait(board.delay);
            board.delay = sc_core::SC_ZERO_TIME;
            if (board.x_int.read()) sc_core::wait(board.x_int.negedge_event());
            firmware.on_interrupt();
            if (board.delay == sc_core::SC_ZERO_TIME) sc_core::wait(board.x_int.posedge_event());
        }
    }

    Board board;
    startup::Firmware firmware;
};

struct PinStation {
    explicit PinStation(const sc_core::sc_module_name& name)
        : board{name, startup_settings<PackageSettings>()}, firmware{{this, &read, &write}, startup::Service::interrupt} {
        board.program = [this] { serve(); };
    }
    static std::uint8_t read(void* self, std::uint16_t address) { return static_cast<PinStation*>(self)->board.read(address); }
    static void write(void* self, std::uint16_t address, std::uint8_t value) { static_cast<PinStation*>(self)->board.write(address, value); }

    void serve() {
        board.power_up();
        EXPECT_TRUE(firmware.begin());
        for (;;) {
            if (board.x_int.read() == sc_dt::SC_LOGIC_1) sc_core::wait(board.x_int.negedge_event());
            firmware.on_interrupt();
        }
    }

    PinBoard board;
    startup::Firmware firmware;
};

}  // namespace dpchip::tlm::test
