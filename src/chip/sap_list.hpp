// SPDX-License-Identifier: Apache-2.0
// The SAP list in RAM: acyclic services on SAPs 0..51 (7.2.1, figures 7-3 to 7-6; reference 5.1, 5.2).
//
// An indication is stored and the user told; a response waits in its buffer until the master polls for it. The list works
// in every DP state and whatever DPV1_Enable says. Chips without DP-V1 have none: every SAP below 52 is not activated.
#pragma once

#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::sap_list {

namespace control = regmap::buffer_control;

inline constexpr std::uint8_t kHighestSap = 51, kEnd = 0xFF, kAnybody = 0x7F, kNoSsap = 0x40, kResponseSent = 0x80;
inline constexpr std::uint16_t kEntryOctets = 7, kHeaderOctets = 4;
/// An unterminated list ends here all the same; 52 SAPs are all there are.
inline constexpr unsigned kMostEntries = 128;

/// Octets of a list entry.
enum Entry : std::uint16_t { sap, request_sa, request_ssap, service_supported, ind_buf_ptr0, ind_buf_ptr1, resp_buf_ptr };
/// Octets of a buffer header.
enum Header : std::uint16_t { control_octet, max_length, length, function_code };

/// An octet of the list or of a buffer, addressed from a segment.
template <class C>
std::uint8_t& octet(C& c, std::uint8_t segment, std::size_t offset) { return c.s.ram[dpram::physical(c, segment, offset)]; }

template <class C>
std::uint8_t& entry_octet(C& c, Entry which) {
    return octet(c, dpram::pointer(c.s, regmap::org::sap_list_ptr), std::size_t{c.s.sap_entry} + which);
}

/// Looks the DSAP up and remembers where its entry begins.
template <class C>
bool find(C& c, std::uint8_t dsap) {
    for (unsigned i = 0; i < kMostEntries; ++i) {
        c.s.sap_entry = static_cast<std::uint16_t>(i * kEntryOctets);
        const std::uint8_t first = entry_octet(c, sap);
        if (first == kEnd) return false;
        if ((first & ~kResponseSent) == dsap) return true;
    }
    return false;
}

constexpr std::uint16_t fc_bit(fdl::Request r) { return static_cast<std::uint16_t>(1u << static_cast<unsigned>(r)); }

/// Function codes that Service_Supported 00..0F permits. 08 and 0C..0F name services this chip does not have.
inline constexpr auto kPermitted = [] {
    using fdl::Request;
    constexpr std::uint16_t sdn_l = fc_bit(Request::sdn_low), sdn_h = fc_bit(Request::sdn_high), sda_l = fc_bit(Request::sda_low);
    constexpr std::uint16_t sda_h = fc_bit(Request::sda_high), srd_l = fc_bit(Request::srd_low), srd_h = fc_bit(Request::srd_high);
    return std::array<std::uint16_t, 16>{
        sdn_l | sdn_h | sda_l | sda_h | srd_l | srd_h,
        sdn_l, sdn_h, sdn_l | sdn_h, sdn_l | sdn_h | srd_l | srd_h,
        sda_l, sda_h, sda_l | sda_h,
        0, srd_l, srd_h, srd_l | srd_h, 0, 0, 0, 0};
}();

constexpr bool permitted(std::uint8_t service, fdl::Request r) { return service < kPermitted.size() && (kPermitted[service] & fc_bit(r)) != 0; }

constexpr std::uint8_t ssap_of(const State& s) { return mac::has_ssap(s) ? mac::ssap(s) : kNoSsap; }

/// Source address (raw, with its extension bit), SSAP and service against the entry.
template <class C>
bool admitted(C& c) {
    const std::uint8_t sa = entry_octet(c, request_sa), ssap = entry_octet(c, request_ssap);
    if (sa != kAnybody && sa != c.s.request_sa) return false;
    if (ssap != kAnybody && (ssap & 0x7F) != (ssap_of(c.s) & 0x7F)) return false;
    if (!permitted(entry_octet(c, service_supported), mac::function_code(c.s).request())) return false;
    return entry_octet(c, ind_buf_ptr0) != 0;
}

