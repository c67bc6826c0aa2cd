// SPDX-License-Identifier: Apache-2.0
// Named little-endian fields, for snapshots on disk. One describe() function both saves and loads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace dpchip::core {

/// Why a snapshot was refused.
enum class ArchiveError : std::uint8_t {
    none,       ///< nothing is wrong
    too_short,  ///< the bytes end before the last field, or the buffer is too small
    magic,      ///< not a snapshot at all
    version,    ///< a snapshot of another format version
    variant,    ///< a snapshot of another chip
    field,      ///< a field has another name or size
    crc,        ///< damaged
    invalid,    ///< well-formed, but describes a state the chip cannot be in
};

/// CRC-32 (IEEE 802.3, reflected), bit by bit: snapshots are rare.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = 0xFFFF'FFFFu;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB8'8320u : 0u);
    }
    return ~crc;
}

/// 16 bits of FNV-1a over a field's name: enough to tell that two fields were mixed up.
constexpr std::uint16_t name_hash(std::string_view name) {
    std::uint32_t h = 2166136261u;
    for (const char c : name) h = (h ^ static_cast<std::uint8_t>(c)) * 16777619u;
    return static_cast<std::uint16_t>(h ^ (h >> 16));
}

/// Visitor for describe(): writes fields into a buffer. Check `error` afterwards.
struct FieldWriter {
    std::span<std::uint8_t> out;
    std::size_t size = 0;
    ArchiveError error = ArchiveError::none;

    template <class T>
    void operator()(std::string_view name, const T& field) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(name_hash(name), 2);
        put(sizeof(T), 2);
        if (out.size() - size < sizeof(T)) { error = ArchiveError::too_short; return; }
        std::memcpy(out.data() + size, &field, sizeof(T));
        size += sizeof(T);
    }
    void put(std::uint64_t value, std::size_t octets) {
        if (out.size() - size < octets) { error = ArchiveError::too_short; return; }
        for (std::size_t i = 0; i < octets; ++i) out[size++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
};

/// Visitor for describe(): reads fields back, refusing any that does not match by name and size.
struct FieldReader {
    std::span<const std::uint8_t> in;
    std::size_t at = 0;
    ArchiveError error = ArchiveError::none;

    template <class T>
    void operator()(std::string_view name, T& field) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::uint64_t hash = get(2), octets = get(2);
        if (error != ArchiveError::none) return;
        if (hash != name_hash(name) || octets != sizeof(T)) { error = ArchiveError::field; return; }
        if (in.size() - at < sizeof(T)) { error = ArchiveError::too_short; return; }
        std::memcpy(&field, in.data() + at, sizeof(T));
        at += sizeof(T);
    }
    std::uint64_t get(std::size_t octets) {
        if (in.size() - at < octets) { error = ArchiveError::too_short; return 0; }
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < octets; ++i) value |= static_cast<std::uint64_t>(in[at++]) << (8 * i);
        return value;
    }
};

// Fields are copied as they lie in memory; every machine this runs on is little-endian.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "snapshots are little-endian");

}  // namespace dpchip::core
