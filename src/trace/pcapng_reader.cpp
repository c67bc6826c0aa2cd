// SPDX-License-Identifier: Apache-2.0
// Reading pcapng, total over any octets.
#include <algorithm>
#include <limits>
#include <optional>

#include <dpchip/trace/pcapng.hpp>

namespace dpchip::trace {
namespace {

constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A, kInterfaceDescription = 1, kSimplePacket = 3, kEnhancedPacket = 6;
constexpr std::uint16_t kComment = 1, kEpbFlags = 2, kIfTsResolution = 9, kIfTsOffset = 14;
constexpr std::uint64_t kMinBlock = 12;
__extension__ using Wide = unsigned __int128;

/// How a section's interface counts time.
struct Interface {
    std::uint16_t link_type{};
    std::uint32_t snap_length{};
    std::uint8_t resolution = 6;  ///< bit 7: power of 2, else power of 10
    std::int64_t offset_s{};
};

/// value * numerator / denominator as a signed 64-bit number, saturated.
std::int64_t scaled(std::uint64_t value, std::uint64_t numerator, Wide denominator) {
    const Wide result = Wide{value} * numerator / denominator;
    constexpr auto kMax = std::numeric_limits<std::int64_t>::max();
    return result > static_cast<Wide>(kMax) ? kMax : static_cast<std::int64_t>(result);
}

std::int64_t saturating_add(std::int64_t a, std::int64_t b) {
    std::int64_t sum = 0;
    if (__builtin_add_overflow(a, b, &sum)) return b > 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
    return sum;
}

std::int64_t to_ns(std::uint64_t ticks, const Interface& on) {
    constexpr std::uint64_t kNsPerSecond = 1'000'000'000;
    Wide per_second = 1;
    const unsigned power = on.resolution & 0x7Fu;
    if ((on.resolution & 0x80u) != 0) {
        per_second = power < 127 ? Wide{1} << power : Wide{1} << 126;
    } else {
        for (unsigned i = 0; i < std::min(power, 38u); ++i) per_second *= 10;
    }
    std::int64_t offset = 0;
    if (__builtin_mul_overflow(on.offset_s, static_cast<std::int64_t>(kNsPerSecond), &offset))
        offset = on.offset_s > 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
    return saturating_add(scaled(ticks, kNsPerSecond, per_second), offset);
}

class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> file) : file_{file} {}

