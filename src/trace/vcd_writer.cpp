// SPDX-License-Identifier: Apache-2.0
// Writing waveforms: header, value changes, a buffer of its own.
#include <dpchip/trace/vcd_writer.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <ostream>

#include <dpchip/core/assert.hpp>
#include <dpchip/version.h>

namespace dpchip::trace {
namespace {

constexpr std::size_t kBuffer = 1 << 16;
constexpr std::array<std::string_view, 6> kUnits{"fs", "ps", "ns", "us", "ms", "s"};

/// One more or less printable octet after the other: !, ", .. ~, then two of them.
std::string id_of(std::size_t n) {
    std::string id;
    do {
        id += static_cast<char>('!' + n % 94);
        n /= 94;
    } while (n != 0);
    return id;
}

std::string identifier(std::string_view name) {
    std::string out{name};
    for (char& c : out) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        if (!plain) c = '_';
    }
    return out.empty() ? "_" : out;
}

std::vector<std::string_view> parts(std::string_view path) {
    std::vector<std::string_view> out;
    while (!path.empty()) {
        const std::size_t dot = std::min(path.find('.'), path.size());
        out.push_back(path.substr(0, dot));
        path.remove_prefix(std::min(dot + 1, path.size()));
    }
    return out;
}

}  // namespace

std::int64_t VcdTimescale::units(Ticks at) const {
    __extension__ using Wide = __int128;
    // A tick is 50000/3 fs. Nearly twenty minutes of these fit into 64 bits.
    if (at.n >= 0 && at.n < (std::int64_t{1} << 46) && femtoseconds < (std::int64_t{1} << 40))
        return (at.n * 100'000 + femtoseconds * 3) / (femtoseconds * 6);
    const Wide twice = static_cast<Wide>(at.n) * 100'000 + static_cast<Wide>(femtoseconds) * 3;
    return static_cast<std::int64_t>(twice / (static_cast<Wide>(femtoseconds) * 6));
}

std::string VcdTimescale::text() const {
    std::int64_t rest = femtoseconds;
    std::size_t unit = 0;
    while (rest >= 1'000 && unit + 1 < kUnits.size()) {
        rest /= 1'000;
        ++unit;
    }
    return std::to_string(rest) + ' ' + std::string{kUnits[unit]};
}

std::optional<VcdTimescale> parse_timescale(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || (number != 1 && number != 10 && number != 100)) return std::nullopt;
    std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    std::int64_t femtoseconds = number;
    for (const std::string_view known : kUnits) {
        if (known == unit) return VcdTimescale{femtoseconds};
        femtoseconds *= 1'000;
    }
    return std::nullopt;
}

VcdWriter::VcdWriter(std::ostream& out, const VcdOptions& options) : out_{out}, options_{options}, comment_{options.comment} {
    buffer_.resize(kBuffer);
}

VcdWriter::Signal VcdWriter::declare(std::string_view scope, std::string_view name, Kind kind, unsigned width, char initial) {
    DPCHIP_ASSERT(!begun_);
    signals_.push_back({std::string{scope}, identifier(name), id_of(signals_.size()), kind, width, 0, "?", initial});
    return static_cast<Signal>(signals_.size() - 1);
}
VcdWriter::Signal VcdWriter::bit(std::string_view scope, std::string_view name, char initial) { return declare(scope, name, Kind::bit, 1, initial); }
VcdWriter::Signal VcdWriter::vector(std::string_view scope, std::string_view name, unsigned width) {
    return declare(scope, name, Kind::vector, std::clamp(width, 1u, 64u), 'x');
}
VcdWriter::Signal VcdWriter::text(std::string_view scope, std::string_view name) { return declare(scope, name, Kind::text, 1, 'x'); }

void VcdWriter::room(std::size_t octets) {
    if (buffer_.size() - used_ >= octets) return;
    flush();
    if (buffer_.size() < octets) buffer_.resize(octets);
}

void VcdWriter::put(std::string_view octets) {
    room(octets.size());
    std::memcpy(buffer_.data() + used_, octets.data(), octets.size());
    used_ += octets.size();
}

void VcdWriter::put_stamp(std::int64_t units) {
    stamp_ = units;
    std::array<char, 24> digits;
    char* at = digits.data() + digits.size();
    *--at = '\n';
    auto rest = static_cast<std::uint64_t>(units);
    do {
        *--at = static_cast<char>('0' + rest % 10);
        rest /= 10;
    } while (rest != 0);
    *--at = '#';
    put({at, static_cast<std::size_t>(digits.data() + digits.size() - at)});
}

