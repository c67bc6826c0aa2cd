// SPDX-License-Identifier: Apache-2.0
// dpchip_chip_*: the chip behind the C API.
#include "chip.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "error.hpp"

using dpchip::capi::fail;
using dpchip::capi::guarded;
using dpchip::core::Ticks;

namespace regmap = dpchip::regmap;

namespace {

using dpchip::chip::Pin;

constexpr std::size_t kMaxEdges = 1024;

constexpr unsigned mask(Pin pin) { return 1u << static_cast<unsigned>(pin); }

/// The pin of a DPCHIP_OUT_ number, or nothing.
std::optional<Pin> output_pin(int output) {
    switch (output) {
    case DPCHIP_OUT_X_INT: return Pin::x_int;
    case DPCHIP_OUT_RTS: return Pin::rts;
    case DPCHIP_OUT_XDATAEXCH_SYNC: return Pin::xdataexch_sync;
    default: return std::nullopt;
    }
}

std::int32_t output_number(Pin pin) {
    switch (pin) {
    case Pin::x_int: return DPCHIP_OUT_X_INT;
    case Pin::rts: return DPCHIP_OUT_RTS;
    case Pin::xdataexch_sync: return DPCHIP_OUT_XDATAEXCH_SYNC;
    }
    return DPCHIP_E_INTERNAL;
}

}  // namespace

std::uint64_t dpchip_chip::next_serial() {
    static std::atomic<std::uint64_t> made{0};
    return ++made;
}

void dpchip_chip::watch(bool on) {
    drain_edges();
    watched = on;
    if (!on) edges.clear();
    model.watch(static_cast<std::uint8_t>(mask(Pin::x_int) | (on ? mask(Pin::rts) | mask(Pin::xdataexch_sync) : 0u)));
}

void dpchip_chip::drain_edges() {
    auto& queue = model.edges();
    while (!queue.empty()) {
        const dpchip::chip::Edge edge = queue.pop();
        const bool high = edge.level == dpchip::chip::Level::high;
        const bool active_high = (model.state().mode0 & regmap::mode0::int_pol) != 0;
        if (edge.pin == Pin::x_int && high == active_high) x_int_rose = true;
        if (!watched) continue;
        if (edges.size() == kMaxEdges) edges.pop_front();
        edges.push_back({attachment.outside(edge.at).n, output_number(edge.pin), high ? 1 : 0});
    }
}

void dpchip_chip::before_access(Ticks duration) {
    if (line == nullptr) {
        model.advance(model.now() + duration);
        return;
    }
    line->spend(duration);
    attachment.advance(line->segment().now());  // not the wall clock: the line moves its chips, and is behind it
}

void dpchip_chip::after_access() {
    drain_edges();
    if (line == nullptr) return;
    line->segment().touch(index);
    line->look();
}

namespace {

constexpr std::int64_t kLongestAccess_ns = 1'000'000;

int null_chip() { return fail(DPCHIP_E_ARGUMENT, "the chip is a null pointer"); }

}  // namespace

dpchip_chip* dpchip_chip_create(const char* variant) {
    return guarded([&]() -> dpchip_chip* {
        const auto v = dpchip::capi::variant_called(variant);
        return v ? std::make_unique<dpchip_chip>(*v).release() : nullptr;
    }, [](int) -> dpchip_chip* { return nullptr; });
}

