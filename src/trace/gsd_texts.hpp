// SPDX-License-Identifier: Apache-2.0
// Diagnosis texts of the stations on a line, out of their GSDs.
#pragma once

#include <array>
#include <cstdint>

#include <dpchip/gsd/gsd.hpp>
#include <dpchip/trace/telegram_text.hpp>

namespace dpchip::trace {

class GsdTexts final : public DeviceTexts {
public:
    /// Station `address` (0..126) is a device of this GSD, which must outlive the texts; null: unknown again.
    void set(std::uint8_t address, const gsd::Gsd* device) {
        if (address < devices_.size()) devices_[address] = device;
    }
    std::vector<std::string> device_diag(std::uint8_t station, std::span<const std::uint8_t> data) const override;
    std::string channel_error(std::uint8_t station, std::uint8_t error) const override;
    std::optional<bool> dpv1_slave(std::uint8_t station) const override {
        const gsd::Gsd* known = device(station);
        return known != nullptr ? std::optional{known->dpv1.slave} : std::nullopt;
    }

private:
    const gsd::Gsd* device(std::uint8_t station) const { return station < devices_.size() ? devices_[station] : nullptr; }

    std::array<const gsd::Gsd*, 127> devices_{};
};

}  // namespace dpchip::trace
