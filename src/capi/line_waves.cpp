// SPDX-License-Identifier: Apache-2.0
// What is drawn of a line, under which names, and what can go wrong.
#include "line_waves.hpp"

#include <algorithm>

#include "chip.hpp"
#include "error.hpp"
#include "line.hpp"

namespace dpchip::capi {

namespace {

/// "NAME", "station_8" of a chip that has an address, "chip_2" of the second on the line; nothing twice.
std::vector<std::string> scopes(std::span<dpchip_chip* const> chips) {
    std::vector<std::string> names;
    for (const dpchip_chip* chip : chips) {
        const std::string place = std::to_string(names.size() + 1);
        const std::uint8_t address = chip->model.address();
        std::string name = !chip->name.empty() ? chip->name : address < segment::kNoAddress ? "station_" + std::to_string(address) : "chip_" + place;
        const auto taken = [&] { return name == "line" || name == "master" || std::ranges::find(names, name) != names.end(); };
        while (taken()) name += '_' + place;
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> patterns(std::string_view text) {
    std::vector<std::string> all;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        std::string_view one = text.substr(0, comma);
        text.remove_prefix(std::min(comma + 1, text.size()));
        while (one.starts_with(' ')) one.remove_prefix(1);
        while (one.ends_with(' ')) one.remove_suffix(1);
        all.emplace_back(one);
    }
    return all;
}

}  // namespace

LineWaves::LineWaves(segment::Segment& segment, std::span<dpchip_chip* const> chips, segment::StationIndex master, const waves::Options& options)
    : waves_{file_, segment, scopes(chips), options} {
    waves_.set_master(master);
    for (const dpchip_chip* chip : chips) serials_.push_back(chip->serial);
}

std::string LineWaves::misfit() const {
    const std::string* const pattern = waves_.unmatched();
    if (pattern == nullptr) return {};
    std::string words = *pattern + ": no signal is called so. There are:";
    for (const std::string& name : waves_.signals()) words += ' ' + name;
    return words;
}

bool LineWaves::open(const std::string& path) {
    path_ = path;
    file_.open(path, std::ios::binary | std::ios::trunc);
    return file_.is_open();
}

void LineWaves::look(std::span<dpchip_chip* const> on_line, core::Ticks hold) {
    for (std::size_t n = 0; n < serials_.size(); ++n) {
        const auto at = std::ranges::find_if(on_line, [&](const dpchip_chip* chip) { return chip->serial == serials_[n]; });
        if (at == on_line.end()) waves_.look(n, nullptr, segment::kNobody);
        else waves_.look(n, &(*at)->model.state(), (*at)->index);
    }
    waves_.settle(hold);
}

bool LineWaves::finish() {
    waves_.finish();
    file_.close();
    return file_.good();
}

// ---- the line's part ---------------------------------------------------------------------------------------------

int Line::draw(const std::string& file, std::string_view signals) {
    if (!is_virtual()) return fail(DPCHIP_E_STATE, "only a sim: line is drawn: the bits of this one are beyond its port; dpchip_line_record keeps its telegrams");
    if (waves_ != nullptr) return fail(DPCHIP_E_STATE, "waveforms go into " + waves_->path() + " already; a null path ends them");
    segment().settle();
    waves::Options options;
    options.signals = patterns(signals);
    options.from = now();
    options.timescale = timescale_;
    auto waves = std::make_unique<LineWaves>(segment(), chips, outside(), options);
    if (const std::string words = waves->misfit(); !words.empty()) return fail(DPCHIP_E_NAME, words);
    if (!waves->open(file)) return fail(DPCHIP_E_FILE, "cannot write " + file);
    waves_ = std::move(waves);
    look();
    return DPCHIP_OK;
}

int Line::end_drawing() {
    if (waves_ == nullptr) return DPCHIP_OK;
    const std::unique_ptr<LineWaves> ended = std::move(waves_);  // gone before the segment is, whatever happens
    ended->look(chips, core::kNever);
    return ended->finish() ? static_cast<int>(DPCHIP_OK) : fail(DPCHIP_E_FILE, "not all waveforms could be written to " + ended->path());
}

int Line::set_option(std::string_view name, const std::string& text) {
    if (name != "waves_timescale") return fail(DPCHIP_E_NAME, "a line has no option " + std::string{name} + "; it has waves_timescale");
    const auto timescale = trace::parse_timescale(text);
    if (!timescale) return fail(DPCHIP_E_ARGUMENT, "waves_timescale=" + text + ": 1, 10 or 100 and fs, ps, ns, us, ms or s, as in 100ns");
    timescale_ = *timescale;
    return DPCHIP_OK;
}

void Line::look_at_waves() {
    Ticks hold = core::kNever;
    for (const Joined& j : joined_)
        if (j.sending) hold = std::min(hold, j.since);
    waves_->look(chips, hold);
}

}  // namespace dpchip::capi
