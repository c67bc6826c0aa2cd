// SPDX-License-Identifier: Apache-2.0
// The firmware of the start-up scenario: see the header.
#include "startup_firmware.hpp"

#include <array>
#include <span>

#include <dpchip/driver/vpc3.hpp>

namespace dpchip::test::startup {

namespace {

struct Port {
    Bus bus;
    std::uint8_t read(std::uint16_t a) const { return bus.read(bus.context, a); }
    void write(std::uint16_t a, std::uint8_t d) const { bus.write(bus.context, a, d); }
    void read_block(std::uint16_t a, std::span<std::uint8_t> out) const {
        for (std::uint8_t& octet : out) octet = read(a++);
    }
    void write_block(std::uint16_t a, std::span<const std::uint8_t> in) const {
        for (const std::uint8_t octet : in) write(a++, octet);
    }
};

}  // namespace

struct Firmware::Body : driver::Events {
    Body(const Bus& bus, Service service) : driver{Port{bus}, *this} {
        config.service = service == Service::polling ? driver::Service::polled : driver::Service::interrupt;
        config.address = kStation;
        config.ident = kIdent;
        config.cfg = kCfg;
        config.max_prm = 16;
    }
    void data_exch_entered() { exchanging = true; }
    void data_exch_left() { exchanging = false; }
    void dx_out() {
        std::array<std::uint8_t, 2> io{};
        if (driver.fetch_outputs(io) == driver::Outputs::unchanged) return;
        for (std::uint8_t& octet : io) octet = static_cast<std::uint8_t>(~octet);
        driver.write_inputs(io);
    }

    driver::Config config{};
    bool exchanging = false;
    driver::Vpc3<Port, Body> driver;
};

Firmware::Firmware(const Bus& bus, Service service) : body_{std::make_unique<Body>(bus, service)} {}
Firmware::~Firmware() = default;

bool Firmware::begin() { return body_->driver.configure(body_->config) == driver::ConfigError::none && body_->driver.start(); }
void Firmware::on_interrupt() { body_->driver.on_interrupt(); }
void Firmware::poll() { body_->driver.poll(); }
bool Firmware::exchanging() const { return body_->exchanging; }

}  // namespace dpchip::test::startup
