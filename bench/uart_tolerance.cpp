// SPDX-License-Identifier: Apache-2.0
// Telegrams with bad bits, one after the other, and a drawing of what came through.
#include "uart_tolerance.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include <dpchip/pins/uart.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::bench {
namespace {

using core::Ticks;
using pins::PinLevel;
namespace control = regmap::control;
namespace org = regmap::org;

constexpr std::uint8_t kTs = 8;
constexpr std::array<std::uint8_t, 6> kStatus{0x10, kTs, 0x02, 0x49, 0x53, 0x16};
const Ticks kBit = fdl::baud(fdl::BaudCode::mbit_12).bit;

/// A chip that has found 12 Mbit/s, and a hand on its RXD.
class Rig {
public:
    explicit Rig(bool start_controlled) {
        chip_.write(control::mode_reg1_r, 0xFF);
        chip_.write(control::mode_reg0_low, start_controlled ? 0 : regmap::mode0::dis_start_control);
        chip_.write(control::mode_reg0_high, 0x01);
        chip_.write(org::r_ts_adr, kTs);
        chip_.write(control::mode_reg1_s, regmap::mode1::start_vpc3);
        answered(0, 0, 0);
        if (chip_.wd_state() != chip::WdState::baud_control || !answered(0, 0, 0)) throw std::logic_error{"the chip hears nothing at all"};
    }

    /// Sends a status request whose bits have this error and this distortion; true when it is answered.
    bool answered(std::int32_t error_ppm, std::int32_t distortion, std::int64_t phase) {
        const Ticks start = uart_.next_sample_from(chip_.now() + kBit * 40) + Ticks{phase};
        const Ticks fall{std::max(-distortion, 0) * kBit.n / 100}, rise{std::max(distortion, 0) * kBit.n / 100};
        bool high = true;
        for (std::int64_t slot = 0; slot <= 11 * static_cast<std::int64_t>(kStatus.size()); ++slot) {
            const bool level = slot == 66 || pins::transmitter::bit_of(pins::transmitter::frame(kStatus[static_cast<std::size_t>(slot / 11)]), static_cast<unsigned>(slot % 11));
            if (level == high) continue;
            high = level;
            const Ticks at = start + Ticks{slot * kBit.n * 1'000'000 / (1'000'000 + error_ppm)} + (high ? rise : fall);
            uart_.set_rxd(chip_, at, pins::to_level(high));
        }
        return finish(start + kBit * 80);
    }

private:
    bool finish(Ticks until) {
        bool sent = false;
        const Ticks end = until + kBit * 160;
        while (uart_.next(chip_) <= end) {
            uart_.advance(chip_, uart_.next(chip_));
            sent = sent || uart_.txd() != PinLevel::z;
            while (!uart_.edges().empty()) static_cast<void>(uart_.edges().pop());
        }
        uart_.advance(chip_, end);
        return sent;
    }

    chip::Chip<core::NoTrace> chip_{regmap::Variant::vpc3c, slow_watchdog()};
    pins::Uart<core::NoTrace> uart_;

    /// The rate that was found is to stay, whatever is not heard.
    static regmap::Options slow_watchdog() {
        regmap::Options o;
        o.baud_probe_ms.fill(1'000'000);
        return o;
    }
};

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f", value);
    return text.data();
}

constexpr const char *kAll = "#2a7f3f", *kMost = "#9ccf8f", *kSome = "#d9c27a", *kNone = "#e4e0dc";
const char* colour(unsigned n, unsigned phases) { return n == phases ? kAll : n == 0 ? kNone : n * 2 >= phases ? kMost : kSome; }

/// The drawing of one map with its axes; the corner of the field is at (x, y).
void draw(std::string& out, const ToleranceMap& m, int x, int y) {
    constexpr int kWide = 8, kHigh = 8;
    const int width = static_cast<int>(m.error_ppm.size()) * kWide, height = static_cast<int>(m.distortion.size()) * kHigh;
    const auto text = [&](int at_x, int at_y, const char* anchor, const std::string& words) {
        out += "<text x=\"" + std::to_string(at_x) + "\" y=\"" + std::to_string(at_y) + "\" text-anchor=\"" + anchor + "\">" + words + "</text>\n";
    };
    text(x + width / 2, y - 10, "middle", m.start_controlled ? "Dis_Start_Control = 0" : "Dis_Start_Control = 1");
    for (std::size_t row = 0; row < m.distortion.size(); ++row) {
        const int top = y + height - (static_cast<int>(row) + 1) * kHigh;
        for (std::size_t column = 0, end = 0; column < m.error_ppm.size(); column = end) {
            const char* const fill = colour(m.accepted[row][column], m.phases);
            for (end = column + 1; end < m.error_ppm.size() && colour(m.accepted[row][end], m.phases) == fill;) ++end;
            out += "<rect x=\"" + std::to_string(x + static_cast<int>(column) * kWide) + "\" y=\"" + std::to_string(top) + "\" width=\"" +
                   std::to_string(static_cast<int>(end - column) * kWide) + "\" height=\"8\" fill=\"" + fill + "\"/>\n";
        }
        if (m.distortion[row] % 25 == 0) text(x - 6, top + kHigh, "end", std::to_string(m.distortion[row]) + " %");
    }
    for (std::size_t column = 0; column < m.error_ppm.size(); ++column)
        if (m.error_ppm[column] % 20'000 == 0) text(x + static_cast<int>(column) * kWide + kWide / 2, y + height + 14, "middle", std::to_string(m.error_ppm[column] / 10'000) + " %");
    text(x + width / 2, y + height + 30, "middle", "the sender's bits are too fast by");
}

}  // namespace

