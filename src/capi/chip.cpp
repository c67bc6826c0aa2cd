// SPDX-License-Identifier: Apache-2.0
// dpchip_chip_*: the chip behind the C API.
#include "chip.hpp"

#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "error.hpp"

using dpchip::capi::fail;
using dpchip::capi::guarded;
using dpchip::core::Ticks;

namespace regmap = dpchip::regmap;

void dpchip_chip::watch_x_int() {
    auto& edges = model.edges();
    while (!edges.empty()) {
        const bool high = edges.pop().level == dpchip::chip::Level::high;
        const bool active_high = (model.state().mode0 & regmap::mode0::int_pol) != 0;
        if (high == active_high) x_int_rose = true;
    }
}

void dpchip_chip::before_access(Ticks duration) {
    if (line == nullptr) {
        model.advance(model.now() + duration);
        return;
    }
    line->spend(duration);
    attachment.advance(line->now());
}

void dpchip_chip::after_access() {
    watch_x_int();
    if (line != nullptr) line->segment().touch(index);
}

namespace {

constexpr std::int64_t kLongestAccess_ns = 1'000'000;

int null_chip() { return fail(DPCHIP_E_ARGUMENT, "the chip is a null pointer"); }

std::string variant_names() {
    std::string names;
    for (const regmap::Traits& t : regmap::kTraits) names += (names.empty() ? "" : ", ") + std::string{t.name};
    return names;
}

const char* words(regmap::OptionError error) {
    switch (error) {
    case regmap::OptionError::unknown_name: return "there is no such option";
    case regmap::OptionError::bad_value: return "not a value of this option";
    case regmap::OptionError::out_of_range: return "out of the option's range";
    }
    return "refused";
}

std::string values_of(std::string_view name) {
    for (const regmap::OptionInfo& o : regmap::option_table())
        if (o.name == name) return " (it takes " + std::string{o.values} + ")";
    return {};
}

const char* kind_name(dpchip::core::FindingKind kind) {
    switch (kind) {
    case dpchip::core::FindingKind::misuse: return "misuse";
    case dpchip::core::FindingKind::unusual: return "unusual";
    case dpchip::core::FindingKind::unverified: return "unverified";
    case dpchip::core::FindingKind::timing_violation: return "timing violation";
    }
    return "finding";
}

dpchip_chip_info info_of(const dpchip_chip& chip) {
    const auto& m = chip.model;
    dpchip_chip_info info{};
    info.online = m.online() ? 1 : 0;
    info.dp_state = static_cast<int>(m.dp_state());
    info.wd_state = static_cast<int>(m.wd_state());
    info.baud_code = static_cast<int>(m.baud());
    info.address = m.address();
    info.owner = m.owner();
    info.findings = static_cast<std::uint32_t>(m.findings().size());
    return info;
}

}  // namespace

dpchip_chip* dpchip_chip_create(const char* variant) {
    return guarded([&]() -> dpchip_chip* {
        const auto v = variant == nullptr ? std::nullopt : regmap::variant_from_name(variant);
        if (v) return std::make_unique<dpchip_chip>(*v).release();
        fail(DPCHIP_E_NAME, "no chip is called '" + std::string{variant == nullptr ? "(null)" : variant} + "'; known: " + variant_names());
        return nullptr;
    }, [](int) -> dpchip_chip* { return nullptr; });
}

void dpchip_chip_destroy(dpchip_chip* chip) {
    if (chip == nullptr) return;
    if (chip->line != nullptr) {
        auto& on_line = chip->line->chips;
        std::erase(on_line, chip);
        chip->line->segment().detach(chip->index);
    }
    delete chip;
}

int dpchip_chip_reset(dpchip_chip* chip) {
    if (chip == nullptr) return null_chip();
    return guarded([&] {
        chip->before_access({});
        chip->model.reset();
        chip->after_access();
        return DPCHIP_OK;
    });
}

uint8_t dpchip_chip_read(dpchip_chip* chip, uint16_t address) {
    if (chip == nullptr) return 0xFF;
    return guarded([&] {
        chip->before_access(chip->access_time);
        const std::uint8_t value = chip->model.read(address);
        chip->after_access();
        return value;
    }, [](int) { return std::uint8_t{0xFF}; });
}

void dpchip_chip_write(dpchip_chip* chip, uint16_t address, uint8_t value) {
    if (chip == nullptr) return;
    guarded([&] {
        chip->before_access(chip->access_time);
        chip->model.write(address, value);
        chip->after_access();
        return 0;
    });
}

uint8_t dpchip_chip_peek(const dpchip_chip* chip, uint16_t address) { return chip == nullptr ? std::uint8_t{0xFF} : chip->model.peek(address); }

