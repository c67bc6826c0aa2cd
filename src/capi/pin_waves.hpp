// SPDX-License-Identifier: Apache-2.0
// Waveforms of a package's pins in a file: edges of the outputs, and what the board does with the inputs.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <dpchip/pins/package.hpp>
#include <dpchip/trace/vcd_pins.hpp>

namespace dpchip::capi {

class PinWaves {
public:
    /// Begins with the levels of now.
    PinWaves(const std::string& path, const pins::Package<>& package, const trace::VcdTimescale& timescale)
        : file_{path, std::ios::binary | std::ios::trunc}, writer_{file_, {timescale, package.now(), core::kNever, "package"}},
          pins_{writer_, "part", pins::kPinTable} {
        for (const pins::PinInfo& p : pins::kPinTable) pins_.edge(pins::PinEdge{package.now(), p.id, package.pin(p.id)});
    }

    /// An edge of an output, or of a pin as it is from now on.
    void edge(const pins::PinEdge& e, const pins::Package<>& package) {
        // What the chip lets go of the board may hold.
        waiting_.push_back({e.at, e.pin, e.level == pins::PinLevel::z ? package.pin(e.pin) : e.level});
    }
    void input(pins::PinId pin, const pins::Package<>& package) { waiting_.push_back({package.now(), pin, package.pin(pin)}); }

    /// Nothing that happened before `now` will come later.
    void settle(core::Ticks now) {
        std::ranges::stable_sort(waiting_, {}, &pins::PinEdge::at);
        const auto end = std::ranges::find_if(waiting_, [&](const pins::PinEdge& e) { return e.at >= now; });
        std::for_each(waiting_.begin(), end, [&](const pins::PinEdge& e) { pins_.edge(e); });
        waiting_.erase(waiting_.begin(), end);
    }
    /// False when not everything could be written.
    bool finish(core::Ticks now) {
        settle(core::kNever);
        writer_.finish(now);
        file_.close();
        return file_.good();
    }
    bool good() const { return file_.is_open() && file_.good(); }

private:
    std::ofstream file_;
    trace::VcdWriter writer_;
    trace::VcdPins<pins::kPins> pins_;
    std::vector<pins::PinEdge> waiting_;
};

}  // namespace dpchip::capi
