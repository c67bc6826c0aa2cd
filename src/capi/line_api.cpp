// SPDX-License-Identifier: Apache-2.0
// dpchip_line_*: the line behind the C API.
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "chip.hpp"
#include "error.hpp"
#include "line.hpp"

using dpchip::capi::fail;
using dpchip::capi::guarded;
using dpchip::core::Ticks;

namespace {

int null_line() { return fail(DPCHIP_E_ARGUMENT, "the line is a null pointer"); }

constexpr std::int64_t kLongest_ns = std::numeric_limits<std::int64_t>::max() / dpchip::core::kTicksPerNs / 2;

Ticks duration_ns(std::int64_t ns) { return dpchip::core::nanoseconds(std::clamp<std::int64_t>(ns, 0, kLongest_ns)); }

/// No further than time reaches.
Ticks bounded(const dpchip::capi::Line& line, Ticks duration) {
    return std::min(duration, Ticks{dpchip::core::kNever.n / 2} - line.now());
}

void forget_rises(dpchip::capi::Line& line) {
    for (dpchip_chip* chip : line.chips) chip->x_int_rose = false;
}

Ticks run(dpchip::capi::Line& line, Ticks duration) {
    const Ticks passed = line.run(std::max(Ticks{}, bounded(line, duration)));
    line.segment().settle();
    for (dpchip_chip* chip : line.chips) chip->drain_edges();
    forget_rises(line);
    return passed;
}

void put_on(dpchip::capi::Line& line, dpchip_chip& chip) {
    chip.attachment.set_offset(chip.model.now() - line.segment().now());  // a live line's clock may be further on
    const auto index = line.segment().attach(chip.attachment, std::string{chip.model.traits().name});
    if (!index) throw std::logic_error{dpchip::segment::name(index.error())};
    chip.index = *index;
    chip.line = &line;
    line.chips.push_back(&chip);
    line.look();
}

/// Hands the telegram over that `next` gives, as far as the caller's structure reaches.
template <class Next>
int take_telegram(dpchip_line* line, dpchip_telegram* telegram, Next next) {
    if (line == nullptr || telegram == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (telegram->size < sizeof(size_t)) return fail(DPCHIP_E_ARGUMENT, "dpchip_telegram.size is not set");
    return guarded([&] {
        auto seen = next();
        if (!seen) return 0;
        seen->size = telegram->size;
        std::memcpy(telegram, &*seen, std::min(telegram->size, sizeof *seen));
        return 1;
    });
}

void take_off(dpchip::capi::Line& line, dpchip_chip& chip) {
    chip.attachment.advance(std::max(line.now(), line.segment().now()));
    line.segment().detach(chip.index);
    std::erase(line.chips, &chip);
    chip.line = nullptr;
    line.look();
}

}  // namespace

dpchip_line* dpchip_line_open(const char* uri, uint32_t baud) {
    return guarded([&]() -> dpchip_line* {
        if (uri == nullptr) {
            fail(DPCHIP_E_ARGUMENT, "the URI is a null pointer");
            return nullptr;
        }
        try {
            auto line = std::make_unique<dpchip_line>();
            line->line = dpchip::capi::open(uri, baud);
            line->path = line->line->path();
            return line.release();
        } catch (const std::invalid_argument& e) {
            fail(DPCHIP_E_ARGUMENT, e.what());
            return nullptr;
        }
    }, [](int) -> dpchip_line* { return nullptr; });
}

void dpchip_line_close(dpchip_line* line) {
    if (line == nullptr) return;
    guarded([&] {
        line->line->end_drawing();
        while (!line->line->chips.empty()) take_off(*line->line, *line->line->chips.back());
        line->line->end_recording();
        line->line->watch(false, false);
        return 0;
    });
    delete line;
}

const char* dpchip_line_path(const dpchip_line* line) { return line == nullptr ? "" : line->path.c_str(); }

int dpchip_line_attach(dpchip_line* line, dpchip_chip* chip) {
    if (line == nullptr || chip == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->line != nullptr) return fail(DPCHIP_E_STATE, "the chip is on a line already");
    return guarded([&] {
        try {
            put_on(*line->line, *chip);
            return static_cast<int>(DPCHIP_OK);
        } catch (const std::logic_error& e) {
            return fail(DPCHIP_E_STATE, e.what());
        }
    });
}

int dpchip_line_detach(dpchip_line* line, dpchip_chip* chip) {
    if (line == nullptr || chip == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (chip->line != line->line.get()) return fail(DPCHIP_E_STATE, "the chip is not on this line");
    return guarded([&] {
        take_off(*line->line, *chip);
        return static_cast<int>(DPCHIP_OK);
    });
}

int64_t dpchip_line_run(dpchip_line* line, int64_t nanoseconds) {
    if (line == nullptr) return null_line();
    return guarded([&] { return dpchip::core::to_ns(run(*line->line, duration_ns(nanoseconds))); });
}

int64_t dpchip_line_run_ticks(dpchip_line* line, int64_t ticks) {
    if (line == nullptr) return null_line();
    return guarded([&] { return run(*line->line, Ticks{ticks}).n; });
}

int64_t dpchip_line_now_ticks(const dpchip_line* line) { return line == nullptr ? 0 : line->line->now().n; }

int64_t dpchip_line_next_ticks(dpchip_line* line) {
    return line == nullptr ? std::numeric_limits<std::int64_t>::max() : line->line->segment().next().n;
}

void dpchip_line_stop(dpchip_line* line) {
    if (line != nullptr) line->line->stop();
}

int dpchip_line_send(dpchip_line* line, const void* bytes, size_t n) {
    if (line == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (n < 1 || n > dpchip::fdl::kMaxTelegram) return fail(DPCHIP_E_ARGUMENT, "a telegram has 1 to 255 octets");
    return guarded([&] { return line->line->send({static_cast<const std::uint8_t*>(bytes), n}); });
}

int dpchip_line_receive(dpchip_line* line, void* bytes, size_t capacity, int64_t timeout_ns) {
    if (line == nullptr || (bytes == nullptr && capacity != 0)) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] { return line->line->receive({static_cast<std::uint8_t*>(bytes), capacity}, duration_ns(timeout_ns)); });
}

int dpchip_line_post(dpchip_line* line, const void* bytes, size_t n, int64_t at_ticks) {
    if (line == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (n < 1 || n > dpchip::fdl::kMaxTelegram) return fail(DPCHIP_E_ARGUMENT, "a telegram has 1 to 255 octets");
    return guarded([&] { return line->line->post({static_cast<const std::uint8_t*>(bytes), n}, Ticks{at_ticks}); });
}

int dpchip_line_watch(dpchip_line* line, int on) {
    if (line == nullptr) return null_line();
    return guarded([&] {
        line->line->watch(on != 0, (on & 2) != 0);
        return DPCHIP_OK;
    });
}

int dpchip_line_telegram(dpchip_line* line, dpchip_telegram* telegram) {
    return take_telegram(line, telegram, [&] { return line->line->seen(); });
}

int dpchip_line_begun(dpchip_line* line, dpchip_telegram* telegram) {
    return take_telegram(line, telegram, [&] { return line->line->begun(); });
}

int dpchip_line_join(dpchip_line* line, uint32_t baud) {
    if (line == nullptr) return null_line();
    const auto rate = dpchip::fdl::baud_from_bits_per_s(baud);
    if (!rate) return fail(DPCHIP_E_ARGUMENT, std::to_string(baud) + " bit/s is none of the ten PROFIBUS rates (9600 .. 12000000)");
    return guarded([&] { return line->line->join(*rate); });
}

int dpchip_line_joined_begins(dpchip_line* line, int station) {
    if (line == nullptr) return null_line();
    return guarded([&] { return line->line->joined_begins(station); });
}

int dpchip_line_joined_sent(dpchip_line* line, int station, const void* bytes, const uint8_t* faults, size_t n, int64_t start_ticks) {
    if (line == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (n < 1 || n > dpchip::fdl::kMaxTelegram) return fail(DPCHIP_E_ARGUMENT, "a telegram has 1 to 255 octets");
    return guarded([&] { return line->line->joined_sent(station, {static_cast<const std::uint8_t*>(bytes), n}, faults, Ticks{start_ticks}); });
}

int dpchip_line_record(dpchip_line* line, const char* path) {
    if (line == nullptr) return null_line();
    return guarded([&] {
        try {
            if (path == nullptr) line->line->end_recording();
            else line->line->record(path);
            return static_cast<int>(DPCHIP_OK);
        } catch (const std::runtime_error& e) {
            return fail(DPCHIP_E_FILE, e.what());
        }
    });
}

int dpchip_line_waves(dpchip_line* line, const char* path, const char* signals) {
    if (line == nullptr) return null_line();
    return guarded([&] { return path == nullptr ? line->line->end_drawing() : line->line->draw(path, signals == nullptr ? "" : signals); });
}

int dpchip_line_set_option(dpchip_line* line, const char* name, const char* text) {
    if (line == nullptr || name == nullptr || text == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] { return line->line->set_option(name, text); });
}
