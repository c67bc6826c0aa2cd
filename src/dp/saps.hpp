// SPDX-License-Identifier: Apache-2.0
// Service access points of DP: numbers, services, names (reference 3.1, 5.3, 5.4).
#pragma once

#include <cstdint>

namespace dpchip::dp {

/// Stands for "no SAP octet in the telegram" (NIL, the default SAP). Never on the wire: SAP octets end at 3Fh.
inline constexpr std::uint8_t kDefaultSap = 0xFF;

// DSAPs of a slave.
inline constexpr std::uint8_t kSapResourceManager = 49;  ///< MS2 Initiate
inline constexpr std::uint8_t kSapAlarm = 50;            ///< MS1, Alarm_Ack only
inline constexpr std::uint8_t kSapMs1 = 51;              ///< MS1
inline constexpr std::uint8_t kSapSetExtPrm = 53;
inline constexpr std::uint8_t kSapSetSlaveAdd = 55;
inline constexpr std::uint8_t kSapRdInput = 56;
inline constexpr std::uint8_t kSapRdOutput = 57;
inline constexpr std::uint8_t kSapGlobalControl = 58;
inline constexpr std::uint8_t kSapGetCfg = 59;
inline constexpr std::uint8_t kSapSlaveDiag = 60;
inline constexpr std::uint8_t kSapSetPrm = 61;
inline constexpr std::uint8_t kSapChkCfg = 62;
inline constexpr std::uint8_t kLastMs2Sap = 48;  ///< MS2 connections live on 0..48

// SSAPs of a master.
inline constexpr std::uint8_t kMasterSapMs2 = 50;
inline constexpr std::uint8_t kMasterSapMs1 = 51;
inline constexpr std::uint8_t kMasterSapMasterMaster = 54;
inline constexpr std::uint8_t kMasterSap = 62;  ///< MS0: all services of SAPs 53 and 55..62

/// What a request to a slave's SAP asks for.
enum class Service : std::uint8_t {
    data_exchange,
    set_ext_prm,
    set_slave_add,
    rd_input,
    rd_output,
    global_control,
    get_cfg,
    slave_diag,
    set_prm,
    chk_cfg,
    ms1,               ///< DS_Read, DS_Write, Alarm_Ack
    ms1_alarm,         ///< Alarm_Ack on SAP 50
    resource_manager,  ///< MS2 Initiate
    ms2,               ///< an MS2 connection
    none,              ///< SAPs that no slave has: 52, 54, 63 and above
};

/// The service behind a slave's DSAP; kDefaultSap is Data_Exchange.
constexpr Service service(std::uint8_t dsap) {
    switch (dsap) {
    case kDefaultSap: return Service::data_exchange;
    case kSapResourceManager: return Service::resource_manager;
    case kSapAlarm: return Service::ms1_alarm;
    case kSapMs1: return Service::ms1;
    case kSapSetExtPrm: return Service::set_ext_prm;
    case kSapSetSlaveAdd: return Service::set_slave_add;
    case kSapRdInput: return Service::rd_input;
    case kSapRdOutput: return Service::rd_output;
    case kSapGlobalControl: return Service::global_control;
    case kSapGetCfg: return Service::get_cfg;
    case kSapSlaveDiag: return Service::slave_diag;
    case kSapSetPrm: return Service::set_prm;
    case kSapChkCfg: return Service::chk_cfg;
    default: return dsap <= kLastMs2Sap ? Service::ms2 : Service::none;
    }
}

/// The service's name as the standard writes it.
constexpr const char* name(Service s) {
    switch (s) {
    case Service::data_exchange: return "Data_Exchange";
    case Service::set_ext_prm: return "Set_Ext_Prm";
    case Service::set_slave_add: return "Set_Slave_Add";
    case Service::rd_input: return "RD_Input";
    case Service::rd_output: return "RD_Output";
    case Service::global_control: return "Global_Control";
    case Service::get_cfg: return "Get_Cfg";
    case Service::slave_diag: return "Slave_Diag";
    case Service::set_prm: return "Set_Prm";
    case Service::chk_cfg: return "Chk_Cfg";
    case Service::ms1: return "MS1";
    case Service::ms1_alarm: return "MS1 Alarm_Ack";
    case Service::resource_manager: return "MS2 Resource_Manager";
    case Service::ms2: return "MS2";
    case Service::none: break;
    }
    return "no service";
}

}  // namespace dpchip::dp
