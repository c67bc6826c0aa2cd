// SPDX-License-Identifier: Apache-2.0
// A GSD file as a value (reference 7.1). All texts are UTF-8. Read it with parse.hpp; plug modules with
// configuration.hpp; build and check parameters with user_prm.hpp; show it with describe.hpp.
//
// Not interpreted, but kept as keywords: masters' files, PROFIsafe and function block parts, physical interfaces,
// data areas of modules, firmware versions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/diagnostic.hpp>

namespace dpchip::gsd {

// ---- rates --------------------------------------------------------------------------------------------------------

/// Transmission rates a GSD can name, slowest first.
enum class Rate : std::uint8_t {
    kbit_9_6,
    kbit_19_2,
    kbit_31_25,
    kbit_45_45,
    kbit_93_75,
    kbit_187_5,
    kbit_500,
    mbit_1_5,
    mbit_3,
    mbit_6,
    mbit_12
};
inline constexpr std::size_t kRates = 11;

/// As the keywords write it: "9.6" .. "12M".
const char* name(Rate rate);
/// Nominal bit/s; 45.45 kbit/s is 45450 here and 500000/11 exactly on the line.
std::uint32_t bits_per_second(Rate rate);

struct RateSupport {
    bool supported{};
    std::optional<std::uint16_t> max_tsdr{};  ///< bit times
};

// ---- parameters ---------------------------------------------------------------------------------------------------

enum class DataType : std::uint8_t { bit, bit_area, unsigned8, unsigned16, unsigned32, signed8, signed16, signed32 };
/// "Bit", "BitArea", "Unsigned8", ...
const char* name(DataType type);
/// Octets in the user parameters: 1, 2 or 4.
std::size_t octets(DataType type);

struct ValueRange {
    std::int64_t min{};
    std::int64_t max{};

    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

/// ExtUserPrmData: a parameter definition, referred to by number.
struct Parameter {
    std::int64_t number{};
    std::string name;
    DataType type{DataType::unsigned8};
    std::uint8_t first_bit{};  ///< bit and bit_area only, 0..7
    std::uint8_t last_bit{};
    std::int64_t default_value{};
    std::vector<ValueRange> allowed;         ///< a value list is ranges of one value; empty: all the type holds
    std::optional<std::int64_t> text_ref{};  ///< Prm_Text_Ref
    bool changeable{true};                   ///< revision 5: Changeable
    bool visible{true};                      ///< revision 5: Visible
    Position at{};

    bool allows(std::int64_t value) const;
};

/// PrmText: names of values.
struct PrmText {
    std::int64_t number{};
    std::map<std::int64_t, std::string> texts;
};

/// Ext_User_Prm_Data_Const(offset).
struct PrmConst {
    std::uint16_t offset{};
    std::vector<std::uint8_t> octets;
};

/// Ext_User_Prm_Data_Ref(offset) = number of a Parameter.
struct PrmRef {
    std::uint16_t offset{};
    std::int64_t number{};
    Position at{};
};

/// Parameters of the device or of a module. Offsets count from its own first octet.
struct UserPrm {
    /// Max_User_Prm_Data_Len of the device, Ext_Module_Prm_Data_Len of a module.
    std::optional<std::uint16_t> length{};
    std::vector<PrmConst> constants;
    std::vector<PrmRef> refs;

    bool empty() const { return constants.empty() && refs.empty(); }
};

// ---- diagnosis texts ----------------------------------------------------------------------------------------------

/// Unit_Diag_Bit, Unit_Diag_Not_Bit: the text of a bit of the device-related block's data (bit 0 = bit 0 of its
/// first octet behind the header).
struct DiagBitText {
    std::uint32_t bit{};
    std::string text;
    std::string help;  ///< Unit_Diag_Bit_Help
};

/// Unit_Diag_Area: names of the values of a group of bits.
struct DiagArea {
    std::uint32_t first_bit{};
    std::uint32_t last_bit{};
    std::map<std::int64_t, std::string> values;
};

struct DiagTexts {
    std::vector<DiagBitText> bits;
    std::vector<DiagBitText> not_bits;  ///< said while the bit is 0
    std::vector<DiagArea> areas;
    std::map<std::int64_t, std::string> channel;  ///< Channel_Diag: error types 16..31

    /// All texts in here, values of areas included.
    std::size_t size() const;
};

/// UnitDiagType=t .. EndUnitDiagType: texts of the device-related blocks whose octet 1 is `type` (DP-V1).
struct UnitDiagType {
    std::int64_t type{};
    DiagTexts texts;
};

// ---- modules ------------------------------------------------------------------------------------------------------

struct Module {
    std::string name;                         ///< blanks at its ends removed
    std::vector<std::uint8_t> cfg;            ///< configuration octets
    std::optional<std::int64_t> reference{};  ///< Module_Reference
    std::uint16_t input_octets{};             ///< by dp/cfg
    std::uint16_t output_octets{};
    UserPrm prm;
    UserPrm ext_prm;  ///< X_ keywords: for Set_Ext_Prm
    DiagTexts diag;
    std::string info_text;
    bool preset{};  ///< plugged when the station is put on the bus
    Position at{};
};

/// Slot(n) in SlotDefinition: what may be plugged there.
struct SlotRule {
    std::uint32_t slot{};
    std::string name;
    std::int64_t default_module{};    ///< Module_Reference
    std::vector<ValueRange> allowed;  ///< Module_References
    Position at{};

