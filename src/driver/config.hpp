// SPDX-License-Identifier: Apache-2.0
// What a station wants of its chip, and why it cannot have it (VPC3+C 4.3, 5.1, 6.1; reference 4.14).
#pragma once

#include <cstdint>
#include <span>

#include <dpchip/driver/prm_rules.hpp>
#include <dpchip/regmap/variant.hpp>

namespace dpchip::driver {

using regmap::Variant;

/// How much of its RAM the chip shall use.
enum class RamSize : std::uint8_t {
    bytes_1536,  ///< APC3, SPC3
    bytes_2048,  ///< every VPC3+
    bytes_4096,  ///< VPC3+B, VPC3+C: 4KB_Mode
};

/// Level of pin XINT/MOT: Motorola swaps the octets of the word registers.
enum class BusMode : std::uint8_t { intel, motorola };

/// How the processor learns of events.
enum class Service : std::uint8_t {
    interrupt,  ///< X/INT is wired: on_interrupt()
    polled,     ///< all masks stay set; poll() looks at the requests
};

/// When DX_Out comes (Mode Register 2 and 3).
enum class DxInt : std::uint8_t {
    with_outputs,  ///< after Data_Exchange when the station has outputs
    always,        ///< after every Data_Exchange; not on APC3 and SPC3
    on_change,     ///< when the outputs differ from those the user has; VPC3+B, VPC3+C
};

/// When New_GC_Command comes. APC3 and SPC3 know changed_command only.
enum class GcInt : std::uint8_t {
    chip_default,
    every,
    changed,          ///< Control_Command or Group_Select
    changed_command,  ///< Control_Command; on a VPC3+ only B and C
};

/// Which Aux-Buffer receives what (R_Aux_Buf_Sel).
enum class AuxUse : std::uint8_t {
    apart,     ///< Set_Prm by Aux 1, Chk_Cfg and Set_Slave_Add by Aux 2; on a VPC3+B as prm_on_2
    prm_on_2,  ///< Set_Prm by Aux 2, the others by Aux 1
    all_on_1,  ///< no Aux 2: every control buffer is as long as the longest
};

/// What to say to a Chk_Cfg that differs from the plugged modules.
enum class CfgPolicy : std::uint8_t {
    plugged,       ///< refuse
    follow_master, ///< take it, as long as its lengths fit into max_inputs and max_outputs
    as_parameterised, ///< refuse, unless Check_Cfg_Mode of DPV1_Status_2 asks for the user's own check: then follow_master
};

enum class UserTimer : std::uint8_t { off, ms_1, ms_10 };
enum class WdTimeBase : std::uint8_t { ms_10, ms_1 };
enum class EoiTime : std::uint8_t { us_1, ms_1 };
enum class IntPolarity : std::uint8_t { low, high };

/// How diagnoses follow each other.
enum class DiagDelivery : std::uint8_t {
    latest,  ///< a newer one replaces one that the master has not fetched yet
    each,    ///< the next one is handed over when the master has fetched the one before (static diagnosis excepted)
};

/// DP-V1: acyclic services and alarms (VPC3+B, VPC3+C). Everything is off unless asked for. Needs a driver made with it:
/// see dpv1.hpp.
struct AcyclicConfig {
    bool ms1 = false;                  ///< SAP 51 for the class-1 master: DS_Read, DS_Write, Alarm_Ack
    std::uint8_t ms1_max_data = 240;   ///< longest record there, 4..240: C1_Max_Data_Len
    bool alarm_sap = false;            ///< SAP 50 as well, for Alarm_Ack alone: Extra_Alarm_SAP_supp
    std::uint8_t connections = 0;      ///< class-2 connections, 0..49: C2_Max_Count_Channels
    std::uint8_t ms2_max_data = 240;   ///< longest record there, 4..240: C2_Max_Data_Len
    std::uint8_t max_initiate = 52;    ///< longest Initiate.req, 20..244: Max_Initiate_PDU_Length
    std::uint16_t send_timeout = 0;    ///< least Send_Timeout granted, 10 ms; the rate's own when that is longer
    std::uint8_t alarms = 0;           ///< alarm types that are raised: the bits of DPV1_Status_2
    std::uint8_t alarm_sequence = 0;   ///< alarms outstanding at a time, 2..32: Alarm_Sequence_Mode_Count; 0: one of each type
    std::uint8_t max_alarm = 0;        ///< longest alarm or status block, header included, 4..63; room for it is kept free behind
                                       ///< the other blocks of a diagnosis of max_diag octets. 0: there are none
    bool identification = false;       ///< I&M calls at index 255 are taken apart here

