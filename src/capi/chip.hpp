// SPDX-License-Identifier: Apache-2.0
// What stands behind a dpchip_chip: the model, and its place on a line.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include <dpchip/chip/chip.hpp>
#include <dpchip/dpchip.h>
#include <dpchip/segment/station.hpp>

#include "line.hpp"
#include "model.hpp"

namespace dpchip::capi {

/// The chip as a station. A chip may have lived before it came to the line: its own time differs by `offset`.
class Attachment {
public:
    explicit Attachment(Model& model) : model_{&model} {}

    void set_offset(Ticks chip_minus_line) { offset_ = chip_minus_line; }
    /// The chip's time as its line, or whoever moves a chip without one, counts it.
    Ticks outside(Ticks chip) const { return chip == core::kNever ? core::kNever : chip - offset_; }

    Ticks next() const { return outside(model_->next()); }
    void advance(Ticks t) { model_->advance(t + offset_); }
    void hear(const segment::Transmission& t) {
        if (offset_ == Ticks{}) return model_->hear(t);
        segment::Transmission shifted = t;
        shifted.start += offset_;
        model_->hear(shifted);
    }
    void hear_character(segment::Character c) {
        c.start += offset_;
        model_->hear_character(c);
    }
    void carrier(Ticks t) { model_->carrier(t + offset_); }
    bool take(segment::Transmission& t) {
        if (!model_->take(t)) return false;
        t.start -= offset_;
        return true;
    }
    bool hears_all() const { return model_->hears_all(); }
    std::uint8_t address() const { return model_->address(); }

private:
    Model* model_;
    Ticks offset_{};
};

}  // namespace dpchip::capi

struct dpchip_chip {
    explicit dpchip_chip(dpchip::regmap::Variant variant) : model{variant}, attachment{model}, serial{next_serial()} { watch(false); }
    dpchip_chip(const dpchip_chip&) = delete;
    dpchip_chip& operator=(const dpchip_chip&) = delete;

    dpchip::capi::Model model;
    dpchip::capi::Attachment attachment;
    dpchip::capi::Line* line = nullptr;
    const std::uint64_t serial;     ///< no other chip ever has it
    std::string name;               ///< as the caller calls it; empty: it has none
    dpchip::segment::StationIndex index{};
    dpchip::core::Ticks access_time = dpchip::core::nanoseconds(125);
    bool x_int_rose = false;
    bool watched = false;           ///< edges are kept for dpchip_chip_edge
    std::deque<dpchip_edge> edges;

    /// Every output's edges, or only what dpchip_line_run needs.
    void watch(bool on);
    /// Brings the chip to the present of its line, after an access time if there is one.
    void before_access(dpchip::core::Ticks duration);
    /// The processor has done something: the line must look again.
    void after_access();
    /// Empties the model's queue of edges: notes rising X/INT, keeps edges for who watches.
    void drain_edges();

private:
    static std::uint64_t next_serial();
};