void dpchip_chip_destroy(dpchip_chip* chip) {
    if (chip == nullptr) return;
    if (chip->line != nullptr) {
        auto& on_line = chip->line->chips;
        std::erase(on_line, chip);
        chip->line->segment().detach(chip->index);
        chip->line->look();
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

int dpchip_chip_level(const dpchip_chip* chip, int output) {
    if (chip == nullptr) return null_chip();
    const auto pin = output_pin(output);
    if (!pin) return fail(DPCHIP_E_ARGUMENT, "the outputs are DPCHIP_OUT_X_INT, DPCHIP_OUT_RTS and DPCHIP_OUT_XDATAEXCH_SYNC");
    return chip->model.level(*pin) == dpchip::chip::Level::high ? 1 : 0;
}

int dpchip_chip_watch(dpchip_chip* chip, int on) {
    if (chip == nullptr) return null_chip();
    return guarded([&] {
        chip->watch(on != 0);
        return DPCHIP_OK;
    });
}

int dpchip_chip_edge(dpchip_chip* chip, dpchip_edge* edge) {
    if (chip == nullptr || edge == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->edges.empty()) return 0;
    *edge = chip->edges.front();
    chip->edges.pop_front();
    return 1;
}

int64_t dpchip_chip_now_ticks(const dpchip_chip* chip) {
    if (chip == nullptr) return 0;
    return chip->line != nullptr ? chip->line->now().n : chip->attachment.outside(chip->model.now()).n;
}

int64_t dpchip_chip_next_ticks(const dpchip_chip* chip) {
    return chip == nullptr ? std::numeric_limits<std::int64_t>::max() : chip->attachment.next().n;
}

int dpchip_chip_run_ticks(dpchip_chip* chip, int64_t ticks) {
    if (chip == nullptr) return null_chip();
    if (chip->line != nullptr) return fail(DPCHIP_E_STATE, "the chip's time is its line's: dpchip_line_run_ticks");
    if (ticks < 0 || chip->model.now().n > dpchip::core::kNever.n / 2 - ticks) return fail(DPCHIP_E_ARGUMENT, "time cannot pass so far");
    return guarded([&] {
        const Ticks end = chip->model.now() + Ticks{ticks};
        while (chip->model.next() < end) {
            chip->model.advance(std::max(chip->model.next(), chip->model.now()));
            chip->drain_edges();
        }
        chip->model.advance(end);
        chip->drain_edges();
        return DPCHIP_OK;
    });
}

int dpchip_chip_set_option(dpchip_chip* chip, const char* name, const char* text) {
    if (chip == nullptr || name == nullptr || text == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] { return dpchip::capi::set_chip_option(chip->model, name, text); });
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

int dpchip_chip_set_name(dpchip_chip* chip, const char* name) {
    if (chip == nullptr || name == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] {
        const std::string wanted{name};
        const auto plain = [](char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; };
        if (wanted.size() > 100 || !std::all_of(wanted.begin(), wanted.end(), plain))
            return fail(DPCHIP_E_ARGUMENT, "a name has up to 100 letters, digits and underscores");
        chip->name = wanted;
        return static_cast<int>(DPCHIP_OK);
    });
}

int dpchip_chip_get_info(const dpchip_chip* chip, dpchip_chip_info* info) {
    if (chip == nullptr || info == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return dpchip::capi::fill_info(chip->model, info);
}

int dpchip_chip_finding(dpchip_chip* chip, char* text, size_t capacity) {
    if (chip == nullptr || (text == nullptr && capacity != 0)) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->model.findings().empty()) return 0;
    return guarded([&] {
        dpchip::capi::give_text(dpchip::capi::chip_finding(chip->model.findings().pop()), text, capacity);
        return 1;
    });
}

size_t dpchip_chip_snapshot_size(const dpchip_chip*) { return dpchip::capi::Model::snapshot_size(); }

int64_t dpchip_chip_save(const dpchip_chip* chip, void* bytes, size_t capacity) {
    if (chip == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] { return dpchip::capi::save_model(chip->model, bytes, capacity); });
}

int dpchip_chip_load(dpchip_chip* chip, const void* bytes, size_t size) {
    if (chip == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->line != nullptr && !chip->line->is_virtual()) return fail(DPCHIP_E_STATE, "a chip on a live line cannot go back in time");
    return guarded([&] {
        const auto error = chip->model.load({static_cast<const std::uint8_t*>(bytes), size});
        if (error != dpchip::core::ArchiveError::none)
            return fail(DPCHIP_E_SNAPSHOT, "not a snapshot of this chip and version (reason " + std::to_string(static_cast<int>(error)) + ")");
        if (chip->line != nullptr) chip->attachment.set_offset(chip->model.now() - chip->line->now());
        chip->watch(chip->watched);  // what is watched is part of a snapshot
        chip->after_access();
        return static_cast<int>(DPCHIP_OK);
    });
}
