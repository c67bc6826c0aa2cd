// SPDX-License-Identifier: Apache-2.0
// Any octets as a pcapng file: what was read lies inside the file, and the rest of what `dpchip decode` does with the
// packets is total too. The same octets are read as hexadecimal text.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <dpchip/trace/dialogue.hpp>
#include <dpchip/trace/hex_text.hpp>
#include <dpchip/trace/pcapng.hpp>

namespace {

using namespace dpchip::trace;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

void inside(std::span<const std::uint8_t> file, const void* part, std::size_t size) {
    if (size == 0) return;
    const auto* begin = static_cast<const std::uint8_t*>(part);
    require(begin >= file.data() && begin + size <= file.data() + file.size());
}

void explained(Dialogue& dialogue, std::span<const std::uint8_t> octets) {
    std::size_t at = 0;
    for (const Utterance& u : split(octets)) {
        require(u.offset == at && !u.octets.empty());
        at += u.octets.size();
        require(!dialogue.next(u.octets).line.empty());
    }
    require(at == octets.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> file{data, size};
    const Capture capture = read_pcapng(file);
    require(capture.offset <= size && name(capture.error) != nullptr);
    require((capture.error == PcapngError::none) == (is_pcapng(file) && capture.offset == size));
    Dialogue dialogue;
    for (const CapturedPacket& packet : capture.packets) {
        inside(file, packet.octets.data(), packet.octets.size());
        inside(file, packet.comment.data(), packet.comment.size());
        explained(dialogue, packet.octets);
    }
    const HexText text = read_hex({reinterpret_cast<const char*>(data), size});
    require(text.lines.size() == text.octets.size() && text.octets.size() <= size);
    explained(dialogue, text.octets);
    return 0;
}