int dpchip_chip_interrupt(const dpchip_chip* chip) { return chip != nullptr && chip->model.interrupt_active() ? 1 : 0; }

int dpchip_chip_set_option(dpchip_chip* chip, const char* name, const char* text) {
    if (chip == nullptr || name == nullptr || text == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] {
        const auto result = regmap::set_option(chip->model.options(), name, text);
        if (result) return static_cast<int>(DPCHIP_OK);
        const int code = result.error() == regmap::OptionError::unknown_name ? DPCHIP_E_NAME : DPCHIP_E_ARGUMENT;
        return fail(code, std::string{name} + "=" + text + ": " + words(result.error()) + values_of(name));
    });
}

int dpchip_chip_set_bus_mode(dpchip_chip* chip, int mode) {
    if (chip == nullptr) return null_chip();
    if (mode != DPCHIP_INTEL && mode != DPCHIP_MOTOROLA) return fail(DPCHIP_E_ARGUMENT, "the bus mode is DPCHIP_INTEL or DPCHIP_MOTOROLA");
    chip->model.set_bus_mode(mode == DPCHIP_MOTOROLA ? dpchip::chip::BusMode::motorola : dpchip::chip::BusMode::intel);
    return DPCHIP_OK;
}

int dpchip_chip_set_access_time(dpchip_chip* chip, int64_t nanoseconds) {
    if (chip == nullptr) return null_chip();
    if (nanoseconds < 0 || nanoseconds > kLongestAccess_ns) return fail(DPCHIP_E_ARGUMENT, "an access takes 0 to 1000000 ns");
    chip->access_time = dpchip::core::nanoseconds(nanoseconds);
    return DPCHIP_OK;
}

int dpchip_chip_set_xcts(dpchip_chip* chip, int level) {
    if (chip == nullptr) return null_chip();
    return guarded([&] {
        chip->before_access({});
        chip->model.set_xcts(level != 0 ? dpchip::chip::Level::high : dpchip::chip::Level::low);
        chip->after_access();
        return DPCHIP_OK;
    });
}

int dpchip_chip_get_info(const dpchip_chip* chip, dpchip_chip_info* info) {
    if (chip == nullptr || info == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (info->size < sizeof(size_t)) return fail(DPCHIP_E_ARGUMENT, "dpchip_chip_info.size is not set");
    dpchip_chip_info known = info_of(*chip);
    known.size = info->size;
    std::memcpy(info, &known, std::min(info->size, sizeof known));
    return DPCHIP_OK;
}

int dpchip_chip_finding(dpchip_chip* chip, char* text, size_t capacity) {
    if (chip == nullptr || (text == nullptr && capacity != 0)) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    auto& findings = chip->model.findings();
    if (findings.empty()) return 0;
    const auto f = findings.pop();
    const auto& rule = regmap::kRules[f.rule];
    std::snprintf(text, capacity, "%lld ns: %s: %.*s [%.*s, %04XH]", static_cast<long long>(dpchip::core::to_ns(f.at)),
                  kind_name(f.kind), static_cast<int>(rule.text.size()), rule.text.data(), static_cast<int>(rule.name.size()),
                  rule.name.data(), static_cast<unsigned>(f.detail));
    return 1;
}

size_t dpchip_chip_snapshot_size(const dpchip_chip*) { return dpchip::capi::Model::snapshot_size(); }

int64_t dpchip_chip_save(const dpchip_chip* chip, void* bytes, size_t capacity) {
    if (chip == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    const auto result = chip->model.save({static_cast<std::uint8_t*>(bytes), capacity});
    if (!result) return fail(DPCHIP_E_SPACE, "a snapshot takes " + std::to_string(dpchip::capi::Model::snapshot_size()) + " octets");
    return static_cast<int64_t>(*result);
}

int dpchip_chip_load(dpchip_chip* chip, const void* bytes, size_t size) {
    if (chip == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->line != nullptr && !chip->line->is_virtual()) return fail(DPCHIP_E_STATE, "a chip on a live line cannot go back in time");
    return guarded([&] {
        const auto error = chip->model.load({static_cast<const std::uint8_t*>(bytes), size});
        if (error != dpchip::core::ArchiveError::none)
            return fail(DPCHIP_E_SNAPSHOT, "not a snapshot of this chip and version (reason " + std::to_string(static_cast<int>(error)) + ")");
        if (chip->line != nullptr) chip->attachment.set_offset(chip->model.now() - chip->line->now());
        chip->after_access();
        return static_cast<int>(DPCHIP_OK);
    });
}