    bool allows(std::int64_t reference) const;
};

// ---- the rest -----------------------------------------------------------------------------------------------------

/// A line with a keyword that has no member in Gsd.
struct Keyword {
    std::string name;                     ///< as written
    std::string value;                    ///< the rest of the line, comment removed
    bool known{};                         ///< a keyword of the standard, else the vendor's own (or a slip of the pen)
    std::optional<std::size_t> module{};  ///< index of the module it stands in
    Position at{};
};

/// DP-V1 abilities.
struct DpV1 {
    bool slave{};  ///< DPV1_Slave
    bool c1_read_write{};
    bool c1_read_write_required{};
    std::uint32_t c1_max_data_len{};
    std::uint32_t c1_response_timeout{};  ///< ms * 10
    bool c2_read_write{};
    bool c2_read_write_required{};
    std::uint32_t c2_max_data_len{};
    std::uint32_t c2_response_timeout{};  ///< ms * 10
    std::uint32_t c2_max_count_channels{};
    std::uint32_t max_initiate_pdu_length{};
    bool diagnostic_alarm{}, process_alarm{}, pull_plug_alarm{}, status_alarm{}, update_alarm{};
    bool manufacturer_specific_alarm{};
    bool diagnostic_alarm_required{}, process_alarm_required{}, pull_plug_alarm_required{}, status_alarm_required{};
    bool update_alarm_required{}, manufacturer_specific_alarm_required{};
    bool alarm_type_mode{};
    std::uint32_t alarm_sequence_mode_count{};
    bool extra_alarm_sap{};
    bool wd_base_1ms{};
    bool check_cfg_mode{};
    bool ident_maintenance{};
};

/// DP-V2 abilities.
struct DpV2 {
    bool publisher{}, subscriber{};
    std::uint32_t dxb_max_link_count{};
    std::uint32_t dxb_max_data_length{};
    std::uint32_t dxb_subscribertable_block_location{};
    bool isochron_mode{}, isochron_mode_required{};
    std::uint32_t tbase_dp{}, tdp_min{}, tdp_max{};  ///< TBASE in 1/12 us
    std::uint32_t t_pll_w_max{};                     ///< 1/12 us
    std::uint32_t tbase_io{}, ti_min{}, to_min{};
    bool prm_block_structure{}, prm_block_structure_required{};
    bool prm_cmd{};
    bool x_prm_sap{};  ///< Set_Ext_Prm
    bool time_sync{};
    bool slave_redundancy{};
    std::uint32_t slave_max_switch_over_time{};
};

/// Everything a GSD file says.
struct Gsd {
    std::string file;  ///< the name it was read under

    // identity
    std::uint32_t gsd_revision{};  ///< 0 when not given
    std::string vendor_name, model_name, revision;
    std::uint16_t ident_number{};
    std::uint32_t protocol_ident{};  ///< 0: DP
    std::uint32_t station_type{};    ///< 0: slave
    std::string hardware_release, software_release;
    std::string order_number, implementation_type, slave_family, info_text;
    std::string bitmap_device, bitmap_diag, bitmap_sf;

    // bus
    std::array<RateSupport, kRates> rates{};
    bool fms{}, redundancy{};
    std::uint32_t repeater_ctrl_sig{}, pins_24v{};

    // slave
    bool freeze_mode{}, sync_mode{}, auto_baud{}, set_slave_add{};
    bool fail_safe{}, fail_safe_required{};
    std::uint32_t min_slave_intervall{};  ///< 100 us
    std::uint32_t max_diag_data_len{6};
    std::uint32_t diag_update_delay{};
    bool modular_station{}, fix_preset_modules{};
    std::optional<std::uint32_t> max_module{};
    std::optional<std::uint32_t> max_input_len{}, max_output_len{}, max_data_len{};
    std::uint32_t modul_offset{};
    DpV1 dpv1;
    DpV2 dpv2;

    // parameters
    std::optional<std::uint16_t> user_prm_data_len{};  ///< the old form, without Ext_
    std::vector<std::uint8_t> user_prm_data;
    UserPrm prm;
    UserPrm ext_prm;  ///< X_ keywords: for Set_Ext_Prm
    std::vector<Parameter> parameters;
    std::vector<PrmText> prm_texts;

    DiagTexts diag;
    std::vector<UnitDiagType> unit_diag_types;
    std::vector<Module> modules;
    std::vector<SlotRule> slots;
    std::vector<Keyword> keywords;  ///< everything else, in the order of the file

    const RateSupport& rate(Rate r) const { return rates[static_cast<std::size_t>(r)]; }
    /// nullptr when there is none of that number; with several, the last.
    const Parameter* parameter(std::int64_t number) const;
    const PrmText* prm_text(std::int64_t number) const;
    /// The text of a parameter's value; empty when it has none.
    std::string_view value_text(const Parameter& parameter, std::int64_t value) const;
};

}  // namespace dpchip::gsd
