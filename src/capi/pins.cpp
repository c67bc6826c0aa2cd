// SPDX-License-Identifier: Apache-2.0
// dpchip_pins_*: the package behind the C API.
#include <dpchip/dpchip_pins.h>

#include <array>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include <dpchip/pins/package.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

#include "error.hpp"
#include "model.hpp"
#include "pin_waves.hpp"

using dpchip::capi::fail;
using dpchip::capi::guarded;
using dpchip::core::Ticks;

namespace pins = dpchip::pins;
namespace regmap = dpchip::regmap;

struct dpchip_pins {
    dpchip_pins(regmap::Variant variant, regmap::Supply supply) : package{variant, supply} {}

    void drain_edges() {
        while (!package.edges().empty()) {
            const pins::PinEdge edge = package.edges().pop();
            if (waves) waves->edge(edge, package);
            if ((wanted >> static_cast<unsigned>(edge.pin) & 1u) != 0) edges.push_back(edge);
        }
        if (waves) waves->settle(package.now());
    }
    /// Whether the package queues a pin's edges: who asks for them, or who draws.
    void watch(pins::PinId pin) {
        const bool queued = (wanted >> static_cast<unsigned>(pin) & 1u) != 0;
        package.watch(pin, queued || (waves && pin != pins::PinId::clkout));
    }
    void watch_all() {
        for (const pins::PinInfo& p : pins::kPinTable)
            if (pins::is_output(p.id)) watch(p.id);
    }

    pins::Package<> package;
    std::deque<pins::PinEdge> edges;
    std::uint64_t wanted = ~(std::uint64_t{1} << static_cast<unsigned>(pins::PinId::clkout));  ///< bit n: the caller wants edges of pin n
    dpchip::trace::VcdTimescale timescale{};
    std::unique_ptr<dpchip::capi::PinWaves> waves;
};

static_assert(DPCHIP_PIN_AB0 == static_cast<int>(pins::PinId::ab0) && DPCHIP_PIN_TXD == static_cast<int>(pins::PinId::txd));
static_assert(DPCHIP_Z == static_cast<int>(pins::PinLevel::z) && DPCHIP_HIGH == static_cast<int>(pins::PinLevel::high));
static_assert(DPCHIP_PIN_BIDIRECTIONAL == static_cast<int>(pins::PinDirection::bidirectional));

namespace {

/// Times beyond the half of what fits are refused, so that sums of them never overflow.
constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max() / 4;

int null_part() { return fail(DPCHIP_E_ARGUMENT, "the part is a null pointer"); }
int no_pin(int pin) { return fail(DPCHIP_E_ARGUMENT, "there is no pin " + std::to_string(pin) + ": 1 to 44"); }
bool is_pin(int pin) { return pin > 0 && pins::is_pin(static_cast<unsigned>(pin)); }
bool is_level(int level) { return level >= DPCHIP_LOW && level <= DPCHIP_Z; }
int no_level(int level) { return fail(DPCHIP_E_ARGUMENT, "there is no level " + std::to_string(level)); }

int failed() { return fail(DPCHIP_E_VIOLATION, "bus timing was violated, and that is fatal"); }

bool supply_of(int millivolts, regmap::Supply& supply) {
    const bool v5 = millivolts >= 4500 && millivolts <= 5500, v3_3 = millivolts >= 3000 && millivolts <= 3600;
    supply = v5 ? regmap::Supply::v5 : regmap::Supply::v3_3;
    return v5 || v3_3;
}

/// The package's own options; -1: it has none of that name, 1: taken, 0: not a value.
int set_package_option(dpchip_pins& part, std::string_view name, std::string_view text) {
    auto& package = part.package;
    pins::PackageOptions o = package.options();
    if (name == "line") {
        if (text != "pins" && text != "none") return 0;
        o.line = text == "pins" ? pins::LineSide::pins : pins::LineSide::telegrams;
        package.set_options(o);
        return 1;
    }
    if (name == "waves_timescale") {
        const auto timescale = dpchip::trace::parse_timescale(text);
        if (timescale) part.timescale = *timescale;
        return timescale ? 1 : 0;
    }
    bool* const flag = name == "fatal" ? &o.fatal : name == "txd_pull_up" ? &o.txd_pull_up : name == "check_timing" ? &o.check_timing : nullptr;
    if (flag == nullptr) return -1;
    if (text != "true" && text != "false") return 0;
    *flag = text == "true";
    package.set_options(o);
    return 1;
}

}  // namespace

