// SPDX-License-Identifier: Apache-2.0
// Every octet of a chip's state. Trivially copyable, no padding, no pointers: a copy is a snapshot, memcmp compares.
//
// describe() lists each member once, for saving and loading; a member that is missing there does not compile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <dpchip/core/ticks.hpp>
#include <dpchip/fdl/baud.hpp>

namespace dpchip::chip {

using core::Ticks;

/// DP_State, Status Register bits 5..4 (5.2).
enum class DpState : std::uint8_t { wait_prm = 0, wait_cfg = 1, data_exch = 2 };
/// WD_State, Status Register bits 7..6 (5.2).
enum class WdState : std::uint8_t { baud_search = 0, baud_control = 1, dp_control = 2 };
/// XINT/MOT: whether the word registers are swapped (4.2).
enum class BusMode : std::uint8_t { intel, motorola };
enum class Level : std::uint8_t { low, high };
/// Output pins that the model drives.
enum class Pin : std::uint8_t { x_int, rts, xdataexch_sync };

/// An output pin changed.
struct Edge {
    Ticks at{};
    Pin pin{};
    Level level{};
    bool operator==(const Edge&) const = default;
};

/// Where the receiver stands (reference 1.4).
enum class RxState : std::uint8_t { unsync, hunt, frame };

/// What the chip sends, or has decided to send.
enum class Answer : std::uint8_t {
    none, sc, fdl_status, rs, rr,
    data_exchange, rd_input, rd_output, get_cfg, slave_diag,
    response,  ///< from a Response-Buffer of the SAP list
    kept,      ///< the same octets again: a repeated poll
};

/// Deadlines, in the order in which they are served within one tick.
enum class Timer : std::uint8_t {
    telegram,      ///< t0 + 1 clk: what a received telegram causes (reference 4.13)
    rts_on,        ///< RTS rises, buffers are fetched, the answer is composed
    answer_start,  ///< first start bit
    answer_end,    ///< end of the last stop bit
    rts_off,
    watchdog,      ///< BAUD_SEARCH probe, BAUD_CONTROL or DP_CONTROL time
    eoi,           ///< end of the interrupt inactive time
    offline,       ///< Go_Offline is executed
    dxb_monitor,   ///< end of a monitoring time of the DXB links
    sync,          ///< next edge of a SYNC pulse
    clock_sync,    ///< supervision of the Clock_Value, overflow of Receive_Delay_Time
    count
};
inline constexpr std::size_t kTimers = static_cast<std::size_t>(Timer::count);

/// Time receiver (7.3.3; reference 6.3).
enum class CsState : std::uint8_t { stopped, wait_te, wait_cv };

/// Who occupies an Aux-Buffer with a telegram that waits for its turn (reference 4.7).
enum class AuxUser : std::uint8_t { none, prm, ext_prm, cfg };

struct State {
    // ---- time
    Ticks now{};
    Ticks next{};                           ///< earliest of timers and a visible User_Timer_Clock
    std::array<Ticks, kTimers> timers{};
    Ticks prescaler_origin{};               ///< phase of the 1 ms and 10 ms watchdog prescaler
    Ticks user_clock_due{};                 ///< next User_Timer_Clock
    Ticks irr_fresh_at{};                   ///< when irr_fresh was set
    // ---- receiver
    Ticks line_idle_since{};                ///< end of the last low bit that is known of
    Ticks character_due{};                  ///< nominal start of the next character of a telegram
    Ticks request_end{};                    ///< t0 of the request being served
    // ---- transmitter
    Ticks answer_at{};                      ///< first start bit of the answer
    Ticks answer_bit{};                     ///< its bit time

    // ---- clock synchronisation
    Ticks time_event_at{};                  ///< end of the last Time_Event
    Ticks delay_from{};                     ///< the Time_Event that Receive_Delay_Time counts from

