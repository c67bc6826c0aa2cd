// SPDX-License-Identifier: Apache-2.0
// Edges on their way from senders to receivers.
#include <dpchip/pins/bit_line.hpp>

#include <algorithm>

namespace dpchip::pins {

namespace {

/// splitmix64: the same numbers everywhere.
std::uint64_t next_random(std::uint64_t& state) {
    state += 0x9E37'79B9'7F4A'7C15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
    z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
    return z ^ (z >> 31);
}

}  // namespace

BitLine::Index BitLine::add(StationRef station, Ticks position) {
    if (count_ == kStations) return kNobody;
    Tap& tap = taps_[count_];
    tap.station = station;
    tap.position = position;
    for (std::size_t s = 0; s < count_; ++s) tap.seen[s] = taps_[s].sent;
    station.table->run(station.object, now_);
    return count_++;
}

bool BitLine::disturb(const Spike& spike) {
    if (spike.at < std::max(now_, last_spike_end_) || spike.length <= Ticks{} || spikes_.size() == spikes_.capacity()) return false;
    last_spike_end_ = spike.at + spike.length;
    spikes_.push(spike);
    if (!spike_waits_) {
        spike_ = spikes_.pop();
        spike_waits_ = true;
    }
    return true;
}

Ticks BitLine::delay(Index from, Index to) const {
    const Ticks d = taps_[to].position - taps_[from].position;
    return d < Ticks{} ? Ticks{} - d : d;
}

/// When an edge that is driven at `at` takes effect.
Ticks BitLine::distorted(Ticks at, bool low) {
    const Distortion& d = distortion_;
    const std::int64_t late = low ? std::max(-d.low_longer, 0) : std::max(d.low_longer, 0);
    std::int64_t jitter = 0;
    if (d.jitter != 0) jitter = static_cast<std::int64_t>(next_random(random_) % static_cast<std::uint64_t>(d.jitter * d.bit.n / 100 + 1));
    return at + Ticks{late * d.bit.n / 100 + jitter};
}

/// Did station `i` change what it drives? Then the edge sets out; one that overtakes the edge before it swallows both.
void BitLine::look(Index i) {
    Tap& tap = taps_[i];
    const bool low = tap.station.table->txd(tap.station.object) == PinLevel::low;
    if (low == tap.drives_low) return;
    tap.drives_low = low;
    if (low) {
        std::size_t others = 0;
        for (std::size_t s = 0; s < count_; ++s) others += s != i && taps_[s].drives_low ? 1u : 0u;
        if (others != 0) ++collisions_;
    }
    const Ticks at = distorted(now_, low);
    const bool waiting = tap.sent != 0 && tap.ways[(tap.sent - 1) % kWays].at >= at && tap.ways[(tap.sent - 1) % kWays].at > now_;
    if (waiting) {
        --tap.sent;
        return;
    }
    tap.ways[tap.sent++ % kWays] = {at, low};
    for (std::size_t r = 0; r < count_; ++r)
        if (tap.sent - taps_[r].seen[i] > kWays) {
            ++overruns_;
            ++taps_[r].seen[i];
        }
}

Ticks BitLine::next_arrival(Index i) const {
    Ticks next = core::kNever;
    for (std::size_t s = 0; s < count_; ++s) {
        const Tap& sender = taps_[s];
        const std::uint64_t n = taps_[i].seen[s];
        if (n < sender.sent) next = std::min(next, sender.ways[n % kWays].at + delay(s, i));
    }
    return next;
}

/// Edges of all senders that have come to station `i` by now.
void BitLine::arrive(Index i) {
    Tap& tap = taps_[i];
    for (std::size_t s = 0; s < count_; ++s) {
        const Tap& sender = taps_[s];
        const Ticks way = delay(s, i);
        for (std::uint64_t& n = tap.seen[s]; n < sender.sent && sender.ways[n % kWays].at + way <= now_; ++n) {
            const std::uint32_t bit = std::uint32_t{1} << s;
            tap.lows = sender.ways[n % kWays].low ? tap.lows | bit : tap.lows & ~bit;
        }
    }
    update(i);
}

void BitLine::update(Index i) {
    Tap& tap = taps_[i];
    const PinLevel forced = noise();
    const PinLevel level = forced != PinLevel::z ? forced : to_level(tap.lows == 0);
    if (level == tap.level) return;
    tap.level = level;
    tap.station.table->set_rxd(tap.station.object, now_, level);
}

PinLevel BitLine::noise() const { return spiking_ ? spike_.level : PinLevel::z; }
Ticks BitLine::next_noise() const {
    if (!spike_waits_) return core::kNever;
    return spiking_ ? spike_.at + spike_.length : spike_.at;
}

void BitLine::noise_due() {
    while (next_noise() <= now_) {
        if (spiking_) {
            spike_waits_ = !spikes_.empty();
            if (spike_waits_) spike_ = spikes_.pop();
        }
        spiking_ = !spiking_;
    }
}

Ticks BitLine::next() const {
    Ticks next = next_noise();
    for (std::size_t i = 0; i < count_; ++i) {
        const StationRef& s = taps_[i].station;
        next = std::min({next, s.table->next(s.object), next_arrival(i)});
    }
    return std::max(next, now_);
}

void BitLine::advance(Ticks to) {
    for (Ticks at = next(); at <= to && at != core::kNever; at = next()) {
        now_ = at;
        noise_due();
        for (std::size_t i = 0; i < count_; ++i) {
            const StationRef& s = taps_[i].station;
            if (s.table->next(s.object) <= now_) s.table->run(s.object, now_);
            look(i);
        }
        for (std::size_t i = 0; i < count_; ++i) arrive(i);
        for (std::size_t i = 0; i < count_; ++i) {
            const StationRef& s = taps_[i].station;
            if (s.table->next(s.object) <= now_) s.table->sample(s.object);
        }
    }
    if (to == core::kNever) return;
    now_ = to;
    for (std::size_t i = 0; i < count_; ++i) taps_[i].station.table->run(taps_[i].station.object, to);
}

}  // namespace dpchip::pins
