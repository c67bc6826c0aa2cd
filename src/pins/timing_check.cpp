// SPDX-License-Identifier: Apache-2.0
// TimingCheck: one loop over the rows of a mode.
#include <dpchip/pins/timing_check.hpp>

#include <algorithm>

namespace dpchip::pins {

namespace {

using regmap::BusEvents;
using regmap::TimingKind;
using regmap::TimingParameter;

struct StrobeEdges {
    BusEvent opens, closes;
};

/// The edges that begin and end an access.
constexpr StrobeEdges strobe(ProcessorMode mode, Cycle cycle) {
    switch (mode) {
    case ProcessorMode::sync_intel:
    case ProcessorMode::async_intel:
        return cycle == Cycle::read ? StrobeEdges{BusEvent::xrd_falls, BusEvent::xrd_rises} : StrobeEdges{BusEvent::xwr_falls, BusEvent::xwr_rises};
    case ProcessorMode::async_motorola: return {BusEvent::as_falls, BusEvent::as_rises};
    case ProcessorMode::sync_motorola: return {BusEvent::e_rises, BusEvent::e_falls};
    }
    return {};
}

}  // namespace

void TimingCheck::configure(ProcessorMode mode, Supply supply) {
    mode_ = mode;
    supply_ = supply;
    const auto of_mode = [&](const TimingParameter& p) { return p.mode == mode; };
    const auto* const first = std::find_if(regmap::kBusTiming.begin(), regmap::kBusTiming.end(), of_mode);
    first_ = static_cast<std::size_t>(first - regmap::kBusTiming.begin());
    end_ = static_cast<std::size_t>(std::find_if_not(first, regmap::kBusTiming.end(), of_mode) - regmap::kBusTiming.begin());
    open_ = ale_phase_ = false;
    last_.fill(kLongAgo);
    reported_.fill(core::kNever);
    waiting_ = {};
}

template <class F>
void TimingCheck::each_check(F&& visit) {
    for (std::size_t i = first_; i < end_; ++i)
        if (regmap::kBusTiming[i].kind == TimingKind::check) visit(regmap::kBusTiming[i]);
}

Ticks TimingCheck::latest(BusEvents events) const {
    Ticks t = kLongAgo;
    for (std::size_t i = 0; i < regmap::kBusEvents; ++i)
        if (events.has(static_cast<BusEvent>(i))) t = std::max(t, last_[i]);
    return t;
}

/// `from`: the edge the time counts from; a second line of the same bus does not report it again.
void TimingCheck::judge(const TimingParameter& p, Ticks found, Ticks from, Ticks at) {
    if (p.at(supply_).meets(found)) return;
    Ticks& reported = reported_[regmap::timing_index(p.number)];
    if (reported == from) return;
    reported = from;
    const Violation v{at, p.number, found};
    const bool of_ale = p.to.has(BusEvent::ale_falls) || p.from.has(BusEvent::ale_falls);
    if (of_ale && !open_) waiting_.push(v);
    else violations_.push(v);
}

void TimingCheck::evaluate(BusEvent e, Ticks at, Cycle cycle) {
    each_check([&](const TimingParameter& p) {
        if (!p.to.has(e) || !regmap::covers(p.cycle, cycle)) return;
        const Ticks from = latest(p.from);
        judge(p, at - from, from, at);
    });
}

void TimingCheck::ale(BusEvent e, Ticks at) {
    evaluate(e, at, Cycle::both);
    last(e) = at;
    ale_phase_ = e == BusEvent::ale_falls;
    late_address_ = kLongAgo;
    if (e == BusEvent::ale_rises) waiting_ = {};
}

void TimingCheck::event(BusEvent e, Ticks at) {
    if (e == BusEvent::ale_rises || e == BusEvent::ale_falls) return ale(e, at);
    if (open_) {
        for (Inside& line : inside_) {
            if (line.event != e) continue;
            if (!line.seen) line.first = at;
            line.seen = true;
            line.last = at;
        }
        if (e == BusEvent::xcs_rises) xcs_rose_inside_ = at;
    }
    const bool stable = e == BusEvent::address_changes || e == BusEvent::r_w_changes || e == BusEvent::xcs_rises;
    if (!(open_ && stable)) evaluate(e, at, Cycle::both);
    if (ale_phase_ && e == BusEvent::address_changes) late_address_ = at;
    last(e) = at;
}

/// The strobe is ours, so was the ALE before it.
void TimingCheck::emit_ale_phase() {
    while (!waiting_.empty()) violations_.push(waiting_.pop());
    if (ale_phase_ && late_address_ != kLongAgo) {
        const Ticks fell = last(BusEvent::ale_falls);
        judge(regmap::timing(3), fell - late_address_, fell, late_address_);
    }
    ale_phase_ = false;
}

void TimingCheck::open(Cycle cycle, Ticks fell) {
    open_ = true;
    cycle_ = cycle;
    fell_ = fell;
    xcs_rose_inside_ = kLongAgo;
    for (Inside& line : inside_) line.seen = false;
    if (mode_ == ProcessorMode::sync_intel) emit_ale_phase();
    const BusEvent opens = strobe(mode_, cycle).opens;
    evaluate(opens, fell, cycle);
    last(opens) = fell;
}

/// A change inside the strobe belongs to the nearer of its edges.
void TimingCheck::changed_inside(const Inside& line, Ticks change, Ticks rose) {
    const StrobeEdges edges = strobe(mode_, cycle_);
    const bool set_up = change - fell_ <= rose - change;
    each_check([&](const TimingParameter& p) {
        if (set_up && p.from.has(line.event) && (p.to.has(edges.opens) || p.to.has(BusEvent::ale_falls))) {
            const Ticks to = p.to.has(edges.opens) ? fell_ : last(BusEvent::ale_falls);
            judge(p, to - change, fell_, change);
        }
        if (!set_up && p.from.has(edges.closes) && p.to.has(line.event)) judge(p, change - rose, rose, rose);
    });
}

void TimingCheck::close(Ticks at) {
    if (!open_) return;
    const StrobeEdges edges = strobe(mode_, cycle_);
    evaluate(edges.closes, at, cycle_);
    last(edges.closes) = at;
    for (const Inside& line : inside_) {
        if (!line.seen) continue;
        changed_inside(line, line.first, at);
        if (line.last != line.first) changed_inside(line, line.last, at);
    }
    if (xcs_rose_inside_ != kLongAgo)
        each_check([&](const TimingParameter& p) {
            if (p.from.has(edges.closes) && p.to.has(BusEvent::xcs_rises)) judge(p, xcs_rose_inside_ - at, at, at);
        });
    open_ = false;
}

}  // namespace dpchip::pins
