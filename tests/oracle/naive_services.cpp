// SPDX-License-Identifier: Apache-2.0
// The naive slave: requests, answers, Data_Exchange and its buffers (reference 2.5, 2.7, 3.2, 3.8, 4.5, 4.9, 4.13).
#include <algorithm>

#include "naive_slave.hpp"

namespace oracle {

// 4.13: effects of a telegram, one clk after its end.
void NaiveSlave::after_a_clk(std::function<void(NaiveSlave&)> effect) {
    later.emplace_back(now + kClk, std::move(effect));
}

// 2.5 and 4.10: frame count bit and watchdog, at t0.
void NaiveSlave::request_arrived(const Request& r) {
    const unsigned function = r.fc & 0x0F;
    if (r.da == 127) {  // 2.4: only SDN (TE and CV have no receiver here)
        if (function == 4 || function == 6) serve(r);
        return;
    }
    if (wd == WdSm::baud_control) load_watchdog();
    if (wd == WdSm::dp_control && static_cast<int>(r.sa) == owner) load_watchdog();

    const bool counted = function == 3 || function == 5 || function == 7 || function == 12 || function == 13;
    if (!counted) return serve(r);
    const bool fcb = (r.fc & 0x20) != 0, fcv = (r.fc & 0x10) != 0;
    const bool positive = fcb_reply != Reply::none && fcb_reply != Reply::rr && fcb_reply != Reply::rs;
    const bool retry = fcv && fcb_valid && fcb_sa == r.sa && fcb_last == fcb && positive;
    // The three services of DATA-EXCH are RS in other states (3.2), also when repeated: 2.5 and 3.2 meet here, 3.2
    // wins.
    const bool exchange_service =
        fcb_reply == Reply::data_exchange || fcb_reply == Reply::rd_input || fcb_reply == Reply::rd_output;
    if (retry && !(exchange_service && dp != DpSm::data_exch)) return answer(r, fcb_reply, true);
    fcb_valid = fcv || fcb;
    fcb_sa = r.sa;
    fcb_last = fcb;
    fcb_octets = rx_octets;
    fcb_reply = Reply::none;
    serve(r);
    fcb_reply = plan.reply;
}

void NaiveSlave::serve(const Request& r) {
    const bool dp_mode = (mode0 & 0x100) != 0;
    switch (r.fc & 0x0F) {
    case 3:
    case 5: return answer(r, Reply::rs);  // 3.2: SDA has no SAP here
    case 4:
    case 6:
        if (dp_mode && r.has_dsap && r.dsap == 58) after_a_clk([r](NaiveSlave& s) { s.global_control(r); });
        return;
    case 7:  // 3.8, 6.1
        if (!publisher) return;
        if (!dp_mode || r.has_dsap || dp != DpSm::data_exch || static_cast<int>(r.sa) != owner)
            return answer(r, Reply::rs);
        return data_exchange(r);
    case 9: return answer(r, Reply::fdl_ok);
    case 12:
    case 13: return serve_srd(r);
    case 14:
    case 15: return answer(r, Reply::rs);
    default: return;
    }
}

// Table 3.2.
void NaiveSlave::serve_srd(const Request& r) {
    const bool exchange = dp == DpSm::data_exch;
    const bool from_owner = static_cast<int>(r.sa) == owner;
    const std::size_t length = r.data.size();
    const auto limit = [&](unsigned select_bit) { return std::size_t{cell(0x28 + aux_index(select_bit))}; };
    const auto occupied_by_other = [&](unsigned select_bit, bool prm_service) {
        const Waiting w = aux_waiting[aux_index(select_bit)];
        if (w == Waiting::none) return false;
        return prm_service ? w == Waiting::cfg : w != Waiting::cfg;
    };
    if ((mode0 & 0x100) == 0) return answer(r, Reply::rs);
    if (!r.has_dsap) {
        if (!exchange || !from_owner) return answer(r, Reply::rs);
        return data_exchange(r);
    }
    switch (r.dsap) {
    case 53:  // 3.5
        if (!kind.ext_prm || (mode0 & 0x800) == 0 || dp != DpSm::wait_cfg) return answer(r, Reply::rs);
        if (cfg_seen) return answer(r, Reply::rs);  // the SAP is closed from the first accepted Chk_Cfg on
        if (length > limit(0) || (from_owner && occupied_by_other(0, true))) return answer(r, Reply::rr);
        after_a_clk([r, from_owner](NaiveSlave& s) {
            if (from_owner) s.prm_indicated(r.data, true);
            else s.received_into_aux(0, r.data);
        });
        return answer(r, Reply::sc);
    case 55:  // 3.3
        if (cell(0x2E) == 0) return answer(r, Reply::rs);
        if (length > limit(2)) return answer(r, Reply::rr);
        if (dp == DpSm::wait_prm && ssa_busy) return answer(r, Reply::rr);
        after_a_clk([r](NaiveSlave& s) {
            s.received_into_aux(2, r.data);
            if (s.set_slave_add_valid(r.data)) s.set_slave_add(r.data);
        });
        return answer(r, Reply::sc);
    case 56: return answer(r, exchange ? Reply::rd_input : Reply::rs);  // 3.10
    case 57: return answer(r, exchange ? Reply::rd_output : Reply::rs);
    case 59: return answer(r, Reply::get_cfg);
    case 60: return answer(r, Reply::slave_diag);
    case 61: {  // 3.4
        const bool special = (mode0 & 0x1000) != 0;
        // 4.7: a telegram that is ignored needs no buffer and gets SC. Lock = Unlock = 0 is nobody's to ignore (3.4.2).
        const bool min_tsdr_only = length >= 7 && (r.data[0] & 0xC0) == 0;
        const bool ignored = owner >= 0 && !from_owner && !min_tsdr_only;
        if (special && (length > cell(0x3D) || (!ignored && prm_counter > 0))) return answer(r, Reply::rr);
        if (!special && (length > limit(0) || (!ignored && occupied_by_other(0, true)))) return answer(r, Reply::rr);
        after_a_clk([r](NaiveSlave& s) { s.set_prm(r.data, r.sa); });
        return answer(r, Reply::sc);
    }
    case 62:  // 3.6
        if (length > limit(1) || (from_owner && occupied_by_other(1, false))) return answer(r, Reply::rr);
        after_a_clk([r](NaiveSlave& s) { s.chk_cfg(r.data, r.sa); });
        return answer(r, Reply::sc);
    default: return answer(r, Reply::rs);  // 58 by SRD, 0..51 with an empty list, 52, 54, 63, above 3Fh
    }
}

// ---- answers (1.6, 2.7, 4.13) ---------------------------------------------------------------------------------------

void NaiveSlave::answer(const Request& r, Reply reply, bool retry) {
    plan = {};
    plan.active = true;
    plan.reply = reply;
    plan.request = r;
    plan.retry = retry;
    plan.bit = bit();
    plan.start = now + std::max<Time>(std::max(11u, min_tsdr) * bit(), 144 * kClk);
    plan.rts = plan.start - 4 * kClk;
}

// RTS rises: inputs are fetched, the diagnosis header and the U buffer are read.
void NaiveSlave::compose() {
    plan.composed = true;
    const Request& r = plan.request;
    bool high = false;
    const Octets data = answer_data(high);
    Octets& o = plan.octets;
    if (plan.reply == Reply::sc ||
        (data.empty() && plan.reply != Reply::fdl_ok && plan.reply != Reply::rr && plan.reply != Reply::rs)) {
        o = {0xE5};
    } else if (data.empty()) {
        const unsigned code = plan.reply == Reply::fdl_ok ? 0 : plan.reply == Reply::rr ? 2 : 3;
        o = {0x10, octet(r.sa), octet(ts), octet(code), octet(r.sa + ts + code), 0x16};
    } else {
        const bool multicast = (r.fc & 0x0F) == 7 && cell(0x1E) != 0;  // 6.1: inputs go to 127
        Octets unit;
        if (!multicast && r.has_ssap) unit.push_back(octet(r.ssap));
        if (!multicast && r.has_dsap) unit.push_back(octet(r.dsap));
        const unsigned da = multicast ? 127 : r.sa | (r.has_ssap ? 0x80u : 0u);
        const unsigned sa = ts | (!multicast && r.has_dsap ? 0x80u : 0u);
        unit.insert(unit.end(), data.begin(), data.end());
        const Octet le = octet(static_cast<unsigned>(unit.size()) + 3);
        o = {0x68, le, le, 0x68, octet(da), octet(sa), octet(high ? 0x0A : 0x08)};
        o.insert(o.end(), unit.begin(), unit.end());
        unsigned sum = 0;
        for (std::size_t i = 4; i < o.size(); ++i) sum += o[i];
        o.push_back(octet(sum));
        o.push_back(0x16);
    }
    plan.end = plan.start + 11 * static_cast<Time>(o.size()) * plan.bit;
}

// What the answer carries; empty for SC and the SD1 answers.
Octets NaiveSlave::answer_data(bool& high) {
    const auto take = [this](unsigned pointer_cell, std::size_t length) {
        Octets out;
        for (unsigned i = 0; i < length; ++i) out.push_back(ram[physical(pointer_cell, i)]);
        return out;
    };
    switch (plan.reply) {
    case Reply::data_exchange:
    case Reply::rd_input: {
        if (!freeze_mode && !plan.retry) fetch_din();
        high = plan.reply == Reply::data_exchange && (plan.retry ? fcb_high : diag_flag);  // a retry repeats the FC
        if (plan.reply == Reply::data_exchange) fcb_high = high;
        Octets data = take(0x1F + din.d - 1, cell(0x1E));
        if (data.empty() && high) data = {0};  // 3.8: one dummy octet
        return data;
    }
    case Reply::rd_output: return take(0x1B + dout.u - 1, cell(0x1A));
    case Reply::get_cfg: return take(0x34, cell(0x33));
    case Reply::slave_diag: {
        const unsigned b = diag_owner[1] >= 2 ? 1 : 2;
        diag_owner[b] = 3;
        Octets data = take(0x26 + b - 1, std::max(6u, cell(0x24 + b - 1)));
        const Octets header = diag_header();
        std::copy(header.begin(), header.end(), data.begin());
        return data;
    }
    case Reply::none:
    case Reply::sc:
    case Reply::fdl_ok:
    case Reply::rr:
    case Reply::rs: break;
    }
    return {};
}

// End of the last stop bit of the answer (4.13).
void NaiveSlave::answer_over() {
    const Plan done = plan;
    plan = {};
    rts_until = now + 4 * kClk;
    rx = hunt;  // 1.5
    rx_octets.clear();
    idle_from = now;
    if (done.reply == Reply::slave_diag) {
        const bool stat_diag = (diag_control & 2) != 0;  // 3.7
        if (!stat_diag && (owner < 0 || static_cast<int>(done.request.sa) == owner)) diag_flag = false;
        const unsigned b = diag_owner[1] == 3 ? 1 : 2;
        if (diag_exchange_pending) diag_exchanged(b == 1 ? 2 : 1, b);
        else if (diag_owner[b] == 3) diag_owner[b] = 2;
        diag_exchange_pending = false;
    }
    if (done.new_address >= 0) take_address(done.new_address);
    if (done.dx_error) {  // 3.8; the fault is reported even when DATA-EXCH was left meanwhile
        cfg_fault = true;
        diag_changed();
    }
    if ((done.dx_error || done.user_wd) && dp == DpSm::data_exch) leave_master();
    if (offline_wanted) offline_at = now;
}

// ---- Data_Exchange (3.8, 4.9) ---------------------------------------------------------------------------------------

void NaiveSlave::data_exchange(const Request& r) {
    const std::size_t length = r.data.size(), expected = cell(0x1A);
    const bool fail_safe_clear = length == 0 && expected > 0 && (mode0 & 0x2000) != 0;
    if (length != expected && !fail_safe_clear) {
        if (length <= expected) {
            answer(r, Reply::data_exchange);
            plan.dx_error = true;  // "due after the answer" (4.13)
            return;
        }
        after_a_clk([](NaiveSlave& s) {
            s.cfg_fault = true;
            s.leave_master();
        });
        return answer(r, Reply::rr);
    }
    answer(r, Reply::data_exchange);
    after_a_clk([r, fail_safe_clear](NaiveSlave& s) {
        if (fail_safe_clear) s.outputs_cleared();
        else s.outputs_received(r.data);
        if ((s.mode1 & 0x20) != 0) {  // Res_User_WD
            s.user_wd = s.cell(0x18) | s.cell(0x19) << 8;
            s.mode1 &= ~0x20u;
        } else if (s.user_wd > 0 && --s.user_wd == 0) {
            s.plan.user_wd = true;
        }
    });
}

void NaiveSlave::outputs_received(const Octets& data) {
    const bool always = kind.mode_reg2 && (mode2 & 4) != 0;
    const bool on_change = kind.mode_reg3 && (mode3 & 2) != 0;
    if (data.empty()) {
        if (always && !on_change) set_irr(1u << 13);
        return;
    }
    bool changed = false;
    for (unsigned i = 0; i < data.size(); ++i) {
        if (ram[physical(0x1B + dout.u - 1, i)] != data[i]) changed = true;
        ram[physical(0x1B + dout.d - 1, i)] = data[i];
    }
    cleared[dout.d] = false;
    d_pending = true;
    if (sync_mode) return;
    shift_dout();
    if (!on_change || changed) set_irr(1u << 13);
}

// DX_Out of a clear obeys DX_Int_Mode like that of an exchange (5.1.3 of the manual, 3.12).
void NaiveSlave::outputs_cleared() {
    const bool always = kind.mode_reg2 && (mode2 & 4) != 0;
    clear_dout();
    if (cell(0x1A) != 0 || always) set_irr(1u << 13);
}

// D zeroed and shifted to N with the cleared mark.
void NaiveSlave::clear_dout() {
    for (unsigned i = 0; i < cell(0x1A); ++i) ram[physical(0x1B + dout.d - 1, i)] = 0;
    cleared[dout.d] = true;
    shift_dout();
}

// 4.5
void NaiveSlave::shift_dout() {
    d_pending = false;
    if (dout.f != 0) {
        dout.n = dout.d;
        dout.d = dout.f;
        dout.f = 0;
    } else {
        std::swap(dout.n, dout.d);
    }
}

void NaiveSlave::fetch_din() {
    if (din.n == 0) return;
    din.f = din.d;
    din.d = din.n;
    din.n = 0;
}

unsigned NaiveSlave::next_dout() {
    unsigned fresh = 0;
    if (dout.n != 0) {
        dout.f = dout.u;
        dout.u = dout.n;
        dout.n = 0;
        fresh = 4;
    }
    return (cleared[dout.u] ? 8u : 0u) | fresh | dout.u;
}

unsigned NaiveSlave::new_din() {
    if (din.f != 0) {
        din.n = din.u;
        din.u = din.f;
        din.f = 0;
    } else {
        std::swap(din.n, din.u);
    }
    din_given = true;
    const unsigned result = din.u;
    try_data_exch();
    return result;
}

}  // namespace oracle
