// SPDX-License-Identifier: Apache-2.0
// What firmware can get wrong before Start: findings about buffers and parameters (4.1, 6.1). Nothing is prevented.
#pragma once

#include <array>

#include <dpchip/chip/aux_buffers.hpp>

namespace dpchip::chip::start_checks {

/// A buffer as its pointer and length cells describe it. A control buffer is as long as the Aux-Buffer that
/// R_Aux_Buf_Sel assigns to its service.
struct BufferCells {
    std::uint16_t pointer, length;
    bool control = false;
    aux::Service service{};
};

namespace org = regmap::org;
// clang-format off
inline constexpr std::array<BufferCells, 14> kBuffers{{
    {org::r_dout_buf_ptr1,    org::r_len_dout_buf},      {org::r_dout_buf_ptr2, org::r_len_dout_buf}, {org::r_dout_buf_ptr3, org::r_len_dout_buf},
    {org::r_din_buf_ptr1,     org::r_len_din_buf},       {org::r_din_buf_ptr2,  org::r_len_din_buf},  {org::r_din_buf_ptr3,  org::r_len_din_buf},
    {org::r_diag_buf_ptr1,    org::r_len_diag_buf1},     {org::r_diag_buf_ptr2, org::r_len_diag_buf2},
    {org::r_aux_buf_ptr1,     org::r_len_cntrl_buf1},    {org::r_aux_buf_ptr2,  org::r_len_cntrl_buf2},
    {org::r_read_cfg_buf_ptr, org::r_len_read_cfg_data}, {org::r_cfg_buf_ptr,   0, true, aux::Service::cfg},
    {org::r_prm_buf_ptr,      0, true, aux::Service::prm}, {org::r_ssa_buf_ptr, 0, true, aux::Service::ssa},
}};
// clang-format on

struct Extent {
    unsigned first{}, octets{};
};

template <class C>
Extent extent(const C& c, const BufferCells& b) {
    const std::uint8_t segment = dpram::pointer(c.s, b.pointer);
    if (segment == 0) return {};
    const bool special = b.service == aux::Service::prm && (c.s.mode0 & regmap::mode0::spec_prm_buf_mode) != 0;
    const std::uint8_t control = special ? dpram::cell(c.s, org::r_len_spec_prm_buf) : aux::limit(c, b.service);
    return {dpram::base(c.s, segment), b.control ? control : dpram::cell(c.s, b.length)};
}

constexpr bool overlap(const Extent& a, const Extent& b) {
    return a.octets != 0 && b.octets != 0 && a.first < b.first + b.octets && b.first < a.first + a.octets;
}

template <class C>
void check_buffers(C& c) {
    std::array<Extent, kBuffers.size()> extents{};
    for (std::size_t i = 0; i < kBuffers.size(); ++i) {
        extents[i] = extent(c, kBuffers[i]);
        if (extents[i].octets != 0 && extents[i].first < regmap::kFirstBuffer)
            c.find(Rule::buffer_in_registers, kBuffers[i].pointer);
        for (std::size_t j = 0; j < i; ++j)
            if (overlap(extents[i], extents[j])) c.find(Rule::buffers_overlap, std::max(extents[i].first, extents[j].first));
    }
}

template <class C>
void run(C& c) {
    check_buffers(c);
    if (dpram::cell(c.s, org::r_len_cntrl_buf1) == 0 || dpram::pointer(c.s, org::r_aux_buf_ptr1) == 0) c.find(Rule::no_aux1, 0);
    if (dpram::cell(c.s, org::r_ts_adr) > 126) c.find(Rule::ts_out_of_range, dpram::cell(c.s, org::r_ts_adr));
    if ((c.s.mode0 & regmap::mode0::dp_mode) == 0) c.find(Rule::no_dp_mode, 0);
    if (c.traits->access_violation && (c.s.mode0 & regmap::mode0::set_ext_prm_supported) != 0) c.find(Rule::wd_test, 0);
}

}  // namespace dpchip::chip::start_checks