dpchip_pins* dpchip_pins_create(const char* variant, int millivolts) {
    return guarded([&]() -> dpchip_pins* {
        const auto v = dpchip::capi::variant_called(variant);
        regmap::Supply supply{};
        if (!v) return nullptr;
        if (supply_of(millivolts, supply) && pins::works_at(*v, supply)) return std::make_unique<dpchip_pins>(*v, supply).release();
        fail(DPCHIP_E_ARGUMENT, std::string{variant} + " does not work at " + std::to_string(millivolts) + " mV");
        return nullptr;
    }, [](int) -> dpchip_pins* { return nullptr; });
}

void dpchip_pins_destroy(dpchip_pins* part) {
    if (part == nullptr) return;
    guarded([&] { return dpchip_pins_waves(part, nullptr); });
    delete part;
}

const char* dpchip_pins_name(int pin) {
    if (is_pin(pin)) return pins::info(static_cast<pins::PinId>(pin)).name.data();
    no_pin(pin);
    return nullptr;
}

int dpchip_pins_direction(int pin) { return is_pin(pin) ? static_cast<int>(pins::info(static_cast<pins::PinId>(pin)).direction) : no_pin(pin); }

int dpchip_pins_set_option(dpchip_pins* part, const char* name, const char* text) {
    if (part == nullptr || name == nullptr || text == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] {
        const int own = set_package_option(*part, name, text);
        part->drain_edges();
        if (own > 0) return static_cast<int>(DPCHIP_OK);
        if (own == 0) return fail(DPCHIP_E_ARGUMENT, std::string{name} + "=" + text + ": not a value of this option");
        return dpchip::capi::set_chip_option(part->package.chip(), name, text);
    });
}

// ---- pins and time ----------------------------------------------------------------------------------------------

int dpchip_pins_set_pin(dpchip_pins* part, int pin, int level) {
    if (part == nullptr) return null_part();
    if (!is_pin(pin)) return no_pin(pin);
    if (!is_level(level)) return no_level(level);
    if (part->package.failed()) return failed();
    return guarded([&] {
        part->package.set_pin(static_cast<pins::PinId>(pin), static_cast<pins::PinLevel>(level));
        if (part->waves) part->waves->input(static_cast<pins::PinId>(pin), part->package);
        part->drain_edges();
        return part->package.failed() ? failed() : static_cast<int>(DPCHIP_OK);
    });
}

int dpchip_pins_get_pin(const dpchip_pins* part, int pin) {
    if (part == nullptr) return null_part();
    return is_pin(pin) ? static_cast<int>(part->package.pin(static_cast<pins::PinId>(pin))) : no_pin(pin);
}

int64_t dpchip_pins_now(const dpchip_pins* part) { return part == nullptr ? 0 : part->package.now().n; }

int64_t dpchip_pins_next(const dpchip_pins* part) { return part == nullptr ? std::numeric_limits<std::int64_t>::max() : part->package.next().n; }

int dpchip_pins_advance(dpchip_pins* part, int64_t ticks) {
    if (part == nullptr) return null_part();
    if (part->package.failed()) return failed();
    if (ticks < part->package.now().n || ticks > kLatest) return fail(DPCHIP_E_ARGUMENT, "time runs forwards, and not beyond 1.2 years");
    return guarded([&] {
        for (;;) {
            const Ticks at = std::min(part->package.next(), Ticks{ticks});
            part->package.advance(at);
            part->drain_edges();
            if (at.n == ticks) return static_cast<int>(DPCHIP_OK);
        }
    });
}

