// SPDX-License-Identifier: Apache-2.0
// User parameters of a configured station: the octets of Set_Prm from octet 7 on, which of them may change, and the
// check of what a master sent. The device's own octets come first, then each module's, in slot order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/gsd.hpp>

namespace dpchip::gsd {

/// Which telegram: Set_Prm, or Set_Ext_Prm with the X_ keywords.
enum class PrmTelegram : std::uint8_t { set_prm, set_ext_prm };

/// A parameter at its place in the user parameters.
struct PrmField {
    std::size_t parameter{};  ///< index into Gsd::parameters
    std::uint32_t slot{};     ///< 0 device, 1.. modules
    std::size_t offset{};     ///< first octet, counted from octet 7 of Set_Prm
    std::uint8_t octets{};    ///< 1, 2 or 4, big endian
    std::uint32_t mask{};     ///< its bits within these octets
    std::uint8_t shift{};     ///< of its lowest bit
    std::int64_t value{};     ///< in UserPrmData::octets
};

struct UserPrmData {
    std::vector<std::uint8_t> octets;    ///< user parameters, octet 7 of Set_Prm on
    std::vector<std::uint8_t> variable;  ///< bit by bit: 1 where a parameter (or DPV1_Status) may differ
    std::vector<PrmField> fields;        ///< by slot, then as the GSD lists them
};

/// A wish: this parameter shall have this value.
struct PrmSetting {
    std::string parameter;                ///< its text (case and runs of blanks do not matter) or its number
    std::string value;                    ///< a number, decimal or 0x.., or a text of its PrmText
    std::optional<std::uint32_t> slot{};  ///< needed when several slots have the parameter
    std::optional<std::size_t> offset{};  ///< needed when a slot has it several times; offset in the user parameters
};

/// Reads "[SLOT:]PARAMETER[@OFFSET]=VALUE". Throws GsdError when there is no '='.
PrmSetting prm_setting(std::string_view text);

/// The octets with defaults and settings. Throws GsdError for a parameter that does not exist or is ambiguous
/// (with the candidates), a value that is not allowed, and octets that fit neither limits nor telegram.
UserPrmData user_prm_data(const Gsd& gsd, const Configuration& configuration, std::span<const PrmSetting> settings = {},
                          PrmTelegram telegram = PrmTelegram::set_prm);

/// What is wrong with received user parameters.
struct PrmFault {
    enum class Kind : std::uint8_t {
        length,    ///< not the length of the configured station
        constant,  ///< an octet that may not change has changed
        range,     ///< a value that its parameter does not allow
    };
    Kind kind{};
    std::size_t offset{};                ///< in the user parameters
    std::optional<std::size_t> field{};  ///< range: index into UserPrmData::fields
    std::string message;                 ///< for people
};

/// Compares what a master sent (octet 7 on) with what the station takes; the first fault, or nothing.
std::optional<PrmFault> check_user_prm(const Gsd& gsd, const UserPrmData& expected,
                                       std::span<const std::uint8_t> received);

/// The value of a field in `octets`, sign-extended for the signed types; 0 when it lies outside.
std::int64_t field_value(const Gsd& gsd, const PrmField& field, std::span<const std::uint8_t> octets);

}  // namespace dpchip::gsd
