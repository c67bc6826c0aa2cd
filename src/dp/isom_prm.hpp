// SPDX-License-Identifier: Apache-2.0
// IsoM_Parameter, block type 4: the times of an isochronous bus cycle (reference 6.2). What the times are good for is the
// application's business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/dp/structured_prm.hpp>

namespace dpchip::dp {

inline constexpr std::size_t kIsoMBlock = 28;

/// Times are counted in 1/12 us where the base says nothing else: T_PLL_W, T_PLL_D, the bases themselves and T_DX.
struct IsoMPrm {
    std::uint8_t slot{}, version{};
    std::uint32_t tbase_dp{};  ///< unit of T_DP, in 1/12 us
    std::uint16_t t_dp{};      ///< cycle time, in Tbase_DP
    std::uint8_t t_mapc{};     ///< master application cycle, in T_DP
    std::uint32_t tbase_io{};  ///< unit of T_I and T_O, in 1/12 us
    std::uint16_t t_i{};       ///< inputs are read this long before the SYNCH
    std::uint16_t t_o{};       ///< outputs are put out this long after the SYNCH
    std::uint32_t t_dx{};      ///< length of the cyclic part, in 1/12 us
    std::uint16_t t_pll_w{};   ///< window that the SYNCH may jitter in, in 1/12 us
    std::uint16_t t_pll_d{};   ///< delay of the SYNC pulse, in 1/12 us

    /// Cycle time in 1/12 us.
    constexpr std::uint64_t cycle() const { return std::uint64_t{tbase_dp} * t_dp; }
    friend constexpr bool operator==(const IsoMPrm&, const IsoMPrm&) = default;
};

enum class IsoMError : std::uint8_t {
    type,     ///< not a block of type 4
    length,   ///< not 28 octets
    cycle,    ///< T_DP or its base is 0
    no_room,  ///< the buffer to encode into is too small
};

namespace detail {
constexpr std::uint16_t word_at(std::span<const std::uint8_t> d, std::size_t i) { return core::word(d[i], d[i + 1]); }
constexpr std::uint32_t dword_at(std::span<const std::uint8_t> d, std::size_t i) {
    return static_cast<std::uint32_t>(word_at(d, i)) << 16 | word_at(d, i + 2);
}
constexpr void put_word(std::span<std::uint8_t> d, std::size_t i, std::uint16_t v) {
    d[i] = core::high(v);
    d[i + 1] = core::low(v);
}
constexpr void put_dword(std::span<std::uint8_t> d, std::size_t i, std::uint32_t v) {
    put_word(d, i, static_cast<std::uint16_t>(v >> 16));
    put_word(d, i + 2, static_cast<std::uint16_t>(v & 0xFFFFu));
}
}  // namespace detail

constexpr core::Result<IsoMPrm, IsoMError> decode_isom(const PrmBlock& b) {
    using detail::dword_at, detail::word_at;
    if (b.type != static_cast<std::uint8_t>(PrmBlockType::isom)) return IsoMError::type;
    if (b.data.size() != kIsoMBlock - 4) return IsoMError::length;
    const auto d = b.data;
    const IsoMPrm p{.slot = b.slot, .version = d[0], .tbase_dp = dword_at(d, 1), .t_dp = word_at(d, 5), .t_mapc = d[7],
                    .tbase_io = dword_at(d, 8), .t_i = word_at(d, 12), .t_o = word_at(d, 14), .t_dx = dword_at(d, 16),
                    .t_pll_w = word_at(d, 20), .t_pll_d = word_at(d, 22)};
    if (p.cycle() == 0) return IsoMError::cycle;
    return p;
}

/// Writes the whole block; returns its 28 octets.
constexpr core::Result<std::size_t, IsoMError> encode(const IsoMPrm& p, std::span<std::uint8_t> out) {
    using detail::put_dword, detail::put_word;
    if (out.size() < kIsoMBlock) return IsoMError::no_room;
    if (p.cycle() == 0) return IsoMError::cycle;
    out[0] = kIsoMBlock;
    out[1] = static_cast<std::uint8_t>(PrmBlockType::isom);
    out[2] = p.slot;
    out[3] = 0;
    const auto d = out.subspan(4);
    d[0] = p.version;
    put_dword(d, 1, p.tbase_dp);
    put_word(d, 5, p.t_dp);
    d[7] = p.t_mapc;
    put_dword(d, 8, p.tbase_io);
    put_word(d, 12, p.t_i);
    put_word(d, 14, p.t_o);
    put_dword(d, 16, p.t_dx);
    put_word(d, 20, p.t_pll_w);
    put_word(d, 22, p.t_pll_d);
    return kIsoMBlock;
}

}  // namespace dpchip::dp
