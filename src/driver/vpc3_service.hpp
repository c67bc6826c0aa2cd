// SPDX-License-Identifier: Apache-2.0
// Vpc3: what is done about interrupts, and the exchange of inputs, outputs and diagnosis (VPC3+C 5.3, 6.2).
#pragma once

#include <dpchip/driver/vpc3.hpp>

namespace dpchip::driver {

template <BusPort Bus, class App, std::size_t N, class D>
std::uint16_t Vpc3<Bus, App, N, D>::poll() {
    if (state_ == State::unconfigured || state_ == State::offline) return 0;
    const Quiet quiet{*this};
    const std::uint16_t served = serve();
    // The status tells as well as MAC_Reset does, and needs no interrupt.
    if (state_ == State::going_offline) serve_offline();
    if (state_ == State::online) {
        if constexpr (kDpv1) finish_acyclic();
        if (!queue_.empty()) hand_over_diagnosis();
        feed_user_watchdog();
    }
    return served;
}

template <BusPort Bus, class App, std::size_t N, class D>
std::uint16_t Vpc3<Bus, App, N, D>::on_interrupt() {
    if (state_ == State::unconfigured) return 0;
    ++quiet_;  // what the application calls from here need not mask
    const std::uint16_t served = serve();
    if constexpr (kDpv1) finish_acyclic();
    if (state_ == State::online && !queue_.empty()) hand_over_diagnosis();
    --quiet_;
    write(ctl::mode_reg1_s, regmap::mode1::eoi);
    return served;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::feed_user_watchdog() {
    if (config_.user_watchdog != 0) write(ctl::mode_reg1_s, regmap::mode1::res_user_wd);
}

/// Acknowledges first and looks afterwards: an event that comes in between is seen by the next call.
template <BusPort Bus, class App, std::size_t N, class D>
std::uint16_t Vpc3<Bus, App, N, D>::serve() {
    const std::uint16_t pending = read_word(ctl::int_req_reg_low);
    const auto irr = static_cast<std::uint16_t>(pending & handled_), own = static_cast<std::uint16_t>(pending & app_->own_interrupts());
    if (own != 0) app_->serve_own(own);
    if (irr == 0) return own;
    const std::uint16_t ack = static_cast<std::uint16_t>(irr & ~unsigned{regmap::interrupt::by_acknowledgement});
    if (core::high(ack) != 0) write(ctl::int_ack_reg_high, core::high(ack));
    if (core::low(ack) != 0) write(ctl::int_ack_reg_low, core::low(ack));
    serve_requests(irr);
    serve_indications(irr);
    return static_cast<std::uint16_t>(irr | own);
}

/// Prm before Cfg (6.2.3), then the ones that belong to data exchange.
template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_requests(std::uint16_t irr) {
    namespace irq = regmap::interrupt;
    if ((irr & (irq::new_prm_data | irq::new_ext_prm_data)) != 0) serve_prm(irr);
    if ((irr & irq::new_cfg_data) != 0) serve_cfg();
    if ((irr & irq::go_leave_data_exch) != 0) {
        if (dp_state() == kDataExch) {
            if constexpr (kDpv1) note_cfg();
            app_->data_exch_entered();
        } else {
            prm_accepted_ = prm_accepted_ && dp_state() != 0;
            if constexpr (kDpv1) acyclic_.data_exch_left();
            app_->data_exch_left();
        }
    }
    if ((irr & irq::dx_out) != 0) {
        if constexpr (kDpv1)
            if (dp_state() == kDataExch) acyclic_.data_exchange();
        app_->dx_out();
    }
    if ((irr & irq::diag_buffer_changed) != 0) {
        hand_over_diagnosis();
        app_->diag_buffer_changed();
    }
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_indications(std::uint16_t irr) {
    namespace irq = regmap::interrupt;
    if ((irr & irq::wd_dp_control_timeout) != 0) app_->wd_dp_control_timeout();
    if ((irr & irq::baud_rate_detect) != 0) {
        const std::uint8_t code = baud_code();
        if constexpr (kDpv1) acyclic_.baud(code);
        app_->baud_rate_detect(code);
    }
    if ((irr & irq::new_gc_command) != 0) app_->new_gc_command(read(org::r_gc_command));
    if ((irr & irq::new_ssa_data) != 0) serve_ssa();
    if ((irr & irq::user_timer_clock) != 0) {
        if constexpr (kDpv1) acyclic_.tick(config_.user_timer == UserTimer::ms_1 ? 1 : 10);
        app_->user_timer_clock();
    }
    if constexpr (kDpv1) {
        if ((irr & irq::poll_end_ind) != 0) acyclic_.poll_end();
        if ((irr & irq::fdl_ind) != 0) acyclic_.fdl_ind();
    }
    if ((irr & irq::mac_reset) != 0) serve_offline();
}

/// The exchange moves these pointers: they are read again for every telegram.
template <BusPort Bus, class App, std::size_t N, class D>
auto Vpc3<Bus, App, N, D>::received(std::uint16_t pointer_cell, std::uint16_t length_cell) -> Octets {
    const std::size_t length = std::min<std::size_t>(read(length_cell), scratch_.size());
    const std::span<std::uint8_t> octets{scratch_.data(), length};
    bus_.read_block(layout_.address(read(pointer_cell)), octets);
    return octets;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_prm(std::uint16_t irr) {
    namespace irq = regmap::interrupt;
    namespace ack = regmap::acknowledge;
    for (int i = 0; i < kConflicts; ++i) {
        const Octets octets = received(org::r_prm_buf_ptr, org::r_len_prm_data);
        const bool okay = (irr & irq::new_prm_data) != 0 ? judge_prm(octets)
                                                         : app_->set_ext_prm(octets) == Verdict::accept;
        const std::uint8_t answer = read(okay ? ctl::user_prm_data_okay : ctl::user_prm_data_not_okay) & 3u;
        if (answer == ack::not_allowed) return;
        if (answer == ack::finished) {
            if ((irr & irq::new_prm_data) != 0 || !okay) prm_accepted_ = okay;
            if constexpr (kDpv1) {
                if (!okay) acyclic_.data_exch_left();
                else if ((irr & irq::new_prm_data) != 0) note_prm(octets);
            }
            return;
        }
        // Prm_Conflict: another telegram has taken the place of this one, perhaps of the other service.
        irr = read_word(ctl::int_req_reg_low);
    }
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::judge_prm(Octets octets) {
    const auto prm = dp::decode_set_prm(octets);
    const PrmFault fault = prm ? check(config_.prm_rules, prm->user_prm) : PrmFault::length;
    if (fault == PrmFault::none) return app_->set_prm(*prm) == Verdict::accept;
    app_->prm_refused(fault);
    return false;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_cfg() {
    namespace ack = regmap::acknowledge;
    for (int i = 0; i < kConflicts; ++i) {
        const bool okay = judge_cfg(received(org::r_cfg_buf_ptr, org::r_len_cfg_data));
        const std::uint8_t answer = read(okay ? ctl::user_cfg_data_okay : ctl::user_cfg_data_not_okay) & 3u;
        if (answer == ack::conflict) continue;  // judge the newer one
        if (answer == ack::finished && !okay) {
            prm_accepted_ = false;
            if constexpr (kDpv1) acyclic_.data_exch_left();
            app_->cfg_refused();
        }
        if constexpr (kDpv1)
            if (answer == ack::finished && okay) note_cfg();
        if (answer == ack::finished && okay && regmap::traits(config_.variant).din_gates_data_exch && inputs_ != 0)
            publish_inputs_again();
        return;
    }
}

/// A Set_Prm of seven octets raises no interrupt, so its missing user parameters are noticed here.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::judge_cfg(Octets octets) {
    if (config_.prm_rules.min_octets != 0 && !prm_accepted_) return false;
    const bool plugged = dp::cfg_matches(config_.cfg, octets);
    if (dp_state() != kDataExch) return (plugged || may_differ()) && take_cfg(octets, plugged);
    const bool same = following_ ? is_read_cfg(octets) : plugged;  // only the same one may be confirmed now (6.2.3)
    return same && app_->chk_cfg(octets, inputs_, outputs_) == Verdict::accept;
}

/// Whether a Chk_Cfg may differ from the plugged modules.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::may_differ() const {
    if (config_.cfg_policy == CfgPolicy::follow_master) return true;
    if constexpr (kDpv1) return config_.cfg_policy == CfgPolicy::as_parameterised && acyclic_.user_checks_cfg();
    return false;
}

/// Makes `octets`, or the plugged configuration they ask for, the present one: lengths and Read_Cfg_Buf.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::take_cfg(Octets octets, bool plugged) {
    const Octets taken = plugged ? config_.cfg : octets;
    const dp::CfgTotals totals = dp::cfg_totals(taken, dp::CfgUse::get_cfg);
    if (taken.empty() || !totals.ok() || totals.input_octets > layout_.max_inputs ||
        totals.output_octets > layout_.max_outputs)
        return false;
    const auto inputs = static_cast<std::uint8_t>(totals.input_octets);
    const auto outputs = static_cast<std::uint8_t>(totals.output_octets);
    if (app_->chk_cfg(octets, inputs, outputs) == Verdict::refuse) return false;
    if (!plugged || following_) {
        write(org::r_len_read_cfg_data, static_cast<std::uint8_t>(taken.size()));
        bus_.write_block(layout_.address(read(org::r_read_cfg_buf_ptr)), taken);
    }
    following_ = !plugged;
    adapt_lengths(inputs, outputs);
    return true;
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::is_read_cfg(Octets octets) {
    if (read(org::r_len_read_cfg_data) != octets.size()) return false;
    const std::uint16_t from = layout_.address(read(org::r_read_cfg_buf_ptr));
    for (std::size_t i = 0; i < octets.size(); ++i)
        if (bus_.read(static_cast<std::uint16_t>(from + i)) != octets[i]) return false;
    return true;
}

/// Octets that a longer buffer gains are old data: nobody else clears them (6.2.5).
template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::adapt_lengths(std::uint8_t inputs, std::uint8_t outputs) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (outputs > outputs_)
            fill(static_cast<std::uint16_t>(layout_.address(layout_.dout[i]) + outputs_), std::size_t{outputs} - outputs_, 0);
        if (inputs > inputs_)
            fill(static_cast<std::uint16_t>(layout_.address(layout_.din[i]) + inputs_), std::size_t{inputs} - inputs_, 0);
    }
    if (outputs != outputs_) write(org::r_len_dout_buf, outputs);
    if (inputs != inputs_) write(org::r_len_din_buf, inputs);
    outputs_ = outputs;
    inputs_ = inputs;
}

/// APC3: DATA-EXCH waits for a New_Din_Buffer_Cmd. The newest inputs are in N or, when the chip has taken them, in D.
template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::publish_inputs_again() {
    const std::uint8_t sm = read(ctl::din_buffer_sm);
    const std::uint8_t n = core::slice(sm, 2, 2), newest = n != 0 ? n : core::slice(sm, 0, 2);
    const std::span<std::uint8_t> octets{scratch_.data(), inputs_};
    if (newest == 0) return;
    bus_.read_block(layout_.address(layout_.din[newest - 1u]), octets);
    write_inputs(octets);
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_ssa() {
    const auto ssa = dp::decode_set_slave_add(received(org::r_ssa_buf_ptr, org::r_len_ssa_data));
    read(ctl::ssa_buffer_free_cmd);
    if (!ssa) return;
    address_ = ssa->address;
    if constexpr (kDpv1) acyclic_.address(address_);
    app_->new_ssa_data(*ssa);
}

/// After MAC_Reset, or because poll() wonders. An old MAC_Reset may show up after a new Start: the status decides.
template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::serve_offline() {
    if (state_ == State::offline || (read(ctl::status_reg_low) & regmap::status::passive_idle) != 0) return;
    state_ = State::offline;
    const bool again = restart_;
    if constexpr (kDpv1) acyclic_.offline();
    app_->offline();
    if (again && state_ == State::offline) start();
}

template <BusPort Bus, class App, std::size_t N, class D>
Outputs Vpc3<Bus, App, N, D>::fetch_outputs(std::span<std::uint8_t> out) {
    namespace nd = regmap::next_dout;
    if (state_ == State::unconfigured) return Outputs::unchanged;
    const std::uint8_t answer = read(ctl::next_dout_buffer_cmd);
    const std::uint8_t u = answer & nd::ind_u_buffer;
    if ((answer & nd::state_u_buffer) == 0 || u == 0) return Outputs::unchanged;
    bus_.read_block(layout_.address(layout_.dout[u - 1u]), out.first(std::min<std::size_t>(out.size(), outputs_)));
    return (answer & nd::u_buffer_cleared) != 0 ? Outputs::cleared : Outputs::fresh;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::write_inputs(std::span<const std::uint8_t> in) {
    if (state_ == State::unconfigured || state_ == State::offline || din_u_ == 0) return;
    const std::uint16_t to = layout_.address(layout_.din[din_u_ - 1u]);
    const std::size_t given = std::min<std::size_t>(in.size(), inputs_);
    bus_.write_block(to, in.first(given));
    fill(static_cast<std::uint16_t>(to + given), inputs_ - given, 0);
    din_u_ = read(ctl::new_din_buffer_cmd) & 3u;
}

template <BusPort Bus, class App, std::size_t N, class D>
DiagResult Vpc3<Bus, App, N, D>::set_diagnosis(std::span<const std::uint8_t> ext_diag, DiagFlags flags) {
    if (state_ == State::unconfigured) return DiagResult::not_ready;
    if (ext_diag.size() + 6 + (kDpv1 ? config_.dpv1.max_alarm : 0) > config_.max_diag) return DiagResult::too_long;
    const Quiet quiet{*this};
    latest_.assign(ext_diag, flags);
    has_diagnosis_ = true;
    if (state_ == State::online && queue_.empty() && write_diagnosis(latest_)) return DiagResult::handed_over;
    const bool kept = queue_.push(latest_);
    return kept ? DiagResult::queued : DiagResult::replaced;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::hand_over_diagnosis() {
    while (state_ == State::online && !queue_.empty() && write_diagnosis(queue_.front())) queue_.pop();
}

/// False when the user has no buffer, or has to wait until the master has fetched the diagnosis before.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::write_diagnosis(const detail::Diagnosis& d) {
    namespace owner = regmap::diag_owner;
    const std::uint8_t sm = read(ctl::diag_buffer_sm);
    const bool first = core::slice(sm, 0, 2) == owner::user, second = core::slice(sm, 2, 2) == owner::user;
    if (!first && !second) return false;
    const std::uint16_t mine = first ? 0 : 1;
    if (config_.diag_delivery == DiagDelivery::each) {
        const std::uint16_t other = layout_.address(layout_.diag[1u - mine]);
        const bool stat_diag = (bus_.read(static_cast<std::uint16_t>(other + 1)) & 0x02u) != 0;
        if (!stat_diag && (read(ctl::status_reg_low) & regmap::status::diag_flag) != 0) return false;
    }
    const std::uint16_t to = layout_.address(layout_.diag[mine]);
    bus_.write(to, d.flags);
    bus_.write_block(static_cast<std::uint16_t>(to + 6), d.data());
    std::size_t octets = std::size_t{6} + d.octets;
    if constexpr (kDpv1) {
        bus_.write_block(static_cast<std::uint16_t>(to + octets), acyclic_.block());
        octets += acyclic_.block().size();
        acyclic_.handed_over();
    }
    write(static_cast<std::uint16_t>(org::r_len_diag_buf1 + mine), static_cast<std::uint8_t>(octets));
    read(ctl::new_diag_buffer_cmd);
    return true;
}

}  // namespace dpchip::driver
