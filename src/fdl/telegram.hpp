// SPDX-License-Identifier: Apache-2.0
// FDL telegrams: decode into a view, encode from a value (reference 2.1, 2.4, 2.7). constexpr, so golden telegrams are static_asserts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/result.hpp>
#include <dpchip/fdl/function_code.hpp>

namespace dpchip::fdl {

inline constexpr std::uint8_t kSd1 = 0x10;  ///< no data unit
inline constexpr std::uint8_t kSd2 = 0x68;  ///< data unit of variable length
inline constexpr std::uint8_t kSd3 = 0xA2;  ///< data unit of exactly 8 octets
inline constexpr std::uint8_t kSd4 = 0xDC;  ///< token
inline constexpr std::uint8_t kSc = 0xE5;   ///< short acknowledgement
inline constexpr std::uint8_t kEd = 0x16;   ///< end delimiter

inline constexpr std::uint8_t kBroadcast = 127;
inline constexpr std::uint8_t kMinLe = 4, kMaxLe = 249;
inline constexpr std::size_t kMaxDataUnit = 246;  ///< SAP octets included

/// Why octets are not a telegram. Each enumerator has a test of its name.
enum class Reject : std::uint8_t {
    need_more,               ///< a good beginning; more octets are needed
    start_delimiter,         ///< the first octet is none of SD1..SD4, SC
    length_mismatch,         ///< LE and LEr differ
    length_range,            ///< LE is not in 4..249
    second_start_delimiter,  ///< the second SD2 is missing
    checksum,                ///< FCS is not the sum of DA .. last data octet
    end_delimiter,           ///< ED is not 16h
    parity,                  ///< a character has odd parity
    stop_bit,                ///< a stop bit is 0
    gap,                     ///< idle time inside a telegram, or a start bit outside its window
    collision,               ///< two stations sent at once
};
const char* name(Reject reason);

/// A telegram, taken apart; a view into the octets it was decoded from.
struct Telegram {
    std::uint8_t sd{};                    ///< start delimiter, or kSc
    std::uint8_t da{};                    ///< raw, with the extension bit; 0 for SC
    std::uint8_t sa{};                    ///< raw, with the extension bit; 0 for SC
    FunctionCode fc{};                    ///< meaningless for SC and SD4
    std::span<const std::uint8_t> unit{}; ///< data unit, SAP octets included
    std::size_t size{};                   ///< octets from SD to ED

