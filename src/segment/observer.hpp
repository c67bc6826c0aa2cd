// SPDX-License-Identifier: Apache-2.0
// Whoever looks at a segment without being a station on it: traces, monitors, the judge.
#pragma once

#include <concepts>

#include <dpchip/fdl/transmission.hpp>
#include <dpchip/segment/station_set.hpp>

namespace dpchip::segment {

/// Something that was on the line, with the line's own times.
struct Sighting {
    const fdl::Transmission& sent;  ///< as it arrived: damage and garbled octets included
    StationIndex sender = kNobody;  ///< kNobody: noise
};

template <class O>
concept Observer = requires(O& o, const Sighting& s) {
    /// A transmission has just ended, before any station hears it. Must not touch the segment.
    { o.see(s) } -> std::same_as<void>;
};

/// An observer may also want to know of a transmission when it begins; damage is not known yet.
template <class O>
concept EarlyObserver = Observer<O> && requires(O& o, const Sighting& s) {
    { o.see_begin(s) } -> std::same_as<void>;
};

/// A non-owning reference to an observer of any type.
class ObserverRef {
public:
    ObserverRef() = default;

    template <Observer O>
    explicit ObserverRef(O& observer)
        : object_{&observer}, see_{[](void* o, const Sighting& s) { static_cast<O*>(o)->see(s); }} {
        if constexpr (EarlyObserver<O>)
            see_begin_ = [](void* o, const Sighting& s) { static_cast<O*>(o)->see_begin(s); };
    }

    void see(const Sighting& s) const { see_(object_, s); }
    void see_begin(const Sighting& s) const {
        if (see_begin_ != nullptr) see_begin_(object_, s);
    }
    const void* object() const { return object_; }

private:
    void* object_ = nullptr;
    void (*see_)(void*, const Sighting&) = nullptr;
    void (*see_begin_)(void*, const Sighting&) = nullptr;
};

}  // namespace dpchip::segment
