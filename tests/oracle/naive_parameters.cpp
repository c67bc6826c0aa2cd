// SPDX-License-Identifier: Apache-2.0
// The naive slave: parameters, configuration, address, control commands, LEAVE-MASTER and diagnosis (reference 3.3
// to 3.7, 3.9, 3.12, 3.13, 4.6, 4.7).
#include <algorithm>

#include "naive_slave.hpp"

namespace oracle {

// ---- Set_Prm, Set_Ext_Prm (3.4, 3.5) --------------------------------------------------------------------------------

unsigned NaiveSlave::aux_index(unsigned select_bit) const {
    if (kind.cfg_aux1_only && select_bit == 1) return 0;
    return (cell(0x2A) >> select_bit) & 1;
}

void NaiveSlave::store(unsigned pointer_cell, const Octets& data) {
    for (unsigned i = 0; i < data.size(); ++i) ram[physical(pointer_cell, i)] = data[i];
}

// 4.1: segment base plus offset.
unsigned NaiveSlave::physical(unsigned pointer_cell, unsigned offset) const {
    unsigned address = unsigned{ram[pointer_cell]} * (four_k() ? 16 : 8) + offset;
    if (kind.one_and_a_half_k) {
        address &= 0x7FF;
        return address >= 0x600 ? address - 0x400 : address;
    }
    return address & (four_k() ? 0xFFFu : 0x7FFu);
}

// 4.7: data go to the aux buffer whatever becomes of them, unless a telegram waits there.
void NaiveSlave::received_into_aux(unsigned select_bit, const Octets& data) {
    const unsigned aux = aux_index(select_bit);
    if (aux_waiting[aux] == Waiting::none) store(0x2B + aux, data);
}

void NaiveSlave::set_prm(const Octets& data, unsigned sa) {
    const bool special = (mode0 & 0x1000) != 0;
    if (special && prm_counter == 0) store(0x30, data);
    else if (!special) received_into_aux(0, data);

    const bool from_owner = static_cast<int>(sa) == owner;
    if (data.size() < 7) {  // 3.4.3 number 1
        if (owner >= 0 && !from_owner) return;
        prm_fault = true;
        if (dp != DpSm::wait_prm) leave_master();
        diag_changed();
        return;
    }
    const bool lock = (data[0] & 0x80) != 0, unlock = (data[0] & 0x40) != 0;
    const bool ident_ok = data[4] == cell(0x3B) && data[5] == cell(0x3A);
    if (!lock && !unlock) {  // 3.4.2
        if (data[3] != 0) min_tsdr = data[3];
        return;
    }
    if (owner >= 0 && !from_owner) return;
    if (unlock) {
        if (dp == DpSm::wait_prm) return;
        if (!ident_ok) prm_fault = true;
        leave_master();
        return;
    }
    if (prm_faulty(data)) {
        prm_fault = true;
        if (dp != DpSm::wait_prm) leave_master();
        diag_changed();
        return;
    }
    prm_taken(data, sa);
}

// 3.4.3, first failing line decides.
bool NaiveSlave::prm_faulty(const Octets& data) {
    const std::size_t length = data.size();
    const bool sync_supported = (mode0 & 0x40) != 0, freeze_supported = (mode0 & 0x80) != 0;
    if (data[4] != cell(0x3B) || data[5] != cell(0x3A)) return true;
    if ((data[0] & 0x08) != 0 && (data[1] == 0 || data[2] == 0)) return true;
    if (((data[0] & 0x20) != 0 && !sync_supported) || ((data[0] & 0x10) != 0 && !freeze_supported)) {
        not_supported = true;
        return true;
    }
    if (!kind.dpv1_status) return false;
    const bool spec_clear = (mode0 & 0x2000) != 0;
    if (length >= 8 && (data[7] & 0x80) != 0 && spec_clear && (data[7] & 0x40) == 0) return true;
    const bool check_reserved = (mode2 & 0x40) == 0;
    if (length >= 9 && check_reserved && (data[8] & 0x02) != 0) return true;
    if (length >= 10 && check_reserved && (data[9] & 0x60) != 0) return true;
    if (length >= 10 && (data[9] & 0x80) != 0 && (mode0 & 0x4000) == 0) return true;
    return length >= 10 && (data[9] & 0x10) != 0 && (mode2 & 0x10) == 0;
}

void NaiveSlave::prm_taken(const Octets& data, unsigned sa) {
    prm_fault = not_supported = cfg_fault = prm_req = false;
    owner = static_cast<int>(sa);
    wd_on = (data[0] & 0x08) != 0;
    if (data[3] != 0) min_tsdr = data[3];
    group_ident = data[6];
    if (data.size() > 7) {
        mode0 = (mode0 & ~7u) | (data[7] & 7u);
        if (kind.dpv1_status) {
            dpv1_enable = (data[7] & 0x80) != 0;
            fail_safe = (data[7] & 0x40) != 0;
            publisher = (data[7] & 0x20) != 0;
        }
    }
    if (wd_on) {
        wd_f1 = data[1];
        wd_f2 = data[2];
    }
    wd_base_1ms = (mode0 & 4) != 0;
    wd = wd_on ? WdSm::dp_control : WdSm::baud_control;
    load_watchdog();
    if (data.size() > 7) prm_indicated(data, false);
    if (dp == DpSm::wait_prm) dp = DpSm::wait_cfg;
    diag_changed();
}

// 4.7: exchange and indicate, or let it wait in the aux buffer.
void NaiveSlave::prm_indicated(const Octets& data, bool ext) {
    const unsigned length = static_cast<unsigned>(data.size());
    if (!ext && (mode0 & 0x1000) != 0) {
        ram[0x2F] = octet(length);
        prm_is_ext = false;
        prm_counter = 1;
        set_irr(1u << 11);
        return;
    }
    const unsigned aux = aux_index(0);
    store(0x2B + aux, data);
    if (prm_counter > 0) {
        prm_counter = 2;
        aux_waiting[aux] = ext ? Waiting::ext_prm : Waiting::prm;
        waiting_prm_len = length;
        return;
    }
    exchange_cells(0x30, 0x2B + aux);
    ram[0x2F] = octet(length);
    prm_is_ext = ext;
    prm_counter = 1;
    set_irr(ext ? 1u << 6 : 1u << 11);
}

// ---- Chk_Cfg (3.6) --------------------------------------------------------------------------------------------------

void NaiveSlave::chk_cfg(const Octets& data, unsigned sa) {
    const unsigned aux = aux_index(1);
    received_into_aux(1, data);
    if (dp == DpSm::wait_prm || static_cast<int>(sa) != owner) return;
    if (data.empty()) {
        cfg_fault = true;
        leave_master();
        return;
    }
    cfg_seen = true;
    store(0x2B + aux, data);
    if (cfg_counter > 0) {
        cfg_counter = 2;
        aux_waiting[aux] = Waiting::cfg;
        waiting_cfg_len = static_cast<unsigned>(data.size());
        return;
    }
    exchange_cells(0x32, 0x2B + aux);
    ram[0x31] = octet(static_cast<unsigned>(data.size()));
    cfg_counter = 1;
    set_irr(1u << 10);
}

// Reads of 0Eh, 0Fh, 10h, 11h (3.4.3, 3.6, 4.7).
unsigned NaiveSlave::acknowledge(bool prm, bool okay) {
    int& counter = prm ? prm_counter : cfg_counter;
    if (dp == DpSm::wait_prm || counter == 0) return 3;
    if (counter == 2) return acknowledge_conflict(prm);
    counter = 0;
    irr &= ~(prm ? (prm_is_ext ? 1u << 6 : 1u << 11) : 1u << 10);
    if (!okay) {
        (prm ? prm_fault : cfg_fault) = true;
        leave_master();
        return 0;
    }
    if (!prm) {
        if ((mode1 & 0x10) != 0) exchange_cells(0x32, 0x34);
        cfg_fault = false;
        cfg_okay = true;
        diag_changed();
    }
    try_data_exch();
    return 0;
}

unsigned NaiveSlave::acknowledge_conflict(bool prm) {
    for (unsigned aux = 0; aux < 2; ++aux) {
        const Waiting w = aux_waiting[aux];
        if (w == Waiting::none || (w == Waiting::cfg) == prm) continue;
        aux_waiting[aux] = Waiting::none;
        exchange_cells(prm ? 0x30 : 0x32, 0x2B + aux);
        ram[prm ? 0x2F : 0x31] = octet(prm ? waiting_prm_len : waiting_cfg_len);
        if (prm) {
            irr &= ~(prm_is_ext ? 1u << 6 : 1u << 11);
            prm_is_ext = w == Waiting::ext_prm;
            irr |= prm_is_ext ? 1u << 6 : 1u << 11;
        }
    }
    (prm ? prm_counter : cfg_counter) = 1;
    return 1;
}

// 3.13
void NaiveSlave::try_data_exch() {
    if (dp != DpSm::wait_cfg || !cfg_okay || prm_counter != 0 || cfg_counter != 0) return;
    if (kind.din_gates_data_exch && cell(0x1E) != 0 && !din_given) return;
    dp = DpSm::data_exch;
    user_wd = cell(0x18) | cell(0x19) << 8;
    diag_changed();
    set_irr(1u << 1);
}

// ---- Set_Slave_Add (3.3) --------------------------------------------------------------------------------------------

bool NaiveSlave::set_slave_add_valid(const Octets& data) const {
    return dp == DpSm::wait_prm && data.size() >= 4 && data[1] == cell(0x3B) && data[2] == cell(0x3A) &&
           data[0] <= 125 && cell(0x39) == 0;
}

void NaiveSlave::set_slave_add(const Octets& data) {
    const unsigned aux = aux_index(2);
    exchange_cells(0x2E, 0x2B + aux);
    ram[0x2D] = octet(static_cast<unsigned>(data.size()));
    plan.new_address = data[0];
    ram[0x39] = data[3] != 0 ? 0xFF : 0x00;
    ssa_busy = true;
    set_irr(1u << 9);
}

void NaiveSlave::take_address(int address) {
    ts = static_cast<unsigned>(address);
    ram[0x16] = octet(ts);
}

// ---- Global_Control (3.9, 4.4) --------------------------------------------------------------------------------------

void NaiveSlave::global_control(const Request& r) {
    if (dp != DpSm::data_exch || static_cast<int>(r.sa) != owner || r.data.size() != 2) return;
    const unsigned command = r.data[0], group = r.data[1];
    const bool check_reserved = !kind.mode_reg2 || (mode2 & 2) == 0;
    if (check_reserved && (command & 0xC1) != 0) return;
    if (group != 0 && (group & group_ident) == 0) return;
    if ((mode0 & 0x80) != 0) {  // Freeze_Supported
        if ((command & 0x04) != 0) {
            freeze_mode = false;
        } else if ((command & 0x08) != 0) {
            fetch_din();
            freeze_mode = true;
        }
    }
    if ((command & 0x02) != 0) outputs_cleared();
    if ((mode0 & 0x40) != 0 && (command & 0x30) != 0) {  // Sync_Supported
        if (d_pending) {
            shift_dout();
            set_irr(1u << 13);
        }
        sync_mode = (command & 0x10) == 0;
    }
    diag_changed();
    ram[0x3C] = octet(command);
    const bool every = !kind.gc_changed_only && (mode2 & 1) != 0;
    const bool command_only = kind.gc_changed_only || (mode3 & 1) != 0;
    const bool differs = command != gc_last_command || (!command_only && group != gc_last_group);
    gc_last_command = command;
    gc_last_group = group;
    if (every || differs) set_irr(1u << 8);
}

// ---- LEAVE-MASTER (3.12) --------------------------------------------------------------------------------------------

void NaiveSlave::leave_master() {
    if (dp == DpSm::data_exch) set_irr(1u << 1);
    dp = DpSm::wait_prm;
    owner = -1;
    outputs_cleared();
    sync_mode = freeze_mode = false;
    group_ident = 0;
    prm_req = true;
    wd_on = false;
    prm_counter = cfg_counter = 0;
    aux_waiting[0] = aux_waiting[1] = Waiting::none;
    cfg_okay = cfg_seen = din_given = false;
    irr &= ~(1u << 6 | 1u << 10 | 1u << 11);
    dpv1_enable = publisher = fail_safe = false;
    if (wd == WdSm::dp_control) {
        wd = WdSm::baud_control;
        load_watchdog();
    }
    mode1 &= ~8u;
    diag_reset_both();
}

// ---- diagnosis (3.7, 4.6) -------------------------------------------------------------------------------------------

Octets NaiveSlave::diag_header() const {
    const unsigned octet0 = (dp != DpSm::data_exch ? 2u : 0u) | (cfg_fault ? 4u : 0u) |
                            ((diag_control & 1) != 0 ? 8u : 0u) | (not_supported ? 0x10u : 0u) |
                            (prm_fault ? 0x40u : 0u);
    const unsigned octet1 = (prm_req ? 1u : 0u) | ((diag_control & 2) != 0 ? 2u : 0u) | 4u | (wd_on ? 8u : 0u) |
                            (freeze_mode ? 0x10u : 0u) | (sync_mode ? 0x20u : 0u);
    const unsigned octet2 = (diag_control & 4) != 0 ? 0x80u : 0u;
    return {octet(octet0), octet(octet1), octet(octet2), octet(owner < 0 ? 0xFFu : static_cast<unsigned>(owner)),
            ram[0x3B],     ram[0x3A]};
}

// Octets 0..5 of the chip's own buffer.
void NaiveSlave::diag_changed() {
    const Octets header = diag_header();
    const unsigned b = diag_owner[1] == 3 ? 1 : diag_owner[2] == 3 ? 2 : diag_owner[1] == 2 ? 1 : 2;
    for (unsigned i = 0; i < 6; ++i) ram[physical(0x26 + b - 1, i)] = header[i];
}

// At Start and LEAVE-MASTER: octets 1..5 of both buffers, octet 0 of the own one.
void NaiveSlave::diag_reset_both() {
    const Octets header = diag_header();
    for (unsigned b : {1u, 2u})
        for (unsigned i = 1; i < 6; ++i) ram[physical(0x26 + b - 1, i)] = header[i];
    diag_changed();
}

unsigned NaiveSlave::new_diag() {
    const unsigned user = diag_owner[1] == 1 ? 1 : diag_owner[2] == 1 ? 2 : 0;
    if (user == 0) return 0;
    const unsigned other = 3 - user;
    if (diag_owner[other] == 3) {
        diag_owner[user] = 2;
        diag_exchange_pending = true;
        return 0;
    }
    diag_exchanged(user, other);
    return other;
}

void NaiveSlave::diag_exchanged(unsigned new_chip, unsigned new_user) {
    diag_owner[new_chip] = 2;
    diag_owner[new_user] = 1;
    diag_control = ram[physical(0x26 + new_chip - 1, 0)] & 7u;
    diag_flag = true;
    diag_changed();
    set_irr(1u << 12);
}

}  // namespace oracle
