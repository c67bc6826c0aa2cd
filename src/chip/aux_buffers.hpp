// SPDX-License-Identifier: Apache-2.0
// Aux-Buffers and the exchange of pointers with the Prm-, Cfg- and SSA-Buffer (6.1, 6.2.1 to 6.2.3; reference 4.7).
//
// Data do not move: after an accepted telegram the Aux pointer and the target pointer change places, in the cells that
// the processor reads. A telegram whose predecessor is not acknowledged waits in its Aux-Buffer.
#pragma once

#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>

namespace dpchip::chip::aux {

/// Bit of R_Aux_Buf_Sel that selects the Aux-Buffer of a service.
enum class Service : std::uint8_t { prm = 0, cfg = 1, ssa = 2 };

struct Target {
    std::uint16_t pointer_cell;  ///< of the buffer the Aux-Buffer is exchanged with
    std::uint16_t length_cell;   ///< where the received length goes
    std::uint8_t sap;            ///< for the trace
};
constexpr Target target(Service service) {
    switch (service) {
    case Service::prm: return {regmap::org::r_prm_buf_ptr, regmap::org::r_len_prm_data, 61};
    case Service::cfg: return {regmap::org::r_cfg_buf_ptr, regmap::org::r_len_cfg_data, 62};
    case Service::ssa: break;
    }
    return {regmap::org::r_ssa_buf_ptr, regmap::org::r_len_ssa_data, 55};
}

/// 0: Aux 1, 1: Aux 2. VPC3+ step B takes Chk_Cfg through Aux 1 only (reference 10, item 16).
template <class C>
unsigned selected(const C& c, Service service) {
    if (service == Service::cfg && c.traits->chk_cfg_aux1) return 0;
    return core::bit(dpram::cell(c.s, regmap::org::r_aux_buf_sel), static_cast<unsigned>(service)) ? 1u : 0u;
}

constexpr std::uint16_t pointer_cell(unsigned index) {
    return static_cast<std::uint16_t>(regmap::org::r_aux_buf_ptr1 + index);
}

/// How long a telegram of this service may be.
template <class C>
std::uint8_t limit(const C& c, Service service) {
    return dpram::cell(c.s, static_cast<std::uint16_t>(regmap::org::r_len_cntrl_buf1 + selected(c, service)));
}

template <class C>
AuxUser waiting(const C& c, Service service) { return c.s.aux_waiting[selected(c, service)]; }

template <class C>
void store(C& c, Service service, std::span<const std::uint8_t> data) {
    dpram::write(c, dpram::pointer(c.s, pointer_cell(selected(c, service))), data);
}

/// Reception: the data reach a free Aux-Buffer whatever becomes of the telegram; one that waits there is not disturbed.
template <class C>
void receive(C& c, Service service, std::span<const std::uint8_t> data) {
    if (waiting(c, service) == AuxUser::none) store(c, service, data);
}

/// Swaps the Aux pointer and the target pointer and stores the received length.
template <class C>
void exchange(C& c, Service service, std::uint8_t length) {
    const Target to = target(service);
    const std::uint16_t from = pointer_cell(selected(c, service));
    const std::uint8_t filled = dpram::pointer(c.s, from), old = dpram::pointer(c.s, to.pointer_cell);
    dpram::set_pointer(c.s, from, old);
    dpram::set_pointer(c.s, to.pointer_cell, filled);
    dpram::set_cell(c.s, to.length_cell, length);
    c.fact(Fact::exchange, to.sap, static_cast<std::uint32_t>(old << 8 | filled));
}

template <class C>
void set_counter(C& c, Fact what, std::uint8_t& counter, std::uint8_t value) {
    change(c, what, counter, value);
}

constexpr std::uint16_t prm_interrupt(AuxUser kind) {
    return kind == AuxUser::ext_prm ? regmap::interrupt::new_ext_prm_data : regmap::interrupt::new_prm_data;
}

/// A Set_Prm or Set_Ext_Prm whose data go to the user: at once, or after the one before has been acknowledged.
template <class C>
void present_prm(C& c, AuxUser kind, std::span<const std::uint8_t> data) {
    const auto length = static_cast<std::uint8_t>(data.size());
    store(c, Service::prm, data);
    if (c.s.prm_counter != 0) {
        c.s.aux_waiting[selected(c, Service::prm)] = kind;
        c.s.waiting_prm_length = length;
        set_counter(c, Fact::prm_counter, c.s.prm_counter, 2);
        return;
    }
    exchange(c, Service::prm, length);
    c.s.prm_present = kind;
    set_counter(c, Fact::prm_counter, c.s.prm_counter, 1);
    irq::raise(c, prm_interrupt(kind));
}

/// The user has acknowledged parameters that a newer telegram has overtaken: the newer one is presented.
template <class C>
void present_waiting_prm(C& c) {
    AuxUser& slot = c.s.aux_waiting[selected(c, Service::prm)];
    irq::clear(c, prm_interrupt(c.s.prm_present));
    exchange(c, Service::prm, c.s.waiting_prm_length);
    c.s.prm_present = slot;
    slot = AuxUser::none;
    set_counter(c, Fact::prm_counter, c.s.prm_counter, 1);
    irq::set_by_user(c, prm_interrupt(c.s.prm_present));
}

template <class C>
void present_cfg(C& c, std::span<const std::uint8_t> data) {
    const auto length = static_cast<std::uint8_t>(data.size());
    store(c, Service::cfg, data);
    if (c.s.cfg_counter != 0) {
        c.s.aux_waiting[selected(c, Service::cfg)] = AuxUser::cfg;
        c.s.waiting_cfg_length = length;
        set_counter(c, Fact::cfg_counter, c.s.cfg_counter, 2);
        return;
    }
    exchange(c, Service::cfg, length);
    set_counter(c, Fact::cfg_counter, c.s.cfg_counter, 1);
    irq::raise(c, regmap::interrupt::new_cfg_data);
}

/// The interrupt stays set: there is a new configuration to look at.
template <class C>
void present_waiting_cfg(C& c) {
    exchange(c, Service::cfg, c.s.waiting_cfg_length);
    c.s.aux_waiting[selected(c, Service::cfg)] = AuxUser::none;
    set_counter(c, Fact::cfg_counter, c.s.cfg_counter, 1);
}

/// LEAVE-MASTER: nothing waits any more, and there is nothing to acknowledge.
template <class C>
void drop_all(C& c) {
    set_counter(c, Fact::prm_counter, c.s.prm_counter, 0);
    set_counter(c, Fact::cfg_counter, c.s.cfg_counter, 0);
    c.s.aux_waiting = {};
    c.s.prm_present = AuxUser::none;
    c.s.waiting_prm_length = c.s.waiting_cfg_length = 0;
    irq::clear(c, regmap::interrupt::by_acknowledgement);
}

}  // namespace dpchip::chip::aux
