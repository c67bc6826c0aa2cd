// SPDX-License-Identifier: Apache-2.0
// The pins of a package as VCD signals. Fits any table of pins that has names and any edge with time, pin and level, such
// as dpchip::pins::kPinTable and dpchip::pins::PinEdge, which this layer does not know.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include <dpchip/trace/vcd_writer.hpp>

namespace dpchip::trace {

/// Signals for N pins numbered from 1; pins whose names begin with V (supply) are left out.
template <std::size_t N>
class VcdPins {
public:
    template <class Table>
    VcdPins(VcdWriter& writer, std::string_view scope, const Table& table) : writer_{&writer} {
        signals_.fill(VcdWriter::kOff);
        for (std::size_t i = 0; i < N; ++i)
            if (!std::string_view{table[i].name}.starts_with('V')) signals_[i] = writer.bit(scope, table[i].name);
    }

    /// An edge, in order of time. letter(level) gives 0, 1 or Z.
    template <class Edge>
    void edge(const Edge& e) {
        const char level = letter(e.level);
        writer_->set(e.at, signals_[static_cast<std::size_t>(e.pin) - 1], level == 'Z' ? 'z' : level);
    }
    VcdWriter::Signal signal(std::size_t pin_number) const { return signals_[pin_number - 1]; }

private:
    VcdWriter* writer_;
    std::array<VcdWriter::Signal, N> signals_{};
};

}  // namespace dpchip::trace
