// SPDX-License-Identifier: Apache-2.0
// Vpc3: initialisation, start and stop, in the order that existing firmware uses (reference 4.14, 10).
#pragma once

#include <dpchip/driver/vpc3.hpp>

namespace dpchip::driver {

/// Both states of the Status Register have codes 0 to 2; a bus that nobody drives reads FFH (5.2).
constexpr bool is_status(std::uint8_t low) {
    return ((low >> regmap::status::dp_state_lsb) & 3u) != 3u && ((low >> regmap::status::wd_state_lsb) & 3u) != 3u;
}

template <BusPort Bus, class App, std::size_t N, class D>
ConfigError Vpc3<Bus, App, N, D>::configure(const Config& config) {
    const Layout layout = lay_out(config);
    if (layout.error != ConfigError::none) return layout.error;
    if constexpr (kDpv1) {
        if (const ConfigError e = Engine::lay_out(config, layout).error; e != ConfigError::none) return e;
    } else if (config.dpv1.any()) return ConfigError::no_dpv1;
    const BusMode before = config_.bus_mode;
    config_.bus_mode = config.bus_mode;
    const std::uint8_t status = read(ctl::status_reg_low);
    if (!is_status(status) || (status & regmap::status::passive_idle) != 0) {
        config_.bus_mode = before;
        return is_status(status) ? ConfigError::running : ConfigError::no_chip;
    }
    state_ = State::unconfigured;
    config_ = config;
    layout_ = layout;
    inputs_ = layout.inputs;
    outputs_ = layout.outputs;
    address_ = config.address;
    if constexpr (kDpv1) acyclic_.configure(config.dpv1, Engine::lay_out(config, layout));
    restart_ = prm_accepted_ = following_ = has_diagnosis_ = false;
    queue_.clear();
    if (has_mode2()) write(ctl::mode_reg2, mode2());  // the RAM's size first: it acts at once
    if (config.test_ram && !(test_ram(0) && test_ram(0xFFFF))) return ConfigError::ram_fault;
    fill(org::first, layout_.ram_bytes - org::first, 0);
    write_registers();
    write_cells();
    bus_.write_block(layout_.address(layout_.read_cfg), config_.cfg);
    state_ = State::offline;
    return ConfigError::none;
}

/// A 16-bit counter over everything behind the registers, high octet first, so that no two cells look alike. `pattern`
/// inverts it, so that in two runs every bit is seen as 0 and as 1.
template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::test_ram(std::uint16_t pattern) {
    const std::uint16_t end = layout_.ram_bytes;
    std::uint16_t count = 0;
    for (std::uint16_t a = org::first; a < end; a = static_cast<std::uint16_t>(a + 2), ++count) {
        bus_.write(a, core::high(static_cast<std::uint16_t>(count ^ pattern)));
        bus_.write(static_cast<std::uint16_t>(a + 1), core::low(static_cast<std::uint16_t>(count ^ pattern)));
    }
    count = 0;
    for (std::uint16_t a = org::first; a < end; a = static_cast<std::uint16_t>(a + 2), ++count) {
        if (bus_.read(a) != core::high(static_cast<std::uint16_t>(count ^ pattern))) return false;
        if (bus_.read(static_cast<std::uint16_t>(a + 1)) != core::low(static_cast<std::uint16_t>(count ^ pattern))) return false;
    }
    return true;
}

template <BusPort Bus, class App, std::size_t N, class D>
std::uint8_t Vpc3<Bus, App, N, D>::mode2() const {
    namespace m = regmap::mode2;
    unsigned v = 0;
    if (config_.ram == RamSize::bytes_4096) v |= m::mode_4kb;
    if (!config_.check_prm_reserved && has_mode3()) v |= m::no_check_prm_reserved;
    if (config_.sync_ena) v |= m::sync_ena;
    if (config_.dx_int == DxInt::always) v |= m::dx_int_mode;
    if (!config_.check_gc_reserved) v |= m::no_check_gc_reserved;
    if (config_.gc_int == GcInt::chip_default || config_.gc_int == GcInt::every) v |= m::gc_int_mode;
    v |= app_->more_mode2();
    return static_cast<std::uint8_t>(v);
}

template <BusPort Bus, class App, std::size_t N, class D>
std::uint16_t Vpc3<Bus, App, N, D>::mode0() const {
    namespace m0 = regmap::mode0;
    const Config& c = config_;
    unsigned v = m0::dp_mode;
    if (c.dis_start_control) v |= m0::dis_start_control;
    if (c.dis_stop_control) v |= m0::dis_stop_control;
    if (c.wd_base == WdTimeBase::ms_1) v |= m0::wd_base;
    if (c.int_polarity == IntPolarity::high) v |= m0::int_pol;
    if (c.sync_supported) v |= m0::sync_supported;
    if (c.freeze_supported) v |= m0::freeze_supported;
    if (c.eoi_time == EoiTime::ms_1) v |= m0::eoi_time_base;
    if (c.user_timer == UserTimer::ms_10) v |= m0::user_time_base;
    if (c.set_ext_prm) v |= m0::set_ext_prm_supported;
    if (c.spec_prm_buf_mode) v |= m0::spec_prm_buf_mode;
    if (c.fail_safe) v |= m0::spec_clear_mode;
    if (c.prm_cmd_supported) v |= m0::prm_cmd_supported;
    v |= app_->more_mode0();
    return static_cast<std::uint16_t>(v);
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::write_registers() {
    namespace irq = regmap::interrupt;
    const Config& c = config_;
    handled_ = irq::mac_reset | irq::go_leave_data_exch | irq::baud_rate_detect | irq::wd_dp_control_timeout |
               irq::new_gc_command | irq::new_ssa_data | irq::new_cfg_data | irq::new_prm_data |
               irq::diag_buffer_changed | irq::dx_out;
    if (c.set_ext_prm) handled_ |= irq::new_ext_prm_data;
    if (c.user_timer != UserTimer::off) handled_ |= irq::user_timer_clock;
    if (kDpv1 && c.dpv1.any()) handled_ |= irq::poll_end_ind | irq::fdl_ind;
    const unsigned own = app_->own_interrupts();
    handled_ &= static_cast<std::uint16_t>(~own);
    imr_ = c.service == Service::polled ? std::uint16_t{0xFFFF}
                                        : static_cast<std::uint16_t>(~((handled_ | own) & ~unsigned{c.masked}));

    write_word(ctl::int_req_reg_low, 0);
    write_word(ctl::int_ack_reg_low, 0xFFFF);
    write(ctl::mode_reg1_r, 0xFF);
    write_word(ctl::mode_reg0_low, mode0());
    if (has_mode3()) {
        unsigned mode3 = 0;
        if (c.dx_int == DxInt::on_change) mode3 |= regmap::mode3::dx_int_mode_2;
        if (c.gc_int == GcInt::changed_command) mode3 |= regmap::mode3::gc_int_mode_ext;
        write(ctl::mode_reg3, static_cast<std::uint8_t>(mode3));
    }
    write_word(ctl::int_mask_reg_low, imr_);
    const std::uint8_t baud_control = regmap::traits(c.variant).baud_control_reset;
    write(ctl::wd_baud_control_val, c.wd_baud_control != 0 ? c.wd_baud_control : baud_control);
    write(ctl::min_tsdr_val, c.min_tsdr);
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::write_cells() {
    std::array<std::uint8_t, org::last - org::first + 1> cells{};
    const auto set = [&](std::uint16_t address, std::uint8_t value) { cells[at(address) - std::size_t{org::first}] = value; };
    const Layout& l = layout_;
    set(org::r_ts_adr, config_.address);
    set(org::sap_list_ptr, l.sap_list);
    if constexpr (kDpv1) set(org::sap_list_ptr, acyclic_.layout().list);
    set(org::r_user_wd_value_low, core::low(config_.user_watchdog));
    set(org::r_user_wd_value_high, core::high(config_.user_watchdog));
    set(org::r_len_dout_buf, outputs_);
    set(org::r_len_din_buf, inputs_);
    for (std::uint16_t i = 0; i < 3; ++i) {
        set(static_cast<std::uint16_t>(org::r_dout_buf_ptr1 + i), l.dout[i]);
        set(static_cast<std::uint16_t>(org::r_din_buf_ptr1 + i), l.din[i]);
    }
    for (std::uint16_t i = 0; i < 2; ++i) {
        set(static_cast<std::uint16_t>(org::r_len_diag_buf1 + i), 6);
        set(static_cast<std::uint16_t>(org::r_diag_buf_ptr1 + i), l.diag[i]);
        set(static_cast<std::uint16_t>(org::r_len_cntrl_buf1 + i), l.aux_octets[i]);
        set(static_cast<std::uint16_t>(org::r_aux_buf_ptr1 + i), l.aux[i]);
    }
    set(org::r_aux_buf_sel, l.aux_sel);
    set(org::r_ssa_buf_ptr, l.ssa);
    set(org::r_prm_buf_ptr, l.prm);
    set(org::r_cfg_buf_ptr, l.cfg);
    set(org::r_len_read_cfg_data, static_cast<std::uint8_t>(config_.cfg.size()));
    set(org::r_read_cfg_buf_ptr, l.read_cfg);
    set(org::r_real_no_add_change, config_.set_slave_add && !config_.no_add_change ? 0x00 : 0xFF);
    set(org::r_ident_low, core::low(config_.ident));
    set(org::r_ident_high, core::high(config_.ident));
    if (config_.spec_prm_buf_mode) set(org::r_len_spec_prm_buf, l.prm_octets);
    bus_.write(l.address(l.sap_list), 0xFF);  // an empty SAP list
    bus_.write_block(org::first, cells);
}

template <BusPort Bus, class App, std::size_t N, class D>
bool Vpc3<Bus, App, N, D>::start() {
    const Quiet quiet{*this};
    if (state_ != State::offline) return false;
    restart_ = prm_accepted_ = false;
    // Both diagnosis buffers start without user bits and data; what the user said last comes again below.
    for (std::uint16_t i = 0; i < 2; ++i) {
        bus_.write(layout_.address(layout_.diag[i]), 0);
        write(static_cast<std::uint16_t>(org::r_len_diag_buf1 + i), 6);
    }
    if (has_diagnosis_ && queue_.empty()) queue_.push(latest_);
    if constexpr (kDpv1) acyclic_.start(address_);
    write(ctl::mode_reg1_s, config_.user_watchdog != 0
                                ? std::uint8_t{regmap::mode1::start_vpc3 | regmap::mode1::res_user_wd}
                                : regmap::mode1::start_vpc3);
    din_u_ = core::slice(read(ctl::din_buffer_sm), 4, 2);
    state_ = State::online;
    hand_over_diagnosis();
    return true;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::go_offline() {
    const Quiet quiet{*this};
    restart_ = false;
    if (state_ != State::online) return;
    state_ = State::going_offline;
    write(ctl::mode_reg1_s, regmap::mode1::go_offline);
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::restart() {
    const Quiet quiet{*this};
    if (state_ == State::offline) { start(); return; }
    go_offline();
    restart_ = state_ == State::going_offline;
}

template <BusPort Bus, class App, std::size_t N, class D>
void Vpc3<Bus, App, N, D>::leave_master() {
    if (state_ == State::online) write(ctl::mode_reg1_s, regmap::mode1::user_leave_master);
}

}  // namespace dpchip::driver
