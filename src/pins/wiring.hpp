// SPDX-License-Identifier: Apache-2.0
// A board's wiring as data: which line of the processor goes to which of the 44 pins, through an inverter or not, and what is
// tied to where (8.1.3 to 8.1.6, figure 8-2; hardware reference 1, 3, 11).
//
// The same table is checked, in words, and used: WiredLine moves the pins that a line of the board reaches. A line that is
// connected nowhere moves nothing, as on a board.
//
// Not modelled: values of resistors, levels in volts, loads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <dpchip/pins/package.hpp>

namespace dpchip::pins {

/// What is at the other end of a connection.
enum class FarEnd : std::uint8_t {
    drives,     ///< an output of the processor, or of anything else on the board
    listens,    ///< an input of it
    both,       ///< a line of the data bus
    vdd, gnd,   ///< the rail itself
    pull_up, pull_down,  ///< a resistor: gives way to whoever drives
};

/// One wire, or one resistor. Names must outlive the wiring.
struct Connection {
    std::string_view line;  ///< as processor or board call it; of a resistor: its value
    PinId pin{};
    FarEnd end{};
    bool inverted = false;
};

constexpr Connection from(std::string_view line, PinId pin) { return {line, pin, FarEnd::drives, false}; }
constexpr Connection from_inverted(std::string_view line, PinId pin) { return {line, pin, FarEnd::drives, true}; }
constexpr Connection to(std::string_view line, PinId pin) { return {line, pin, FarEnd::listens, false}; }
constexpr Connection to_inverted(std::string_view line, PinId pin) { return {line, pin, FarEnd::listens, true}; }
constexpr Connection both_ways(std::string_view line, PinId pin) { return {line, pin, FarEnd::both, false}; }
constexpr Connection on_vdd(PinId pin) { return {"VDD", pin, FarEnd::vdd, false}; }
constexpr Connection on_gnd(PinId pin) { return {"GND", pin, FarEnd::gnd, false}; }
constexpr Connection pull_up(std::string_view ohms, PinId pin) { return {ohms, pin, FarEnd::pull_up, false}; }
constexpr Connection pull_down(std::string_view ohms, PinId pin) { return {ohms, pin, FarEnd::pull_down, false}; }

enum class WiringRule : std::uint8_t {
    open_input,     ///< nothing gives the input a level
    two_drivers,    ///< two outputs of the board, or one and a rail, on one pin
    output_driven,  ///< the board drives a pin that the chip always drives
    outputs_tied,   ///< two outputs of the chip on one line
    no_pull_up,     ///< TXD
    data_bus,       ///< DB can only be read, only be driven, or is tied
    supply,         ///< a supply pin is not on its rail
    test_pin,       ///< XTEST0 or XTEST1 is low
    strap,          ///< XINT/MOT, MODE or DIVIDER hangs on a line
    unused_pin,     ///< without function in this mode, and on the wrong rail
};

struct WiringFault {
    WiringRule rule{};
    PinId pin{}, other{};                ///< other: of outputs_tied
    std::string_view line, other_line;   ///< where they say something
    bool operator==(const WiringFault&) const = default;
};

/// Words in a place of their own; what does not fit is cut off.
class WiringText {
public:
    operator std::string_view() const { return {text_.data(), length_}; }
    WiringText& operator+=(std::string_view words);
    WiringText& operator+=(unsigned number);

private:
    std::array<char, 256> text_{};
    std::size_t length_ = 0;
};
/// The fault in a sentence with pin number, name and section.
WiringText text(const WiringFault& fault, Variant variant = Variant::vpc3c);

/// What check() has found, by pin number.
class WiringFaults {
public:
    const WiringFault* begin() const { return faults_.data(); }
    const WiringFault* end() const { return faults_.data() + count_; }
    std::size_t size() const { return count_; }
    bool empty() const { return count_ == 0; }

private:
    friend class Wiring;
    void push(const WiringFault& fault) {
        if (count_ < faults_.size()) faults_[count_++] = fault;
    }
    void sort();
    std::array<WiringFault, 4 * kPins> faults_{};  ///< more are not told
    std::size_t count_ = 0;
};

/// A line of the board as the package sees it: the pins at its end.
class WiredLine {
public:
    bool connected() const { return count_ != 0; }
    std::size_t pins() const { return count_; }

    /// The board drives the line, or lets go of it.
    template <class Trace>
    void drive(Package<Trace>& package, PinLevel level) const {
        for (std::size_t i = 0; i < count_; ++i) package.set_pin(ends_[i].pin, seen(ends_[i], level));
    }
    /// What the board reads on it; Z when there is nothing.
    template <class Trace>
    PinLevel level(const Package<Trace>& package) const {
        return count_ == 0 ? PinLevel::z : seen(ends_[0], package.pin(ends_[0].pin));
    }

private:
    friend class Wiring;
    struct End {
        PinId pin{};
        bool inverted = false;
    };
    static PinLevel seen(const End& end, PinLevel level) {
        return !end.inverted || level == PinLevel::z ? level : to_level(level == PinLevel::low);
    }
    std::array<End, kPins> ends_{};
    std::size_t count_ = 0;
};

class Wiring {
public:
    /// So many wires and resistors it holds; more are a mistake of the program.
    static constexpr std::size_t kConnections = 4 * kPins;

    Wiring() = default;
    explicit Wiring(std::span<const Connection> connections) { add(connections); }

    Wiring& add(std::span<const Connection> connections);
    Wiring& add(const Connection& connection) { return add(std::span{&connection, 1}); }
    /// Takes everything off a pin.
    Wiring& cut(PinId pin);
    std::span<const Connection> connections() const { return {connections_.data(), count_}; }

    /// Everything that is wrong, by pin number. `with_4k`: the chip's 4 KB are used, so that AB11 has a pin.
    WiringFaults check(bool with_4k = false) const;
    /// The mode that the straps select; nothing when they hang on lines or nowhere.
    std::optional<ProcessorMode> mode() const;

    /// The ends of a line.
    WiredLine line(std::string_view name) const;
    /// The level that rails and resistors give a pin on which no line drives.
    std::optional<PinLevel> tied(PinId pin) const;
    /// Gives straps and unused pins their levels and lets open inputs go. Before RESET ends.
    template <class Trace>
    void tie(Package<Trace>& package) const {
        for (const PinInfo& p : kPinTable) {
            if (!is_input(p.id)) continue;
            if (const auto level = tied(p.id)) package.set_pin(p.id, *level);
            else if (!has_driver(p.id)) package.set_pin(p.id, PinLevel::z);
        }
        PackageOptions options = package.options();
        options.txd_pull_up = has(PinId::txd, FarEnd::pull_up);
        package.set_options(options);
    }

private:
    bool has(PinId pin, FarEnd end) const;
    bool has_driver(PinId pin) const { return has(pin, FarEnd::drives) || has(pin, FarEnd::both); }
    void check_supply(const PinInfo& pin, WiringFaults& faults) const;
    void check_input(const PinInfo& pin, WiringFaults& faults) const;
    void check_output(const PinInfo& pin, WiringFaults& faults) const;
    void check_data(const PinInfo& pin, WiringFaults& faults) const;
    void check_unused(bool with_4k, WiringFaults& faults) const;

    std::array<Connection, kConnections> connections_{};
    std::size_t count_ = 0;
};

}  // namespace dpchip::pins
