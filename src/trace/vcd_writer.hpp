// SPDX-License-Identifier: Apache-2.0
// VCD: waveforms that GTKWave, Surfer, PulseView and sigrok open (IEEE 1364, value change dump).
//
// Signals are declared first, in scopes; then come changes in order of time. Times are absolute: every time stamp is
// rounded from its own ticks, none is a sum. Values are bits (0, 1, x, z), vectors up to 64 bits, and names, which are
// written as GTKWave's strings. Unchanged values are not written.
//
// Not written: real numbers, the extended dump of ports (EVCD).
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/core/ticks.hpp>

namespace dpchip::trace {

using core::Ticks;

/// The unit of time stamps.
struct VcdTimescale {
    std::int64_t femtoseconds = 1'000;  ///< 1 ps; 1, 10 or 100 times a power of 1000

    /// `at` in these units, rounded to the nearest.
    std::int64_t units(Ticks at) const;
    /// "1 ps", as a file has it.
    std::string text() const;
};
/// "1ps", "10 ns", "100us": a number of 1, 10, 100 and s, ms, us, ns, ps or fs. Nothing for anything else.
std::optional<VcdTimescale> parse_timescale(std::string_view text);

struct VcdOptions {
    VcdTimescale timescale{};
    Ticks from{};                ///< what was before stands as the first values of the dump
    Ticks to = core::kNever;     ///< what comes later is left out
    std::string_view comment{};  ///< for the header
};

class VcdWriter {
public:
    /// A signal; kOff stands for one that nobody wants and is legal in every call.
    using Signal = std::uint32_t;
    static constexpr Signal kOff = 0xFFFF'FFFF;

    /// `out` must outlive the writer. Nothing is written before the first change or finish().
    explicit VcdWriter(std::ostream& out, const VcdOptions& options = {});
    ~VcdWriter() { finish(now_); }
    VcdWriter(const VcdWriter&) = delete;
    VcdWriter& operator=(const VcdWriter&) = delete;

    // ---- declarations, before the first change --------------------------------------------------------------------
    /// A bit; `scope` is a path with dots. What is no letter, digit or underscore becomes an underscore, / included.
    Signal bit(std::string_view scope, std::string_view name, char initial = 'x');
    /// `width` bits, 1 .. 64.
    Signal vector(std::string_view scope, std::string_view name, unsigned width);
    /// A value with a name: states of a machine.
    Signal text(std::string_view scope, std::string_view name);
    std::size_t signals() const { return signals_.size(); }

    // ---- changes, in order of time; one that comes late is written at the time of the last one and counted ---------
    void set(Ticks at, Signal signal, char level);          ///< 0, 1, x or z
    void set_value(Ticks at, Signal signal, std::uint64_t value);
    void set_text(Ticks at, Signal signal, std::string_view value);  ///< blanks become underscores
    void unknown(Ticks at, Signal signal);                  ///< x, or the text "?"

    /// Writes what is left and the time `at` (or the end of the window); nothing may follow. Safe to call twice.
    void finish(Ticks at);
    std::uint64_t changes() const { return changes_; }
    std::uint64_t late() const { return late_; }
    /// False when the stream has failed.
    bool good() const;

private:
    enum class Kind : std::uint8_t { bit, vector, text };
    struct Declared {
        std::string scope, name, id;
        Kind kind{};
        unsigned width = 1;
        std::uint64_t value = 0;
        std::string words;       ///< text, as it was given
        char level = 'x';        ///< bit; vector: 'x' while unknown, else '1'
    };

    Signal declare(std::string_view scope, std::string_view name, Kind kind, unsigned width, char initial);
    /// True when a change at `at` is to be written; the time stamp is out then.
    bool stamp(Ticks at);
    void header();
    void put(const Declared& d);
    void put(std::string_view octets);
    void put_stamp(std::int64_t units);
    /// Makes room for so many octets.
    void room(std::size_t octets);
    void flush();

    std::ostream& out_;
    VcdOptions options_;
    std::string comment_;
    std::vector<Declared> signals_;
    std::string buffer_;         ///< of a fixed size, filled up to used_
    std::size_t used_ = 0;
    bool begun_ = false, finished_ = false;
    Ticks now_{};
    std::int64_t stamp_ = -1;
    std::uint64_t changes_ = 0, late_ = 0;
};

}  // namespace dpchip::trace