/// An indication buffer that nobody uses and that is large enough; 0: none.
template <class C>
std::uint8_t free_buffer(C& c, std::size_t octets) {
    for (const Entry which : {ind_buf_ptr0, ind_buf_ptr1}) {
        const std::uint8_t segment = entry_octet(c, which);
        if (segment == 0) continue;
        const bool free = (octet(c, segment, control_octet) & (control::user | control::ind | control::resp | control::inuse)) == 0;
        if (free && octet(c, segment, max_length) >= octets) return segment;
    }
    return 0;
}

/// An entry that was open to anybody now belongs to this requester.
template <class C>
void capture_requester(C& c) {
    std::uint8_t& sa = entry_octet(c, request_sa);
    std::uint8_t& ssap = entry_octet(c, request_ssap);
    if (sa == kAnybody) sa = c.s.request_sa;
    if (ssap == kAnybody) ssap = ssap_of(c.s);
}

template <class C>
void store(C& c, std::uint8_t segment) {
    const auto d = mac::data(c.s);
    octet(c, segment, control_octet) = control::user | control::ind;
    octet(c, segment, length) = static_cast<std::uint8_t>(d.size());
    octet(c, segment, function_code) = mac::function_code(c.s).function();
    for (std::size_t i = 0; i < d.size(); ++i) octet(c, segment, kHeaderOctets + i) = d[i];
}

/// The response that waits on this SAP, if there is one; SDA cannot carry it.
template <class C>
bool response_ready(C& c) {
    const std::uint8_t segment = entry_octet(c, resp_buf_ptr);
    const auto request = mac::function_code(c.s).request();
    if (segment == 0 || !fdl::is_srd(request) || (octet(c, segment, control_octet) & control::resp) == 0) return false;
    c.s.resp_segment = segment;
    return true;
}

/// A request with data: an indication for the user. FDL_Ind waits for the end of an immediate response.
template <class C>
Answer indicate(C& c) {
    const std::uint8_t segment = free_buffer(c, c.s.request_length);
    if (segment == 0) return Answer::rr;
    capture_requester(c);
    store(c, segment);
    if (response_ready(c)) {
        c.s.fdl_ind_after_answer = 1;
        return Answer::response;
    }
    irq::raise(c, regmap::interrupt::fdl_ind);
    return Answer::sc;
}

/// SRD or SDA on SAPs 0..51; SDN leaves the answer to nobody.
template <class C>
Answer serve(C& c, std::uint8_t dsap) {
    if (!c.traits->dpv1 || dsap > kHighestSap || !find(c, dsap) || !admitted(c)) return Answer::rs;
    if (c.s.request_length != 0) return indicate(c);
    return response_ready(c) ? Answer::response : Answer::sc;
}

/// The response has been sent: its buffer is free again and the user is told (figure 7-6).
template <class C>
void sent(C& c) {
    octet(c, c.s.resp_segment, control_octet) &= static_cast<std::uint8_t>(~(control::resp | control::user));
    entry_octet(c, sap) |= kResponseSent;
    std::uint16_t events = regmap::interrupt::poll_end_ind;
    if (c.s.fdl_ind_after_answer != 0) events |= regmap::interrupt::fdl_ind;
    c.s.fdl_ind_after_answer = 0;
    irq::raise(c, events);
}

/// The immediate response was never sent; the indication is there all the same.
template <class C>
void given_up(C& c) {
    if (c.s.fdl_ind_after_answer == 0) return;
    c.s.fdl_ind_after_answer = 0;
    irq::raise(c, regmap::interrupt::fdl_ind);
}

}  // namespace dpchip::chip::sap_list
