// SPDX-License-Identifier: Apache-2.0
// Configuration octets (Chk_Cfg, Get_Cfg, GSD modules): general and special format, lengths, totals, comparison
// (reference 7.2, 7.3). Inputs and outputs are the master's words: inputs go slave to master (Din).
//
// Not interpreted: the DP-V1 data types that manufacturer octets may carry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kMaxDirectionOctets = 244;  ///< inputs of a slave, and its outputs
inline constexpr std::size_t kMaxCfgOctets = 244;        ///< octets of one Chk_Cfg

/// Where the octets come from: a count of 15 manufacturer octets is a wildcard in Chk_Cfg and forbidden elsewhere.
enum class CfgUse : std::uint8_t { chk_cfg, get_cfg };

/// Why octets are not a configuration.
enum class CfgError : std::uint8_t {
    none,
    truncated,         ///< a block of the special format goes on beyond the last octet
    wildcard,          ///< manufacturer count 15 outside Chk_Cfg
    too_many_inputs,   ///< inputs exceed 244 octets with this block
    too_many_outputs,  ///< outputs exceed 244 octets with this block
};

constexpr const char* name(CfgError e) {
    switch (e) {
    case CfgError::none: return "no error";
    case CfgError::truncated: return "block cut short";
    case CfgError::wildcard: return "manufacturer count 15 is allowed in Chk_Cfg only";
    case CfgError::too_many_inputs: return "more than 244 octets of inputs";
    case CfgError::too_many_outputs: return "more than 244 octets of outputs";
    }
    return "no error";
}

/// One direction of a block.
struct CfgLength {
    std::uint8_t octets{};  ///< 0..128
    bool words{};           ///< counted in words, else in octets
    bool whole{};           ///< consistent over the whole length, else over one octet or word

    friend constexpr bool operator==(const CfgLength&, const CfgLength&) = default;
};

/// One configuration block: a general-format octet, or a special-format header and what belongs to it.
struct CfgBlock {
    std::size_t offset{};  ///< of its first octet
    std::size_t size{};    ///< its octets
    CfgLength input{};
    CfgLength output{};
    std::span<const std::uint8_t> manufacturer{};  ///< manufacturer octets
    bool special{};                                ///< special format
    bool wildcard{};                               ///< manufacturer count 15: none follow, they are not compared
    /// An empty slot: special format without data.
    constexpr bool empty_slot() const { return special && input.octets == 0 && output.octets == 0; }
};

namespace detail {
constexpr CfgLength cfg_length(unsigned count, bool words, bool whole) {
    return {static_cast<std::uint8_t>(words ? 2 * count : count), words, whole};
}
constexpr CfgLength cfg_length_octet(std::uint8_t b) {
    return cfg_length((b & 0x3Fu) + 1u, (b & 0x40u) != 0, (b & 0x80u) != 0);
}
}  // namespace detail

/// The octets that a block with this first octet takes.
constexpr std::size_t cfg_block_size(std::uint8_t first) {
    if ((first & 0x30u) != 0) return 1;
    const std::size_t lengths = (first >> 7) + ((first >> 6) & 1u);
    const std::size_t k = first & 0x0Fu;
    return 1 + lengths + (k == 15 ? 0 : k);
}

/// The block at `offset`; `offset` at or beyond the end is `truncated`.
constexpr core::Result<CfgBlock, CfgError> cfg_block(std::span<const std::uint8_t> cfg, std::size_t offset,
                                                     CfgUse use = CfgUse::chk_cfg) {
    if (offset >= cfg.size()) return CfgError::truncated;
    const std::uint8_t first = cfg[offset];
    CfgBlock block{};
    block.offset = offset;
    block.size = cfg_block_size(first);
    if (block.size > cfg.size() - offset) return CfgError::truncated;
    if ((first & 0x30u) != 0) {
        const CfgLength length = detail::cfg_length((first & 0x0Fu) + 1u, (first & 0x40u) != 0, (first & 0x80u) != 0);
        if ((first & 0x10u) != 0) block.input = length;
        if ((first & 0x20u) != 0) block.output = length;
        return block;
    }
    block.special = true;
    block.wildcard = (first & 0x0Fu) == 15;
    if (block.wildcard && use != CfgUse::chk_cfg) return CfgError::wildcard;
    std::size_t at = offset + 1;
    if ((first & 0x80u) != 0) block.output = detail::cfg_length_octet(cfg[at++]);
    if ((first & 0x40u) != 0) block.input = detail::cfg_length_octet(cfg[at++]);
    block.manufacturer = cfg.subspan(at, offset + block.size - at);
    return block;
}

