// SPDX-License-Identifier: Apache-2.0
// Unit_Diag_Bit, Unit_Diag_Area and Channel_Diag applied to octets.
#include <dpchip/core/bits.hpp>
#include <dpchip/trace/gsd_texts.hpp>

namespace dpchip::trace {
namespace {

using Octets = std::span<const std::uint8_t>;

bool in(Octets data, std::uint32_t bit) { return bit / 8 < data.size(); }
bool set(Octets data, std::uint32_t bit) { return in(data, bit) && core::bit(data[bit / 8], bit % 8); }

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// The number in a group of bits, the lowest bit first; areas of more than 63 bits have no names anyway.
std::int64_t area_value(Octets data, const gsd::DiagArea& area) {
    std::int64_t value = 0;
    for (std::uint32_t bit = area.first_bit; bit <= area.last_bit && bit - area.first_bit < 63; ++bit)
        if (set(data, bit)) value |= std::int64_t{1} << (bit - area.first_bit);
    return value;
}

void apply(const gsd::DiagTexts& texts, Octets data, std::vector<std::string>& out) {
    for (const gsd::DiagBitText& bit : texts.bits)
        if (set(data, bit.bit)) out.push_back(std::string{"bit "} + std::to_string(bit.bit) + ' ' + quoted(bit.text));
    for (const gsd::DiagBitText& bit : texts.not_bits)
        if (in(data, bit.bit) && !set(data, bit.bit)) out.push_back(std::string{"not bit "} + std::to_string(bit.bit) + ' ' + quoted(bit.text));
    for (const gsd::DiagArea& area : texts.areas) {
        if (!in(data, area.last_bit)) continue;
        const auto text = area.values.find(area_value(data, area));
        if (text == area.values.end()) continue;
        out.push_back(std::string{"bits "} + std::to_string(area.first_bit) + '-' + std::to_string(area.last_bit) + ' ' + quoted(text->second));
    }
}

}  // namespace

std::vector<std::string> GsdTexts::device_diag(std::uint8_t station, Octets data) const {
    std::vector<std::string> out;
    const gsd::Gsd* known = device(station);
    if (known == nullptr) return out;
    apply(known->diag, data, out);
    // Blocks of a DP-V1 slave say what they are in their first octet.
    if (!data.empty())
        for (const gsd::UnitDiagType& type : known->unit_diag_types)
            if (type.type == data[0]) apply(type.texts, data, out);
    return out;
}

std::string GsdTexts::channel_error(std::uint8_t station, std::uint8_t error) const {
    const gsd::Gsd* known = device(station);
    if (known == nullptr) return {};
    const auto text = known->diag.channel.find(error);
    return text == known->diag.channel.end() ? std::string{} : text->second;
}

}  // namespace dpchip::trace
