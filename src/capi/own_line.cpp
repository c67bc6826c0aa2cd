// SPDX-License-Identifier: Apache-2.0
// A chip on a line that the caller models: telegrams and characters in, telegrams out, at the chip's present.
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>

#include "chip.hpp"
#include "error.hpp"

using dpchip::capi::fail;
using dpchip::capi::guarded;
using dpchip::core::Ticks;

namespace fdl = dpchip::fdl;

static_assert(DPCHIP_FAULT_PARITY == int{fdl::fault_parity} && DPCHIP_FAULT_STOP == int{fdl::fault_stop} &&
              DPCHIP_FAULT_COLLISION == int{fdl::fault_collision});

namespace {

/// DPCHIP_OK when the caller may play the line.
int alone(const dpchip_chip* chip) {
    if (chip == nullptr) return fail(DPCHIP_E_ARGUMENT, "the chip is a null pointer");
    if (chip->line != nullptr) return fail(DPCHIP_E_STATE, "the chip is on a line that brings it its telegrams");
    return DPCHIP_OK;
}

std::optional<Ticks> bit_time(std::uint32_t baud) {
    const auto code = fdl::baud_from_bits_per_s(baud);
    if (code) return fdl::baud(*code).bit;
    fail(DPCHIP_E_ARGUMENT, std::to_string(baud) + " bit/s is none of the ten PROFIBUS rates (9600 .. 12000000)");
    return std::nullopt;
}

}  // namespace

int dpchip_chip_carrier(dpchip_chip* chip) {
    if (const int code = alone(chip); code != DPCHIP_OK) return code;
    return guarded([&] {
        chip->model.carrier(chip->model.now());
        chip->drain_edges();
        return DPCHIP_OK;
    });
}

int dpchip_chip_hear(dpchip_chip* chip, const void* telegram, size_t n, uint32_t baud) {
    if (const int code = alone(chip); code != DPCHIP_OK) return code;
    if (telegram == nullptr || n > fdl::kMaxTelegram) return fail(DPCHIP_E_ARGUMENT, "a telegram has 1 to 255 octets");
    const auto bit = bit_time(baud);
    if (!bit) return DPCHIP_E_ARGUMENT;
    return guarded([&] {
        const std::span<const std::uint8_t> octets{static_cast<const std::uint8_t*>(telegram), n};
        const auto decoded = fdl::decode(octets);
        if (!decoded || decoded->size != n) return fail(DPCHIP_E_ARGUMENT, "not exactly one good telegram: give its characters one by one");
        fdl::Transmission t;
        t.assign(chip->model.now() - *bit * (fdl::kCharacterBits * static_cast<std::int64_t>(n)), *bit, octets);
        chip->model.hear(t);
        chip->drain_edges();
        return static_cast<int>(DPCHIP_OK);
    });
}

int dpchip_chip_hear_character(dpchip_chip* chip, uint8_t octet, int faults, uint32_t baud) {
    if (const int code = alone(chip); code != DPCHIP_OK) return code;
    if (faults < 0 || faults > (DPCHIP_FAULT_PARITY | DPCHIP_FAULT_STOP | DPCHIP_FAULT_COLLISION))
        return fail(DPCHIP_E_ARGUMENT, "faults are sums of DPCHIP_FAULT_PARITY, DPCHIP_FAULT_STOP and DPCHIP_FAULT_COLLISION");
    const auto bit = bit_time(baud);
    if (!bit) return DPCHIP_E_ARGUMENT;
    return guarded([&] {
        chip->model.hear_character({chip->model.now() - *bit * fdl::kCharacterBits, *bit, octet, static_cast<std::uint8_t>(faults)});
        chip->drain_edges();
        return DPCHIP_OK;
    });
}

int dpchip_chip_take(dpchip_chip* chip, dpchip_telegram* telegram) {
    if (const int code = alone(chip); code != DPCHIP_OK) return code;
    if (telegram == nullptr || telegram->size < sizeof(size_t)) return fail(DPCHIP_E_ARGUMENT, "dpchip_telegram.size is not set");
    return guarded([&] {
        fdl::Transmission sent;
        if (!chip->model.take(sent)) return 0;
        dpchip_telegram t{};
        t.size = telegram->size;
        t.start_ticks = chip->attachment.outside(sent.start).n;
        t.end_ticks = chip->attachment.outside(sent.end()).n;
        t.length = sent.length;
        std::ranges::copy(sent.bytes(), t.octets);
        std::memcpy(telegram, &t, std::min(telegram->size, sizeof t));
        return 1;
    });
}
