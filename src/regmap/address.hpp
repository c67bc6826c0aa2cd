// SPDX-License-Identifier: Apache-2.0
// Addresses and bits by the manual's names, for code that knows which cell it wants (VPC3+C 4.2, 4.3, 5.1 to 5.3).
#pragma once

#include <cstdint>

namespace dpchip::regmap {

/// Control parameters 00H..15H, Intel addresses. Read side and write side differ.
namespace control {
inline constexpr std::uint16_t int_req_reg_low = 0x00, int_req_reg_high = 0x01;      // read; write sets
inline constexpr std::uint16_t int_reg_low = 0x02, int_reg_high = 0x03;              // read
inline constexpr std::uint16_t int_ack_reg_low = 0x02, int_ack_reg_high = 0x03;      // write
inline constexpr std::uint16_t status_reg_low = 0x04, status_reg_high = 0x05;        // read
inline constexpr std::uint16_t int_mask_reg_low = 0x04, int_mask_reg_high = 0x05;    // write
inline constexpr std::uint16_t mode_reg0_low = 0x06, mode_reg0_high = 0x07;
inline constexpr std::uint16_t din_buffer_sm = 0x08, mode_reg1_s = 0x08;             // read, write
inline constexpr std::uint16_t new_din_buffer_cmd = 0x09, mode_reg1_r = 0x09;
inline constexpr std::uint16_t dout_buffer_sm = 0x0A, wd_baud_control_val = 0x0A;
inline constexpr std::uint16_t next_dout_buffer_cmd = 0x0B, min_tsdr_val = 0x0B;
inline constexpr std::uint16_t diag_buffer_sm = 0x0C, mode_reg2 = 0x0C;
inline constexpr std::uint16_t new_diag_buffer_cmd = 0x0D, sync_pw_reg = 0x0D;
inline constexpr std::uint16_t user_prm_data_okay = 0x0E, control_command_reg = 0x0E;
inline constexpr std::uint16_t user_prm_data_not_okay = 0x0F, group_select_reg = 0x0F;
inline constexpr std::uint16_t user_cfg_data_okay = 0x10;
inline constexpr std::uint16_t user_cfg_data_not_okay = 0x11;
inline constexpr std::uint16_t dxbout_buffer_sm = 0x12, mode_reg3 = 0x12;
inline constexpr std::uint16_t next_dxbout_buffer_cmd = 0x13;
inline constexpr std::uint16_t ssa_buffer_free_cmd = 0x14;
inline constexpr std::uint16_t mode_reg1 = 0x15;                                     // read
inline constexpr std::uint16_t count = 0x16;
}  // namespace control

/// Organizational parameters 16H..3FH: plain RAM, read and written.
namespace org {
inline constexpr std::uint16_t r_ts_adr = 0x16, sap_list_ptr = 0x17, r_user_wd_value_low = 0x18, r_user_wd_value_high = 0x19;
inline constexpr std::uint16_t r_len_dout_buf = 0x1A, r_dout_buf_ptr1 = 0x1B, r_dout_buf_ptr2 = 0x1C, r_dout_buf_ptr3 = 0x1D;
inline constexpr std::uint16_t r_len_din_buf = 0x1E, r_din_buf_ptr1 = 0x1F, r_din_buf_ptr2 = 0x20, r_din_buf_ptr3 = 0x21;
inline constexpr std::uint16_t r_len_dxbout_buf = 0x22, r_dxbout_buf_ptr1 = 0x23;
inline constexpr std::uint16_t r_len_diag_buf1 = 0x24, r_len_diag_buf2 = 0x25, r_diag_buf_ptr1 = 0x26, r_diag_buf_ptr2 = 0x27;
inline constexpr std::uint16_t r_len_cntrl_buf1 = 0x28, r_len_cntrl_buf2 = 0x29, r_aux_buf_sel = 0x2A;
inline constexpr std::uint16_t r_aux_buf_ptr1 = 0x2B, r_aux_buf_ptr2 = 0x2C;
inline constexpr std::uint16_t r_len_ssa_data = 0x2D, r_ssa_buf_ptr = 0x2E, r_len_prm_data = 0x2F, r_prm_buf_ptr = 0x30;
inline constexpr std::uint16_t r_len_cfg_data = 0x31, r_cfg_buf_ptr = 0x32, r_len_read_cfg_data = 0x33, r_read_cfg_buf_ptr = 0x34;
inline constexpr std::uint16_t r_len_dxb_link_buf = 0x35, r_dxb_link_buf_ptr = 0x36;
inline constexpr std::uint16_t r_len_dxb_status_buf = 0x37, r_dxb_status_buf_ptr = 0x38;
inline constexpr std::uint16_t r_real_no_add_change = 0x39, r_ident_low = 0x3A, r_ident_high = 0x3B;
inline constexpr std::uint16_t r_gc_command = 0x3C, r_len_spec_prm_buf = 0x3D;
inline constexpr std::uint16_t r_dxbout_buf_ptr2 = 0x3E, r_dxbout_buf_ptr3 = 0x3F;
inline constexpr std::uint16_t first = 0x16, last = 0x3F;
}  // namespace org

inline constexpr std::uint16_t kFirstBuffer = 0x40;

/// Interrupt bits, the same in IRR, IR, IMR and IAR (5.3.1).
namespace interrupt {
inline constexpr std::uint16_t mac_reset = 1u << 0, clock_sync = 1u << 0, go_leave_data_exch = 1u << 1;
inline constexpr std::uint16_t baud_rate_detect = 1u << 2, wd_dp_control_timeout = 1u << 3, user_timer_clock = 1u << 4;
inline constexpr std::uint16_t dxb_link_error = 1u << 5, new_ext_prm_data = 1u << 6, dxb_out = 1u << 7;
inline constexpr std::uint16_t new_gc_command = 1u << 8, new_ssa_data = 1u << 9, new_cfg_data = 1u << 10, new_prm_data = 1u << 11;
inline constexpr std::uint16_t diag_buffer_changed = 1u << 12, dx_out = 1u << 13, poll_end_ind = 1u << 14, fdl_ind = 1u << 15;
/// Not clearable through the IAR: the user's acknowledgement clears them (5.3.2).
inline constexpr std::uint16_t by_acknowledgement = new_ext_prm_data | new_cfg_data | new_prm_data;
}  // namespace interrupt

/// Mode Register 0, both octets as one word (5.1.1).
namespace mode0 {
inline constexpr std::uint16_t dis_start_control = 1u << 0, dis_stop_control = 1u << 1, wd_base = 1u << 2, cs_supported = 1u << 3;
inline constexpr std::uint16_t min_tsdr = 1u << 3;  // APC3: combi operation
inline constexpr std::uint16_t int_pol = 1u << 4, early_rdy = 1u << 5, sync_supported = 1u << 6, freeze_supported = 1u << 7;
inline constexpr std::uint16_t dp_mode = 1u << 8, eoi_time_base = 1u << 9, user_time_base = 1u << 10, set_ext_prm_supported = 1u << 11;
inline constexpr std::uint16_t spec_prm_buf_mode = 1u << 12, spec_clear_mode = 1u << 13, prm_cmd_supported = 1u << 14;
}  // namespace mode0

/// Mode Register 1 (5.1.2).
namespace mode1 {
inline constexpr std::uint8_t start_vpc3 = 1u << 0, eoi = 1u << 1, go_offline = 1u << 2, user_leave_master = 1u << 3;
inline constexpr std::uint8_t en_change_cfg_buffer = 1u << 4, res_user_wd = 1u << 5;
}  // namespace mode1

/// Mode Register 2 (5.1.3).
namespace mode2 {
inline constexpr std::uint8_t gc_int_mode = 1u << 0, no_check_gc_reserved = 1u << 1, dx_int_mode = 1u << 2, dx_int_port = 1u << 3;
inline constexpr std::uint8_t sync_ena = 1u << 4, sync_pol = 1u << 5, no_check_prm_reserved = 1u << 6, mode_4kb = 1u << 7;
}  // namespace mode2

/// Mode Register 3 (5.1.4).
namespace mode3 {
inline constexpr std::uint8_t gc_int_mode_ext = 1u << 0, dx_int_mode_2 = 1u << 1;
}  // namespace mode3

/// Status Register, both octets as one word (5.2).
namespace status {
inline constexpr std::uint16_t passive_idle = 1u << 0, diag_flag = 1u << 2, ram_access_violation = 1u << 3;
inline constexpr unsigned dp_state_lsb = 4, wd_state_lsb = 6, baud_lsb = 8, release_lsb = 12;
}  // namespace status

/// R_Aux_Buf_Sel (6.1): 1 = Aux 2.
namespace aux_sel {
inline constexpr std::uint8_t set_prm = 1u << 0, chk_cfg = 1u << 1, set_slave_adr = 1u << 2;
}  // namespace aux_sel

/// What 0EH, 0FH, 10H and 11H return (6.2.2, 6.2.3).
namespace acknowledge {
inline constexpr std::uint8_t finished = 0, conflict = 1, not_allowed = 3;
}  // namespace acknowledge

/// Diag_Buffer_SM codes (6.2.4).
namespace diag_owner {
inline constexpr std::uint8_t nil = 0, user = 1, vpc3 = 2, vpc3_send_mode = 3;
}  // namespace diag_owner

/// Next_Dout_Buffer_Cmd result bits (6.2.5).
namespace next_dout {
inline constexpr std::uint8_t ind_u_buffer = 3, state_u_buffer = 4, u_buffer_cleared = 8;
}  // namespace next_dout

/// DP-V1 buffer header, control octet (7.2.1).
namespace buffer_control {
inline constexpr std::uint8_t user = 0x80, ind = 0x40, resp = 0x20, inuse = 0x10;
}  // namespace buffer_control

}  // namespace dpchip::regmap