void VcdWriter::put(const Declared& d) {
    room(80 + d.words.size() + d.id.size());
    char* at = buffer_.data() + used_;
    switch (d.kind) {
    case Kind::bit: *at++ = d.level; break;
    case Kind::vector:
        *at++ = 'b';
        if (d.level == 'x') *at++ = 'x';
        else
            for (unsigned n = d.width; n-- > 0;) *at++ = static_cast<char>('0' + ((d.value >> n) & 1));
        *at++ = ' ';
        break;
    case Kind::text:
        *at++ = 's';
        at = std::replace_copy(d.words.begin(), d.words.end(), at, ' ', '_');
        *at++ = ' ';
        break;
    }
    at = std::copy(d.id.begin(), d.id.end(), at);
    *at++ = '\n';
    used_ = static_cast<std::size_t>(at - buffer_.data());
}

/// Scopes open and close so that each path stands once where its signals were declared together.
void VcdWriter::header() {
    begun_ = true;
    put("$version dpchip " DPCHIP_VERSION " $end\n");
    if (!comment_.empty()) {
        put("$comment ");
        put(comment_);
        put(" $end\n");
    }
    put("$timescale ");
    put(options_.timescale.text());
    put(" $end\n");
    std::vector<std::string_view> open;
    for (const Declared& d : signals_) {
        const std::vector<std::string_view> path = parts(d.scope);
        std::size_t same = 0;
        while (same < std::min(open.size(), path.size()) && open[same] == path[same]) ++same;
        for (std::size_t n = open.size(); n > same; --n) put("$upscope $end\n");
        for (std::size_t n = same; n < path.size(); ++n) put("$scope module " + identifier(path[n]) + " $end\n");
        open = path;
        const char* type = d.kind == Kind::bit ? "wire" : d.kind == Kind::vector ? "reg" : "string";
        put("$var " + std::string{type} + ' ' + std::to_string(d.width) + ' ' + d.id + ' ' + d.name + " $end\n");
    }
    for (std::size_t n = open.size(); n > 0; --n) put("$upscope $end\n");
    put("$enddefinitions $end\n");
    put_stamp(options_.timescale.units(options_.from));
    put("$dumpvars\n");
    for (const Declared& d : signals_) put(d);
    put("$end\n");
}

bool VcdWriter::stamp(Ticks at) {
    if (at < now_) {
        ++late_;
        at = now_;
    }
    now_ = at;
    if (at <= options_.from || finished_) return false;
    if (!begun_) header();
    if (at > options_.to) return false;
    const std::int64_t units = options_.timescale.units(at);
    if (units > stamp_) put_stamp(units);
    ++changes_;
    return true;
}

void VcdWriter::set(Ticks at, Signal signal, char level) {
    if (signal >= signals_.size() || signals_[signal].level == level) return;
    const bool write = stamp(at);
    signals_[signal].level = level;
    if (write) put(signals_[signal]);
}

void VcdWriter::set_value(Ticks at, Signal signal, std::uint64_t value) {
    if (signal >= signals_.size()) return;
    Declared& d = signals_[signal];
    if (d.value == value && d.level != 'x') return;
    const bool write = stamp(at);
    d.value = value;
    d.level = '1';
    if (write) put(d);
}

void VcdWriter::set_text(Ticks at, Signal signal, std::string_view value) {
    if (value.empty()) value = "?";
    if (signal >= signals_.size() || signals_[signal].words == value) return;
    const bool write = stamp(at);
    Declared& d = signals_[signal];
    d.words = value;
    if (write) put(d);
}

void VcdWriter::unknown(Ticks at, Signal signal) {
    if (signal >= signals_.size()) return;
    if (signals_[signal].kind == Kind::text) set_text(at, signal, "?");
    else set(at, signal, 'x');
}

void VcdWriter::finish(Ticks at) {
    if (finished_) return;
    if (!begun_) header();
    const std::int64_t end = options_.timescale.units(std::min(std::max(at, now_), options_.to));
    if (end > stamp_) put_stamp(end);
    finished_ = true;
    flush();
    out_.flush();
}

void VcdWriter::flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(used_));
    used_ = 0;
}

bool VcdWriter::good() const { return out_.good(); }

}  // namespace dpchip::trace
