// SPDX-License-Identifier: Apache-2.0
// The firmware of the start-up scenario: the driver on a bus of function pointers, behind a C++17 face. It hands the
// outputs back as inputs, inverted.
#pragma once

#include <cstdint>
#include <memory>

#include "support/startup_scenario.hpp"

namespace dpchip::test::startup {

/// One 8-bit processor cycle each.
struct Bus {
    void* context;
    std::uint8_t (*read)(void* context, std::uint16_t address);
    void (*write)(void* context, std::uint16_t address, std::uint8_t value);
};

class Firmware {
public:
    Firmware(const Bus& bus, Service service);
    ~Firmware();
    Firmware(const Firmware&) = delete;
    Firmware& operator=(const Firmware&) = delete;

    /// Tests the RAM, sets the chip up and starts it. False when the driver refuses.
    bool begin();
    /// X/INT is active.
    void on_interrupt();
    /// The main program's turn.
    void poll();
    bool exchanging() const;

private:
    struct Body;
    std::unique_ptr<Body> body_;
};

/// The reference: chip and line in C++, telegram by telegram, accesses without time.
Result telegram_level(Service service);

}  // namespace dpchip::test::startup
