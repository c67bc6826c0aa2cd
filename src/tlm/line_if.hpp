// SPDX-License-Identifier: Apache-2.0
// The faces of a telegram-level line: a master's, that of the chips on it, and that of transceivers, whose stations have bits.
#pragma once

#include <cstdint>
#include <ostream>
#include <vector>

#include <systemc>

#include <dpchip/dpchip.h>
#include <dpchip/tlm/time.hpp>

namespace dpchip::tlm {

using Octets = std::vector<std::uint8_t>;

/// What was on the line, whoever sent it.
struct Telegram {
    Octets octets;           ///< as they arrived
    sc_core::sc_time start;  ///< first start bit
    sc_core::sc_time end;    ///< end of the last stop bit
    bool own = false;        ///< sent through a LineMasterIf
    bool damaged = false;    ///< a collision, or no telegram at all
};

/// Hexadecimal octets, as in "10 08 02 49 53 16".
std::ostream& operator<<(std::ostream& out, const Telegram& telegram);

/// For a DP master, or a test that plays one.
class LineMasterIf : public virtual sc_core::sc_interface {
public:
    /// Octets (1 to 255), a good telegram or not, at the earliest moment that the bus rules allow. False while
    /// others still wait for that.
    [[nodiscard]] virtual bool send(const Octets& octets) = 0;
    /// The same now, whatever the rules say.
    [[nodiscard]] virtual bool send_now(const Octets& octets) = 0;
    /// What send() was given has left the line.
    virtual const sc_core::sc_event& sent_event() const = 0;

    /// Takes the oldest telegram of a station; false when there is none. 64 are kept, newer ones push the oldest out.
    [[nodiscard]] virtual bool receive(Telegram& telegram) = 0;
    /// A station's telegram has ended.
    virtual const sc_core::sc_event& received_event() const = 0;

    /// Sends, then waits up to `timeout` for a station's telegram to end; forgets what came before. False: there was none.
    /// From an SC_THREAD only.
    [[nodiscard]] virtual bool exchange(const Octets& request, Telegram& answer, const sc_core::sc_time& timeout) = 0;
};

/// Told by the line that it has moved: edges may wait, the next event may be another one.
class LineStation {
public:
    virtual void line_moved() = 0;

protected:
    ~LineStation() = default;
};

/// For modules that have a dpchip_chip.
class LineChipIf : public virtual sc_core::sc_interface {
public:
    /// Puts a chip on the line, at the end of elaboration. Both must outlive the simulation.
    virtual void attach(dpchip_chip& chip, LineStation& station) = 0;
    /// Brings the line and all that is on it to `to`, if it is not there yet; touched() must follow.
    virtual void advance(Ticks to) = 0;
    /// The line has been moved or a chip accessed: what came of it is handed on, and what comes next is planned.
    virtual void touched() = 0;
};

/// Told by the line what others put on it, at the kernel's time.
class LineWire {
public:
    /// The telegram of a master or a chip begins, with that bit time in ticks. What a collision makes of it is not known.
    virtual void telegram_begins(const Octets& octets, Ticks start, Ticks bit) = 0;
    /// The wires of the other transceivers are at this level together; 1 is idle.
    virtual void others_drive(bool level) = 0;

protected:
    ~LineWire() = default;
};

/// For transceivers. One that has begun must end: meanwhile it collides with everybody.
class LineWireIf : public virtual sc_core::sc_interface {
public:
    /// Puts a station on the line that sends at `baud`, at the end of elaboration; returns its number.
    virtual int join(LineWire& wire, std::uint32_t baud) = 0;
    /// What the others with wires see from now on.
    virtual void drive(int station, bool level) = 0;
    /// It begins to send now; nobody knows what.
    virtual void begins(int station) = 0;
    /// What it has sent from tick `start` on has ended now. `faults`, sums of DPCHIP_FAULT_*, one for each octet.
    virtual void sent(int station, const Octets& octets, const Octets& faults, Ticks start) = 0;
};

}  // namespace dpchip::tlm
