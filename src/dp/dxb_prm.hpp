// SPDX-License-Identifier: Apache-2.0
// Links between publishers and subscribers in parameter blocks: DXB_Linktable (type 3) and DXB_Subscribertable (type 7),
// and the status message about them (figures 7-8 to 7-10; reference 6.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/result.hpp>
#include <dpchip/dp/structured_prm.hpp>

namespace dpchip::dp {

/// Links that a subscriber can have.
inline constexpr std::size_t kMaxDxbLinks = 29;
inline constexpr std::uint8_t kDxbVersion = 1;
inline constexpr std::uint8_t kMaxPublisher = 125, kMaxPublished = 244;

/// One link. The last two say where the application wants the sample; a link table does not have them.
struct DxbLink {
    std::uint8_t publisher{};         ///< Publisher_Addr, 0..125
    std::uint8_t publisher_length{};  ///< octets that the publisher broadcasts, 1..244
    std::uint8_t sample_offset{};     ///< first octet of the sample in them
    std::uint8_t sample_length{};     ///< octets of the sample
    std::uint8_t dest_slot{};
    std::uint8_t offset_data_area{};

    friend constexpr bool operator==(const DxbLink&, const DxbLink&) = default;
};

enum class DxbError : std::uint8_t {
    none,
    type,       ///< the block is of neither type
    version,    ///< not 1
    length,     ///< no whole number of links, none at all, or more than 29
    publisher,  ///< above 125
    published,  ///< Publisher_Length 0 or above 244
    sample,     ///< the sample is empty, lies outside the published data, or is longer than the station takes
    watchdog,   ///< links without WD_On are not monitored
    no_room,    ///< the buffer to encode into is too small
};

/// Whether a link can ever work (reference 6.1, the user's plausibility check).
constexpr DxbError check(const DxbLink& l) {
    if (l.publisher > kMaxPublisher) return DxbError::publisher;
    if (l.publisher_length == 0 || l.publisher_length > kMaxPublished) return DxbError::published;
    if (l.sample_length == 0 || l.sample_offset >= l.publisher_length) return DxbError::sample;
    return unsigned{l.sample_offset} + l.sample_length > l.publisher_length ? DxbError::sample : DxbError::none;
}

/// A block of type 3 or 7, link by link. The links are not checked.
class DxbTable {
public:
    static constexpr core::Result<DxbTable, DxbError> of(const PrmBlock& block) {
        const bool subscriber = block.type == static_cast<std::uint8_t>(PrmBlockType::dxb_subscribertable);
        if (!subscriber && block.type != static_cast<std::uint8_t>(PrmBlockType::dxb_linktable)) return DxbError::type;
        if (block.data.empty()) return DxbError::length;
        if (block.data[0] != kDxbVersion) return DxbError::version;
        const std::size_t octets = entry_octets(subscriber), n = block.data.size() - 1;
        if (n == 0 || n % octets != 0 || n / octets > kMaxDxbLinks) return DxbError::length;
        return DxbTable{block.data.subspan(1), subscriber};
    }
    constexpr DxbTable() = default;

    constexpr bool subscribertable() const { return subscriber_; }
    constexpr std::size_t size() const { return entries_.size() / entry_octets(subscriber_); }
    /// Link `n`, which must be less than size().
    constexpr DxbLink operator[](std::size_t n) const {
        const auto e = entries_.subspan(n * entry_octets(subscriber_), entry_octets(subscriber_));
        if (subscriber_) return {e[0], e[1], e[2], e[5], e[3], e[4]};
        return {e[0], e[1], e[2], e[3]};
    }
    static constexpr std::size_t entry_octets(bool subscribertable) { return subscribertable ? 6 : 4; }

private:
    constexpr DxbTable(std::span<const std::uint8_t> entries, bool subscriber) : entries_{entries}, subscriber_{subscriber} {}
    std::span<const std::uint8_t> entries_{};
    bool subscriber_{};
};

/// Writes a whole block; returns its octets. Every link must pass check().
constexpr core::Result<std::size_t, DxbError> encode_dxb(PrmBlockType type, std::span<const DxbLink> links, std::span<std::uint8_t> out) {
    const bool subscriber = type == PrmBlockType::dxb_subscribertable;
    if (!subscriber && type != PrmBlockType::dxb_linktable) return DxbError::type;
    if (links.empty() || links.size() > kMaxDxbLinks) return DxbError::length;
    const std::size_t size = 5 + links.size() * DxbTable::entry_octets(subscriber);
    if (size > out.size()) return DxbError::no_room;
    std::size_t at = 0;
    for (const std::uint8_t octet : {static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(type), std::uint8_t{0}, std::uint8_t{0}, kDxbVersion})
        out[at++] = octet;
    for (const DxbLink& l : links) {
        if (const DxbError error = check(l); error != DxbError::none) return error;
        for (const std::uint8_t octet : {l.publisher, l.publisher_length, l.sample_offset}) out[at++] = octet;
        if (subscriber)
            for (const std::uint8_t octet : {l.dest_slot, l.offset_data_area}) out[at++] = octet;
        out[at++] = l.sample_length;
    }
    return size;
}

// ---- DXB_Link_Status ------------------------------------------------------------------------------------------------

inline constexpr std::uint8_t kLinkStatus = 0x80;  ///< valid data in the last monitoring period
inline constexpr std::uint8_t kLinkError = 0x40;   ///< the last data had the wrong length
inline constexpr std::uint8_t kDataExist = 0x01;   ///< valid data in the present monitoring period
inline constexpr std::uint8_t kDxbLinkStatusType = 0x83;

constexpr std::size_t dxb_status_octets(std::size_t links) { return 4 + 2 * links; }

/// The status message with every link at its default; returns its octets, 0 when `out` is too small.
constexpr std::size_t encode_dxb_status(std::span<const DxbLink> links, std::span<std::uint8_t> out) {
    const std::size_t size = dxb_status_octets(links.size());
    if (size > out.size() || links.size() > kMaxDxbLinks) return 0;
    out[0] = static_cast<std::uint8_t>(size);
    out[1] = kDxbLinkStatusType;
    out[2] = out[3] = 0;
    for (std::size_t i = 0; i < links.size(); ++i) {
        out[4 + 2 * i] = links[i].publisher;
        out[5 + 2 * i] = 0;
    }
    return size;
}

}  // namespace dpchip::dp
