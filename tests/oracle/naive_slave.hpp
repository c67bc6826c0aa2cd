// SPDX-License-Identifier: Apache-2.0
// A second DP slave, written naively from the engineering reference: slow, obvious, never optimised. It shares no code
// and no idea with src/chip; the differential test holds the two against each other.
//
// Every rule stands where the reference has it; the number in a comment is the reference's section ("hw 12": hardware
// reference). Times are whole ticks of 1/60 ns, one clk is 1250.
//
// Left out on purpose: SAP list with entries (0..51 answer RS), DXB subscriber, IsoM and Simple Sync, clock
// synchronisation, bit-level sampling.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace oracle {

using Time = std::int64_t;
using Octet = std::uint8_t;
using Octets = std::vector<Octet>;
inline constexpr Time kClk = 1250;
/// 4.13: Go_Offline on an idle bus, "within 48 clk".
inline constexpr Time kOfflineDelay = 48 * kClk;
inline constexpr Time kMs = 60'000'000;
inline constexpr Time kNever = std::numeric_limits<Time>::max();

constexpr Octet octet(unsigned v) { return static_cast<Octet>(v); }

/// What one chip has and another has not (hw 12, and section 5.2 of both manuals).
struct Kind {
    const char* name;
    bool has_4k;              ///< 4KB_Mode
    bool one_and_a_half_k;    ///< 600h and above folds by -400h (4.11)
    unsigned release;         ///< Status bits 15..12
    unsigned interrupts;      ///< IRR bits that exist
    bool mode_regs_readable;  ///< 06h, 07h, 15h
    bool mode_reg2, mode_reg3;
    unsigned mode_reg2_mask;
    bool dxb;  ///< 12h, 13h
    bool user_timer;
    bool ext_prm;      ///< SAP 53
    bool dpv1_status;  ///< Set_Prm octets 7..9 are DPV1_Status
    unsigned baud_control_val;
    bool dis_start;            ///< Dis_Start_Control after reset (3.4.1)
    bool din_gates_data_exch;  ///< 3.6
    bool gc_changed_only;      ///< 4.4
    bool presets_gc_command;   ///< 4.12
    bool cfg_aux1_only;        ///< section 10, item 16
};

inline constexpr int kKinds = 5;
extern const std::array<Kind, kKinds> kKind;

/// Bit time of each baud code in clk (1.2).
inline constexpr std::array<Time, 10> kBitClk{4, 8, 16, 32, 96, 256, 512, 1056, 2500, 5000};

struct Char {
    Time start, bit;
    Octet value;
    bool bad_parity, low_stop;
};

enum class DpSm { wait_prm, wait_cfg, data_exch };
enum class WdSm { baud_search, baud_control, dp_control };
enum class Reply { none, sc, fdl_ok, rr, rs, data_exchange, rd_input, rd_output, get_cfg, slave_diag };
const char* name(Reply reply);

/// A request, taken apart (2.1).
struct Request {
    unsigned da, sa, fc;  ///< da and sa without the extension bits
    bool has_dsap, has_ssap;
    unsigned dsap, ssap;
    bool sd1;
    Octets data;
};

struct Sent {
    Time start, bit;
    Octets octets;
    Reply reply;
};

class NaiveSlave {
public:
    explicit NaiveSlave(const Kind& kind, bool motorola = false);

    void reset();
    void advance(Time to);
    unsigned read(unsigned address);
    void write(unsigned address, unsigned value);
    unsigned peek(unsigned address) const;
    /// All characters of a telegram, the last of which ended now.
    void hear(Time start, Time bit, const Octets& octets);
    void hear_character(const Char& c);
    void carrier(Time at);
    bool hears_all() const;
    unsigned pin_x_int() const { return (x_int_active ? 1u : 0u) ^ (int_pol() ? 0u : 1u); }
    unsigned ram_size() const { return kind.one_and_a_half_k ? 0x600u : four_k() ? 0x1000u : 0x800u; }

    // Everything is open: this is an oracle.
    Kind kind;
    bool motorola;
    Time now = 0;
    std::vector<Sent> sent;  ///< answers that have begun, oldest first
    std::vector<Octet> ram;

    // registers (4.2, 4.3)
    unsigned irr = 0, imr = 0xFFFF, mode0 = 0, mode1 = 0, mode2 = 1, mode3 = 0;
    unsigned baud_control_val = 0x10, min_tsdr = 11;
    bool x_int_active = false;
    Time inactive_until = 0;
    Time user_clock_due = kNever;
    Time prescaler_from = 0;
    unsigned irr_fresh = 0;  ///< bits set at irr_fresh_at: an acknowledgement in the same clk loses (4.4)
    Time irr_fresh_at = -1;

    // MAC
    bool online = false;
    bool access_violation = false;
    unsigned ts = 255;
    unsigned probe = 0, baud = 15;
    Time probe_until = kNever, wd_until = kNever;
    unsigned wd_f1 = 1, wd_f2 = 1;
    bool wd_base_1ms = false;
    bool fcb_valid = false, fcb_last = false;
    unsigned fcb_sa = 0;
    Reply fcb_reply = Reply::none;
    bool fcb_high = false;
    Octets fcb_octets;  ///< the request itself, for the test's use only
    bool offline_wanted = false;
    Time offline_at = kNever;
    // receiver (1.4)
    enum RxState { unsync, hunt, frame } rx = unsync;
    Octets rx_octets;
    Time idle_from = 0, rx_end = 0, rx_since = 0;
    bool line_busy = false;  ///< from carrier() to the end of what was heard

