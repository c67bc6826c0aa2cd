// SPDX-License-Identifier: Apache-2.0
// Structured_Prm_Data: the blocks in a Set_Prm with Prm_Structure = 1 and in every Set_Ext_Prm
// (reference 3.4.6, 6.1, 6.2, 6.4). The contents of the blocks are their users' business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dpchip::dp {

/// Structure_Type octets that have a meaning of their own; 32..128 belong to manufacturers.
enum class PrmBlockType : std::uint8_t {
    prm_cmd = 2,
    dxb_linktable = 3,
    isom = 4,
    f_parameters = 5,
    dxb_subscribertable = 7,
    time_ar = 8,
    user_prm_data = 129,
};

constexpr const char* prm_block_name(std::uint8_t type) {
    switch (static_cast<PrmBlockType>(type)) {
    case PrmBlockType::prm_cmd: return "PrmCmd";
    case PrmBlockType::dxb_linktable: return "DXB_Linktable";
    case PrmBlockType::isom: return "IsoM_Parameter";
    case PrmBlockType::f_parameters: return "F-Parameter";
    case PrmBlockType::dxb_subscribertable: return "DXB_Subscribertable";
    case PrmBlockType::time_ar: return "Time_AR_Parameter";
    case PrmBlockType::user_prm_data: return "User_Prm_Data";
    }
    return type >= 32 && type <= 128 ? "manufacturer specific" : "reserved";
}

/// One block.
struct PrmBlock {
    std::size_t offset{};  ///< of Structured_Length
    std::uint8_t type{};   ///< Structure_Type
    std::uint8_t slot{};
    std::uint8_t reserved{};  ///< octet 3: reserved, or the block's own (PrmCmd: Specifier)
    std::span<const std::uint8_t> data{};
};

enum class PrmBlockError : std::uint8_t {
    none,
    length_range,  ///< Structured_Length is less than 5 or more than 244
    truncated,     ///< the block goes on beyond the last octet
};

/// Goes through the blocks; false from next() at the end and at an error.
class PrmBlockWalker {
public:
    constexpr explicit PrmBlockWalker(std::span<const std::uint8_t> octets) : octets_{octets} {}

    constexpr bool next(PrmBlock& block) {
        if (error_ != PrmBlockError::none || offset_ == octets_.size()) return false;
        const std::size_t length = octets_[offset_];
        if (length < 5 || length > 244) error_ = PrmBlockError::length_range;
        else if (length > octets_.size() - offset_) error_ = PrmBlockError::truncated;
        if (error_ != PrmBlockError::none) return false;
        block = {offset_, octets_[offset_ + 1], octets_[offset_ + 2], octets_[offset_ + 3],
                 octets_.subspan(offset_ + 4, length - 4)};
        offset_ += length;
        return true;
    }
    constexpr PrmBlockError error() const { return error_; }
    /// First octet not yet walked over; with an error, the bad block's first octet.
    constexpr std::size_t offset() const { return offset_; }

private:
    std::span<const std::uint8_t> octets_;
    std::size_t offset_{};
    PrmBlockError error_{PrmBlockError::none};
};

}  // namespace dpchip::dp
