// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/gsd.hpp>

#include <algorithm>

namespace dpchip::gsd {
namespace {

struct RateFacts {
    const char* name;
    std::uint32_t bits_per_second;
};
// clang-format off
constexpr RateFacts kRateFacts[kRates]{
    {"9.6", 9'600},      {"19.2", 19'200},    {"31.25", 31'250},    {"45.45", 45'450},    {"93.75", 93'750},   {"187.5", 187'500},
    {"500", 500'000},    {"1.5M", 1'500'000}, {"3M", 3'000'000},    {"6M", 6'000'000},    {"12M", 12'000'000}};
// clang-format on

bool any_range_has(const std::vector<ValueRange>& ranges, std::int64_t value) {
    return std::ranges::any_of(ranges, [&](const ValueRange& r) { return r.min <= value && value <= r.max; });
}

/// The last element with this number.
template <class T>
const T* by_number(const std::vector<T>& all, std::int64_t number) {
    const auto found = std::find_if(all.rbegin(), all.rend(), [&](const T& t) { return t.number == number; });
    return found == all.rend() ? nullptr : &*found;
}

}  // namespace

const char* name(Rate rate) { return kRateFacts[static_cast<std::size_t>(rate)].name; }
std::uint32_t bits_per_second(Rate rate) { return kRateFacts[static_cast<std::size_t>(rate)].bits_per_second; }

const char* name(DataType type) {
    switch (type) {
    case DataType::bit: return "Bit";
    case DataType::bit_area: return "BitArea";
    case DataType::unsigned8: return "Unsigned8";
    case DataType::unsigned16: return "Unsigned16";
    case DataType::unsigned32: return "Unsigned32";
    case DataType::signed8: return "Signed8";
    case DataType::signed16: return "Signed16";
    case DataType::signed32: return "Signed32";
    }
    return "Unsigned8";
}

std::size_t octets(DataType type) {
    switch (type) {
    case DataType::unsigned16:
    case DataType::signed16: return 2;
    case DataType::unsigned32:
    case DataType::signed32: return 4;
    case DataType::bit:
    case DataType::bit_area:
    case DataType::unsigned8:
    case DataType::signed8: break;
    }
    return 1;
}

bool Parameter::allows(std::int64_t value) const {
    const unsigned bits = type == DataType::bit || type == DataType::bit_area ? last_bit - first_bit + 1u
                                                                              : static_cast<unsigned>(8 * octets(type));
    const bool is_signed = type == DataType::signed8 || type == DataType::signed16 || type == DataType::signed32;
    const std::int64_t limit = std::int64_t{1} << (is_signed ? bits - 1 : bits);
    if (value >= limit || value < (is_signed ? -limit : 0)) return false;
    return allowed.empty() || any_range_has(allowed, value);
}

bool SlotRule::allows(std::int64_t reference) const {
    return reference == default_module || any_range_has(allowed, reference);
}

std::size_t DiagTexts::size() const {
    std::size_t n = bits.size() + not_bits.size() + channel.size();
    for (const DiagArea& area : areas) n += area.values.size();
    return n;
}

const Parameter* Gsd::parameter(std::int64_t number) const { return by_number(parameters, number); }
const PrmText* Gsd::prm_text(std::int64_t number) const { return by_number(prm_texts, number); }

std::string_view Gsd::value_text(const Parameter& p, std::int64_t value) const {
    const PrmText* text = p.text_ref ? prm_text(*p.text_ref) : nullptr;
    if (text == nullptr) return {};
    const auto found = text->texts.find(value);
    return found == text->texts.end() ? std::string_view{} : std::string_view{found->second};
}

}  // namespace dpchip::gsd
