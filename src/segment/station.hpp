// SPDX-License-Identifier: Apache-2.0
// What it takes to be a station on a segment: a concept, and a reference to any type that models it.
//
// Times are line time. A station owns its own state and is driven from outside: the segment asks next(), moves it
// with advance(), lets it hear what others sent and takes what it wants to send. A station never calls anybody.
//
// Optional: `void sent(Ticks at)`. What take() gave has left the line at `at` already, before its end(): a live line's
// medium may be faster than the bit time of its rate. Stations that time their own sending need it to be on a live line.
#pragma once

#include <concepts>
#include <cstdint>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/transmission.hpp>

namespace dpchip::segment {

using core::Ticks;
using fdl::Character;
using fdl::Transmission;

/// No station address: the station hears only what hears_all() gives it, and broadcasts.
inline constexpr std::uint8_t kNoAddress = 255;

template <class S>
concept Station = requires(S& s, const S& c, Ticks t, const Transmission& heard, Transmission& sent, const Character& ch) {
    /// When the station wants to be advanced next; kNever when only the line can wake it.
    { c.next() } -> std::same_as<Ticks>;
    /// Does everything due up to and including `t`. t never runs backwards.
    { s.advance(t) } -> std::same_as<void>;
    /// An undamaged telegram has just ended (the station has been advanced to its end()).
    { s.hear(heard) } -> std::same_as<void>;
    /// One character of a damaged transmission has just ended. All characters of it come this way, in order.
    { s.hear_character(ch) } -> std::same_as<void>;
    /// A foreign transmission begins at `t`; told to every station that will hear it and to every one with a planned
    /// answer, which is given up.
    { s.carrier(t) } -> std::same_as<void>;
    /// True and `sent` filled when the station starts sending now (sent.start == the time advanced to). Called after
    /// every advance() at which the station was due; next() is later than that time afterwards. What is not exactly one
    /// good telegram must be marked damaged, with its faults filled.
    { s.take(sent) } -> std::same_as<bool>;
    /// True while the station must hear every telegram, not only those addressed to it or to 127.
    { c.hears_all() } -> std::same_as<bool>;
    /// The address it answers to now, or kNoAddress.
    { c.address() } -> std::same_as<std::uint8_t>;
};

/// A non-owning reference to a station of any type: an object pointer and a static table of functions.
class StationRef {
public:
    StationRef() = default;

    template <Station S>
    explicit StationRef(S& station) : object_{&station}, table_{&kTable<S>} {}

    Ticks next() const { return table_->next(object_); }
    void advance(Ticks to) const { table_->advance(object_, to); }
    void hear(const Transmission& t) const { table_->hear(object_, t); }
    void hear_character(const Character& c) const { table_->hear_character(object_, c); }
    void carrier(Ticks at) const { table_->carrier(object_, at); }
    bool take(Transmission& t) const { return table_->take(object_, t); }
    bool hears_all() const { return table_->hears_all(object_); }
    std::uint8_t address() const { return table_->address(object_); }
    void sent(Ticks at) const { table_->sent(object_, at); }
    const void* object() const { return object_; }

private:
    struct Table {
        Ticks (*next)(const void*);
        void (*advance)(void*, Ticks);
        void (*hear)(void*, const Transmission&);
        void (*hear_character)(void*, const Character&);
        void (*carrier)(void*, Ticks);
        bool (*take)(void*, Transmission&);
        bool (*hears_all)(const void*);
        std::uint8_t (*address)(const void*);
        void (*sent)(void*, Ticks);
    };

    template <class S>
    static constexpr Table kTable{
        [](const void* o) { return static_cast<const S*>(o)->next(); },
        [](void* o, Ticks t) { static_cast<S*>(o)->advance(t); },
        [](void* o, const Transmission& t) { static_cast<S*>(o)->hear(t); },
        [](void* o, const Character& c) { static_cast<S*>(o)->hear_character(c); },
        [](void* o, Ticks t) { static_cast<S*>(o)->carrier(t); },
        [](void* o, Transmission& t) { return static_cast<S*>(o)->take(t); },
        [](const void* o) { return static_cast<const S*>(o)->hears_all(); },
        [](const void* o) { return static_cast<const S*>(o)->address(); },
        [](void* o, Ticks t) {
            if constexpr (requires(S& s) { s.sent(t); }) static_cast<S*>(o)->sent(t);
        },
    };

    void* object_ = nullptr;
    const Table* table_ = nullptr;
};

}  // namespace dpchip::segment
