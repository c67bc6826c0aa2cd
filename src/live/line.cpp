// SPDX-License-Identifier: Apache-2.0
// Moving octets between a port and a segment, in time.
#include <algorithm>

#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/live/line.hpp>

namespace dpchip::live {
namespace {

using namespace core::literals;

constexpr Ticks kSlotTimeWithoutBits = 200_ms;
/// Silence that ends an unfinished telegram. A USB adapter hands over what it has every 16 ms unless told otherwise.
constexpr Ticks kGiveUp = 50_ms, kGiveUpSerial = 20_ms;
/// Nothing to do: look again after this time, so that a clock that jumps cannot hang a run.
constexpr Ticks kLongest = 1_s;

}  // namespace

LiveLine::LiveLine(Port& port, const TimeSource& time, const LineOptions& options)
    : port_{port}, time_{time}, origin_{time.now()}, pace_{options.pace}, baud_{options.baud},
      wanted_slot_time_{options.slot_time}, reception_{std::make_unique<Reception>()} {
    apply_baud(options.baud);
    const auto attached = segment_.attach(tap_, "port");
    port_station_ = attached ? *attached : segment::kNobody;
    segment_.observe(outbox_);
}

LiveLine::~LiveLine() = default;

/// Bit time, slot time and decoders for a rate.
void LiveLine::apply_baud(fdl::BaudCode baud) {
    baud_ = baud;
    bit_ = fdl::baud(baud).bit;
    const Ticks profile = timed() ? bit_ * fdl::bus_times(baud).tsl : kSlotTimeWithoutBits;
    slot_time_ = wanted_slot_time_.value_or(profile);
    const Ticks give_up = std::max(timed() ? kGiveUpSerial : kGiveUp, bit_ * fdl::kTsynBits);
    decoders_.assign(Port::kMaxSources, StreamDecoder{give_up, bit_ * fdl::kTsynBits});
}

Ticks LiveLine::now() const { return std::max(wall(), segment_.now()); }

void LiveLine::stop() noexcept {
    stop_ = true;
    port_.wake();
}

Ticks LiveLine::run(Ticks duration, const std::function<bool()>& enough) {
    const Ticks begin = time_.now(), end = begin + duration;
    for (;;) {
        step();
        const Ticks now = time_.now();
        if (stop_ || (enough && enough()) || now >= end) return now - begin;
        const Ticks pause = std::min({next_event() - wall(), end - now, kLongest});
        if (pause > Ticks{}) port_.wait(pause);
    }
}

void LiveLine::spend(Ticks duration) {
    const Ticks to = segment_.now() + duration;
    advance(to);
    write_due();
}

/// Everything that is due: input first, then the stations, then output.
void LiveLine::step() {
    listen();
    advance(wall());
    write_due();
    if (!follow_) return;
    const fdl::BaudCode wanted = follow_();
    if (wanted == baud_ || wanted == fdl::BaudCode::not_found) return;
    deaf_ = !port_.set_baud(wanted);
    apply_baud(wanted);
}

/// The next line time at which there is something to do without input.
Ticks LiveLine::next_event() {
    Ticks next = segment_.next();
    for (const StreamDecoder& decoder : decoders_) next = std::min(next, decoder.deadline());
    for (const Outgoing& out : outgoing_) next = std::min(next, out.due);
    return next;
}

// ---- out ---------------------------------------------------------------------------------------------------------

/// A station begins to send.
void LiveLine::begun(const segment::Sighting& s) {
    if (s.sender == port_station_ || s.sender == segment::kNobody) return;
    const bool paced = !timed() && pace_ == Pace::wire;
    outgoing_.push_back({s.sent, s.sender, paced ? s.sent.end() : s.sent.start});
}

/// Moves the segment event by event, so that what begins is written before anything else happens.
void LiveLine::advance(Ticks to) {
    for (Ticks at = segment_.next(); at <= to; at = segment_.next()) {
        segment_.advance(at);
        write_due();
    }
    if (to > segment_.now()) segment_.advance(to);
}

void LiveLine::write_due() {
    while (!outgoing_.empty() && outgoing_.front().due <= wall()) {
        const Outgoing out = outgoing_.front();
        outgoing_.erase(outgoing_.begin());
        write(out);
    }
}

void LiveLine::write(const Outgoing& out) {
    const auto telegram = fdl::decode(out.sent.bytes());
    const bool request = telegram && telegram->has_fc() && telegram->fc.is_request();
    const bool answer = telegram && !request && telegram->sd != fdl::kSd4 && request_end_;
    // How late it leaves, its own length on a wire apart.
    const Ticks late = answer ? wall() - out.due + (out.sent.start - *request_end_) : Ticks{};
    if (late > slot_time_) ++counters_.late;
    else if (port_.send(out.sent.bytes())) ++counters_.sent;
    else ++counters_.unsent;
    request_end_.reset();
    if (!timed()) segment_.finish(out.sender);
    busy_until_ = std::max(busy_until_, timed() ? out.sent.end() : segment_.now());
}

// ---- in ----------------------------------------------------------------------------------------------------------

void LiveLine::listen() {
    while (port_.receive(*reception_)) {
        const Ticks at = wall();
        if (deaf_) continue;
        const std::size_t source = reception_->source < decoders_.size() ? reception_->source : 0;
        std::span<const std::uint8_t> octets = reception_->bytes(), faults = reception_->damage();
        while (!octets.empty()) {
            const std::size_t taken = decoders_[source].feed(octets, faults, at);
            octets = octets.subspan(taken);
            faults = faults.subspan(taken);
            drain(source, at);
        }
    }
    const Ticks now = wall();
    for (std::size_t source = 0; source < decoders_.size(); ++source) drain(source, now);
}

void LiveLine::drain(std::size_t source, Ticks now) {
    while (const auto piece = decoders_[source].next(now))
        if (piece->good) hear(*piece, source);
        else hear_damage(*piece);
}

void LiveLine::hear(const Piece& piece, std::size_t source) {
    ++counters_.heard;
    port_.relay(piece.octets, source);
    // Two telegrams of one read: the second must not hide what the first one causes.
    Ticks end = std::max(piece.end, segment_.now());
    if (busy_until_ >= end) end = busy_until_ + bit_;
    inject(piece.octets, {}, end);
    busy_until_ = end;
    request_end_ = end;
}

/// Damage comes as characters back to back, the last of them when it was read.
void LiveLine::hear_damage(const Piece& piece) {
    ++counters_.damaged;
    counters_.damaged_octets += piece.octets.size();
    for (std::size_t at = 0; at < piece.octets.size(); at += fdl::kMaxTelegram) {
        const std::size_t n = std::min(fdl::kMaxTelegram, piece.octets.size() - at);
        const std::size_t behind = piece.octets.size() - at - n;
        inject(piece.octets.subspan(at, n), piece.faults.subspan(at, n),
               piece.end - bit_ * (fdl::kCharacterBits * static_cast<std::int64_t>(behind)));
    }
}

/// Something that came through the port ended at `end`. Stations are at max(end, now) when they hear it.
void LiveLine::inject(std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults, Ticks end) {
    if (end > segment_.now()) advance(end);
    fdl::Transmission t;
    t.assign({}, bit_, octets);
    t.start = end - bit_ * (fdl::kCharacterBits * static_cast<std::int64_t>(octets.size()));
    const auto telegram = fdl::decode(t.bytes());
    t.damaged = !telegram || telegram->size != octets.size() || !faults.empty();
    t.synchronised = !timed();
    std::fill_n(t.faults.begin(), t.length, std::uint8_t{fdl::fault_none});
    std::copy(faults.begin(), faults.end(), t.faults.begin());
    segment_.inject(port_station_, t);
    write_due();
}

}  // namespace dpchip::live
