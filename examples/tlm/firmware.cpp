// SPDX-License-Identifier: Apache-2.0
// The slave's firmware in C++20, with dpchip's driver, behind the three C functions of firmware.h: two octets out, two
// octets in, which repeat them.
#include <array>
#include <span>

#include <dpchip/driver/vpc3.hpp>

extern "C" {
#include "../firmware.h"
}

using namespace dpchip;

namespace {

struct Bus {
    std::uint8_t read(std::uint16_t a) const { return bus_read(a); }
    void write(std::uint16_t a, std::uint8_t d) const { bus_write(a, d); }
    void read_block(std::uint16_t a, std::span<std::uint8_t> out) const { for (auto& octet : out) octet = bus_read(a++); }
    void write_block(std::uint16_t a, std::span<const std::uint8_t> in) const { for (auto octet : in) bus_write(a++, octet); }
};

struct Slave : driver::Events {
    driver::Vpc3<Bus, Slave> chip{{}, *this};
    std::array<std::uint8_t, 2> io{};
};

constexpr std::array<std::uint8_t, 2> kCfg{0x11, 0x21};  // 2 octets in, 2 octets out
Slave slave;

}  // namespace

void firmware_init(uint8_t station_address, uint16_t ident_number) {
    driver::Config config;
    config.address = station_address;
    config.ident = ident_number;
    config.cfg = kCfg;
    if (slave.chip.configure(config) == driver::ConfigError::none) slave.chip.start();
}

void firmware_isr() { slave.chip.on_interrupt(); }

void firmware_main_loop() {
    if (slave.chip.fetch_outputs(slave.io) == driver::Outputs::fresh) slave.chip.write_inputs(slave.io);
}
