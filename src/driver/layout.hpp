// SPDX-License-Identifier: Apache-2.0
// Where every buffer lies in the Dual-Port RAM: whole segments from 40H on, in the order of the vendor's drivers
// (VPC3+C 4.1, 6.1; reference 4.1, 4.14). constexpr: firmware can static_assert that its station fits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <dpchip/driver/config.hpp>
#include <dpchip/dp/cfg.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::driver {

constexpr std::uint16_t bytes(RamSize size) {
    switch (size) {
    case RamSize::bytes_1536: return 1536;
    case RamSize::bytes_2048: return 2048;
    case RamSize::bytes_4096: return 4096;
    }
    return 0;
}

/// Segments and lengths of all buffers. Segment 0 means: there is none.
struct Layout {
    ConfigError error = ConfigError::none;
    std::uint16_t ram_bytes{};
    std::uint16_t used_bytes{};               ///< first free address
    std::uint8_t shift{};                     ///< address = segment << shift
    std::uint8_t inputs{}, outputs{};         ///< octets that cfg says
    std::uint8_t max_inputs{}, max_outputs{}; ///< octets that the buffers hold
    std::uint8_t max_cfg{};
    std::uint8_t sap_list{};
    std::array<std::uint8_t, 3> dout{}, din{};
    std::array<std::uint8_t, 2> diag{};
    std::uint8_t cfg{}, read_cfg{}, prm{}, ssa{};
    std::array<std::uint8_t, 2> aux{};
    std::array<std::uint8_t, 2> aux_octets{};  ///< R_Len_Cntrl_Buf1, 2
    std::uint8_t aux_sel{};                    ///< R_Aux_Buf_Sel
    std::uint8_t prm_octets{}, cfg_octets{}, ssa_octets{};  ///< lengths of the control buffers

    constexpr std::uint16_t address(std::uint8_t segment) const { return static_cast<std::uint16_t>(segment << shift); }
};

namespace detail {

/// Hands out whole segments, and remembers the first buffer for which there was none.
class Allocator {
public:
    constexpr Allocator(Layout& layout, std::uint16_t first) : layout_{&layout}, next_{first} {}

    /// A buffer without octets takes no room; its segment is that of the next buffer, or the last of the RAM.
    constexpr std::uint8_t take(std::uint8_t octets, ConfigError error) {
        const std::uint32_t size = 1u << layout_->shift;
        const std::uint32_t room = (octets + size - 1u) & ~(size - 1u);
        if (layout_->error == ConfigError::none && next_ + room > layout_->ram_bytes) layout_->error = error;
        if (layout_->error != ConfigError::none) return 0;
        const std::uint32_t at = next_ < layout_->ram_bytes ? next_ : layout_->ram_bytes - size;
        next_ = static_cast<std::uint16_t>(next_ + room);
        return static_cast<std::uint8_t>(at >> layout_->shift);
    }
    constexpr std::uint16_t next() const { return next_; }

private:
    Layout* layout_;
    std::uint16_t next_;
};

constexpr ConfigError check_lengths(const Config& c) {
    if (c.address > 126) return ConfigError::address;
    if (c.address == 126 && !c.set_slave_add) return ConfigError::address_126;
    if (c.cfg.size() > dp::kMaxCfgOctets || (c.max_cfg != 0 && c.cfg.size() > c.max_cfg) || c.max_cfg > dp::kMaxCfgOctets)
        return ConfigError::cfg_too_long;
    if (c.cfg.empty() || !dp::cfg_totals(c.cfg, dp::CfgUse::get_cfg).ok()) return ConfigError::cfg_octets;
    if (c.max_inputs > dp::kMaxDirectionOctets) return ConfigError::inputs_too_long;
    if (c.max_outputs > dp::kMaxDirectionOctets) return ConfigError::outputs_too_long;
    if (c.max_prm < dp::kSetPrmHeader || c.max_prm > dp::kMaxSetPrm) return ConfigError::prm_length;
    if (c.prm_rules.min_octets + dp::kSetPrmHeader > c.max_prm) return ConfigError::prm_length;
    if (c.max_diag < 6 || c.max_diag > 244) return ConfigError::diag_length;
    if (c.set_slave_add && (c.max_ssa < 4 || c.max_ssa > 244)) return ConfigError::ssa_length;
    return ConfigError::none;
}

constexpr ConfigError check_chip(const Config& c) {
    const regmap::Traits& t = regmap::traits(c.variant);
    if (bytes(c.ram) != t.ram_bytes && bytes(c.ram) != t.max_ram_bytes) return ConfigError::ram_size;
    const bool has_mode2 = !t.access_violation;  // Mode Register 2: every VPC3+; Mode Register 3: B and C
    const bool has_mode3 = t.isom;
    if (c.set_ext_prm && !t.ext_prm) return ConfigError::not_in_this_chip;
    if ((c.prm_cmd_supported || c.sync_ena) && !has_mode3) return ConfigError::not_in_this_chip;
    if (c.user_timer != UserTimer::off && !t.user_timer) return ConfigError::not_in_this_chip;
    if (c.dx_int == DxInt::always && !has_mode2) return ConfigError::not_in_this_chip;
    if (c.dx_int == DxInt::on_change && !has_mode3) return ConfigError::not_in_this_chip;
    if ((c.gc_int == GcInt::every || c.gc_int == GcInt::changed) && !has_mode2) return ConfigError::not_in_this_chip;
    if (c.gc_int == GcInt::changed_command && has_mode2 && !has_mode3) return ConfigError::not_in_this_chip;
    if (c.set_ext_prm && (c.spec_prm_buf_mode || c.aux == AuxUse::all_on_1)) return ConfigError::ext_prm_buffers;
    return ConfigError::none;
}

/// Lengths of the control buffers: those exchanged with one Aux-Buffer are as long as it.
constexpr void size_control_buffers(const Config& c, Layout& l) {
    const std::uint8_t ssa = c.set_slave_add ? c.max_ssa : std::uint8_t{0};
    const std::uint8_t rest = std::max(l.max_cfg, ssa);
    const std::uint8_t all = std::max(rest, c.max_prm);
    namespace sel = regmap::aux_sel;
    if (c.spec_prm_buf_mode) {
        l.aux_octets = {rest, 0};
        l.prm_octets = c.max_prm;
    } else if (c.aux == AuxUse::all_on_1) {
        l.aux_octets = {all, 0};
        l.prm_octets = all;
    } else {
        const bool prm_first = c.aux == AuxUse::apart && !regmap::traits(c.variant).chk_cfg_aux1;
        l.aux_sel = prm_first ? sel::chk_cfg | sel::set_slave_adr : sel::set_prm;
        l.aux_octets = prm_first ? std::array{c.max_prm, rest} : std::array{rest, c.max_prm};
        l.prm_octets = c.max_prm;
    }
    l.cfg_octets = c.aux == AuxUse::all_on_1 && !c.spec_prm_buf_mode ? all : rest;
    l.ssa_octets = c.set_slave_add ? l.cfg_octets : std::uint8_t{0};
}

}  // namespace detail

