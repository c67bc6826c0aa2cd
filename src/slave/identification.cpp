// SPDX-License-Identifier: Apache-2.0
// GSD texts into I&M0, and the records by their index.
#include <dpchip/slave/identification.hpp>

#include <array>
#include <string>

namespace dpchip::slave {

namespace {

/// The first numbers in a text such as "V1.2.3".
template <std::size_t N>
std::array<std::uint32_t, N> numbers(const std::string& text) {
    std::array<std::uint32_t, N> found{};
    std::size_t n = 0;
    bool in_number = false;
    for (const char c : text) {
        const bool digit = c >= '0' && c <= '9';
        if (!digit && in_number && ++n == N) break;
        in_number = digit;
        if (digit) found[n] = (found[n] * 10 + static_cast<std::uint32_t>(c - '0')) % 1'000'000;
    }
    return found;
}

}  // namespace

Identification identification(const gsd::Gsd& gsd) {
    Identification id{};
    id.im0.order_id = dp::im_text<20>(gsd.order_number.empty() ? gsd.model_name : gsd.order_number);
    id.im0.serial_number = dp::im_text<16>(std::array{'0'});
    id.im0.hardware_revision = static_cast<std::uint16_t>(numbers<1>(gsd.hardware_release)[0]);
    const auto software = numbers<3>(gsd.software_release);
    for (std::size_t i = 0; i < software.size(); ++i)
        id.im0.software_revision[i + 1] = static_cast<char>(static_cast<std::uint8_t>(software[i]));
    id.im0.im_supported = 0x001E;
    return id;
}

std::optional<dp::ImOctets> Identification::record(std::uint16_t im_index) const {
    switch (im_index) {
    case dp::kIm0: return dp::encode(im0);
    case dp::kIm0 + 1: return dp::encode(im1);
    case dp::kIm0 + 2: return dp::encode(im2);
    case dp::kIm0 + 3: return dp::encode(im3);
    case dp::kIm4: return dp::encode(im4);
    default: return std::nullopt;
    }
}

bool Identification::write(std::uint16_t im_index, std::span<const std::uint8_t, dp::kImRecord> octets) {
    switch (im_index) {
    case dp::kIm0 + 1: im1 = *dp::decode_im1(octets); return true;
    case dp::kIm0 + 2: im2 = *dp::decode_im2(octets); return true;
    case dp::kIm0 + 3: im3 = *dp::decode_im3(octets); return true;
    case dp::kIm4: im4 = *dp::decode_im4(octets); return true;
    default: return false;
    }
}

}  // namespace dpchip::slave