    constexpr bool any() const { return ms1 || alarm_sap || connections != 0 || alarms != 0 || max_alarm != 0; }
};

/// Everything configure() needs. Views must outlive the driver.
struct Config {
    Variant variant = Variant::vpc3c;
    RamSize ram = RamSize::bytes_2048;
    BusMode bus_mode = BusMode::intel;
    Service service = Service::interrupt;

    std::uint8_t address = 126;              ///< 0..126; 126 only with set_slave_add
    std::uint16_t ident = 0;
    std::span<const std::uint8_t> cfg{};     ///< configuration octets of the plugged modules: Get_Cfg, and what Chk_Cfg must equal
    CfgPolicy cfg_policy = CfgPolicy::plugged;
    std::uint8_t max_inputs = 0;             ///< octets to reserve when the master may change the lengths; at least cfg's
    std::uint8_t max_outputs = 0;
    std::uint8_t max_cfg = 0;                ///< longest Chk_Cfg taken; longer ones are answered RR. 0: as long as cfg
    std::uint8_t max_prm = 7;                ///< longest Set_Prm taken, 7..244
    std::uint8_t max_diag = 6;               ///< longest diagnosis, header included, 6..244
    PrmRules prm_rules{};

    bool set_slave_add = false;              ///< SAP 55 on
    bool no_add_change = false;              ///< the stored Real_No_Add_Change: the address may not be changed any more
    std::uint8_t max_ssa = 4;                ///< longest Set_Slave_Add taken, 4..244
    bool sync_supported = true;
    bool freeze_supported = true;
    bool fail_safe = false;                  ///< Spec_Clear_Mode: Data_Exchange without outputs clears them
    bool set_ext_prm = false;                ///< SAP 53 on: VPC3+B, VPC3+C
    bool spec_prm_buf_mode = false;          ///< Set_Prm without an Aux-Buffer
    bool prm_cmd_supported = false;          ///< Set_Prm may ask for PrmCmd (octet 9 bit 7): VPC3+B, VPC3+C
    bool sync_ena = false;                   ///< Set_Prm may ask for isochron mode (octet 9 bit 4); pin 13 is SYNC: VPC3+B, VPC3+C
    bool check_prm_reserved = true;          ///< the chip checks reserved bits of DPV1_Status_2 and 3
    bool check_gc_reserved = true;
    bool dis_start_control = false;          ///< until Set_Prm says otherwise
    bool dis_stop_control = false;
    AuxUse aux = AuxUse::apart;

