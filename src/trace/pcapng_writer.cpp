// SPDX-License-Identifier: Apache-2.0
// Writing pcapng, little-endian.
#include <algorithm>
#include <ostream>

#include <dpchip/trace/pcapng.hpp>

namespace dpchip::trace {
namespace {

constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A, kInterfaceDescription = 1, kEnhancedPacket = 6;
constexpr std::uint16_t kEndOfOptions = 0, kComment = 1, kEpbFlags = 2, kIfName = 2, kIfDescription = 3,
                        kIfTsResolution = 9, kShbUserApplication = 4;
constexpr std::size_t kMaxOption = 0xFFFF;

/// Builds one block: header and trailer are put around what is added in between.
class Block {
public:
    Block(std::vector<std::uint8_t>& octets, std::uint32_t type) : octets_{octets} {
        octets_.clear();
        u32(type);
        u32(0);
    }
    void u16(std::uint16_t v) { little(v, 2); }
    void u32(std::uint32_t v) { little(v, 4); }
    void u64(std::uint64_t v) { little(v, 8); }
    void padded(std::span<const std::uint8_t> data) {
        octets_.insert(octets_.end(), data.begin(), data.end());
        octets_.resize((octets_.size() + 3) / 4 * 4);
    }
    void option(std::uint16_t code, std::span<const std::uint8_t> value) {
        u16(code);
        u16(static_cast<std::uint16_t>(value.size()));
        padded(value);
    }
    void option(std::uint16_t code, std::string_view text) {
        if (text.empty()) return;
        text = text.substr(0, kMaxOption);
        option(code, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }
    /// Ends the block; after options there must have been an end_of_options().
    void finish() {
        const auto length = static_cast<std::uint32_t>(octets_.size() + 4);
        u32(length);
        for (std::size_t i = 0; i < 4; ++i) octets_[4 + i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
    void end_of_options() { u32(kEndOfOptions); }

private:
    void little(std::uint64_t value, std::size_t octets) {
        for (std::size_t i = 0; i < octets; ++i) octets_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    std::vector<std::uint8_t>& octets_;
};

}  // namespace

PcapngWriter::PcapngWriter(std::ostream& out, std::string_view application) : out_{out} {
    Block block{block_, kSectionHeader};
    block.u32(0x1A2B3C4D);
    block.u16(1);
    block.u16(0);
    block.u64(~std::uint64_t{0});  // section length unknown: the file is a stream
    block.option(kShbUserApplication, application);
    block.end_of_options();
    block.finish();
    flush();
}

std::uint32_t PcapngWriter::add_interface(LinkType type, std::string_view name, std::string_view description) {
    Block block{block_, kInterfaceDescription};
    block.u16(static_cast<std::uint16_t>(type));
    block.u16(0);
    block.u32(0);  // no snap length
    block.option(kIfName, name);
    block.option(kIfDescription, description);
    static constexpr std::uint8_t kNanoseconds[]{9};
    block.option(kIfTsResolution, kNanoseconds);
    block.end_of_options();
    block.finish();
    flush();
    return interfaces_++;
}

bool PcapngWriter::write(const Packet& packet) {
    if (packet.interface >= interfaces_ || !out_) return false;
    const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(packet.time_ns, 0));
    const auto length = static_cast<std::uint32_t>(packet.octets.size());
    Block block{block_, kEnhancedPacket};
    block.u32(packet.interface);
    block.u32(static_cast<std::uint32_t>(time >> 32));
    block.u32(static_cast<std::uint32_t>(time));
    block.u32(length);
    block.u32(length);
    block.padded(packet.octets);
    if (packet.direction != Direction::unknown || !packet.comment.empty()) {
        block.option(kComment, packet.comment);
        if (packet.direction != Direction::unknown) {
            const std::uint8_t flags[]{static_cast<std::uint8_t>(packet.direction), 0, 0, 0};
            block.option(kEpbFlags, flags);
        }
        block.end_of_options();
    }
    block.finish();
    if (!flush()) return false;
    ++packets_;
    return true;
}

bool PcapngWriter::flush() {
    out_.write(reinterpret_cast<const char*>(block_.data()), static_cast<std::streamsize>(block_.size()));
    return static_cast<bool>(out_);
}

}  // namespace dpchip::trace
