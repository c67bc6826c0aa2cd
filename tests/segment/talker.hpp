// SPDX-License-Identifier: Apache-2.0
// A station for tests: answers requests to its address after a fixed time and writes down everything it is told.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/segment/segment.hpp>

namespace dpchip::test {

using core::kNever;
using core::Ticks;
using fdl::Transmission;

/// One thing a station was told.
struct Told {
    std::string what;
    Ticks at{};
    bool operator==(const Told&) const = default;
};

struct Talker {
    std::uint8_t own = segment::kNoAddress;
    bool ears = false;
    std::int64_t tsdr_bits = 11;
    Ticks bit = fdl::baud(fdl::BaudCode::mbit_12).bit;
    std::vector<std::uint8_t> reply{fdl::kSc};  ///< sent after every request to its own address
    std::vector<std::pair<Ticks, std::vector<std::uint8_t>>> plan{};  ///< sent at these ticks, in order
    Ticks alarm = kNever;                       ///< something to be advanced for, that sends nothing

    std::vector<Told> told{};
    Ticks now{};
    Ticks answer_at = kNever;
    bool begins = false;
    std::vector<std::uint8_t> outgoing{};

    void note(const std::string& what, Ticks at) { told.push_back({what, at}); }
    std::size_t count(const std::string& what) const {
        std::size_t n = 0;
        for (const Told& t : told) n += t.what == what ? 1u : 0u;
        return n;
    }

    Ticks next() const {
        Ticks first = answer_at < alarm ? answer_at : alarm;
        if (!plan.empty() && plan.front().first < first) first = plan.front().first;
        return first;
    }
    void advance(Ticks t) {
        if (t < now) note("time ran backwards", t);
        now = t;
        if (alarm <= t) { note("alarm", t); alarm = kNever; }
        if (answer_at <= t) { outgoing = reply; answer_at = kNever; begins = true; }
        else if (!plan.empty() && plan.front().first <= t) {
            outgoing = plan.front().second;
            plan.erase(plan.begin());
            begins = true;
        }
    }
    void hear(const Transmission& t) {
        note("telegram", now);
        if (t.end() != now) note("wrong end", now);
        const auto telegram = fdl::decode(t.bytes());
        if (!telegram) return note("no telegram", now);
        if (telegram->has_fc() && telegram->fc.is_request() && telegram->destination() == own)
            answer_at = now + bit * tsdr_bits;
    }
    void hear_character(const fdl::Character& c) {
        note("character " + std::to_string(c.octet) + " faults " + std::to_string(c.faults), c.end());
    }
    void carrier(Ticks at) {
        note("carrier", at);
        answer_at = kNever;
    }
    bool take(Transmission& t) {
        if (!begins) return false;
        begins = false;
        const auto telegram = fdl::decode(outgoing);
        t.assign(now, bit, outgoing);
        if (telegram && telegram->size == outgoing.size()) return true;
        t.damaged = true;
        t.faults.fill(0);
        return true;
    }
    bool hears_all() const { return ears; }
    std::uint8_t address() const { return own; }
};
static_assert(segment::Station<Talker>);

/// Remembers what was on the line.
struct Recorder {
    struct Entry {
        segment::StationIndex sender{};
        Ticks start{}, end{};
        bool damaged{};
        std::vector<std::uint8_t> octets;
        bool operator==(const Entry&) const = default;
    };
    std::vector<Entry> entries;
    std::size_t begun = 0;
    void see(const segment::Sighting& s) {
        entries.push_back({s.sender, s.sent.start, s.sent.end(), s.sent.damaged, {s.sent.bytes().begin(), s.sent.bytes().end()}});
    }
    void see_begin(const segment::Sighting&) { ++begun; }
};

inline std::vector<std::uint8_t> request(std::uint8_t da, std::uint8_t sa = 2, std::vector<std::uint8_t> data = {}) {
    std::vector<std::uint8_t> out(fdl::kMaxTelegram);
    const std::uint8_t fc = da == fdl::kBroadcast ? 0x46 : 0x7D;
    out.resize(fdl::encode(out, da, sa, fc, data));
    return out;
}
inline std::vector<std::uint8_t> answer(std::uint8_t da, std::uint8_t sa, const std::vector<std::uint8_t>& data) {
    std::vector<std::uint8_t> out(fdl::kMaxTelegram);
    out.resize(fdl::encode(out, da, sa, 0x08, data));
    return out;
}

}  // namespace dpchip::test