int dpchip_pins_next_edge(dpchip_pins* part, int64_t* ticks, int* pin, int* level) {
    if (part == nullptr || ticks == nullptr || pin == nullptr || level == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    if (part->edges.empty()) return 0;
    const pins::PinEdge edge = part->edges.front();
    part->edges.pop_front();
    *ticks = edge.at.n;
    *pin = static_cast<int>(edge.pin);
    *level = static_cast<int>(edge.level);
    return 1;
}

int dpchip_pins_watch(dpchip_pins* part, int pin, int on) {
    if (part == nullptr) return null_part();
    if (!is_pin(pin) || !pins::is_output(static_cast<pins::PinId>(pin))) return fail(DPCHIP_E_ARGUMENT, "pin " + std::to_string(pin) + " is no output");
    const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(pin);
    part->wanted = on != 0 ? part->wanted | bit : part->wanted & ~bit;
    part->watch(static_cast<pins::PinId>(pin));
    return DPCHIP_OK;
}

int dpchip_pins_waves(dpchip_pins* part, const char* path) {
    if (part == nullptr) return null_part();
    return guarded([&] {
        if (path == nullptr) {
            if (!part->waves) return static_cast<int>(DPCHIP_OK);
            const bool whole = part->waves->finish(part->package.now());
            part->waves.reset();
            part->watch_all();
            return whole ? static_cast<int>(DPCHIP_OK) : fail(DPCHIP_E_FILE, "not all waveforms could be written");
        }
        if (part->waves) return fail(DPCHIP_E_STATE, "waveforms are being drawn already; a null path ends them");
        part->drain_edges();
        auto waves = std::make_unique<dpchip::capi::PinWaves>(path, part->package, part->timescale);
        if (!waves->good()) return fail(DPCHIP_E_FILE, std::string{"cannot write "} + path);
        part->waves = std::move(waves);
        part->watch_all();
        return static_cast<int>(DPCHIP_OK);
    });
}

int dpchip_pins_set_clock_phase(dpchip_pins* part, int64_t ticks) {
    if (part == nullptr) return null_part();
    if (ticks < 0 || ticks >= dpchip::core::kClk.n) return fail(DPCHIP_E_ARGUMENT, "a phase is 0 to 1249 ticks");
    return guarded([&] {
        part->package.set_clock_phase(Ticks{ticks});
        part->drain_edges();
        return DPCHIP_OK;
    });
}

int dpchip_pins_clock_edge(dpchip_pins* part, int level, int64_t slope) {
    if (part == nullptr) return null_part();
    if (level != DPCHIP_LOW && level != DPCHIP_HIGH) return no_level(level);
    if (slope < 0 || slope > kLatest) return fail(DPCHIP_E_ARGUMENT, "an edge lasts 0 ticks or longer");
    if (part->package.failed()) return failed();
    return guarded([&] {
        part->package.clock_edge(static_cast<pins::PinLevel>(level), Ticks{slope});
        if (part->waves) part->waves->edge({part->package.now(), pins::PinId::clk, static_cast<pins::PinLevel>(level)}, part->package);
        part->drain_edges();
        return part->package.failed() ? failed() : static_cast<int>(DPCHIP_OK);
    });
}

// ---- findings ---------------------------------------------------------------------------------------------------

int dpchip_pins_finding(dpchip_pins* part, char* text, size_t capacity) {
    if (part == nullptr || (text == nullptr && capacity != 0)) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] {
        auto& own = part->package.findings();
        auto& chip = part->package.chip().findings();
        if (own.empty() && chip.empty()) return 0;
        const bool of_chip = own.empty() || (!chip.empty() && chip.front().at < own.front().at);
        const dpchip::core::Finding f = of_chip ? chip.pop() : own.pop();
        const std::string words = of_chip ? dpchip::capi::chip_finding(f) : dpchip::capi::finding_head(f) + dpchip::trace::pin_finding_text(f.rule, f.detail);
        dpchip::capi::give_text(words, text, capacity);
        return 1;
    });
}

int64_t dpchip_pins_violations(const dpchip_pins* part, int number) {
    if (part == nullptr) return null_part();
    if (number != 0 && (number < 0 || !regmap::is_timing_number(static_cast<unsigned>(number)))) return fail(DPCHIP_E_ARGUMENT, "there is no timing parameter " + std::to_string(number));
    return part->package.violations(static_cast<unsigned>(number));
}

int dpchip_pins_failed(const dpchip_pins* part) { return part != nullptr && part->package.failed() ? 1 : 0; }

// ---- the chip inside --------------------------------------------------------------------------------------------

uint8_t dpchip_pins_peek(const dpchip_pins* part, uint16_t address) { return part == nullptr ? std::uint8_t{0xFF} : part->package.chip().peek(address); }

int dpchip_pins_chip_info(const dpchip_pins* part, dpchip_chip_info* info) {
    if (part == nullptr || info == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return dpchip::capi::fill_info(part->package.chip(), info);
}

size_t dpchip_pins_snapshot_size(const dpchip_pins*) { return dpchip::capi::Model::snapshot_size(); }

int64_t dpchip_pins_save(const dpchip_pins* part, void* bytes, size_t capacity) {
    if (part == nullptr || bytes == nullptr) return fail(DPCHIP_E_ARGUMENT, "a null pointer");
    return guarded([&] { return dpchip::capi::save_model(part->package.chip(), bytes, capacity); });
}
