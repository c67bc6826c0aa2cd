// SPDX-License-Identifier: Apache-2.0
// Lines of the C API: virtual time on "sim:", the wall clock on all others.
#include "line.hpp"

#include <algorithm>
#include <stdexcept>

#include <dpchip/live/open_line.hpp>
#include <dpchip/live/time_source.hpp>
#include <dpchip/segment/port.hpp>

#include "chip.hpp"
#include "error.hpp"
#include "line_waves.hpp"

namespace dpchip::capi {

namespace {

constexpr std::string_view kSim = "sim:";
constexpr std::uint32_t kSimBaud = 1'500'000, kLiveBaud = 19'200;

fdl::BaudCode rate(std::uint32_t baud, std::uint32_t otherwise) {
    const std::uint32_t wanted = baud == 0 ? otherwise : baud;
    if (const auto code = fdl::baud_from_bits_per_s(wanted)) return *code;
    throw std::invalid_argument{std::to_string(wanted) + " bit/s is none of the ten PROFIBUS rates (9600 .. 12000000)"};
}

class SimLine final : public Line {
public:
    explicit SimLine(fdl::BaudCode baud) : port_{baud} { port_index_ = *segment_.attach(port_, "test"); }

    segment::Segment& segment() override { return segment_; }
    Ticks now() const override { return segment_.now(); }
    bool is_virtual() const override { return true; }

    Ticks run(Ticks duration) override {
        const Ticks from = segment_.now();
        segment_.run_until([this] { return look(), x_int_rose(); }, duration);
        return segment_.now() - from;
    }
    void spend(Ticks duration) override {
        if (!drawn()) return segment_.run(duration);
        segment_.run_until([this] { return look(), false; }, duration);
    }

    int send(std::span<const std::uint8_t> octets) override {
        if (!port_.send(octets)) return fail(DPCHIP_E_STATE, "the octets before are still on their way");
        segment_.touch(port_index_);
        segment_.run_until([this] { return look(), !port_.sending(segment_.now()); }, core::kNever - segment_.now());
        segment_.settle();
        return DPCHIP_OK;
    }
    int receive(std::span<std::uint8_t> into, Ticks timeout) override {
        if (!segment_.run_until([this] { return look(), port_.pending(); }, timeout)) return 0;
        const auto t = port_.receive();
        std::copy_n(t.octets.begin(), std::min<std::size_t>(t.length, into.size()), into.begin());
        segment_.settle();
        return t.length;
    }
    int post(std::span<const std::uint8_t> octets, Ticks at) override {
        segment_.settle();
        const bool taken = at < Ticks{} ? port_.send(octets) : port_.send_at(std::max(at, segment_.now()), octets);
        if (!taken) return fail(DPCHIP_E_STATE, "the octets before are still on their way");
        segment_.touch(port_index_);
        return DPCHIP_OK;
    }
    segment::StationIndex outside() const override { return port_index_; }

private:
    segment::Segment segment_;
    segment::Port port_;
    segment::StationIndex port_index_{};
};

class WallLine final : public Line {
public:
    WallLine(std::string_view uri, fdl::BaudCode baud) : open_{uri, live::Role::serve, options(baud)} {}

    segment::Segment& segment() override { return open_.line().segment(); }
    Ticks now() const override { return open_.line_now(); }
    bool is_virtual() const override { return false; }
    std::string path() const override { return open_.place(); }
    std::int64_t epoch_ns() const override { return live::epoch_ns(now()); }
    segment::StationIndex port() const override { return open_.port_station(); }
    void stop() noexcept override { open_.line().stop(); }
    void spend(Ticks duration) override { open_.line().spend(duration); }

