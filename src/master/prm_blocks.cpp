// SPDX-License-Identifier: Apache-2.0
// Structured_Prm_Data, encoded and put behind the DPV1_Status octets.
#include <dpchip/master/prm_blocks.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace dpchip::master {
namespace {

constexpr std::size_t kStatusOctets = 3;
constexpr std::uint8_t kGroup8 = 0x80;
constexpr Ticks kTwelfth{5'000};  // 1/12 us, the unit of TBASE_DP

struct Status {
    std::uint8_t octet_1 = 0, octet_3 = dp::kPrmStructure;
};

/// User parameters without structure cannot be told from blocks.
bool structured(const SlaveConfig& slave) {
    return slave.user_prm.size() <= kStatusOctets || (slave.user_prm[2] & dp::kPrmStructure) != 0;
}

template <class Encoded>
BlockAdded append(SlaveConfig& slave, const Encoded& size, std::span<const std::uint8_t> block, const Status& status) {
    if (!size || !structured(slave)) return ConfigError::block;
    const std::size_t before = std::max(slave.user_prm.size(), kStatusOctets);
    if (before + *size > dp::kMaxUserPrm) return ConfigError::too_long;
    slave.user_prm.resize(before);
    slave.user_prm[0] |= status.octet_1;
    slave.user_prm[2] |= status.octet_3;
    slave.user_prm.insert(slave.user_prm.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*size));
    return slave.user_prm.size();
}

}  // namespace

BlockAdded add_links(SlaveConfig& slave, std::span<const dp::DxbLink> links) {
    std::array<std::uint8_t, dp::kMaxUserPrm> block{};
    if (slave.watchdog_ms == 0) return ConfigError::watchdog;
    return append(slave, dp::encode_dxb(dp::PrmBlockType::dxb_linktable, links, block), block, {.octet_1 = dp::kDpv1Enable});
}

BlockAdded add_isochron(SlaveConfig& slave, const dp::IsoMPrm& times) {
    std::array<std::uint8_t, dp::kIsoMBlock> block{};
    const Status status{.octet_1 = dp::kDpv1Enable | dp::kFailSafe, .octet_3 = dp::kPrmStructure | dp::kIsoMReq};
    const BlockAdded added = append(slave, dp::encode(times, block), block, status);
    if (!added) return added;
    slave.fail_safe = true;
    slave.sync = slave.freeze = false;
    slave.group = static_cast<std::uint8_t>(slave.group & ~unsigned{kGroup8});
    return added;
}

BlockAdded add_clock(SlaveConfig& slave, const dp::TimeAr& time) {
    std::array<std::uint8_t, 14> block{};
    return append(slave, dp::encode(time, block), block, {.octet_1 = dp::kDpv1Enable});
}

BlockAdded add_prm_cmd(SlaveConfig& slave, const dp::PrmCmd& command) {
    std::array<std::uint8_t, dp::kPrmCmdBlock> block{};
    return append(slave, dp::encode(command, block), block, {.octet_1 = dp::kDpv1Enable, .octet_3 = dp::kPrmStructure | dp::kPrmCmd});
}

dp::IsoMPrm isochron_times(const gsd::DpV2& abilities, Ticks cycle) {
    dp::IsoMPrm times{.version = 1, .tbase_dp = abilities.tbase_dp, .t_mapc = 1, .tbase_io = abilities.tbase_io};
    times.t_i = static_cast<std::uint16_t>(std::min<std::uint32_t>(abilities.ti_min, 0xFFFF));
    times.t_o = static_cast<std::uint16_t>(std::min<std::uint32_t>(abilities.to_min, 0xFFFF));
    times.t_pll_w = static_cast<std::uint16_t>(std::min<std::uint32_t>(abilities.t_pll_w_max, 0xFFFF));
    const std::int64_t base = kTwelfth.n * abilities.tbase_dp;
    if (base == 0 || cycle.n % base != 0) return times;
    const std::int64_t units = cycle.n / base, most = abilities.tdp_max == 0 ? 0xFFFF : std::min<std::int64_t>(abilities.tdp_max, 0xFFFF);
    if (units >= std::int64_t{abilities.tdp_min} && units <= most) times.t_dp = static_cast<std::uint16_t>(units);
    return times;
}

}  // namespace dpchip::master