/// Goes through the blocks of a configuration:
/// `CfgBlock b; for (CfgWalker w{cfg}; w.next(b);) ...; if (w.error() != CfgError::none) ... w.offset()`.
class CfgWalker {
public:
    constexpr explicit CfgWalker(std::span<const std::uint8_t> cfg, CfgUse use = CfgUse::chk_cfg)
        : cfg_{cfg}, use_{use} {}

    /// Fetches the next block; false at the end and at an error.
    constexpr bool next(CfgBlock& block) {
        if (error_ != CfgError::none || offset_ >= cfg_.size()) return false;
        const auto found = cfg_block(cfg_, offset_, use_);
        if (!found) {
            error_ = found.error();
            return false;
        }
        block = *found;
        offset_ += block.size;
        return true;
    }
    constexpr CfgError error() const { return error_; }
    /// First octet not yet walked over; with an error, the first octet of the bad block.
    constexpr std::size_t offset() const { return offset_; }

private:
    std::span<const std::uint8_t> cfg_;
    std::size_t offset_{};
    CfgUse use_;
    CfgError error_{CfgError::none};
};

/// What a configuration adds up to. With an error, the sums of the blocks before it.
struct CfgTotals {
    std::uint16_t input_octets{};
    std::uint16_t output_octets{};
    std::uint16_t blocks{};
    CfgError error{CfgError::none};
    std::uint16_t error_offset{};  ///< first octet of the bad block

    constexpr bool ok() const { return error == CfgError::none; }
};

/// Adds up the blocks; stops at the first error, the 244 octets per direction included.
constexpr CfgTotals cfg_totals(std::span<const std::uint8_t> cfg, CfgUse use = CfgUse::chk_cfg) {
    CfgTotals totals{};
    CfgWalker walker{cfg, use};
    for (CfgBlock block{}; walker.next(block);) {
        const std::size_t inputs = std::size_t{totals.input_octets} + block.input.octets;
        const std::size_t outputs = std::size_t{totals.output_octets} + block.output.octets;
        if (inputs > kMaxDirectionOctets || outputs > kMaxDirectionOctets) {
            totals.error = inputs > kMaxDirectionOctets ? CfgError::too_many_inputs : CfgError::too_many_outputs;
            totals.error_offset = static_cast<std::uint16_t>(block.offset);
            return totals;
        }
        totals.input_octets = static_cast<std::uint16_t>(inputs);
        totals.output_octets = static_cast<std::uint16_t>(outputs);
        ++totals.blocks;
    }
    totals.error = walker.error();
    if (!totals.ok()) totals.error_offset = static_cast<std::uint16_t>(walker.offset());
    return totals;
}

/// True when `received` (Chk_Cfg) asks for exactly what is `plugged`: the same octets, except that a received
/// manufacturer count of 15 leaves the plugged block's manufacturer octets unchecked. False when either is damaged.
constexpr bool cfg_matches(std::span<const std::uint8_t> plugged, std::span<const std::uint8_t> received) {
    CfgWalker mine{plugged}, theirs{received};
    CfgBlock a{}, b{};
    for (;;) {
        const bool more = mine.next(a);
        if (theirs.next(b) != more) return false;
        if (!more) return mine.error() == CfgError::none && theirs.error() == CfgError::none;
        if (!b.wildcard) {
            if (!std::ranges::equal(plugged.subspan(a.offset, a.size), received.subspan(b.offset, b.size)))
                return false;
        } else if (!a.special || (plugged[a.offset] & 0xF0u) != (received[b.offset] & 0xF0u) || a.input != b.input ||
                   a.output != b.output) {
            return false;
        }
    }
}

/// A general-format octet for `count` (1..16) octets or words; 0 when it cannot be said in one octet.
constexpr std::uint8_t general_cfg(bool input, bool output, unsigned count, bool words, bool whole) {
    if (count < 1 || count > 16 || !(input || output)) return 0;
    return static_cast<std::uint8_t>((whole ? 0x80u : 0u) | (words ? 0x40u : 0u) | (output ? 0x20u : 0u) |
                                     (input ? 0x10u : 0u) | (count - 1));
}

}  // namespace dpchip::dp
