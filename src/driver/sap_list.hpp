// SPDX-License-Identifier: Apache-2.0
// The SAP list in the chip's RAM and the hand-over of its buffers, octet by octet (VPC3+C 7.2.1, figures 7-3 to 7-6;
// reference 5.1, 5.2, 10.13).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/driver/acyclic_layout.hpp>
#include <dpchip/driver/bus_port.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::driver::detail {

/// Who may use a SAP, or who did.
struct Requester {
    std::uint8_t sa{0x7F};    ///< the raw SA octet, bit 7 set when an SSAP follows; 7FH: anybody
    std::uint8_t ssap{0x7F};  ///< 7FH: any; 40H: none

    constexpr std::uint8_t master() const { return sa & 0x7Fu; }
};

/// A buffer of a request.
enum class Buffer : std::uint8_t { first, second };

template <BusPort Bus>
class SapList {
public:
    static constexpr std::uint8_t kSrd = 0x0B;      // Service_Supported: SRD low and high

    explicit SapList(Bus bus) : bus_{bus} {}

    /// Writes the whole list, every SAP locked, every buffer empty.
    void set_up(const AcyclicLayout& layout, std::uint8_t own_address) {
        layout_ = layout;
        for (std::uint8_t ch = 0; ch < layout_.channels(); ++ch) {
            if (!layout_.has(ch)) continue;
            const std::array<std::uint8_t, kSapEntry> entry{channel_sap(ch), own_address, 0, kSrd, layout_.request_buffer(ch),
                                                            layout_.second_buffer(ch), layout_.answer_buffer(ch)};
            bus_.write_block(layout_.entry(ch), entry);
            set_up_buffer(layout_.request_buffer(ch), layout_.max_pdu(ch));
            if (ch == channel::resource_manager) set_up_buffer(layout_.answer_buffer(ch), dp::kResourceManagerPdu);
            else if (ch >= channel::connection0) set_up_buffer(layout_.second_buffer(ch), dp::kMaxAbortPdu);
        }
        bus_.write(static_cast<std::uint16_t>(layout_.address(layout_.list) + layout_.entries() * kSapEntry), 0xFF);
    }
    const AcyclicLayout& layout() const { return layout_; }

    // ---- who may use it -----------------------------------------------------------------------------------------
    /// No telegram's SA can be the station's own.
    void lock(std::uint8_t ch, std::uint8_t own_address) {
        bus_.write(entry(ch, 1), own_address);
        bus_.write(entry(ch, 2), 0);
    }
    /// SSAP first: while the address does not match, nothing comes in.
    void open(std::uint8_t ch, const Requester& who) {
        bus_.write(entry(ch, 2), who.ssap);
        bus_.write(entry(ch, 1), who.sa);
    }
    Requester requester(std::uint8_t ch) { return {bus_.read(entry(ch, 1)), bus_.read(entry(ch, 2))}; }

    // ---- requests -----------------------------------------------------------------------------------------------
    bool has_request(std::uint8_t ch, Buffer which) {
        namespace b = regmap::buffer_control;
        return (bus_.read(buffer(ch, which)) & (b::ind | b::inuse)) == b::ind;
    }
    /// Copies the request out; the buffer stays the user's. `out` must hold any PDU.
    std::span<const std::uint8_t> read_request(std::uint8_t ch, Buffer which, std::span<std::uint8_t> out) {
        const auto pdu = peek_request(ch, which, out);
        bus_.write(buffer(ch, which), regmap::buffer_control::user);
        return pdu;
    }
    /// The request's first octets, as long as no answer has been written over them.
    std::span<const std::uint8_t> peek_request(std::uint8_t ch, Buffer which, std::span<std::uint8_t> out) {
        const std::uint16_t at = buffer(ch, which);
        const std::size_t length = std::min<std::size_t>(bus_.read(static_cast<std::uint16_t>(at + 2)), out.size());
        bus_.read_block(static_cast<std::uint16_t>(at + kAcyclicHeader), out.first(length));
        return out.first(length);
    }
    /// Puts a request into the first buffer as if it had come in there, the user's already.
    void keep_request(std::uint8_t ch, std::span<const std::uint8_t> pdu) {
        const std::uint16_t at = buffer(ch, Buffer::first);
        const std::span<const std::uint8_t> kept = pdu.first(std::min<std::size_t>(pdu.size(), layout_.max_pdu(ch)));
        bus_.write(at, regmap::buffer_control::user);
        bus_.write(static_cast<std::uint16_t>(at + 2), static_cast<std::uint8_t>(kept.size()));
        bus_.write_block(static_cast<std::uint16_t>(at + kAcyclicHeader), kept);
    }
    /// Gives a request buffer back to the chip.
    void release(std::uint8_t ch, Buffer which) { bus_.write(buffer(ch, which), 0); }

    // ---- answers ------------------------------------------------------------------------------------------------
    /// `head` and `data`, one behind the other. The control octet is written last.
    void respond(std::uint8_t ch, std::span<const std::uint8_t> head, std::span<const std::uint8_t> data = {}) {
        namespace b = regmap::buffer_control;
        const std::uint16_t at = layout_.address(layout_.answer_buffer(ch));
        bus_.write(at, b::user);  // what stood ready before must not go out half written over
        bus_.write(static_cast<std::uint16_t>(at + 2), static_cast<std::uint8_t>(head.size() + data.size()));
        bus_.write(static_cast<std::uint16_t>(at + 3), kDataLow);
        bus_.write_block(static_cast<std::uint16_t>(at + kAcyclicHeader), head);
        bus_.write_block(static_cast<std::uint16_t>(at + kAcyclicHeader + head.size()), data);
        bus_.write(at, b::user | b::resp);
    }
    void withdraw_answer(std::uint8_t ch) { bus_.write(layout_.address(layout_.answer_buffer(ch)), 0); }
    /// True once for every answer that has been sent.
    bool take_response_sent(std::uint8_t ch) {
        const std::uint8_t octet = bus_.read(entry(ch, 0));
        if ((octet & 0x80u) == 0) return false;
        bus_.write(entry(ch, 0), octet & 0x7Fu);
        return true;
    }

private:
    static constexpr std::uint8_t kDataLow = 0x08;  // Function Code of an answer: DL

    std::uint16_t entry(std::uint8_t ch, unsigned octet) const { return static_cast<std::uint16_t>(layout_.entry(ch) + octet); }
    std::uint16_t buffer(std::uint8_t ch, Buffer which) const {
        return layout_.address(which == Buffer::first ? layout_.request_buffer(ch) : layout_.second_buffer(ch));
    }
    void set_up_buffer(std::uint8_t segment, std::size_t pdu) {
        const std::array<std::uint8_t, kAcyclicHeader> header{0, static_cast<std::uint8_t>(pdu), 0, 0};
        bus_.write_block(layout_.address(segment), header);
    }

    Bus bus_;
    AcyclicLayout layout_{};
};

}  // namespace dpchip::driver::detail