    // ---- interrupt controller (5.3)
    std::uint16_t irr{};
    std::uint16_t imr{};
    std::uint16_t irr_fresh{};              ///< raised in the present CLK period and not yet read: an IAR write keeps them
    // ---- registers
    std::uint16_t mode0{};
    std::uint16_t user_wd_timer{};
    std::uint16_t rx_count{};               ///< octets in rx
    std::uint16_t rx_size{};                ///< octets the telegram in rx will have; 0: not known yet
    std::uint16_t tx_count{};               ///< octets in tx
    std::uint16_t kept_count{};             ///< octets in kept
    std::uint16_t sap_entry{};              ///< offset of the SAP-List entry of the request being served
    std::uint8_t mode1{}, mode2{}, mode3{};
    std::uint8_t wd_baud_control_val{}, min_tsdr{}, sync_pw{}, control_command{}, group_select{};

    // ---- pins
    std::uint8_t x_int_active{}, rts{}, xcts_high{}, xcts_hold{}, watched_pins{};
    BusMode bus_mode{};

    // ---- status
    DpState dp_state{};
    WdState wd_state{};
    fdl::BaudCode baud{};                   ///< found rate
    fdl::BaudCode probe{};                  ///< rate the receiver works at
    std::uint8_t passive_idle{}, diag_flag{}, ram_access_violation{};
    std::uint8_t offline_requested{};       ///< Go_Offline or a RAM access violation waits for the end of the request

    // ---- receiver and MAC
    RxState rx_state{};
    std::uint8_t rx_busy{};                 ///< a telegram is coming in
    std::uint8_t ts{};                      ///< own address as latched; 255 while Offline
    std::uint8_t next_ts{};                 ///< address that Set_Slave_Add makes valid after its answer; 255: none
    std::uint8_t fcb_valid{}, fcb_sa{}, fcb_last{}, retry{}, answered_negative{};
    // ---- the request being served, and its answer
    std::uint8_t request_da{}, request_sa{}, request_fc{};
    std::uint8_t request_data_at{};         ///< where in rx its data begin, behind the SAP octets
    std::uint8_t request_length{};          ///< data octets
    std::uint8_t suppress_answer{};         ///< somebody else sent before the request was worked on
    Answer answer{};                        ///< being prepared or sent
    Answer last_answer{};                   ///< what a repetition gets
    std::uint8_t last_fc{};                 ///< FC of that answer
    std::uint8_t answer_fc{};
    std::uint8_t leave_after_answer{};      ///< 0, or LeaveCause + 1
    std::uint8_t resp_segment{};            ///< Response-Buffer being sent
    std::uint8_t fdl_ind_after_answer{};    ///< FDL_Ind waits for the end of an immediate response
    std::uint8_t answer_ready{};            ///< the first start bit falls now: take() may have it

    // ---- DP_SM
    std::uint8_t owner{};                   ///< Diag_Master_Add; 255: none
    std::uint8_t master_add{};              ///< octet 3 of the diagnosis
    std::uint8_t group_ident{}, sync_req{}, freeze_req{}, sync_mode{}, freeze_mode{};
    std::uint8_t wd_on{}, wd_fact_1{}, wd_fact_2{};
    std::uint8_t dpv1_enable{}, fail_safe{}, publisher_enable{};
    std::uint8_t prm_counter{}, cfg_counter{};
    std::uint8_t cfg_okay{};                ///< the configuration was acknowledged positively
    std::uint8_t chk_cfg_seen{};            ///< no Set_Ext_Prm any more
    std::uint8_t din_given{};               ///< New_Din_Buffer_Cmd since Start or LEAVE-MASTER (APC3 5.2.3)
    std::uint8_t gc_command_before{}, gc_group_before{};
    std::uint8_t prm_fault{}, cfg_fault{}, not_supported{}, prm_req{};

    // ---- DP-V2
    std::uint8_t sync_active{};             ///< pin 13 shows SYNC or a synchronised DX_Out
    std::uint8_t dx_stored{};               ///< Simple Sync Mode: DX_Out waits for the next SYNCH
    CsState cs_state{};
    std::uint8_t delay_running{};           ///< Receive_Delay_Time has not been read
    std::array<std::uint8_t, 8> last_time_event{};