    Capture read() {
        if (!is_pcapng(file_)) { capture_.error = PcapngError::not_pcapng; return std::move(capture_); }
        while (at_ < file_.size() && capture_.error == PcapngError::none) {
            capture_.offset = at_;
            capture_.error = block();
        }
        if (capture_.error == PcapngError::none) capture_.offset = at_;
        return std::move(capture_);
    }

private:
    std::uint64_t number(std::span<const std::uint8_t> from, std::size_t at, std::size_t octets) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < octets; ++i) value = value << 8 | from[at + (big_endian_ ? i : octets - 1 - i)];
        return value;
    }
    std::uint16_t u16(std::span<const std::uint8_t> from, std::size_t at) const { return static_cast<std::uint16_t>(number(from, at, 2)); }
    std::uint32_t u32(std::span<const std::uint8_t> from, std::size_t at) const { return static_cast<std::uint32_t>(number(from, at, 4)); }

    PcapngError block() {
        const auto rest = file_.subspan(at_);
        if (rest.size() < kMinBlock) return PcapngError::truncated;
        const bool section = rest[0] == 0x0A && rest[1] == 0x0D && rest[2] == 0x0D && rest[3] == 0x0A;
        if (section) {
            if (rest[8] == 0x1A && rest[9] == 0x2B && rest[10] == 0x3C && rest[11] == 0x4D) big_endian_ = true;
            else if (rest[8] == 0x4D && rest[9] == 0x3C && rest[10] == 0x2B && rest[11] == 0x1A) big_endian_ = false;
            else return PcapngError::byte_order;
        }
        const std::uint64_t length = u32(rest, 4);
        if (length < kMinBlock || length % 4 != 0) return PcapngError::block_length;
        if (length > rest.size()) return PcapngError::truncated;
        if (u32(rest, length - 4) != length) return PcapngError::block_length;
        const auto body = rest.subspan(8, length - kMinBlock);
        const PcapngError error = contents(u32(rest, 0), body);
        if (error == PcapngError::none) at_ += length;
        return error;
    }

    PcapngError contents(std::uint32_t type, std::span<const std::uint8_t> body) {
        switch (type) {
        case kSectionHeader: return section_header(body);
        case kInterfaceDescription: return interface_description(body);
        case kEnhancedPacket: return enhanced_packet(body);
        case kSimplePacket: return simple_packet(body);
        default: ++capture_.skipped_blocks; return PcapngError::none;
        }
    }

    PcapngError section_header(std::span<const std::uint8_t> body) {
        if (body.size() < 16) return PcapngError::block_length;
        if (u16(body, 4) != 1) return PcapngError::version;
        interfaces_.clear();
        return PcapngError::none;
    }

    PcapngError interface_description(std::span<const std::uint8_t> body) {
        if (body.size() < 8) return PcapngError::block_length;
        Interface added{u16(body, 0), u32(body, 4)};
        each_option(body.subspan(8), [&](std::uint16_t code, std::span<const std::uint8_t> value) {
            if (code == kIfTsResolution && !value.empty()) added.resolution = value[0];
            if (code == kIfTsOffset && value.size() >= 8) added.offset_s = static_cast<std::int64_t>(number(value, 0, 8));
        });
        interfaces_.push_back(added);
        return PcapngError::none;
    }

    PcapngError enhanced_packet(std::span<const std::uint8_t> body) {
        if (body.size() < 20) return PcapngError::block_length;
        const std::uint32_t interface = u32(body, 0), length = u32(body, 12);
        if (interface >= interfaces_.size()) return PcapngError::no_interface;
        if (length > body.size() - 20) return PcapngError::packet_length;
        CapturedPacket packet{};
        packet.time_ns = to_ns(std::uint64_t{u32(body, 4)} << 32 | u32(body, 8), interfaces_[interface]);
        packet.link_type = interfaces_[interface].link_type;
        packet.octets = body.subspan(20, length);
        packet.original_length = u32(body, 16);
        const std::size_t options = std::min<std::size_t>(20 + (std::size_t{length} + 3) / 4 * 4, body.size());
        each_option(body.subspan(options), [&](std::uint16_t code, std::span<const std::uint8_t> value) {
            if (code == kComment && packet.comment.empty())
                packet.comment = {reinterpret_cast<const char*>(value.data()), value.size()};
            if (code == kEpbFlags && value.size() >= 4 && (u32(value, 0) & 3u) != 3)
                packet.direction = static_cast<Direction>(u32(value, 0) & 3u);
        });
        capture_.packets.push_back(packet);
        return PcapngError::none;
    }

    PcapngError simple_packet(std::span<const std::uint8_t> body) {
        if (body.size() < 4) return PcapngError::block_length;
        if (interfaces_.empty()) return PcapngError::no_interface;
        CapturedPacket packet{};
        packet.has_time = false;
        packet.link_type = interfaces_[0].link_type;
        packet.original_length = u32(body, 0);
        const std::uint32_t snap = interfaces_[0].snap_length;
        const std::uint32_t length = snap == 0 ? packet.original_length : std::min(packet.original_length, snap);
        if (length > body.size() - 4) return PcapngError::packet_length;
        packet.octets = body.subspan(4, length);
        capture_.packets.push_back(packet);
        return PcapngError::none;
    }

    /// Options that do not fit end the list: the block itself is sound, so its packet is kept.
    template <class Visit>
    void each_option(std::span<const std::uint8_t> list, Visit&& visit) const {
        while (list.size() >= 4) {
            const std::uint16_t code = u16(list, 0);
            const std::size_t length = u16(list, 2);
            if (code == 0 || length > list.size() - 4) return;
            visit(code, list.subspan(4, length));
            list = list.subspan(std::min(4 + (length + 3) / 4 * 4, list.size()));
        }
    }

    std::span<const std::uint8_t> file_;
    std::size_t at_{};
    bool big_endian_{};
    std::vector<Interface> interfaces_;
    Capture capture_;
};

}  // namespace

const char* name(PcapngError error) {
    switch (error) {
    case PcapngError::none: return "no error";
    case PcapngError::not_pcapng: return "not a pcapng file";
    case PcapngError::byte_order: return "section header without a valid byte-order magic";
    case PcapngError::version: return "unknown pcapng version";
    case PcapngError::truncated: return "the file ends inside a block";
    case PcapngError::block_length: return "bad block length";
    case PcapngError::no_interface: return "packet of an interface that was not described";
    case PcapngError::packet_length: return "packet longer than its block";
    }
    return "unknown";
}

bool is_pcapng(std::span<const std::uint8_t> file) {
    return file.size() >= 4 && file[0] == 0x0A && file[1] == 0x0D && file[2] == 0x0D && file[3] == 0x0A;
}

Capture read_pcapng(std::span<const std::uint8_t> file) { return Reader{file}.read(); }

}  // namespace dpchip::trace