    constexpr std::uint8_t destination() const { return da & 0x7Fu; }
    constexpr std::uint8_t source() const { return sa & 0x7Fu; }
    constexpr bool has_dsap() const { return (da & 0x80u) != 0; }
    constexpr bool has_ssap() const { return (sa & 0x80u) != 0; }
    /// SAP octets announced by the extension bits.
    constexpr std::size_t sap_octets() const { return (has_dsap() ? 1u : 0u) + (has_ssap() ? 1u : 0u); }
    /// False when the data unit has no room for the announced SAP octets (reference 2.4: discard).
    constexpr bool saps_present() const { return unit.size() >= sap_octets(); }
    /// DSAP and SSAP; call only when has_dsap() / has_ssap() and saps_present().
    constexpr std::uint8_t dsap() const { return unit[0]; }
    constexpr std::uint8_t ssap() const { return unit[has_dsap() ? 1u : 0u]; }
    /// The data behind the SAP octets; needs saps_present().
    constexpr std::span<const std::uint8_t> data() const { return unit.subspan(sap_octets()); }
    constexpr bool has_addresses() const { return sd != kSc; }
    constexpr bool has_fc() const { return sd == kSd1 || sd == kSd2 || sd == kSd3; }
};

/// Octets from SD to ED that a telegram beginning with `in` has; need_more when that is not known yet.
constexpr core::Result<std::size_t, Reject> telegram_size(std::span<const std::uint8_t> in) {
    if (in.empty()) return Reject::need_more;
    switch (in[0]) {
    case kSc: return std::size_t{1};
    case kSd4: return std::size_t{3};
    case kSd1: return std::size_t{6};
    case kSd3: return std::size_t{14};
    case kSd2: break;
    default: return Reject::start_delimiter;
    }
    if (in.size() < 2) return Reject::need_more;
    if (in[1] < kMinLe || in[1] > kMaxLe) return Reject::length_range;
    if (in.size() < 3) return Reject::need_more;
    if (in[1] != in[2]) return Reject::length_mismatch;
    if (in.size() < 4) return Reject::need_more;
    if (in[3] != kSd2) return Reject::second_start_delimiter;
    return std::size_t{in[1]} + 6;
}

/// Sum modulo 256 of DA .. last data octet.
constexpr std::uint8_t frame_check_sequence(std::span<const std::uint8_t> octets) {
    unsigned sum = 0;
    for (const std::uint8_t o : octets) sum += o;
    return static_cast<std::uint8_t>(sum);
}

/// The telegram at the start of `in`; what follows it is not looked at.
constexpr core::Result<Telegram, Reject> decode(std::span<const std::uint8_t> in) {
    const auto size = telegram_size(in);
    if (!size) return size.error();
    if (in.size() < *size) return Reject::need_more;
    if (in[0] == kSc) return Telegram{kSc, 0, 0, {}, {}, 1};
    if (in[0] == kSd4) return Telegram{kSd4, in[1], in[2], {}, {}, 3};
    const std::size_t head = in[0] == kSd2 ? 4 : 1;
    const std::size_t body = *size - head - 2;
    if (frame_check_sequence(in.subspan(head, body)) != in[head + body]) return Reject::checksum;
    if (in[head + body + 1] != kEd) return Reject::end_delimiter;
    return Telegram{in[0], in[head], in[head + 1], {in[head + 2]}, in.subspan(head + 3, body - 3), *size};
}

/// After a Reject other than need_more: octets to drop before it is worth trying again (at least 1).
/// The next octet that could start a telegram is kept, so a good telegram behind a bad one survives.
constexpr std::size_t resync(std::span<const std::uint8_t> in) {
    for (std::size_t i = 1; i < in.size(); ++i)
        if (in[i] == kSd1 || in[i] == kSd2 || in[i] == kSd3 || in[i] == kSd4 || in[i] == kSc) return i;
    return in.empty() ? 1 : in.size();
}

/// Writes `10 DA SA FC FCS 16`; returns 6, or 0 when `out` is too small.
constexpr std::size_t encode_sd1(std::span<std::uint8_t> out, std::uint8_t da, std::uint8_t sa, std::uint8_t fc) {
    if (out.size() < 6) return 0;
    out[0] = kSd1; out[1] = da; out[2] = sa; out[3] = fc;
    out[4] = static_cast<std::uint8_t>(da + sa + fc);
    out[5] = kEd;
    return 6;
}

/// Writes SD2 around a data unit of `unit` octets that already stands at out[7]; returns unit + 9.
/// 0 when `out` is too small or the unit is not 1..246 octets long.
constexpr std::size_t finish_sd2(std::span<std::uint8_t> out, std::uint8_t da, std::uint8_t sa, std::uint8_t fc,
                                 std::size_t unit) {
    if (unit < 1 || unit > kMaxDataUnit || out.size() < unit + 9) return 0;
    const auto le = static_cast<std::uint8_t>(unit + 3);
    out[0] = kSd2; out[1] = le; out[2] = le; out[3] = kSd2;
    out[4] = da; out[5] = sa; out[6] = fc;
    out[unit + 7] = frame_check_sequence(out.subspan(4, unit + 3));
    out[unit + 8] = kEd;
    return unit + 9;
}

/// Writes SD2 (SD1 when there is nothing in the data unit). 0 when `out` is too small or the unit too long.
constexpr std::size_t encode(std::span<std::uint8_t> out, std::uint8_t da, std::uint8_t sa, std::uint8_t fc,
                             std::span<const std::uint8_t> unit) {
    if (unit.empty()) return encode_sd1(out, da, sa, fc);
    if (unit.size() > kMaxDataUnit || out.size() < unit.size() + 9) return 0;
    for (std::size_t i = 0; i < unit.size(); ++i) out[7 + i] = unit[i];
    return finish_sd2(out, da, sa, fc, unit.size());
}

/// A request or an answer between SAPs, as a value: extension bits and SAP octets are put in by encode().
struct SapTelegram {
    std::uint8_t da{}, sa{};                 ///< without extension bits
    std::uint8_t fc{};
    std::uint8_t dsap{}, ssap{};
    std::span<const std::uint8_t> data{};    ///< at most 244 octets
};
constexpr std::size_t encode(std::span<std::uint8_t> out, const SapTelegram& t) {
    if (t.data.size() > kMaxDataUnit - 2 || out.size() < t.data.size() + 11) return 0;
    out[7] = t.dsap;
    out[8] = t.ssap;
    for (std::size_t i = 0; i < t.data.size(); ++i) out[9 + i] = t.data[i];
    return finish_sd2(out, t.da | 0x80u, t.sa | 0x80u, t.fc, t.data.size() + 2);
}

/// Writes the token `DC DA SA`; returns 3, or 0 when `out` is too small.
constexpr std::size_t encode_token(std::span<std::uint8_t> out, std::uint8_t da, std::uint8_t sa) {
    if (out.size() < 3) return 0;
    out[0] = kSd4; out[1] = da; out[2] = sa;
    return 3;
}

}  // namespace dpchip::fdl