    // ---- buffers
    std::uint8_t din_sm{}, dout_sm{}, dxbout_sm{}, diag_sm{};
    std::uint8_t dout_cleared{};            ///< bit n: Dout_Buf n was zeroed by the chip
    std::uint8_t dout_d_filled{};           ///< D holds outputs that Sync_Mode keeps back
    std::uint8_t diag_control{};            ///< Ext_Diag, Stat_Diag, Overflow of the chip's diagnosis buffer
    std::uint8_t diag_pending{};            ///< New_Diag_Cmd came while the buffer was being sent
    std::uint8_t ssa_busy{};
    std::array<AuxUser, 2> aux_waiting{};   ///< telegram waiting in Aux 1, 2
    std::uint8_t waiting_prm_length{}, waiting_cfg_length{};
    AuxUser prm_present{};                  ///< what the Prm-Buffer holds: prm or ext_prm
    std::array<std::uint8_t, 42> latched{}; ///< organizational parameters 16H..3FH as of Start; pointers are taken from here

    std::array<std::uint8_t, 256> rx{};
    std::array<std::uint8_t, 256> tx{};
    std::array<std::uint8_t, 256> kept{};   ///< the last response of the SAP list as it was sent
    std::array<std::uint8_t, 4096> ram{};
    std::array<std::uint8_t, 3> spare{};  ///< fills the last eight octets, so that there is no padding
};
static_assert(std::is_trivially_copyable_v<State>);
static_assert(std::has_unique_object_representations_v<State>, "no padding: snapshots compare with memcmp");

/// Calls `visit(name, member)` for every member, in the order of declaration.
template <class S, class Visitor>
constexpr void describe(S& s, Visitor&& visit) {
#define DPCHIP_FIELD(member) visit(std::string_view{#member}, s.member)
    DPCHIP_FIELD(now); DPCHIP_FIELD(next); DPCHIP_FIELD(timers); DPCHIP_FIELD(prescaler_origin);
    DPCHIP_FIELD(user_clock_due); DPCHIP_FIELD(irr_fresh_at); DPCHIP_FIELD(line_idle_since);
    DPCHIP_FIELD(character_due); DPCHIP_FIELD(request_end); DPCHIP_FIELD(answer_at); DPCHIP_FIELD(answer_bit);
    DPCHIP_FIELD(time_event_at); DPCHIP_FIELD(delay_from);
    DPCHIP_FIELD(irr); DPCHIP_FIELD(imr); DPCHIP_FIELD(irr_fresh); DPCHIP_FIELD(mode0);
    DPCHIP_FIELD(user_wd_timer); DPCHIP_FIELD(rx_count); DPCHIP_FIELD(rx_size); DPCHIP_FIELD(tx_count); DPCHIP_FIELD(kept_count); DPCHIP_FIELD(sap_entry);
    DPCHIP_FIELD(mode1); DPCHIP_FIELD(mode2); DPCHIP_FIELD(mode3); DPCHIP_FIELD(wd_baud_control_val);
    DPCHIP_FIELD(min_tsdr); DPCHIP_FIELD(sync_pw); DPCHIP_FIELD(control_command); DPCHIP_FIELD(group_select);
    DPCHIP_FIELD(x_int_active); DPCHIP_FIELD(rts); DPCHIP_FIELD(xcts_high); DPCHIP_FIELD(xcts_hold);
    DPCHIP_FIELD(watched_pins); DPCHIP_FIELD(bus_mode); DPCHIP_FIELD(dp_state); DPCHIP_FIELD(wd_state);
    DPCHIP_FIELD(baud); DPCHIP_FIELD(probe); DPCHIP_FIELD(passive_idle); DPCHIP_FIELD(diag_flag);
    DPCHIP_FIELD(ram_access_violation); DPCHIP_FIELD(offline_requested); DPCHIP_FIELD(rx_state); DPCHIP_FIELD(rx_busy); DPCHIP_FIELD(ts);
    DPCHIP_FIELD(next_ts); DPCHIP_FIELD(fcb_valid); DPCHIP_FIELD(fcb_sa); DPCHIP_FIELD(fcb_last);
    DPCHIP_FIELD(retry); DPCHIP_FIELD(answered_negative); DPCHIP_FIELD(request_da); DPCHIP_FIELD(request_sa);
    DPCHIP_FIELD(request_fc); DPCHIP_FIELD(request_data_at); DPCHIP_FIELD(request_length);
    DPCHIP_FIELD(suppress_answer); DPCHIP_FIELD(answer); DPCHIP_FIELD(last_answer); DPCHIP_FIELD(last_fc);
    DPCHIP_FIELD(answer_fc); DPCHIP_FIELD(resp_segment); DPCHIP_FIELD(fdl_ind_after_answer);
    DPCHIP_FIELD(leave_after_answer); DPCHIP_FIELD(answer_ready); DPCHIP_FIELD(owner);
    DPCHIP_FIELD(master_add); DPCHIP_FIELD(group_ident); DPCHIP_FIELD(sync_req); DPCHIP_FIELD(freeze_req);
    DPCHIP_FIELD(sync_mode); DPCHIP_FIELD(freeze_mode); DPCHIP_FIELD(wd_on); DPCHIP_FIELD(wd_fact_1);
    DPCHIP_FIELD(wd_fact_2); DPCHIP_FIELD(dpv1_enable); DPCHIP_FIELD(fail_safe); DPCHIP_FIELD(publisher_enable);
    DPCHIP_FIELD(prm_counter); DPCHIP_FIELD(cfg_counter); DPCHIP_FIELD(cfg_okay); DPCHIP_FIELD(chk_cfg_seen);
    DPCHIP_FIELD(din_given); DPCHIP_FIELD(gc_command_before); DPCHIP_FIELD(gc_group_before);
    DPCHIP_FIELD(prm_fault); DPCHIP_FIELD(cfg_fault); DPCHIP_FIELD(not_supported); DPCHIP_FIELD(prm_req);
    DPCHIP_FIELD(sync_active); DPCHIP_FIELD(dx_stored); DPCHIP_FIELD(cs_state); DPCHIP_FIELD(delay_running);
    DPCHIP_FIELD(last_time_event); DPCHIP_FIELD(din_sm); DPCHIP_FIELD(dout_sm); DPCHIP_FIELD(dxbout_sm); DPCHIP_FIELD(diag_sm);
    DPCHIP_FIELD(dout_cleared); DPCHIP_FIELD(dout_d_filled); DPCHIP_FIELD(diag_control);
    DPCHIP_FIELD(diag_pending); DPCHIP_FIELD(ssa_busy); DPCHIP_FIELD(aux_waiting);
    DPCHIP_FIELD(waiting_prm_length); DPCHIP_FIELD(waiting_cfg_length); DPCHIP_FIELD(prm_present);
    DPCHIP_FIELD(latched); DPCHIP_FIELD(rx); DPCHIP_FIELD(tx); DPCHIP_FIELD(kept); DPCHIP_FIELD(ram); DPCHIP_FIELD(spare);
#undef DPCHIP_FIELD
}

namespace detail {
/// Octets that describe() covers, and whether it names nothing twice.
consteval std::size_t described_octets() {
    State s{};
    std::size_t octets = 0, count = 0;
    std::array<std::string_view, 128> names{};
    describe(s, [&](std::string_view name, auto& member) {
        for (std::size_t i = 0; i < count; ++i)
            if (names[i] == name) throw "a member is described twice";
        names[count++] = name;
        octets += sizeof member;
    });
    return octets;
}
}  // namespace detail
static_assert(detail::described_octets() == sizeof(State), "a State member is missing from describe()");

}  // namespace dpchip::chip