std::int32_t ToleranceMap::lowest_ppm() const {
    const std::size_t row = static_cast<std::size_t>(std::find(distortion.begin(), distortion.end(), 0) - distortion.begin());
    std::size_t n = static_cast<std::size_t>(std::find(error_ppm.begin(), error_ppm.end(), 0) - error_ppm.begin());
    while (n > 0 && accepted[row][n - 1] == phases) --n;
    return error_ppm[n];
}
std::int32_t ToleranceMap::highest_ppm() const {
    const std::size_t row = static_cast<std::size_t>(std::find(distortion.begin(), distortion.end(), 0) - distortion.begin());
    std::size_t n = static_cast<std::size_t>(std::find(error_ppm.begin(), error_ppm.end(), 0) - error_ppm.begin());
    while (n + 1 < error_ppm.size() && accepted[row][n + 1] == phases) ++n;
    return error_ppm[n];
}
std::int32_t ToleranceMap::lowest_distortion() const {
    const std::size_t column = static_cast<std::size_t>(std::find(error_ppm.begin(), error_ppm.end(), 0) - error_ppm.begin());
    std::size_t n = static_cast<std::size_t>(std::find(distortion.begin(), distortion.end(), 0) - distortion.begin());
    while (n > 0 && accepted[n - 1][column] == phases) --n;
    return distortion[n];
}
std::int32_t ToleranceMap::highest_distortion() const {
    const std::size_t column = static_cast<std::size_t>(std::find(error_ppm.begin(), error_ppm.end(), 0) - error_ppm.begin());
    std::size_t n = static_cast<std::size_t>(std::find(distortion.begin(), distortion.end(), 0) - distortion.begin());
    while (n + 1 < distortion.size() && accepted[n + 1][column] == phases) ++n;
    return distortion[n];
}

ToleranceMap measure_tolerance(bool start_controlled, unsigned phases) {
    ToleranceMap m;
    m.start_controlled = start_controlled;
    m.phases = std::clamp(phases, 1u, 1000u);
    for (std::int32_t ppm = -70'000; ppm <= 70'000; ppm += 2'500) m.error_ppm.push_back(ppm);
    for (std::int32_t percent = -75; percent <= 75; percent += 5) m.distortion.push_back(percent);
    Rig rig{start_controlled};
    for (const std::int32_t percent : m.distortion) {
        std::vector<unsigned>& row = m.accepted.emplace_back();
        for (const std::int32_t ppm : m.error_ppm) {
            unsigned n = 0;
            for (unsigned p = 0; p < m.phases; ++p) n += rig.answered(ppm, percent, core::kClk.n * p / m.phases) ? 1u : 0u;
            row.push_back(n);
        }
    }
    return m;
}

std::string tolerance_text(const ToleranceMap& m) {
    std::string out = std::string{"Dis_Start_Control = "} + (m.start_controlled ? "0" : "1") + ", " + std::to_string(m.phases) + " phases: # all, + some, . none\n";
    for (std::size_t row = m.distortion.size(); row-- > 0;) {
        std::array<char, 16> label{};
        std::snprintf(label.data(), label.size(), "%+4d %%  ", m.distortion[row]);
        out += label.data();
        for (const unsigned n : m.accepted[row]) out += n == m.phases ? '#' : n != 0 ? '+' : '.';
        out += '\n';
    }
    out += "low levels longer by (up), sender too fast by " + number(m.error_ppm.front() / 10'000.0) + " % to " + number(m.error_ppm.back() / 10'000.0) + " % (across)\n";
    out += "without distortion: " + number(m.lowest_ppm() / 10'000.0) + " % to " + number(m.highest_ppm() / 10'000.0) + " % of the rate; at the exact rate: " +
           std::to_string(m.lowest_distortion()) + " % to " + std::to_string(m.highest_distortion()) + " % of a bit\n";
    return out;
}

std::string tolerance_svg(const ToleranceMap& controlled, const ToleranceMap& uncontrolled) {
    const int width = static_cast<int>(controlled.error_ppm.size()) * 8, height = static_cast<int>(controlled.distortion.size()) * 8;
    const int all_width = 2 * width + 150, all_height = height + 110;
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(all_width) + "\" height=\"" + std::to_string(all_height) +
                      "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
                      "<text x=\"10\" y=\"18\" font-size=\"13\">Status requests that are answered. Upwards: low levels longer by so much of a bit. Dark green: at every "
                      "phase, pale: at some, grey: at none.</text>\n";
    draw(out, controlled, 60, 56);
    draw(out, uncontrolled, 130 + width, 56);
    return out + "</svg>\n";
}

}  // namespace dpchip::bench
