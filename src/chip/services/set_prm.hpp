// SPDX-License-Identifier: Apache-2.0
// Set_Prm, SAP 61 (6.2.2, 7.1; reference 3.4).
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::set_prm {

using Data = std::span<const std::uint8_t>;

/// Octet 0, Station_Status.
inline constexpr std::uint8_t kLock = 0x80, kUnlock = 0x40, kSync = 0x20, kFreeze = 0x10, kWdOn = 0x08;
/// Octet 7, DPV1_Status_1.
inline constexpr std::uint8_t kDpv1Enable = 0x80, kFailSafe = 0x40, kPublisher = 0x20, kReceiverBits = 0x07;
/// Octets 8 and 9.
inline constexpr std::uint8_t kStatus2Reserved = 0x02, kStatus3Reserved = 0x60, kPrmCmd = 0x80, kIsoM = 0x10;

/// What the full check found.
enum class Verdict : std::uint8_t { good, prm_fault, not_supported };

constexpr std::uint8_t octet(Data d, std::size_t i) { return i < d.size() ? d[i] : std::uint8_t{0}; }

template <class C>
bool ident_matches(const C& c, Data d) {
    return d[4] == dpram::cell(c.s, regmap::org::r_ident_high) && d[5] == dpram::cell(c.s, regmap::org::r_ident_low);
}

/// Checks 5 to 8, which only chips with the DP extensions make. Octets that were not sent read as 0 and pass.
template <class C>
bool extensions_good(const C& c, Data d) {
    namespace m0 = regmap::mode0;
    namespace m2 = regmap::mode2;
    const std::uint8_t s1 = octet(d, 7), s2 = octet(d, 8), s3 = octet(d, 9);
    const bool fail_safe_required = (s1 & kDpv1Enable) != 0 && (c.s.mode0 & m0::spec_clear_mode) != 0;
    if (fail_safe_required && (s1 & kFailSafe) == 0) return false;
    const bool reserved_set = (s2 & kStatus2Reserved) != 0 || (s3 & kStatus3Reserved) != 0;
    if (reserved_set && (c.s.mode2 & m2::no_check_prm_reserved) == 0) return false;
    if ((s3 & kPrmCmd) != 0 && (c.s.mode0 & m0::prm_cmd_supported) == 0) return false;
    return (s3 & kIsoM) == 0 || (c.s.mode2 & m2::sync_ena) != 0;
}

/// Reference 3.4.3; the first line that fails decides.
template <class C>
Verdict check(C& c, Data d) {
    if (d.size() < 7 || !ident_matches(c, d)) return Verdict::prm_fault;
    if ((d[0] & kWdOn) != 0 && (d[1] == 0 || d[2] == 0)) return Verdict::prm_fault;
    const bool sync_ok = (d[0] & kSync) == 0 || (c.s.mode0 & regmap::mode0::sync_supported) != 0;
    const bool freeze_ok = (d[0] & kFreeze) == 0 || (c.s.mode0 & regmap::mode0::freeze_supported) != 0;
    if (!sync_ok || !freeze_ok) return Verdict::not_supported;
    if (c.traits->prm_reserved_checks && !extensions_good(c, d)) return Verdict::prm_fault;
    return Verdict::good;
}

template <class C>
void take_min_tsdr(C& c, Data d) {
    if (d[3] != 0) c.s.min_tsdr = d[3];
}

template <class C>
void take_octet_7(C& c, std::uint8_t o) {
    c.s.mode0 = static_cast<std::uint16_t>((c.s.mode0 & ~kReceiverBits) | (o & kReceiverBits));
    if (!c.traits->dpv1) return;
    c.s.dpv1_enable = (o & kDpv1Enable) != 0;
    c.s.fail_safe = (o & kFailSafe) != 0;
    c.s.publisher_enable = (o & kPublisher) != 0;
}

/// Success actions 1 to 3.
template <class C>
void take(C& c, Data d) {
    c.s.prm_fault = c.s.not_supported = c.s.cfg_fault = c.s.prm_req = 0;
    c.s.owner = c.s.master_add = mac::master(c.s);
    c.s.wd_on = (d[0] & kWdOn) != 0;
    take_min_tsdr(c, d);
    c.s.group_ident = d[6];
    c.s.sync_req = (d[0] & kSync) != 0;
    c.s.freeze_req = (d[0] & kFreeze) != 0;
    c.s.wd_fact_1 = d[1];
    c.s.wd_fact_2 = d[2];
    if (d.size() > 7) take_octet_7(c, d[7]);
    if (c.s.wd_on != 0 && d[1] == 1 && d[2] == 1 && c.traits->dpv1) c.find(Rule::watchdog_1_by_1, 0);
    wd::dispatch(c, c.s.wd_on != 0 ? wd::Event::prm_wd_on : wd::Event::prm_wd_off);
}

template <class C>
bool special_buffer(const C& c) { return (c.s.mode0 & regmap::mode0::spec_prm_buf_mode) != 0; }

/// Spec_Prm_Buf_Mode: the data are in the Prm-Buffer already, nothing is exchanged.
template <class C>
void present_directly(C& c, Data d) {
    dpram::set_cell(c.s, regmap::org::r_len_prm_data, static_cast<std::uint8_t>(d.size()));
    c.s.prm_present = AuxUser::prm;
    aux::set_counter(c, Fact::prm_counter, c.s.prm_counter, 1);
    irq::raise(c, regmap::interrupt::new_prm_data);
}

template <class C>
void accept(C& c, Data d) {
    take(c, d);
    clock_sync::cyclic_state_machine_changed(c);
    if (d.size() > 7) {
        if (special_buffer(c)) present_directly(c, d);
        else aux::present_prm(c, AuxUser::prm, d);
    }
    dp::dispatch(c, dp::Event::prm_accepted);
    diag::refresh(c);
}

template <class C>
void refuse(C& c, Verdict verdict) {
    if (verdict == Verdict::not_supported) c.s.not_supported = 1;
    dp::leave_with_fault(c, regmap::LeaveCause::faulty_set_prm, &State::prm_fault);
}

template <class C>
void unlock(C& c, Data d) {
    if (c.s.dp_state == DpState::wait_prm) return;
    if (ident_matches(c, d)) return dp::leave_master(c, regmap::LeaveCause::unlock);
    dp::leave_with_fault(c, regmap::LeaveCause::faulty_set_prm, &State::prm_fault);
}

/// Reference 3.4.2, for a telegram that is not ignored.
template <class C>
void evaluate(C& c, Data d) {
    if (d.size() < 7) return refuse(c, Verdict::prm_fault);
    if ((d[0] & kUnlock) != 0) return unlock(c, d);
    if ((d[0] & kLock) == 0) {
        take_min_tsdr(c, d);
        return;
    }
    const Verdict verdict = check(c, d);
    if (verdict == Verdict::good) accept(c, d);
    else refuse(c, verdict);
}

/// A master that does not own the slave may only set minTSDR.
template <class C>
bool ignored(const C& c, Data d) {
    if (c.s.owner == dp::kNoMaster || c.s.owner == mac::master(c.s)) return false;
    return d.size() < 7 || (d[0] & (kLock | kUnlock)) != 0;
}

template <class C>
bool buffer_free(const C& c) {
    if (special_buffer(c)) return c.s.prm_counter == 0;
    return aux::waiting(c, aux::Service::prm) != AuxUser::cfg;
}

template <class C>
void receive(C& c, Data d) {
    if (!special_buffer(c)) aux::receive(c, aux::Service::prm, d);
    else if (c.s.prm_counter == 0) dpram::write(c, dpram::pointer(c.s, regmap::org::r_prm_buf_ptr), d);
}

template <class C>
Answer serve(C& c) {
    const Data d = mac::data(c.s);
    const std::uint8_t limit =
        special_buffer(c) ? dpram::cell(c.s, regmap::org::r_len_spec_prm_buf) : aux::limit(c, aux::Service::prm);
    if (d.size() > limit) return Answer::rr;
    receive(c, d);
    if (ignored(c, d)) return Answer::sc;
    if (!buffer_free(c)) return Answer::rr;
    evaluate(c, d);
    return Answer::sc;
}

}  // namespace dpchip::chip::set_prm