    Time rts_until = 0;  ///< RTS falls 4 clk after the last stop bit (1.5)

    // answer being prepared or sent (4.13)
    struct Plan {
        bool active = false;
        Reply reply = Reply::none;
        Request request{};
        bool retry = false;
        bool dx_error = false;  ///< LEAVE-MASTER with Cfg_Fault when the answer is over (3.8)
        bool user_wd = false;   ///< LEAVE-MASTER by the user watchdog when the answer is over (4.9)
        int new_address = -1;
        bool composed = false, begun = false;
        Time bit = 0, rts = 0, start = 0, end = kNever;
        Octets octets;
    } plan;
    bool rts() const { return plan.composed || now < rts_until; }
    std::vector<std::pair<Time, std::function<void(NaiveSlave&)>>> later;  ///< t0 + 1 clk

    // DP state machine
    DpSm dp = DpSm::wait_prm;
    WdSm wd = WdSm::baud_search;
    int owner = -1;
    bool cfg_fault = false, not_supported = false, prm_fault = false, prm_req = true, wd_on = false;
    bool freeze_mode = false, sync_mode = false, d_pending = false;
    unsigned group_ident = 0;
    unsigned gc_last_command = 0, gc_last_group = 0;
    bool dpv1_enable = false, fail_safe = false, publisher = false;
    enum class Waiting { none, prm, ext_prm, cfg };
    int prm_counter = 0, cfg_counter = 0;
    bool prm_is_ext = false;  ///< which bit the current Prm buffer belongs to
    Waiting aux_waiting[2] = {Waiting::none, Waiting::none};
    unsigned waiting_prm_len = 0, waiting_cfg_len = 0;
    bool cfg_okay = false, cfg_seen = false, din_given = false;
    bool ssa_busy = false;
    unsigned user_wd = 0;
    // buffer machines (4.5, 4.6)
    struct Three {
        unsigned f, u, n, d;
    };
    Three din{3, 2, 0, 1}, dout{3, 2, 0, 1};
    bool cleared[4] = {};
    unsigned diag_owner[3] = {0, 1, 2};  ///< [1], [2]: code of buffer 1 and 2
    bool diag_exchange_pending = false;
    bool diag_flag = false;
    unsigned diag_control = 0;  ///< octet 0 bits 2..0 of the buffer the chip has

    // ---- helpers, public like everything else
    bool four_k() const { return kind.has_4k && (mode2 & 0x80) != 0; }
    bool int_pol() const { return (mode0 & 0x10) != 0; }
    Time bit() const { return kBitClk[baud < 10 ? baud : probe] * kClk; }
    unsigned cell(unsigned address) const { return ram[address]; }
    unsigned physical(unsigned pointer_cell, unsigned offset) const;
    unsigned status_low() const;
    unsigned fold(unsigned address, bool user_access);

    Time next() const;
    void step(Time at);
    void set_irr(unsigned bits);
    void update_pin();
    void end_of_interrupt();
    unsigned read_control(unsigned address);
    void write_control(unsigned address, unsigned value);
    void set_mode1(unsigned value);
    void start_chip();
    void want_offline();
    void execute_offline();

    void line_over();
    void receiver_lost(Time idle);
    void character(const Char& c);
    void frame_octet(const Char& c);
    void telegram_complete();
    bool take_apart(Request& r) const;
    void request_arrived(const Request& r);
    void serve(const Request& r);
    void serve_srd(const Request& r);
    void answer(const Request& r, Reply reply, bool retry = false);
    void received_into_aux(unsigned select_bit, const Octets& data);
    void after_a_clk(std::function<void(NaiveSlave&)> effect);
    void compose();
    Octets answer_data(bool& high);
    void answer_over();

    void load_watchdog();
    Time prescaler(Time period, unsigned n) const;
    void start_search();
    void restart_probe();

    void data_exchange(const Request& r);
    void outputs_received(const Octets& data);
    void outputs_cleared();
    void clear_dout();
    void shift_dout();
    void fetch_din();
    void set_prm(const Octets& data, unsigned sa);
    bool prm_faulty(const Octets& data);
    void prm_taken(const Octets& data, unsigned sa);
    void prm_indicated(const Octets& data, bool ext);
    void chk_cfg(const Octets& data, unsigned sa);
    bool set_slave_add_valid(const Octets& data) const;
    void set_slave_add(const Octets& data);
    void take_address(int address);
    void global_control(const Request& r);
    void leave_master();
    void try_data_exch();
    void exchange_cells(unsigned a, unsigned b) { std::swap(ram[a], ram[b]); }
    unsigned aux_index(unsigned select_bit) const;
    void store(unsigned pointer_cell, const Octets& data);
    unsigned acknowledge(bool prm, bool okay);
    unsigned acknowledge_conflict(bool prm);
    unsigned new_diag();
    void diag_exchanged(unsigned new_chip, unsigned new_user);
    void diag_changed();
    void diag_reset_both();
    Octets diag_header() const;
    unsigned next_dout();
    unsigned new_din();
};

}  // namespace oracle
