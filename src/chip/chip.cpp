// SPDX-License-Identifier: Apache-2.0
// Chip: the door to the blocks. Every entry leaves State::next right.
#include <dpchip/chip/chip.hpp>

#include <algorithm>

#include <dpchip/chip/control.hpp>
#include <dpchip/version.h>

namespace dpchip::chip {

namespace {

/// Registers, latches and machines after a hardware RESET; RAM, time and straps are the caller's business.
void reset_registers(State& s, const regmap::Traits& t, const regmap::Options& o) {
    s.timers.fill(core::kNever);
    s.user_clock_due = core::kNever;
    s.imr = 0xFFFF;
    s.mode2 = 0x01;
    s.wd_baud_control_val = t.baud_control_reset;
    s.min_tsdr = t.min_tsdr_reset;
    if (t.dis_start_reset && o.apc3_reset_dis_start) s.mode0 = regmap::mode0::dis_start_control;
    s.baud = fdl::BaudCode::not_found;
    s.probe = fdl::BaudCode::mbit_12;
    s.ts = s.next_ts = 0xFF;
    s.owner = s.master_add = dp::kNoMaster;
    s.din_sm = o.initial_din_sm;
    s.dout_sm = o.initial_dout_sm;
    s.dxbout_sm = o.initial_dxb_sm;
    s.diag_sm = o.initial_diag_sm;
    s.next = core::kNever;
}

void reset_ram(State& s, const State& before, regmap::RamAfterReset what) {
    switch (what) {
    case regmap::RamAfterReset::keep: s.ram = before.ram; break;
    case regmap::RamAfterReset::zero: break;
    case regmap::RamAfterReset::ones: s.ram.fill(0xFF); break;
    }
}

inline constexpr std::uint32_t kMagic = 0x50434844;  // the octets "DHCP"
inline constexpr std::size_t kHead = 8, kTail = 4;

/// A state that a running chip could be in: enumerators in range, buffer machines sound, counts inside their arrays.
bool plausible(const State& s) {
    const bool machines = BufferSm{s.din_sm}.valid() && BufferSm{s.dout_sm}.valid() && BufferSm{s.dxbout_sm}.valid();
    const bool states = s.dp_state <= DpState::data_exch && s.wd_state <= WdState::dp_control && s.rx_state <= RxState::frame &&
                        s.bus_mode <= BusMode::motorola && s.cs_state <= CsState::wait_cv && s.answer <= Answer::kept && s.last_answer <= Answer::kept;
    const bool rates = static_cast<std::size_t>(s.probe) < fdl::kBaudRates &&
                       (s.baud == fdl::BaudCode::not_found || static_cast<std::size_t>(s.baud) < fdl::kBaudRates);
    const bool counts = s.rx_count <= fdl::kMaxTelegram && s.tx_count <= fdl::kMaxTelegram && s.kept_count <= fdl::kMaxTelegram && s.prm_counter <= 2 && s.cfg_counter <= 2 &&
                        s.request_data_at + s.request_length <= fdl::kMaxTelegram && s.leave_after_answer <= 10 &&
                        s.xcts_hold <= transmitter::kHeldLater;
    const bool aux = s.aux_waiting[0] <= AuxUser::cfg && s.aux_waiting[1] <= AuxUser::cfg && s.prm_present <= AuxUser::cfg;
    bool times = s.now >= Ticks{} && s.user_clock_due >= Ticks{} && s.prescaler_origin >= Ticks{} && s.prescaler_origin <= s.now;
    for (const Ticks t : s.timers) times = times && t >= Ticks{};
    return machines && states && rates && counts && aux && times;
}

}  // namespace

template <class Trace>
Chip<Trace>::Chip(Variant variant, const Options& options, BusMode bus_mode)
    : c_{.s = {}, .traits = &regmap::traits(variant), .options = options, .edges = {}, .findings = {}, .ram_uses = {}, .ram_watched = false, .trace = {}} {
    c_.s.bus_mode = bus_mode;
    reset_registers(c_.s, *c_.traits, c_.options);
    if (options.ram_after_reset == regmap::RamAfterReset::ones) c_.s.ram.fill(0xFF);
}

template <class Trace>
void Chip<Trace>::reset() {
    const State before = c_.s;
    c_.s = State{};
    c_.s.now = before.now;
    c_.s.line_idle_since = before.line_idle_since;
    c_.s.bus_mode = before.bus_mode;
    c_.s.xcts_high = before.xcts_high;
    c_.s.watched_pins = before.watched_pins;
    reset_registers(c_.s, *c_.traits, c_.options);
    reset_ram(c_.s, before, c_.options.ram_after_reset);
    c_.fact(Fact::reset, 0);
    for (const Pin pin : {Pin::x_int, Pin::rts, Pin::xdataexch_sync})
        if (outputs::level(before, pin) != outputs::level(c_.s, pin) && core::bit(c_.s.watched_pins, core::to_underlying(pin)))
            c_.edges.push({c_.s.now, pin, outputs::level(c_.s, pin)});
}

template <class Trace>
void Chip<Trace>::advance(Ticks to) {
    DPCHIP_ASSERT(to >= c_.s.now);
    ms::run(c_, to);
}

template <class Trace>
std::uint8_t Chip<Trace>::read(std::uint16_t address) {
    const std::uint8_t value = control::read(c_, address);
    c_.s.next = ms::next(c_.s);
    return value;
}

template <class Trace>
void Chip<Trace>::write(std::uint16_t address, std::uint8_t value) {
    control::write(c_, address, value);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
std::uint8_t Chip<Trace>::peek(std::uint16_t address) const { return control::peek(c_, address); }

template <class Trace>
void Chip<Trace>::read_block(std::uint16_t address, std::span<std::uint8_t> out) {
    if (control::plain(c_, address, out.size())) {
        std::copy_n(c_.s.ram.begin() + address, out.size(), out.begin());
        return;
    }
    for (std::uint8_t& octet : out) octet = control::read(c_, address++);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::write_block(std::uint16_t address, std::span<const std::uint8_t> in) {
    if (control::plain(c_, address, in.size())) {
        std::copy_n(in.begin(), in.size(), c_.s.ram.begin() + address);
        return;
    }
    for (const std::uint8_t octet : in) control::write(c_, address++, octet);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::hear(const fdl::Transmission& t) {
    receiver::transmission(c_, t);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::hear_character(const fdl::Character& ch) {
    receiver::character(c_, ch);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::carrier(Ticks) {
    ms::carrier(c_);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
bool Chip<Trace>::take(fdl::Transmission& t) {
    if (c_.s.answer_ready == 0) return false;
    c_.s.answer_ready = 0;
    t.assign(c_.s.now, c_.s.answer_bit, {c_.s.tx.data(), c_.s.tx_count});
    return true;
}

template <class Trace>
void Chip<Trace>::sent(Ticks at) {
    transmitter::sent(c_.s, at);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::hold() {
    transmitter::hold(c_.s);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
void Chip<Trace>::line_low(Ticks until) { c_.s.line_idle_since = std::max(c_.s.line_idle_since, until); }

template <class Trace>
bool Chip<Trace>::hears_all() const {
    return c_.s.passive_idle != 0 && (c_.s.wd_state == WdState::baud_search || c_.s.rx_state == RxState::unsync);
}

template <class Trace>
std::uint8_t Chip<Trace>::address() const { return c_.s.passive_idle != 0 ? c_.s.ts : std::uint8_t{0xFF}; }

template <class Trace>
Level Chip<Trace>::level(Pin pin) const { return outputs::level(c_.s, pin); }

template <class Trace>
void Chip<Trace>::set_xcts(Level level) {
    c_.s.xcts_high = core::to_underlying(level);
    if (level == Level::low) transmitter::clear_to_send(c_);
    c_.s.next = ms::next(c_.s);
}

template <class Trace>
std::uint16_t Chip<Trace>::ram_bytes() const { return dpram::size(c_.s, *c_.traits); }

template <class Trace>
void Chip<Trace>::restore(const State& state) { c_.s = state; }

template <class Trace>
std::size_t Chip<Trace>::snapshot_size() {
    std::size_t size = kHead + kTail;
    State s{};
    describe(s, [&](std::string_view, auto& member) { size += 4 + sizeof member; });
    return size;
}

template <class Trace>
core::Result<std::size_t, core::ArchiveError> Chip<Trace>::save(std::span<std::uint8_t> out) const {
    if (out.size() < snapshot_size()) return core::ArchiveError::too_short;
    core::FieldWriter writer{out};
    writer.put(kMagic, 4);
    writer.put(DPCHIP_SNAPSHOT_VERSION, 2);
    writer.put(core::to_underlying(variant()), 2);
    describe(c_.s, writer);
    writer.put(core::crc32(out.first(writer.size)), 4);
    return writer.size;
}

template <class Trace>
core::ArchiveError Chip<Trace>::load(std::span<const std::uint8_t> in) {
    using core::ArchiveError;
    if (in.size() < snapshot_size()) return ArchiveError::too_short;
    in = in.first(snapshot_size());
    core::FieldReader reader{in};
    if (reader.get(4) != kMagic) return ArchiveError::magic;
    if (reader.get(2) != DPCHIP_SNAPSHOT_VERSION) return ArchiveError::version;
    if (reader.get(2) != core::to_underlying(variant())) return ArchiveError::variant;
    State s{};
    describe(s, reader);
    if (reader.error != ArchiveError::none) return reader.error;
    if (reader.get(4) != core::crc32(in.first(in.size() - kTail))) return ArchiveError::crc;
    if (!plausible(s)) return ArchiveError::invalid;
    s.next = ms::next(s);
    c_.s = s;
    return ArchiveError::none;
}

template class Chip<core::NoTrace>;
template class Chip<core::RingTrace>;

}  // namespace dpchip::chip
