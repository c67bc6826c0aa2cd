// SPDX-License-Identifier: Apache-2.0
// Where the SAP list and its buffers lie: behind the buffers of layout.hpp (VPC3+C 7.2.1; reference 5.1).
//
// SAPs 51 and 50 have one buffer each, for the request and then for its answer. A connection has that and a second,
// short one, so that an Abort gets through while an answer is worked on. SAP 49 has one for the request and one in
// which its answer stands ready.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <dpchip/dp/acyclic.hpp>
#include <dpchip/dp/initiate.hpp>
#include <dpchip/dp/saps.hpp>
#include <dpchip/driver/layout.hpp>

namespace dpchip::driver {

inline constexpr std::size_t kSapEntry = 7;         ///< octets
inline constexpr std::size_t kAcyclicHeader = 4;    ///< of a buffer: Control, Max_Length, Length, Function Code
inline constexpr std::uint8_t kMaxConnections = dp::kLastMs2Sap + 1;

/// The users of the SAP list; connection n is connection0 + n.
namespace channel {
// NOLINTNEXTLINE(readability-identifier-naming): words, like the registers'
inline constexpr std::uint8_t ms1 = 0, alarm = 1, resource_manager = 2, connection0 = 3;
}

/// A connection's SAP: from 48 downwards.
constexpr std::uint8_t channel_sap(std::uint8_t ch) {
    switch (ch) {
    case channel::ms1: return dp::kSapMs1;
    case channel::alarm: return dp::kSapAlarm;
    case channel::resource_manager: return dp::kSapResourceManager;
    default: return static_cast<std::uint8_t>(dp::kLastMs2Sap + channel::connection0 - ch);
    }
}

/// Segments; see Layout. `pdu` lengths are those of the buffers' data.
struct AcyclicLayout {
    ConfigError error = ConfigError::none;
    std::uint16_t used_bytes{};                 ///< first free address
    std::uint8_t shift{};
    std::uint8_t connections{};
    bool ms1{}, alarm{};
    std::uint8_t list{};
    std::uint8_t ms1_buffer{}, alarm_buffer{}, rm_request{}, rm_answer{};
    std::uint8_t c2_buffer{}, c2_stride{};      ///< the first, and from one to the next
    std::uint8_t c2_abort{}, c2_abort_stride{};
    std::uint8_t ms1_pdu{}, rm_pdu{}, c2_pdu{};

