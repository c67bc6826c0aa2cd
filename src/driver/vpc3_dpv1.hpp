// SPDX-License-Identifier: Apache-2.0
// Vpc3: where the cyclic and the acyclic half meet. Instantiated with DP-V1 only.
#pragma once

#include <dpchip/driver/vpc3.hpp>

namespace dpchip::driver {

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::tick(std::uint32_t ms) requires(D::present) {
    if (state_ != State::online) return;
    const Quiet quiet{*this};
    acyclic_.tick(ms);
    finish_acyclic();
    hand_over_diagnosis();
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::complete(const Handle& handle, const RecordAnswer& answer, std::span<const std::uint8_t> data) requires(D::present) {
    if (state_ != State::online) return false;
    const Quiet quiet{*this};
    return acyclic_.complete(handle, answer, data);
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::complete(const Handle& handle, const InitiateAnswer& answer) requires(D::present) {
    if (state_ != State::online) return false;
    const Quiet quiet{*this};
    return acyclic_.complete(handle, answer);
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::abort_connection(std::uint8_t sap, std::uint8_t reason) requires(D::present) {
    if (state_ != State::online) return false;
    const Quiet quiet{*this};
    return acyclic_.abort(sap, reason);
}

template <BusPort Bus, class App, std::size_t N, class D>
AlarmRaised Vpc3<Bus, App, N, D>::raise(const dp::AlarmStatus& alarm) requires(D::present) {
    if (state_ != State::online) return {AlarmResult::closed};
    const Quiet quiet{*this};
    const AlarmRaised raised = acyclic_.raise(alarm);
    finish_acyclic();
    hand_over_diagnosis();
    return raised;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::note_prm(Octets octets) requires(D::present) {
    if (const auto prm = dp::decode_set_prm(octets))
        acyclic_.prm_accepted({prm->dpv1_status_1(), prm->dpv1_status_2(), prm->dpv1_status_3()}, dp_state() == kDataExch);
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::note_cfg() requires(D::present) {
    if (const std::uint8_t master = owner(); master <= 126) acyclic_.cfg_accepted(master);
}

/// After every event and every call: what the acyclic half wants of the cyclic one.
template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::finish_acyclic() requires(D::present) {
    if (state_ != State::online) return;
    if (acyclic_.waits_for_fetch() && diag_fetched()) acyclic_.fetched();
    const auto demand = acyclic_.take_demand();
    if (demand.new_diagnosis && queue_.empty()) queue_.push(latest_);
    if (demand.leave_master) leave_master();
}

/// The newest diagnosis is the chip's, no exchange is pending, and Diag_Flag is down. Never true with Stat_Diag.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::diag_fetched() requires(D::present) {
    namespace owner = regmap::diag_owner;
    if ((read(ctl::status_reg_low) & regmap::status::diag_flag) != 0) return false;
    const std::uint8_t sm = read(ctl::diag_buffer_sm);
    return core::slice(sm, 0, 2) == owner::user || core::slice(sm, 2, 2) == owner::user;
}

/// The master's address, from the diagnosis in RAM: FFH without one (reference 10.11).
template <BusPort Bus, class App, std::size_t N, class D>
std::uint8_t Vpc3<Bus, App, N, D>::owner() requires(D::present) {
    const std::uint8_t first = bus_.read(static_cast<std::uint16_t>(layout_.address(layout_.diag[0]) + 3));
    if (first <= 126) return first;
    return bus_.read(static_cast<std::uint16_t>(layout_.address(layout_.diag[1]) + 3));
}

}  // namespace dpchip::driver
