// SPDX-License-Identifier: Apache-2.0
// What a slave accepts as User_Prm_Data: its length, octets that must not change, values and their ranges. Plain data,
// written by hand or made from a GSD file; offsets count as in a GSD, from octet 7 of Set_Prm.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/set_prm.hpp>

namespace dpchip::driver {

/// The bits in `mask` of this octet must be those of `value`.
struct PrmConstant {
    std::uint8_t offset{};
    std::uint8_t mask{0xFF};
    std::uint8_t value{};
};

/// A range of values, ends included.
struct PrmRange {
    std::int64_t min{};
    std::int64_t max{};
};

/// A parameter: 1, 2 or 4 octets, most significant first; or `width` bits from bit `bit` on in one octet.
struct PrmValue {
    std::uint8_t offset{};
    std::uint8_t octets{1};
    bool is_signed{};
    std::uint8_t bit{};
    std::uint8_t width{};  ///< 0: all bits of the octets
    std::int64_t min{};
    std::int64_t max{};
    std::span<const PrmRange> ranges{};  ///< when not empty, the value must lie in one of them; min and max do not count

    constexpr bool allows(std::int64_t value) const {
        if (ranges.empty()) return value >= min && value <= max;
        return std::ranges::any_of(ranges, [=](const PrmRange& r) { return value >= r.min && value <= r.max; });
    }
};

/// The views must outlive the driver.
struct PrmRules {
    std::uint8_t min_octets{};                           ///< of User_Prm_Data
    std::uint8_t max_octets{dp::kMaxUserPrm};
    std::span<const PrmConstant> constants{};
    std::span<const PrmValue> values{};
};

/// Which rule a Set_Prm broke.
enum class PrmFault : std::uint8_t {
    none,
    length,        ///< User_Prm_Data too short or too long
    constant,      ///< an octet that must not change is different
    out_of_range,  ///< a value outside its ranges
};

/// The value of a parameter; `user_prm` must be long enough.
constexpr std::int64_t prm_value(const PrmValue& rule, std::span<const std::uint8_t> user_prm) {
    std::uint32_t raw = 0;
    for (std::size_t i = 0; i < rule.octets; ++i) raw = raw << 8 | user_prm[rule.offset + i];
    unsigned width = 8u * rule.octets;
    if (rule.width != 0) {
        raw = raw >> rule.bit & ((std::uint32_t{1} << rule.width) - 1u);
        width = rule.width;
    }
    if (!rule.is_signed) return raw;
    const std::uint32_t sign = std::uint32_t{1} << (width - 1);
    return static_cast<std::int32_t>((raw ^ sign) - sign);
}

/// The first rule that `user_prm` (Set_Prm from octet 7 on) breaks. Rules about octets beyond its end do not apply:
/// whether they must be there is the length's business.
constexpr PrmFault check(const PrmRules& rules, std::span<const std::uint8_t> user_prm) {
    if (user_prm.size() < rules.min_octets || user_prm.size() > rules.max_octets) return PrmFault::length;
    for (const PrmConstant& c : rules.constants)
        if (c.offset < user_prm.size() && ((user_prm[c.offset] ^ c.value) & c.mask) != 0) return PrmFault::constant;
    for (const PrmValue& v : rules.values) {
        if (std::size_t{v.offset} + v.octets > user_prm.size()) continue;
        if (!v.allows(prm_value(v, user_prm))) return PrmFault::out_of_range;
    }
    return PrmFault::none;
}

}  // namespace dpchip::driver
