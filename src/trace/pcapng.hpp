// SPDX-License-Identifier: Apache-2.0
// pcapng: captures that Wireshark and its relatives open (draft-ietf-opsawg-pcapng).
//
// Written: Section Header, Interface Description with nanosecond times, Enhanced Packet Blocks with direction and
// comment. Read: the same and Simple Packet Blocks, either byte order, any time resolution, any number of sections.
// Not read: the obsolete Packet Block, name resolution, statistics and custom blocks; they are skipped and counted.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dpchip::trace {

/// What the octets of a packet are. Any 16-bit number may stand in a file; these two mean PROFIBUS here.
enum class LinkType : std::uint16_t {
    user0 = 147,        ///< reserved for private use; Wireshark opens it and tools/wireshark/profibus.lua dissects it
    profibus_dl = 257,  ///< PROFIBUS data link layer, SD to ED
};

/// Which way a packet went, seen from the program that recorded it.
enum class Direction : std::uint8_t { unknown, inbound, outbound };

/// One packet to write.
struct Packet {
    std::int64_t time_ns{};                 ///< since 1970-01-01, or since the start of a simulation; not negative
    std::span<const std::uint8_t> octets{};
    Direction direction = Direction::unknown;
    std::string_view comment{};             ///< UTF-8, at most 65535 octets are kept; empty: none
    std::uint32_t interface{};              ///< as add_interface() returned it
};

/// Writes a capture block by block; every block leaves in one write, so a cut file loses at most its last packet.
class PcapngWriter {
public:
    /// `out` must outlive the writer. The Section Header is written at once; `application` is named in it.
    explicit PcapngWriter(std::ostream& out, std::string_view application = "dpchip");

    /// Describes one line; returns the number to put into Packet::interface.
    std::uint32_t add_interface(LinkType type, std::string_view name, std::string_view description = {});
    /// False when the stream failed or the interface was never added; nothing is written then.
    bool write(const Packet& packet);
    /// Packets written so far.
    [[nodiscard]] std::uint64_t packets() const { return packets_; }

private:
    bool flush();

    std::ostream& out_;
    std::vector<std::uint8_t> block_;
    std::uint32_t interfaces_{};
    std::uint64_t packets_{};
};

/// Why reading ended before the end of the file. Each enumerator has a test of its name.
enum class PcapngError : std::uint8_t {
    none,            ///< everything was read
    not_pcapng,      ///< the file does not begin with a Section Header Block
    byte_order,      ///< a Section Header without a valid byte-order magic
    version,         ///< a section of a major version other than 1
    truncated,       ///< the file ends inside a block
    block_length,    ///< a block length below the minimum, not a multiple of 4, or differing at its two ends
    no_interface,    ///< a packet of an interface that was not described
    packet_length,   ///< a packet longer than its block
};
const char* name(PcapngError error);

/// One packet as read. `octets` and `comment` point into the file's octets.
struct CapturedPacket {
    std::int64_t time_ns{};           ///< rounded down; 0 when has_time is false
    bool has_time = true;             ///< Simple Packet Blocks carry no time
    std::uint16_t link_type{};
    Direction direction = Direction::unknown;
    std::span<const std::uint8_t> octets{};
    std::uint32_t original_length{};  ///< larger than octets.size() when the packet was cut by a snap length
    std::string_view comment{};       ///< the first comment
};

/// Everything that could be read, and what ended the reading.
struct Capture {
    std::vector<CapturedPacket> packets;
    std::uint64_t skipped_blocks{};   ///< blocks of other types
    PcapngError error = PcapngError::none;
    std::uint64_t offset{};           ///< of the block that the error is about, or the end
};

/// True when `file` begins like a pcapng file.
bool is_pcapng(std::span<const std::uint8_t> file);

/// Reads a whole file. Total: any octets give a Capture. `file` must outlive the result.
Capture read_pcapng(std::span<const std::uint8_t> file);

}  // namespace dpchip::trace
