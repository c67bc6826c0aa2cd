// SPDX-License-Identifier: Apache-2.0
// Outputs out, inputs in and compared.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/application.hpp>
#include <dpchip/cli/units.hpp>

namespace dpchip::cli {

using Kind = slave::IoBehaviour::Kind;

namespace {

/// Cycles after Unsync, Unfreeze or Operate until inputs and outputs belong together again.
constexpr unsigned kSettle = 4;
/// A counter counts answers, so a repeated one too.
constexpr std::uint32_t kMostAnswers = 16;

std::uint32_t low_word(std::span<const std::uint8_t> octets) {
    std::uint32_t value = 0;
    for (const std::uint8_t o : octets.last(std::min<std::size_t>(octets.size(), 4))) value = value << 8 | o;
    return value;
}

/// `now` is a little more than `before`.
bool counted(std::span<const std::uint8_t> before, std::span<const std::uint8_t> now) {
    const std::uint32_t mask = now.size() >= 4 ? ~0u : (1u << (8 * now.size())) - 1;
    const std::uint32_t step = (low_word(now) - low_word(before)) & mask;
    return step >= 1 && step <= kMostAnswers;
}

}  // namespace

Application::Application(std::vector<Wish> wishes) {
    for (Wish& w : wishes) slaves_.push_back({std::move(w), {}, 0, 0, false, {}, {}, {}});
}

void Application::operator()(master::Master& master) {
    if (disturbed_) settling_ = kSettle;
    else if (settling_ != 0) --settling_;
    const bool plain = master.mode() == master::Mode::operate && settling_ == 0;
    for (std::size_t n = 0; n < slaves_.size() && n < master.size(); ++n) {
        Slave& s = slaves_[n];
        master::SlaveHandler& h = master.slave(n);
        if (!plain) s.in_step = false;
        look(s, h);
        if (!plain) s.in_step = false;
        set_outputs(s, n, h);
    }
    ++round_;
}

/// Was there an exchange in this cycle? Then its inputs follow from its outputs, when the firmware was quick enough, or
/// from those of the exchange before.
void Application::look(Slave& s, const master::SlaveHandler& h) {
    const master::SlaveCounters& c = h.counters();
    if (c.lost != s.lost || !h.exchanging()) s.in_step = false;
    s.lost = c.lost;
    if (c.exchanges == s.seen) return;
    s.seen = c.exchanges;
    ++s.checked.exchanges;
    if (s.in_step && s.wish.io && !h.inputs().empty()) compare(s, h);
    s.sent.assign(h.outputs().begin(), h.outputs().end());
    s.last.assign(h.inputs().begin(), h.inputs().end());
    s.in_step = h.exchanging();
}

void Application::compare(Slave& s, const master::SlaveHandler& h) {
    s.expected.resize(h.inputs().size());
    ++s.checked.compared;
    if (s.wish.io->kind() == Kind::counter) {
        if (counted(s.last, h.inputs())) return;
        s.expected = s.last;
    } else {
        s.wish.io->fill(s.expected, s.sent, 0);
        if (std::ranges::equal(h.inputs(), s.expected)) return;
        s.wish.io->fill(s.expected, h.outputs(), 0);
        if (std::ranges::equal(h.inputs(), s.expected)) return;
    }
    if (s.checked.wrong++ == 0)
        s.checked.first_wrong = fmt::format("exchange {}: inputs {} instead of {}{}", s.checked.exchanges, hex_text(h.inputs()),
                                            s.wish.io->kind() == Kind::counter ? "a little more than " : "", hex_text(s.expected));
}

void Application::set_outputs(const Slave& s, std::size_t n, master::SlaveHandler& h) const {
    const auto out = h.outputs();
    if (s.wish.outputs) {
        std::ranges::fill(out, std::uint8_t{0});
        std::copy_n(s.wish.outputs->begin(), std::min(out.size(), s.wish.outputs->size()), out.begin());
        return;
    }
    if (!s.wish.io) return;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(round_ * 7 + n * 3 + i);
}

void Application::disturb(bool disturbed) { disturbed_ = disturbed; }

void Application::expect(std::size_t n, const slave::IoBehaviour& io) {
    if (slaves_[n].wish.io) slaves_[n].wish.io = io;
    slaves_[n].in_step = false;
}

std::uint64_t Application::compared() const {
    std::uint64_t sum = 0;
    for (const Slave& s : slaves_) sum += s.checked.compared;
    return sum;
}

std::uint64_t Application::wrong() const {
    std::uint64_t sum = 0;
    for (const Slave& s : slaves_) sum += s.checked.wrong;
    return sum;
}

}  // namespace dpchip::cli