    Ticks run(Ticks duration) override {
        const Ticks passed = open_.line().run(duration, [this] { return x_int_rose(); });
        open_.line().resume();
        return passed;
    }
    int send(std::span<const std::uint8_t>) override { return only_sim(); }
    int receive(std::span<std::uint8_t>, Ticks) override { return only_sim(); }
    int post(std::span<const std::uint8_t>, Ticks) override { return only_sim(); }
    segment::StationIndex outside() const override { return port(); }

private:
    /// OpenLine with the const views that this class needs.
    struct Opened : live::OpenLine {
        using OpenLine::OpenLine;
        live::LiveLine& self() const { return const_cast<Opened*>(this)->line(); }
        Ticks line_now() const { return self().now(); }
        segment::StationIndex port_station() const { return self().port_station(); }
        std::string place() const { return const_cast<Opened*>(this)->port().place(); }
    };
    static live::LineOptions options(fdl::BaudCode baud) {
        live::LineOptions o;
        o.baud = baud;
        return o;
    }
    static int only_sim() { return fail(DPCHIP_E_STATE, "only a test on a sim: line plays the master; on this line the master is somebody else"); }

    Opened open_;
};

}  // namespace

Line::Line() = default;
Line::~Line() = default;

bool Line::x_int_rose() {
    bool rose = false;
    for (dpchip_chip* chip : chips) {
        chip->drain_edges();
        rose = rose || chip->x_int_rose;
    }
    return rose;
}

void Line::record(const std::string& file) {
    end_recording();
    auto r = std::make_unique<Recording>();
    r->file.open(file, std::ios::binary | std::ios::trunc);
    if (!r->file) throw std::runtime_error{"cannot write " + file};
    r->writer.emplace(r->file, "dpchip " DPCHIP_VERSION);
    live::Recorder::Options options;
    options.epoch_ns = epoch_ns();
    options.port = port();
    r->recorder.emplace(*r->writer, options);
    segment().observe(*r->recorder);
    recording_ = std::move(r);
}

void Line::end_recording() {
    if (recording_ == nullptr) return;
    segment().unobserve(&*recording_->recorder);
    recording_.reset();
}

// ---- what was on the line ----------------------------------------------------------------------------------------

void Line::Watch::keep(std::deque<dpchip_telegram>& in, const segment::Sighting& s) const {
    constexpr std::size_t kMaxTelegrams = 1024;
    if (in.size() == kMaxTelegrams) in.pop_front();
    dpchip_telegram& t = in.emplace_back();
    t.start_ticks = s.sent.start.n;
    t.end_ticks = s.sent.end().n;
    t.own = s.sender == line.outside() ? 1 : 0;
    t.damaged = s.sent.damaged ? 1 : 0;
    t.length = s.sent.length;
    std::ranges::copy(s.sent.bytes(), t.octets);
}

void Line::Watch::see(const segment::Sighting& s) { keep(telegrams, s); }

void Line::Watch::see_begin(const segment::Sighting& s) {
    const bool joined = std::ranges::any_of(line.joined_, [&](const Joined& j) { return j.index == s.sender; });
    if (beginnings && !joined) keep(begun, s);
}

void Line::watch(bool ends, bool beginnings) {
    if (!ends) {
        if (watch_ != nullptr) segment().unobserve(watch_.get());
        watch_.reset();
        return;
    }
    if (watch_ == nullptr) {
        watch_ = std::make_unique<Watch>(Watch{*this});
        segment().observe(*watch_);
    }
    watch_->beginnings = beginnings;
    if (!beginnings) watch_->begun.clear();
}

std::optional<dpchip_telegram> Line::oldest(std::deque<dpchip_telegram>& of) {
    if (of.empty()) return std::nullopt;
    const dpchip_telegram t = of.front();
    of.pop_front();
    return t;
}

std::optional<dpchip_telegram> Line::seen() { return watch_ == nullptr ? std::nullopt : oldest(watch_->telegrams); }

std::optional<dpchip_telegram> Line::begun() { return watch_ == nullptr ? std::nullopt : oldest(watch_->begun); }

std::unique_ptr<Line> open(std::string_view uri, std::uint32_t baud) {
    if (uri == kSim || uri == "sim") return std::make_unique<SimLine>(rate(baud, kSimBaud));
    return std::make_unique<WallLine>(uri, rate(baud, kLiveBaud));
}

}  // namespace dpchip::capi
