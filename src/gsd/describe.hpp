// SPDX-License-Identifier: Apache-2.0
// GSD values as text for people, and the numbers of a file at a glance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <dpchip/gsd/gsd.hpp>
#include <dpchip/gsd/user_prm.hpp>

namespace dpchip::gsd {

/// A file at a glance.
struct Summary {
    std::string file, vendor_name, model_name;
    std::uint16_t ident_number{};
    std::uint32_t gsd_revision{};
    std::size_t modules{};
    std::size_t parameters{};        ///< ExtUserPrmData definitions
    std::size_t prm_texts{};         ///< texts of values in PrmText
    std::size_t diag_texts{};        ///< diagnosis texts of device, block types and modules
    std::size_t keywords{};          ///< lines that Gsd has no member for, known and unknown
    std::size_t unknown_keywords{};  ///< those whose keyword the standard does not have
};
Summary summarize(const Gsd& gsd);

/// "0x4711".
std::string hex(std::uint16_t value);
/// "11 21": octets as the manuals write them.
std::string hex(std::span<const std::uint8_t> octets);

/// Identity, rates, abilities, limits: a line each.
std::string describe(const Gsd& gsd);
/// The modules: number, name, octets, lengths; a line each.
std::string describe_modules(const Gsd& gsd);
/// The parameters of a configured station with place, value, range and texts.
std::string describe_parameters(const Gsd& gsd, const UserPrmData& data);
/// Keywords that Gsd has no member for: line, name, value. `unknown_only` leaves out those of the standard.
enum class KeywordChoice : std::uint8_t { all, unknown_only };
std::string describe_keywords(const Gsd& gsd, KeywordChoice choice = KeywordChoice::unknown_only);

/// The diagnosis texts that apply to a device-related block of a diagnosis: `block` with its header.
std::vector<std::string> diag_texts(const Gsd& gsd, std::span<const std::uint8_t> block);
/// The text of a channel error type: the GSD's, else the standard's.
std::string channel_error_text(const Gsd& gsd, std::uint8_t error);

}  // namespace dpchip::gsd