    constexpr std::uint16_t address(std::uint8_t segment) const { return static_cast<std::uint16_t>(segment << shift); }
    constexpr bool has(std::uint8_t ch) const {
        if (ch == channel::ms1) return ms1;
        if (ch == channel::alarm) return alarm;
        if (ch == channel::resource_manager) return connections != 0;
        return ch < channel::connection0 + connections;
    }
    constexpr std::uint8_t channels() const { return static_cast<std::uint8_t>(channel::connection0 + connections); }
    /// Address of a channel's entry. Only for channels that exist.
    constexpr std::uint16_t entry(std::uint8_t ch) const {
        unsigned before = 0;
        for (std::uint8_t c = 0; c < ch && c < channel::connection0; ++c) before += has(c) ? 1u : 0u;
        if (ch >= channel::connection0) before += ch - unsigned{channel::connection0};
        return static_cast<std::uint16_t>(address(list) + before * kSapEntry);
    }
    constexpr std::size_t entries() const { return (ms1 ? 1u : 0u) + (alarm ? 1u : 0u) + (connections != 0 ? 1u + connections : 0u); }
    /// Segment of the buffer for requests; for all but SAP 49 also of the answer.
    constexpr std::uint8_t request_buffer(std::uint8_t ch) const {
        switch (ch) {
        case channel::ms1: return ms1_buffer;
        case channel::alarm: return alarm_buffer;
        case channel::resource_manager: return rm_request;
        default: return static_cast<std::uint8_t>(c2_buffer + (ch - channel::connection0) * c2_stride);
        }
    }
    /// Segment of the second request buffer; the first one again where there is none.
    constexpr std::uint8_t second_buffer(std::uint8_t ch) const {
        if (ch < channel::connection0) return request_buffer(ch);
        return static_cast<std::uint8_t>(c2_abort + (ch - channel::connection0) * c2_abort_stride);
    }
    constexpr std::uint8_t answer_buffer(std::uint8_t ch) const {
        return ch == channel::resource_manager ? rm_answer : request_buffer(ch);
    }
    /// Octets a request may have.
    constexpr std::uint8_t max_pdu(std::uint8_t ch) const {
        switch (ch) {
        case channel::ms1: return ms1_pdu;
        case channel::alarm: return dp::kRecordHeader;
        case channel::resource_manager: return rm_pdu;
        default: return c2_pdu;
        }
    }
};

namespace detail {

constexpr bool record_length(std::uint8_t octets) { return octets >= 4 && octets <= dp::kMaxRecord; }

constexpr ConfigError check_acyclic(const Config& c) {
    const AcyclicConfig& a = c.dpv1;
    if (a.any() && !regmap::traits(c.variant).dpv1) return ConfigError::not_in_this_chip;
    if ((a.ms1 && !record_length(a.ms1_max_data)) || (a.connections != 0 && !record_length(a.ms2_max_data)))
        return ConfigError::record_length;
    if (a.connections > kMaxConnections) return ConfigError::connections;
    if (a.connections != 0 && (a.max_initiate < dp::kMinInitiateReq || a.max_initiate > dp::kMaxInitiatePdu))
        return ConfigError::initiate_length;
    if (((a.alarms != 0 || a.alarm_sap) && !a.ms1) || a.alarm_sequence > 32) return ConfigError::alarm_relation;
    if (a.max_alarm == 0) return a.alarms != 0 ? ConfigError::alarm_length : ConfigError::none;
    if (a.max_alarm < 4 || a.max_alarm > 63 || 6 + a.max_alarm > c.max_diag) return ConfigError::alarm_length;
    return ConfigError::none;
}

/// Segments of a buffer with so many octets of data.
constexpr unsigned segments(std::size_t pdu, std::uint8_t shift) {
    return static_cast<unsigned>((kAcyclicHeader + pdu + (1u << shift) - 1u) >> shift);
}

}  // namespace detail

/// Lays SAP list and buffers out behind `cyclic`, the Layout of the same configuration. Look at `error` first.
constexpr AcyclicLayout lay_out_acyclic(const Config& c, const Layout& cyclic) {
    AcyclicLayout l{};
    l.error = detail::check_acyclic(c);
    if (l.error != ConfigError::none) return l;
    const AcyclicConfig& a = c.dpv1;
    l.shift = cyclic.shift;
    l.list = cyclic.sap_list;
    l.used_bytes = cyclic.used_bytes;
    if (!a.any()) return l;  // an empty list has its place among the cyclic buffers
    l.connections = a.connections;
    l.ms1 = a.ms1;
    l.alarm = a.alarm_sap;
    l.ms1_pdu = static_cast<std::uint8_t>(dp::kRecordHeader + a.ms1_max_data);
    l.rm_pdu = a.max_initiate;
    l.c2_pdu = std::max(static_cast<std::uint8_t>(dp::kRecordHeader + a.ms2_max_data), a.max_initiate);
    unsigned next = static_cast<unsigned>(cyclic.used_bytes) >> l.shift;
    const auto take = [&next](unsigned segments) {
        const unsigned at = next;
        next += segments;
        return static_cast<std::uint8_t>(at);
    };
    l.list = take(static_cast<unsigned>((l.entries() * kSapEntry + 1 + (1u << l.shift) - 1u) >> l.shift));
    if (a.ms1) l.ms1_buffer = take(detail::segments(l.ms1_pdu, l.shift));
    if (a.alarm_sap) l.alarm_buffer = take(detail::segments(dp::kRecordHeader, l.shift));
    if (a.connections != 0) {
        l.rm_request = take(detail::segments(l.rm_pdu, l.shift));
        l.rm_answer = take(detail::segments(dp::kResourceManagerPdu, l.shift));
        l.c2_stride = static_cast<std::uint8_t>(detail::segments(l.c2_pdu, l.shift));
        l.c2_abort_stride = static_cast<std::uint8_t>(detail::segments(dp::kMaxAbortPdu, l.shift));
        l.c2_buffer = take(unsigned{l.c2_stride} * a.connections);
        l.c2_abort = take(unsigned{l.c2_abort_stride} * a.connections);
    }
    l.used_bytes = static_cast<std::uint16_t>(next << l.shift);
    if (l.used_bytes > cyclic.ram_bytes) l.error = ConfigError::acyclic_space;
    return l;
}

/// How many class-2 connections of this configuration's kind fit into the chip's RAM, at most kMaxConnections.
constexpr std::uint8_t connections_that_fit(Config c) {
    const Layout cyclic = lay_out(c);
    if (cyclic.error != ConfigError::none) return 0;
    for (c.dpv1.connections = kMaxConnections; c.dpv1.connections != 0; --c.dpv1.connections)
        if (lay_out_acyclic(c, cyclic).error == ConfigError::none) break;
    return c.dpv1.connections;
}

}  // namespace dpchip::driver
