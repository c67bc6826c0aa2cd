// SPDX-License-Identifier: Apache-2.0
// Data eXchange Broadcast, the subscriber (7.3.1, figures 7-10 to 7-14; reference 6.1). A publisher is Data_Exchange with
// function code 7, answered to 127 by the transmitter.
//
// Several links to one publisher are served in the order of the table and each shifts the same three buffers: only the
// last sample is left in N.
#pragma once

#include <dpchip/chip/buffer_sm.hpp>
#include <dpchip/chip/dpram.hpp>
#include <dpchip/chip/irq.hpp>
#include <dpchip/chip/mac.hpp>
#include <dpchip/chip/wd_sm.hpp>

namespace dpchip::chip::dxb {

namespace org = regmap::org;

inline constexpr std::uint8_t kLinkStatus = 0x80, kLinkError = 0x40, kDataExist = 0x01;
inline constexpr unsigned kMostLinks = 29, kLinkOctets = 4, kStatusHeader = 4;

/// An entry of DXB_Link_Buf.
struct Link {
    std::uint8_t publisher{}, publisher_length{}, sample_offset{}, sample_length{};
};

constexpr unsigned links(const State& s) {
    return std::min<unsigned>(dpram::cell(s, org::r_len_dxb_link_buf) / kLinkOctets, kMostLinks);
}

template <class C>
bool subscribes(const C& c) {
    return c.traits->dxb && c.s.dp_state == DpState::data_exch && links(c.s) != 0;
}

template <class C>
Link link(C& c, unsigned n) {
    std::array<std::uint8_t, kLinkOctets> o{};
    for (std::size_t i = 0; i < kLinkOctets; ++i)
        o[i] = c.s.ram[dpram::physical(c, dpram::pointer(c.s, org::r_dxb_link_buf_ptr), n * kLinkOctets + i)];
    return {o[0], o[1], o[2], o[3]};
}

/// The status octet of a link, the second of its pair in DXB_Status_Buf; null when the buffer is too short for it.
template <class C>
std::uint8_t* status(C& c, unsigned n) {
    const unsigned offset = kStatusHeader + 2 * n + 1;
    if (offset >= dpram::cell(c.s, org::r_len_dxb_status_buf)) return nullptr;
    return &c.s.ram[dpram::physical(c, dpram::pointer(c.s, org::r_dxb_status_buf_ptr), offset)];
}

/// An answer to everybody from one of the publishers: the only kind of answer that the chip listens to.
template <class C>
bool wants(C& c, const fdl::Telegram& t) {
    const auto code = t.fc.response();
    const bool data = (t.fc.octet & 0xC0u) == 0 && (code == fdl::Response::dl || code == fdl::Response::dh);
    if (!data || t.da != fdl::kBroadcast || !subscribes(c)) return false;
    for (unsigned n = 0; n < links(c.s); ++n)
        if (link(c, n).publisher == t.sa) return true;
    return false;
}

constexpr std::uint8_t segment(const State& s, std::uint8_t number) {
    constexpr std::array<std::uint16_t, 4> kPointers{0, org::r_dxbout_buf_ptr1, org::r_dxbout_buf_ptr2, org::r_dxbout_buf_ptr3};
    return dpram::pointer(s, kPointers[number]);
}

template <class C>
bool fits(const C& c, const Link& l, std::size_t octets) {
    return octets == l.publisher_length && std::size_t{l.sample_offset} + l.sample_length <= octets &&
           l.sample_length + 2u <= dpram::cell(c.s, org::r_len_dxbout_buf);
}

/// The sample with its origin in front goes to D, then to N (figure 7-11).
template <class C>
void store(C& c, const Link& l, std::span<const std::uint8_t> data) {
    BufferSm sm{c.s.dxbout_sm};
    const std::uint8_t to = segment(c.s, sm.at(Slot::d));
    dpram::write(c, to, std::array{l.publisher, l.sample_length});
    for (std::size_t i = 0; i < l.sample_length; ++i) c.s.ram[dpram::physical(c, to, 2 + i)] = data[l.sample_offset + i];
    sm.publish(Slot::d);
    change(c, Fact::dxbout_buffer_sm, c.s.dxbout_sm, sm.raw());
    irq::raise(c, regmap::interrupt::dxb_out);
}

/// Figure 7-14, rows 1 and 2, for every link to this publisher.
template <class C>
void receive(C& c) {
    const auto data = mac::data(c.s);
    for (unsigned n = 0; n < links(c.s); ++n) {
        const Link l = link(c, n);
        if (l.publisher != mac::master(c.s)) continue;
        std::uint8_t* const st = status(c, n);
        if (fits(c, l, data.size())) {
            store(c, l, data);
            if (st != nullptr) *st = static_cast<std::uint8_t>((*st & kLinkStatus) | kDataExist);
        } else if (st != nullptr) {
            *st = kLinkError;
        }
    }
}

constexpr void stop_monitoring(State& s) { timers::stop(s, Timer::dxb_monitor); }

/// The next monitoring time; none without response time monitoring, which a Set_Prm may have switched off meanwhile.
template <class C>
void start_monitoring(C& c) {
    stop_monitoring(c.s);
    if (c.traits->dxb && c.s.wd_on != 0) timers::start(c.s, Timer::dxb_monitor, wd::t_wd_end(c));
}

/// Figure 7-14, rows 3 and 4: the monitoring time is over for all links; one interrupt if a link broke.
template <class C>
void monitor(C& c) {
    bool broken = false;
    for (unsigned n = 0; n < links(c.s); ++n) {
        std::uint8_t* const st = status(c, n);
        if (st == nullptr) break;
        const bool alive = (*st & kDataExist) != 0;
        broken = broken || (!alive && (*st & (kLinkStatus | kLinkError)) != 0);
        *st = alive ? kLinkStatus : std::uint8_t{0};
    }
    if (broken) irq::raise(c, regmap::interrupt::dxb_link_error);
    start_monitoring(c);
}

}  // namespace dpchip::chip::dxb
