// SPDX-License-Identifier: Apache-2.0
// The naive slave: registers, time, receiver, watchdogs, start and stop (reference 1, 2.4, 4.1
// to 4.4, 4.8, 4.10, 4.11, 4.13).
#include "naive_slave.hpp"

#include <algorithm>

namespace oracle {

// clang-format off
const std::array<Kind, kKinds> kKind{{
    //name      4k     1.5k   release irr     readable mode2 mode3  mask  dxb    timer  ext53  dpv1   V     dis_start din  gc     preset cfg_aux1
    {"vpc3+",   false, false, 0x0, 0x3F1F, true,  true,  false, 0x07, false, true,  false, false, 0x10, false, false, false, false, false},
    {"vpc3+b",  true,  false, 0xB, 0xFFFF, true,  true,  true,  0xFF, true,  true,  true,  true,  0x10, false, false, false, false, true },
    {"vpc3+c",  true,  false, 0xC, 0xFFFF, true,  true,  true,  0xFF, true,  true,  true,  true,  0x10, false, false, false, false, false},
    {"apc3",    false, true,  0x0, 0x3F0F, false, false, false, 0x00, false, false, false, false, 0x1E, true,  true,  true,  true,  false},
    {"spc3",    false, true,  0x0, 0x3F0F, false, false, false, 0x00, false, false, false, false, 0x1E, true,  true,  true,  true,  false},
}};
// clang-format on

const char* name(Reply reply) {
    static constexpr const char* kNames[]{"none",          "SC",       "FDL OK",    "RR",      "RS",
                                          "Data_Exchange", "RD_Input", "RD_Output", "Get_Cfg", "Slave_Diag"};
    return kNames[static_cast<int>(reply)];
}

NaiveSlave::NaiveSlave(const Kind& k, bool mot) : kind{k}, motorola{mot}, ram(0x1000) {
    mode0 = kind.dis_start ? 1 : 0;
    mode2 = kind.mode_reg2 ? 1 : 0;
    baud_control_val = kind.baud_control_val;
}

// 4.8: registers to reset values, RAM kept, Offline, BAUD_SEARCH. Time goes on.
void NaiveSlave::reset() {
    NaiveSlave fresh{kind, motorola};
    fresh.now = fresh.prescaler_from = fresh.idle_from = fresh.rx_since = now;
    fresh.ram = ram;
    fresh.sent = sent;
    *this = fresh;
}

// ---- time -----------------------------------------------------------------------------------------------------------

Time NaiveSlave::next() const {
    Time t = std::min({probe_until, wd_until, user_clock_due, offline_at});
    for (const auto& [at, effect] : later) t = std::min(t, at);
    if (plan.active) t = std::min(t, !plan.composed ? plan.rts : !plan.begun ? plan.start : plan.end);
    if (inactive_until > now) t = std::min(t, inactive_until);
    return t;
}

void NaiveSlave::advance(Time to) {
    for (Time t = next(); t <= to; t = next()) step(t);
    now = to;
    update_pin();
}

// Everything due at `at`. Order inside one tick: what a telegram causes, the answer, the timers (architecture c.2).
void NaiveSlave::step(Time at) {
    now = at;
    if (!later.empty() && later.front().first == at) {
        const auto effect = later.front().second;
        later.erase(later.begin());
        effect(*this);
        update_pin();
        return;
    }
    if (plan.active && !plan.composed && plan.rts == at) {
        compose();
    } else if (plan.active && plan.composed && !plan.begun && plan.start == at) {
        plan.begun = true;
        sent.push_back({plan.start, plan.bit, plan.octets, plan.reply});
    } else if (plan.active && plan.begun && plan.end == at) {
        answer_over();
    } else if (probe_until == at) {  // 4.10: next rate, slowest is followed by fastest
        probe = (probe + 1) % 10;
        restart_probe();
    } else if (wd_until == at) {
        wd_until = kNever;
        if (wd == WdSm::dp_control) {  // 4.10: T_WD
            set_irr(1u << 3);
            leave_master();
        } else if (wd == WdSm::baud_control) {  // T_BC: DP_State unchanged
            start_search();
        }
    } else if (user_clock_due == at) {  // 4.4 bit 4
        set_irr(1u << 4);
        user_clock_due = at + ((mode0 & 0x400) != 0 ? 10 : 1) * kMs;
    } else if (offline_at == at) {
        execute_offline();
    }
    update_pin();
}

// 4.10: the n-th tick of a free-running prescaler after now.
Time NaiveSlave::prescaler(Time period, unsigned n) const {
    const Time done = (now - prescaler_from) / period;
    return prescaler_from + (done + static_cast<Time>(n)) * period;
}

void NaiveSlave::load_watchdog() {
    if (wd == WdSm::dp_control) {
        wd_until = prescaler(wd_base_1ms ? kMs : 10 * kMs, wd_f1 * wd_f2);
    } else if (wd == WdSm::baud_control) {
        const unsigned v = baud_control_val == 0 ? 1 : baud_control_val;
        wd_until = prescaler(10 * kMs, v * v);
    }
}

void NaiveSlave::start_search() {
    wd = WdSm::baud_search;
    baud = 15;
    wd_until = kNever;
    probe = 0;
    restart_probe();
}

void NaiveSlave::restart_probe() {
    const Time bits6000 = 6000 * kBitClk[probe] * kClk;
    probe_until = now + std::max(100 * kMs, bits6000);
    rx = unsync;
    rx_octets.clear();
    rx_since = now;
    idle_from = std::max(idle_from, now);
}

// ---- interrupts (4.4) -----------------------------------------------------------------------------------------------

void NaiveSlave::set_irr(unsigned bits) {
    bits &= kind.interrupts;
    if (irr_fresh_at != now) irr_fresh = 0;
    irr_fresh_at = now;
    irr_fresh |= bits;
    irr |= bits;
}

void NaiveSlave::update_pin() {
    if (!x_int_active && now >= inactive_until && (irr & ~imr & 0xFFFF) != 0) x_int_active = true;
}

void NaiveSlave::end_of_interrupt() {
    x_int_active = false;
    inactive_until = now + ((mode0 & 0x200) != 0 ? 48000 : 48) * kClk;
}

// ---- processor side (4.1 to 4.3) ------------------------------------------------------------------------------------

// Where an address of the processor ends up.
unsigned NaiveSlave::fold(unsigned address, bool user_access) {
    if (kind.one_and_a_half_k) {
        address &= 0x7FF;
        if (address >= 0x600) {  // 4.11
            address -= 0x400;
            if (user_access) {
                access_violation = true;
                want_offline();
            }
        }
    } else {
        address &= four_k() ? 0xFFFu : 0x7FFu;
    }
    if (motorola && (address <= 0x07 || address == 0x18 || address == 0x19)) address ^= 1;
    return address;
}

unsigned NaiveSlave::read(unsigned address) {
    address = fold(address, true);
    const unsigned value = address < 0x16 ? read_control(address) : ram[address];
    update_pin();
    return value;
}

void NaiveSlave::write(unsigned address, unsigned value) {
    address = fold(address, true);
    if (address < 0x16) write_control(address, value);
    else ram[address] = octet(value);
    update_pin();
}

unsigned NaiveSlave::peek(unsigned address) const {
    NaiveSlave other{*this};
    return other.read(address);
}

unsigned NaiveSlave::status_low() const {
    return static_cast<unsigned>(wd) << 6 | static_cast<unsigned>(dp) << 4 | (access_violation ? 8u : 0u) |
           (diag_flag ? 4u : 0u) | (online ? 1u : 0u);
}

unsigned NaiveSlave::read_control(unsigned address) {
    const unsigned ir = irr & ~imr & 0xFFFF;
    const auto sm = [](const Three& b) { return b.f << 6 | b.u << 4 | b.n << 2 | b.d; };
    switch (address) {
    case 0x00: return irr & 0xFF;
    case 0x01: return irr >> 8;
    case 0x02: return ir & 0xFF;
    case 0x03: return ir >> 8;
    case 0x04: return status_low();
    case 0x05: return kind.release << 4 | baud;
    case 0x06: return kind.mode_regs_readable ? mode0 & 0xFF : 0;
    case 0x07: return kind.mode_regs_readable ? mode0 >> 8 : 0;
    case 0x08: return sm(din);
    case 0x09: return new_din();
    case 0x0A: return sm(dout);
    case 0x0B: return next_dout();
    case 0x0C: return diag_owner[2] << 2 | diag_owner[1];
    case 0x0D: return new_diag();
    case 0x0E: return acknowledge(true, true);
    case 0x0F: return acknowledge(true, false);
    case 0x10: return acknowledge(false, true);
    case 0x11: return acknowledge(false, false);
    case 0x12: return kind.dxb ? 0xE1 : 0;  // no subscriber here: the machine rests
    case 0x13: return kind.dxb ? 2 : 0;
    case 0x14: ssa_busy = false; return 0;
    case 0x15: return kind.mode_regs_readable ? mode1 : 0;
    default: return 0;
    }
}

void NaiveSlave::write_control(unsigned address, unsigned value) {
    const auto low = [value](unsigned word) { return (word & 0xFF00) | value; };
    const auto high = [value](unsigned word) { return (word & 0x00FF) | value << 8; };
    const unsigned mode0_bits = kind.one_and_a_half_k ? 0x3BFF : kind.ext_prm ? 0x7FFF : 0x37FF;
    const unsigned protect = (1u << 6 | 1u << 10 | 1u << 11) | (irr_fresh_at == now ? irr_fresh : 0);
    switch (address) {
    case 0x00: irr |= value & kind.interrupts; break;
    case 0x01: irr |= value << 8 & kind.interrupts; break;
    case 0x02: irr &= ~(value & ~protect); break;
    case 0x03: irr &= ~(value << 8 & ~protect); break;
    case 0x04: imr = low(imr); break;
    case 0x05: imr = high(imr); break;
    case 0x06:
        if (online) break;
        if (kind.one_and_a_half_k && ((value ^ mode0) & 8) != 0) min_tsdr = (value & 8) != 0 ? 255 : 11;  // 3.4.4
        mode0 = low(mode0) & mode0_bits;
        break;
    case 0x07:
        if (!online) mode0 = high(mode0) & mode0_bits;
        break;
    case 0x08: set_mode1(value); break;
    case 0x09:
        mode1 &= ~(value & 0x3F);                     // every bit can be reset (manual 5.1.2); running goes on
        if ((value & 4) != 0 && !access_violation) {  // not executed yet: taken back
            offline_wanted = false;
            offline_at = kNever;
        }
        break;
    case 0x0A: baud_control_val = value; break;
    case 0x0B: min_tsdr = value; break;
    case 0x0C:
        if (!online && kind.mode_reg2) mode2 = value & kind.mode_reg2_mask;
        break;
    case 0x12:
        if (!online && kind.mode_reg3) mode3 = value & 3;
        break;
    default: break;
    }
}

// Mode-Reg 1-S (4.4).
void NaiveSlave::set_mode1(unsigned value) {
    mode1 |= value & 0x30;
    if ((value & 2) != 0) end_of_interrupt();
    if ((value & 8) != 0 && online && dp != DpSm::wait_prm) leave_master();
    if ((value & 4) != 0 && online) want_offline();
    if ((value & 1) != 0 && !online) start_chip();
}

// ---- start and stop (4.8) -------------------------------------------------------------------------------------------

void NaiveSlave::start_chip() {
    online = true;
    access_violation = false;
    mode1 = (mode1 & ~4u) | 1;
    prescaler_from = now;  // 4.8: the WD timer starts
    ts = cell(0x16);
    dp = DpSm::wait_prm;
    owner = -1;
    cfg_fault = not_supported = prm_fault = wd_on = false;
    prm_req = true;
    freeze_mode = sync_mode = d_pending = false;
    group_ident = gc_last_command = gc_last_group = 0;
    prm_counter = cfg_counter = 0;
    aux_waiting[0] = aux_waiting[1] = Waiting::none;
    cfg_okay = cfg_seen = din_given = ssa_busy = false;
    fcb_valid = false;
    user_wd = cell(0x18) | cell(0x19) << 8;
    din = dout = {3, 2, 0, 1};
    std::fill(std::begin(cleared), std::end(cleared), false);
    clear_dout();
    set_irr(1u << 13);
    diag_owner[1] = 1;
    diag_owner[2] = 2;
    diag_exchange_pending = diag_flag = false;
    diag_control = 0;
    if (kind.presets_gc_command) ram[0x3C] = 0;
    diag_reset_both();
    if (kind.user_timer) user_clock_due = prescaler(((mode0 & 0x400) != 0 ? 10 : 1) * kMs, 1);
    idle_from = now;
    start_search();
}

void NaiveSlave::want_offline() {
    if (!online) {  // there already: only MAC_Reset (4.11)
        if (offline_at == kNever) offline_at = now + kOfflineDelay;
        return;
    }
    mode1 |= 4;
    offline_wanted = true;
    if (!plan.active && !line_busy && later.empty()) offline_at = std::min(offline_at, now + kOfflineDelay);
}

void NaiveSlave::execute_offline() {
    if (!online) {
        offline_at = kNever;
        set_irr(1);
        return;
    }
    leave_master();
    offline_wanted = false;
    offline_at = kNever;
    online = false;
    mode1 &= ~5u;
    if (kind.one_and_a_half_k || (mode0 & 8) == 0) set_irr(1);
    wd = WdSm::baud_search;
    baud = 15;
    probe_until = wd_until = user_clock_due = kNever;
    ts = 255;
    later.clear();
    plan = {};
    rx = unsync;
}

// ---- receiver (1.4) -------------------------------------------------------------------------------------------------

void NaiveSlave::carrier(Time at) {
    line_busy = true;
    if (plan.active && !plan.begun && at < plan.start) {  // 4.13: the answer is given up
        const bool leave = plan.dx_error || plan.user_wd;
        if (plan.dx_error) cfg_fault = true;
        if (plan.new_address >= 0) take_address(plan.new_address);
        const bool locked = plan.composed && plan.reply == Reply::slave_diag;
        plan = {};
        if (locked)
            for (unsigned b : {1u, 2u})
                if (diag_owner[b] == 3) diag_owner[b] = 2;
        if (leave && dp == DpSm::data_exch) leave_master();
        if (offline_wanted) execute_offline();  // the message cycle has ended
        update_pin();
    }
}

bool NaiveSlave::hears_all() const {
    if (!online) return false;
    if (wd == WdSm::baud_search) return true;
    return rx == unsync && now - idle_from < 33 * bit();
}

void NaiveSlave::receiver_lost(Time idle) {
    rx = unsync;
    rx_octets.clear();
    idle_from = idle;
}

void NaiveSlave::hear(Time start, Time bit_time, const Octets& octets) {
    for (std::size_t i = 0; i < octets.size(); ++i)
        character({start + static_cast<Time>(i) * 11 * bit_time, bit_time, octets[i], false, false});
    line_over();
}

// The message cycle is over when nothing is heard and nothing is to be sent.
void NaiveSlave::line_over() {
    line_busy = false;
    if (offline_wanted && !plan.active) offline_at = std::min(offline_at, now + kClk);
}

// End of the last low bit of a character: start, d0..d7, parity (even), stop.
static Time last_low(const Char& c) {
    unsigned ones = 0;
    for (unsigned i = 0; i < 8; ++i) ones += (c.value >> i) & 1u;
    bool bits[11] = {false};
    for (unsigned i = 0; i < 8; ++i) bits[1 + i] = ((c.value >> i) & 1u) != 0;
    bits[9] = ((ones & 1) != 0) != c.bad_parity;
    bits[10] = !c.low_stop;
    Time last = 0;
    for (int i = 0; i < 11; ++i)
        if (!bits[i]) last = i + 1;
    return c.start + last * c.bit;
}

void NaiveSlave::hear_character(const Char& c) {
    character(c);
    if (rx != frame) line_over();
}

void NaiveSlave::character(const Char& c) {
    const Time end = c.start + 11 * c.bit;
    if (!online || end <= rx_since) return;
    if (rts() && c.start < std::max(rts_until, plan.end)) return;  // 1.5: own echo, everything while RTS
    if (c.bit != bit() || c.start < rx_since) return receiver_lost(last_low(c));
    if (c.start - idle_from >= 33 * c.bit) {
        rx = hunt;
        rx_octets.clear();
    }
    const bool dis_start = (mode0 & 1) != 0, dis_stop = (mode0 & 2) != 0;
    if (rx == unsync) return receiver_lost(last_low(c));
    if (rx == frame && !dis_start && std::abs(c.start - rx_end) > c.bit / 4) return receiver_lost(last_low(c));  // 1.3
    if (c.bad_parity || (c.low_stop && !dis_stop)) return receiver_lost(last_low(c));
    idle_from = last_low(c);
    rx_end = end;
    frame_octet(c);
}

void NaiveSlave::frame_octet(const Char& c) {
    rx = frame;
    rx_octets.push_back(c.value);
    const Octets& o = rx_octets;
    std::size_t size = 0;
    switch (o[0]) {
    case 0x10: size = 6; break;
    case 0xA2: size = 14; break;
    case 0xDC: size = 3; break;
    case 0xE5: size = 1; break;
    case 0x68:
        if (o.size() >= 2 && (o[1] < 4 || o[1] > 249)) return receiver_lost(idle_from);
        if (o.size() >= 3 && o[2] != o[1]) return receiver_lost(idle_from);
        if (o.size() >= 4 && o[3] != 0x68) return receiver_lost(idle_from);
        size = o.size() < 2 ? 256 : o[1] + 6u;
        break;
    default: return receiver_lost(idle_from);
    }
    if (o.size() < size) return;
    if (o[0] == 0xDC || o[0] == 0xE5) {
        rx = hunt;
        rx_octets.clear();
        return;
    }
    unsigned sum = 0;
    for (std::size_t i = o[0] == 0x68 ? 4 : 1; i + 2 < size; ++i) sum += o[i];
    if ((sum & 0xFF) != o[size - 2] || o[size - 1] != 0x16) return receiver_lost(idle_from);
    rx = hunt;
    telegram_complete();
    rx_octets.clear();
}

// 2.4: which telegrams are looked at. t0 is now.
void NaiveSlave::telegram_complete() {
    if (wd == WdSm::baud_search) {  // 2.6: proves the rate, is not answered
        after_a_clk([](NaiveSlave& s) {
            s.baud = s.probe;
            s.wd = WdSm::baud_control;
            s.probe_until = kNever;
            s.load_watchdog();
            s.set_irr(1u << 2);
        });
        return;
    }
    Request r;
    if (!take_apart(r)) return;
    request_arrived(r);
}

bool NaiveSlave::take_apart(Request& r) const {
    const Octets& o = rx_octets;
    const std::size_t head = o[0] == 0x68 ? 4 : 1;
    r.da = o[head] & 0x7Fu;
    r.sa = o[head + 1] & 0x7Fu;
    r.fc = o[head + 2];
    r.has_dsap = (o[head] & 0x80) != 0;
    r.has_ssap = (o[head + 1] & 0x80) != 0;
    r.sd1 = o[0] == 0x10;
    Octets unit(o.begin() + static_cast<std::ptrdiff_t>(head) + 3, o.end() - 2);
    if ((r.fc & 0x40) == 0) return false;  // a response
    if ((r.fc & 0x80) != 0) return false;  // CV has no receiver here; others: 9.3 number 24
    if (r.sa == 127) return false;
    if (r.da != ts && r.da != 127) return false;
    const std::size_t saps = (r.has_dsap ? 1u : 0u) + (r.has_ssap ? 1u : 0u);
    if (unit.size() < saps) return false;  // SD1 with EXT, or no room for the SAP octets
    std::size_t at = 0;
    r.dsap = r.has_dsap ? unit[at++] : 0;
    r.ssap = r.has_ssap ? unit[at++] : 0;
    r.data.assign(unit.begin() + static_cast<std::ptrdiff_t>(at), unit.end());
    return true;
}

}  // namespace oracle
