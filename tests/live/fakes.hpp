// SPDX-License-Identifier: Apache-2.0
// A port and a time that tests move by hand, and stations to put on a line.
#pragma once

#include <deque>
#include <string_view>
#include <vector>

#include <dpchip/chip/chip.hpp>
#include <dpchip/live/line.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/trace/hex_text.hpp>

namespace dpchip::live {

using namespace core::literals;
using Octets = std::vector<std::uint8_t>;

inline Octets octets(std::string_view hex) { return trace::read_hex(hex).octets; }

class FakeTime final : public TimeSource {
public:
    Ticks now() const override { return now_; }
    Ticks now_ = 1_s;  // a monotonic clock does not begin at 0
};

/// Time passes only in wait(). What arrives is planned; what is sent is kept with its time.
class FakePort final : public Port {
public:
    struct Arrival { Ticks at; Octets octets; Octets faults; std::size_t source; };
    struct Sent { Ticks at; Octets octets; };

    explicit FakePort(FakeTime& time, Medium medium = Medium::pty) : time_{time}, medium_{medium} {}

    Medium medium() const override { return medium_; }
    std::string place() const override { return "fake"; }
    bool receive(Reception& into) override {
        if (arrivals.empty() || arrivals.front().at > time_.now_) return false;
        const Arrival a = arrivals.front();
        arrivals.pop_front();
        into.size = a.octets.size();
        into.source = a.source;
        into.faults.fill(0);
        std::copy(a.octets.begin(), a.octets.end(), into.octets.begin());
        std::copy(a.faults.begin(), a.faults.end(), into.faults.begin());
        return true;
    }
    bool send(std::span<const std::uint8_t> octets) override {
        if (refuses) return false;
        sent.push_back({time_.now_, {octets.begin(), octets.end()}});
        if (on_send) on_send();
        return true;
    }
    void relay(std::span<const std::uint8_t> octets, std::size_t source) override { relayed.push_back({octets.begin(), octets.end()}); static_cast<void>(source); }
    void wait(Ticks at_most) override {
        ++waits;
        Ticks to = time_.now_ + at_most;
        if (!arrivals.empty() && arrivals.front().at < to) to = arrivals.front().at;
        time_.now_ = std::max(time_.now_, to + oversleep);
    }
    void wake() noexcept override { woken = true; }
    bool set_baud(fdl::BaudCode baud) override {
        rates.push_back(baud);
        return baud >= fastest;
    }

    void arrive(Ticks at, Octets octets, Octets faults = {}, std::size_t source = 0) {
        arrivals.push_back({at, std::move(octets), std::move(faults), source});
    }

    std::deque<Arrival> arrivals;
    std::vector<Sent> sent;
    std::vector<Octets> relayed;
    std::vector<fdl::BaudCode> rates;
    std::function<void()> on_send;
    Ticks oversleep{};             ///< the host is busy elsewhere: every wait takes so much longer
    fdl::BaudCode fastest = fdl::BaudCode::mbit_12;
    bool refuses = false, woken = false;
    int waits = 0;

private:
    FakeTime& time_;
    Medium medium_;
};

/// Answers every request to its address with SC, 11 bit times after its end.
struct Echoer {
    std::uint8_t ts = 8;
    Ticks bit = fdl::baud(fdl::BaudCode::kbit_19_2).bit;
    Ticks due = core::kNever;
    Octets answer{0xE5};
    std::vector<Octets> heard;
    std::vector<Ticks> heard_at;
    std::vector<std::uint8_t> faults;
    std::vector<Ticks> sent_at;
    int carriers = 0;

    Ticks next() const { return due; }
    void advance(Ticks) {}
    void hear(const fdl::Transmission& t) {
        const auto telegram = fdl::decode(t.bytes());
        heard.emplace_back(t.bytes().begin(), t.bytes().end());
        heard_at.push_back(t.end());
        if (telegram && telegram->has_fc() && telegram->destination() == ts) due = t.end() + 11 * bit;
    }
    void hear_character(const fdl::Character& c) { faults.push_back(c.faults); }
    void carrier(Ticks) { ++carriers; due = core::kNever; }
    bool take(fdl::Transmission& t) {
        if (due == core::kNever) return false;
        t.assign(due, bit, answer);
        due = core::kNever;
        return true;
    }
    bool hears_all() const { return true; }
    std::uint8_t address() const { return ts; }
    void sent(Ticks at) { sent_at.push_back(at); }
};

/// A started VPC3+C with 2 octets of inputs and outputs, as a small firmware would set it up.
inline void start(chip::Chip<>& c, std::uint8_t address) {
    namespace org = regmap::org;
    const auto set = [&](std::uint16_t a, std::uint8_t v) { c.write(a, v); };
    for (std::uint16_t a = org::first; a < 0x200; ++a) set(a, 0);
    set(0x07, 0x01);  // DP_Mode
    set(0x04, 0xFF);
    set(org::r_ts_adr, address);
    set(org::sap_list_ptr, 8);
    set(0x40, 0xFF);
    set(org::r_user_wd_value_high, 0x20);
    set(org::r_len_dout_buf, 2);
    set(org::r_len_din_buf, 2);
    std::uint8_t segment = 9;
    for (const std::uint16_t p : {org::r_dout_buf_ptr1, org::r_dout_buf_ptr2, org::r_dout_buf_ptr3, org::r_din_buf_ptr1, org::r_din_buf_ptr2,
                                  org::r_din_buf_ptr3, org::r_diag_buf_ptr1, org::r_diag_buf_ptr2, org::r_cfg_buf_ptr, org::r_read_cfg_buf_ptr})
        set(p, segment++);
    for (const std::uint16_t p : {org::r_prm_buf_ptr, org::r_aux_buf_ptr1, org::r_aux_buf_ptr2}) {
        set(p, segment);
        segment = static_cast<std::uint8_t>(segment + 2);
    }
    set(org::r_aux_buf_sel, 0x06);
    set(org::r_len_diag_buf1, 6);
    set(org::r_len_diag_buf2, 6);
    set(org::r_len_cntrl_buf1, 16);
    set(org::r_len_cntrl_buf2, 16);
    set(org::r_len_prm_data, 16);
    set(org::r_len_cfg_data, 8);
    set(org::r_len_read_cfg_data, 1);
    set(org::r_ident_low, 0xDA);
    set(org::r_ident_high, 0x0C);
    set(0x08, 0x01);  // Start_VPC3
}

}  // namespace dpchip::live
