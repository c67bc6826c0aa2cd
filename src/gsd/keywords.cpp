// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/keywords.hpp>

#include <unordered_map>
#include <unordered_set>

#include <dpchip/gsd/text.hpp>

namespace dpchip::gsd {
namespace {

using Find = Target (*)(Gsd&);
template <auto Member>
Target top(Gsd& g) {
    return &(g.*Member);
}
template <auto Member>
Target v1(Gsd& g) {
    return &(g.dpv1.*Member);
}
template <auto Member>
Target v2(Gsd& g) {
    return &(g.dpv2.*Member);
}

struct Scalar {
    const char* keyword;
    Find find;
};

// clang-format off
constexpr Scalar kScalars[]{
    {"GSD_Revision", top<&Gsd::gsd_revision>}, {"Vendor_Name", top<&Gsd::vendor_name>}, {"Model_Name", top<&Gsd::model_name>},
    {"Revision", top<&Gsd::revision>}, {"Protocol_Ident", top<&Gsd::protocol_ident>}, {"Station_Type", top<&Gsd::station_type>},
    {"Hardware_Release", top<&Gsd::hardware_release>}, {"Software_Release", top<&Gsd::software_release>},
    {"OrderNumber", top<&Gsd::order_number>}, {"Implementation_Type", top<&Gsd::implementation_type>}, {"Slave_Family", top<&Gsd::slave_family>},
    {"Bitmap_Device", top<&Gsd::bitmap_device>}, {"Bitmap_Diag", top<&Gsd::bitmap_diag>}, {"Bitmap_SF", top<&Gsd::bitmap_sf>},
    {"FMS_supp", top<&Gsd::fms>}, {"Redundancy", top<&Gsd::redundancy>}, {"Repeater_Ctrl_Sig", top<&Gsd::repeater_ctrl_sig>},
    {"24V_Pins", top<&Gsd::pins_24v>}, {"Freeze_Mode_supp", top<&Gsd::freeze_mode>}, {"Sync_Mode_supp", top<&Gsd::sync_mode>},
    {"Auto_Baud_supp", top<&Gsd::auto_baud>}, {"Set_Slave_Add_supp", top<&Gsd::set_slave_add>}, {"Fail_Safe", top<&Gsd::fail_safe>},
    {"Fail_Safe_required", top<&Gsd::fail_safe_required>}, {"Min_Slave_Intervall", top<&Gsd::min_slave_intervall>},
    {"Max_Diag_Data_Len", top<&Gsd::max_diag_data_len>}, {"Diag_Update_Delay", top<&Gsd::diag_update_delay>},
    {"Modular_Station", top<&Gsd::modular_station>}, {"FixPresetModules", top<&Gsd::fix_preset_modules>}, {"Max_Module", top<&Gsd::max_module>},
    {"Max_Input_Len", top<&Gsd::max_input_len>}, {"Max_Output_Len", top<&Gsd::max_output_len>}, {"Max_Data_Len", top<&Gsd::max_data_len>},
    {"Modul_Offset", top<&Gsd::modul_offset>}, {"User_Prm_Data_Len", top<&Gsd::user_prm_data_len>},
    {"Max_User_Prm_Data_Len", [](Gsd& g) -> Target { return &g.prm.length; }},
    {"X_Max_User_Prm_Data_Len", [](Gsd& g) -> Target { return &g.ext_prm.length; }},

    {"DPV1_Slave", v1<&DpV1::slave>}, {"C1_Read_Write_supp", v1<&DpV1::c1_read_write>}, {"C1_Read_Write_required", v1<&DpV1::c1_read_write_required>},
    {"C1_Max_Data_Len", v1<&DpV1::c1_max_data_len>}, {"C1_Response_Timeout", v1<&DpV1::c1_response_timeout>},
    {"C2_Read_Write_supp", v1<&DpV1::c2_read_write>}, {"C2_Read_Write_required", v1<&DpV1::c2_read_write_required>},
    {"C2_Max_Data_Len", v1<&DpV1::c2_max_data_len>}, {"C2_Response_Timeout", v1<&DpV1::c2_response_timeout>},
    {"C2_Max_Count_Channels", v1<&DpV1::c2_max_count_channels>}, {"Max_Initiate_PDU_Length", v1<&DpV1::max_initiate_pdu_length>},
    {"Diagnostic_Alarm_supp", v1<&DpV1::diagnostic_alarm>}, {"Process_Alarm_supp", v1<&DpV1::process_alarm>},
    {"Pull_Plug_Alarm_supp", v1<&DpV1::pull_plug_alarm>}, {"Status_Alarm_supp", v1<&DpV1::status_alarm>},
    {"Update_Alarm_supp", v1<&DpV1::update_alarm>}, {"Manufacturer_Specific_Alarm_supp", v1<&DpV1::manufacturer_specific_alarm>},
    {"Diagnostic_Alarm_required", v1<&DpV1::diagnostic_alarm_required>}, {"Process_Alarm_required", v1<&DpV1::process_alarm_required>},
    {"Pull_Plug_Alarm_required", v1<&DpV1::pull_plug_alarm_required>}, {"Status_Alarm_required", v1<&DpV1::status_alarm_required>},
    {"Update_Alarm_required", v1<&DpV1::update_alarm_required>},
    {"Manufacturer_Specific_Alarm_required", v1<&DpV1::manufacturer_specific_alarm_required>},
    {"Alarm_Type_Mode_supp", v1<&DpV1::alarm_type_mode>}, {"Alarm_Sequence_Mode_Count", v1<&DpV1::alarm_sequence_mode_count>},
    {"Extra_Alarm_SAP_supp", v1<&DpV1::extra_alarm_sap>}, {"WD_Base_1ms_supp", v1<&DpV1::wd_base_1ms>},
    {"Check_Cfg_Mode", v1<&DpV1::check_cfg_mode>}, {"Ident_Maintenance_supp", v1<&DpV1::ident_maintenance>},

    {"Publisher_supp", v2<&DpV2::publisher>}, {"Subscriber_supp", v2<&DpV2::subscriber>}, {"DXB_Max_Link_Count", v2<&DpV2::dxb_max_link_count>},
    {"DXB_Max_Data_Length", v2<&DpV2::dxb_max_data_length>}, {"DXB_Subscribertable_Block_Location", v2<&DpV2::dxb_subscribertable_block_location>},
    {"Isochron_Mode_supp", v2<&DpV2::isochron_mode>}, {"Isochron_Mode_required", v2<&DpV2::isochron_mode_required>},
    {"TBASE_DP", v2<&DpV2::tbase_dp>}, {"TDP_MIN", v2<&DpV2::tdp_min>}, {"TDP_MAX", v2<&DpV2::tdp_max>}, {"T_PLL_W_MAX", v2<&DpV2::t_pll_w_max>},
    {"TBASE_IO", v2<&DpV2::tbase_io>}, {"TI_MIN", v2<&DpV2::ti_min>}, {"TO_MIN", v2<&DpV2::to_min>},
    {"Prm_Block_Structure_supp", v2<&DpV2::prm_block_structure>}, {"Prm_Block_Structure_req", v2<&DpV2::prm_block_structure_required>},
    {"PrmCmd_supp", v2<&DpV2::prm_cmd>}, {"X_Prm_SAP_supp", v2<&DpV2::x_prm_sap>}, {"Time_Sync_supp", v2<&DpV2::time_sync>},
    {"Slave_Redundancy_supp", v2<&DpV2::slave_redundancy>}, {"Slave_Max_Switch_Over_Time", v2<&DpV2::slave_max_switch_over_time>},
};

// Keywords of the standard that Gsd keeps as they are.
constexpr const char* kStandard[]{
    "DPV1_Data_Types", "Value_Help", "X_Value_Help", "Unit_Diag_Area_Help", "Channel_Diag_Help",
    "Data_Area_Beg", "Area_Name", "Related_CFG_Identifier", "IO_Direction", "Length", "Consistency", "Publisher_Allowed", "DP_Master_Allowed",
    "Data_Type", "Data_Area_End", "Physical_Interface", "Transmission_Delay", "Reaction_Delay", "End_Physical_Interface",
    "F_Ext_User_Prm_Data_Const", "F_Ext_User_Prm_Data_Ref", "F_ParamDescCRC", "F_IO_StructureDescVersion", "F_IO_StructureDescCRC",
    "Max_iParameterSize", "Jokerblock_supp", "Jokerblock_Slot", "Jokerblock_Type", "Jokerblock_Location",
    // of masters
    "Download_supp", "Upload_supp", "Act_Para_Brct_supp", "Act_Param_supp", "Max_MPS_Length", "Max_Lsdu_MS", "Max_Lsdu_MM", "Def_Max_TTR_supp",
    "Min_Poll_Timeout", "Max_Slaves_supp", "Max_Master_Input_Len", "Max_Master_Output_Len", "Max_Master_Data_Len", "LAS_Len",
};

struct RateKeyword {
    Rate rate;
    bool tsdr;
};

template <class Value>
using Table = std::unordered_map<std::string, Value>;

const Table<Find>& scalars() {
    static const Table<Find> table = [] {
        Table<Find> t;
        for (const Scalar& s : kScalars) t.emplace(lower(s.keyword), s.find);
        return t;
    }();
    return table;
}
const Table<RateKeyword>& rate_keywords() {
    static const Table<RateKeyword> table = [] {
        Table<RateKeyword> t;
        for (std::size_t i = 0; i < kRates; ++i) {
            const auto rate = static_cast<Rate>(i);
            t.emplace(lower(std::string{name(rate)} + "_supp"), RateKeyword{rate, false});
            t.emplace(lower(std::string{"MaxTsdr_"} + name(rate)), RateKeyword{rate, true});
        }
        return t;
    }();
    return table;
}
// clang-format on

}  // namespace

std::optional<Target> scalar_target(Gsd& gsd, std::string_view key) {
    const std::string k{key};
    if (const auto found = scalars().find(k); found != scalars().end()) return found->second(gsd);
    if (const auto found = rate_keywords().find(k); found != rate_keywords().end()) {
        RateSupport& support = gsd.rates[static_cast<std::size_t>(found->second.rate)];
        return found->second.tsdr ? Target{&support.max_tsdr} : Target{&support.supported};
    }
    return std::nullopt;
}

bool is_standard_keyword(std::string_view key) {
    static const std::unordered_set<std::string> names = [] {
        std::unordered_set<std::string> s;
        for (const char* n : kStandard) s.insert(lower(n));
        return s;
    }();
    return names.contains(std::string{key});
}

}  // namespace dpchip::gsd