/// Lays the buffers out. Look at `error` first: with one, segments are not valid.
constexpr Layout lay_out(const Config& c) {
    Layout l{};
    l.error = detail::check_chip(c);
    if (l.error == ConfigError::none) l.error = detail::check_lengths(c);
    if (l.error != ConfigError::none) return l;

    const dp::CfgTotals totals = dp::cfg_totals(c.cfg, dp::CfgUse::get_cfg);
    l.ram_bytes = bytes(c.ram);
    l.shift = c.ram == RamSize::bytes_4096 ? 4 : 3;
    l.inputs = static_cast<std::uint8_t>(totals.input_octets);
    l.outputs = static_cast<std::uint8_t>(totals.output_octets);
    l.max_inputs = std::max(l.inputs, c.max_inputs);
    l.max_outputs = std::max(l.outputs, c.max_outputs);
    l.max_cfg = std::max(c.max_cfg, static_cast<std::uint8_t>(c.cfg.size()));
    detail::size_control_buffers(c, l);

    detail::Allocator ram{l, regmap::kFirstBuffer};
    l.sap_list = ram.take(1, ConfigError::dout_space);
    for (std::uint8_t& s : l.dout) s = ram.take(l.max_outputs, ConfigError::dout_space);
    for (std::uint8_t& s : l.din) s = ram.take(l.max_inputs, ConfigError::din_space);
    for (std::uint8_t& s : l.diag) s = ram.take(c.max_diag, ConfigError::diag_space);
    l.cfg = ram.take(l.cfg_octets, ConfigError::cfg_space);
    l.read_cfg = ram.take(l.cfg_octets, ConfigError::cfg_space);
    l.prm = ram.take(l.prm_octets, ConfigError::prm_space);
    l.aux[0] = ram.take(l.aux_octets[0], ConfigError::aux_space);
    if (l.aux_octets[1] != 0) l.aux[1] = ram.take(l.aux_octets[1], ConfigError::aux_space);
    if (c.set_slave_add) l.ssa = ram.take(l.ssa_octets, ConfigError::ssa_space);
    l.used_bytes = ram.next();
    return l;
}

}  // namespace dpchip::driver
