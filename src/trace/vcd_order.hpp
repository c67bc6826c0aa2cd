// SPDX-License-Identifier: Apache-2.0
// Changes that are not known in the order of time, brought into it before they are written.
//
// What was on the line is known when it has ended; what a chip did meanwhile is known at once. Changes wait here until
// nobody can bring an earlier one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <dpchip/fdl/transmission.hpp>
#include <dpchip/trace/vcd_writer.hpp>

namespace dpchip::trace {

/// Calls `edge(at, high)` for every change of level of `t`, which begins and ends high: start, data, parity and stop
/// bits of all characters, faults included.
template <class Edge>
void render(const fdl::Transmission& t, Edge&& edge) {
    bool high = true;
    for (std::size_t i = 0; i < t.length; ++i) {
        const fdl::Character c = t.character(i);
        const bool parity = fdl::even_parity(c.octet) != ((c.faults & fdl::fault_parity) != 0);
        const bool stop = (c.faults & fdl::fault_stop) == 0;
        const unsigned bits = static_cast<unsigned>(c.octet) << 1 | (parity ? 1u << 9 : 0u) | (stop ? 1u << 10 : 0u);
        for (unsigned n = 0; n < fdl::kCharacterBits; ++n) {
            const bool level = ((bits >> n) & 1u) != 0;
            if (level == high) continue;
            high = level;
            edge(c.start + c.bit * static_cast<std::int64_t>(n), high);
        }
    }
    if (!high) edge(t.end(), true);
}

class VcdOrder {
public:
    explicit VcdOrder(VcdWriter& writer) : writer_{&writer} {}

    void set(Ticks at, VcdWriter::Signal signal, char level) { push({at, 0, signal, Kind::level, static_cast<std::uint64_t>(level), {}}); }
    void set_value(Ticks at, VcdWriter::Signal signal, std::uint64_t value) { push({at, 0, signal, Kind::value, value, {}}); }
    /// `text` must outlive the change: names of states do.
    void set_text(Ticks at, VcdWriter::Signal signal, std::string_view text) { push({at, 0, signal, Kind::text, 0, text}); }
    void unknown(Ticks at, VcdWriter::Signal signal) { push({at, 0, signal, Kind::unknown, 0, {}}); }

    /// Writes every change before `until`: nothing earlier will come.
    void release(Ticks until) {
        while (!waiting_.empty() && waiting_.front().at < until) {
            std::pop_heap(waiting_.begin(), waiting_.end(), later);
            const Change c = waiting_.back();
            waiting_.pop_back();
            write(c);
        }
    }
    std::size_t waiting() const { return waiting_.size(); }

private:
    enum class Kind : std::uint8_t { level, value, text, unknown };
    struct Change {
        Ticks at;
        std::uint64_t number;
        VcdWriter::Signal signal;
        Kind kind;
        std::uint64_t value;
        std::string_view text;
    };
    static bool later(const Change& a, const Change& b) { return a.at > b.at || (a.at == b.at && a.number > b.number); }
    void push(Change c) {
        if (c.signal == VcdWriter::kOff) return;
        c.number = count_++;
        waiting_.push_back(c);
        std::push_heap(waiting_.begin(), waiting_.end(), later);
    }
    void write(const Change& c) {
        switch (c.kind) {
        case Kind::level: return writer_->set(c.at, c.signal, static_cast<char>(c.value));
        case Kind::value: return writer_->set_value(c.at, c.signal, c.value);
        case Kind::text: return writer_->set_text(c.at, c.signal, c.text);
        case Kind::unknown: return writer_->unknown(c.at, c.signal);
        }
    }

    VcdWriter* writer_;
    std::vector<Change> waiting_;
    std::uint64_t count_ = 0;
};

}  // namespace dpchip::trace