    std::uint16_t user_watchdog = 0;         ///< Data_Exchange telegrams without a poll() until the chip leaves its master; 0: off
    std::uint8_t min_tsdr = 11;              ///< bit times
    std::uint8_t wd_baud_control = 0;        ///< the baud rate is given up after value * value * 10 ms; 0: the chip's reset value
    WdTimeBase wd_base = WdTimeBase::ms_10;  ///< until Set_Prm says otherwise
    DxInt dx_int = DxInt::with_outputs;
    GcInt gc_int = GcInt::chip_default;
    UserTimer user_timer = UserTimer::off;
    EoiTime eoi_time = EoiTime::us_1;
    IntPolarity int_polarity = IntPolarity::low;
    std::uint16_t masked = 0;                ///< interrupt bits that shall not raise X/INT; they are served all the same
    DiagDelivery diag_delivery = DiagDelivery::latest;
    bool test_ram = true;                    ///< write, read back and clear the whole RAM first
    AcyclicConfig dpv1{};
};

/// Why configure() refused. The *_too_long and *_space errors name the length that is at fault.
enum class ConfigError : std::uint8_t {
    none,
    no_chip,             ///< what stands at the address of the Status Register is none: a bus that nobody drives, a wrong base
    running,             ///< the chip is not Offline: go_offline() first
    ram_size,            ///< this chip has no such RAM
    ram_fault,           ///< the RAM test failed
    address,             ///< above 126
    address_126,         ///< 126 and no set_slave_add: the station could never be reached
    cfg_octets,          ///< cfg is not a configuration: damaged, empty, or more than 244 octets in a direction
    cfg_too_long,        ///< cfg is longer than 244 octets or than max_cfg
    inputs_too_long,     ///< max_inputs above 244
    outputs_too_long,    ///< max_outputs above 244
    prm_length,          ///< max_prm outside 7..244, or shorter than prm_rules ask for
    diag_length,         ///< max_diag outside 6..244
    ssa_length,          ///< max_ssa outside 4..244
    not_in_this_chip,    ///< set_ext_prm, prm_cmd_supported, sync_ena, dx_int, gc_int or user_timer ask for what the chip does not have
    ext_prm_buffers,     ///< set_ext_prm together with spec_prm_buf_mode, or without an Aux-Buffer of its own (7.1)
    dout_space,          ///< the RAM ends before the output buffers do: outputs
    din_space,           ///< inputs
    diag_space,          ///< max_diag
    cfg_space,           ///< max_cfg (or max_ssa, max_prm with all_on_1)
    prm_space,           ///< max_prm
    aux_space,           ///< max_prm, max_cfg, max_ssa: the Aux-Buffers
    ssa_space,           ///< max_ssa
    no_dpv1,             ///< dpv1 asks for something, and this driver was made without DP-V1
    record_length,       ///< dpv1: ms1_max_data or ms2_max_data outside 4..240
    initiate_length,     ///< dpv1: max_initiate outside 20..244
    connections,         ///< dpv1: more connections than SAPs, or than this driver was made for
    alarm_length,        ///< dpv1: max_alarm not 0 and outside 4..63, or longer than max_diag allows; alarms without max_alarm
    alarm_relation,      ///< dpv1: alarms or alarm_sap without ms1; alarm_sequence above 32
    acyclic_space,       ///< dpv1: the RAM ends before the SAP list and its buffers do
};

constexpr const char* name(ConfigError e) {
    switch (e) {
    case ConfigError::none: return "no error";
    case ConfigError::no_chip: return "no chip answers at this address";
    case ConfigError::running: return "the chip is not Offline";
    case ConfigError::ram_size: return "the chip has no RAM of this size";
    case ConfigError::ram_fault: return "the RAM test failed";
    case ConfigError::address: return "station address above 126";
    case ConfigError::address_126: return "station address 126 needs Set_Slave_Add";
    case ConfigError::cfg_octets: return "the configuration octets are damaged, or stand for more than 244 octets in a direction";
    case ConfigError::cfg_too_long: return "too many configuration octets";
    case ConfigError::inputs_too_long: return "more than 244 octets of inputs";
    case ConfigError::outputs_too_long: return "more than 244 octets of outputs";
    case ConfigError::prm_length: return "Set_Prm length out of range";
    case ConfigError::diag_length: return "diagnosis length out of range";
    case ConfigError::ssa_length: return "Set_Slave_Add length out of range";
    case ConfigError::not_in_this_chip: return "the chip does not have this function";
    case ConfigError::ext_prm_buffers: return "Set_Ext_Prm needs an Aux-Buffer shared with Set_Prm only";
    case ConfigError::dout_space: return "the RAM is too small for the outputs";
    case ConfigError::din_space: return "the RAM is too small for the inputs";
    case ConfigError::diag_space: return "the RAM is too small for the diagnosis";
    case ConfigError::cfg_space: return "the RAM is too small for the configuration";
    case ConfigError::prm_space: return "the RAM is too small for the parameters";
    case ConfigError::aux_space: return "the RAM is too small for the Aux-Buffers";
    case ConfigError::ssa_space: return "the RAM is too small for Set_Slave_Add";
    case ConfigError::no_dpv1: return "the driver was made without DP-V1";
    case ConfigError::record_length: return "record length outside 4 to 240 octets";
    case ConfigError::initiate_length: return "Initiate length outside 20 to 244 octets";
    case ConfigError::connections: return "too many class-2 connections";
    case ConfigError::alarm_length: return "alarm length out of range";
    case ConfigError::alarm_relation: return "alarms need the class-1 acyclic services, and at most 32 at a time";
    case ConfigError::acyclic_space: return "the RAM is too small for the SAP list and its buffers";
    }
    return "no error";
}

}  // namespace dpchip::driver
