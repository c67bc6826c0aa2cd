// SPDX-License-Identifier: Apache-2.0
// A small DP slave for tests of the master: written from the reference, independent of the chip and of the driver.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include <dpchip/dp/saps.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/segment/segment.hpp>

namespace dpchip::test {

using core::kNever;
using core::Ticks;

struct ScriptedSlave {
    enum class State : std::uint8_t { wait_prm, wait_cfg, data_exch };

    // what it is
    std::uint8_t own = 3;
    std::uint16_t ident = 0x4711;
    fdl::BaudCode rate = fdl::BaudCode::mbit_12;
    std::int64_t tsdr_bits = 11;
    std::uint16_t inputs = 2, outputs = 2;
    std::vector<std::uint8_t> cfg{0x11, 0x21};
    // what goes wrong with it
    bool mute = false;             ///< answers nothing
    int mute_for = 0;              ///< answers nothing to so many requests
    bool refuse_prm = false;
    int not_ready_for = 0;         ///< diagnoses with Station_Not_Ready after Chk_Cfg
    bool diagnosis_waiting = false;///< answers DH until its diagnosis is read
    bool offline = false;          ///< not even there

    // what it knows
    State state = State::wait_prm;
    std::uint8_t owner = 0xFF;
    std::uint8_t status_1 = 0x02, status_2 = 0x05;
    std::vector<std::uint8_t> output_data{}, set_prm{};
    std::vector<std::uint8_t> fcs{};        ///< FC of each request to it
    std::vector<std::uint8_t> commands{};   ///< Global_Control
    std::uint64_t exchanges = 0, repeats = 0, diagnoses_read = 0;
    bool counting = false, last_fcb = false;
    std::vector<std::uint8_t> kept{};       ///< the last answer
    bool log = false;

    Ticks now{}, answer_at = kNever;
    std::array<std::uint8_t, fdl::kMaxTelegram> buffer{};
    std::size_t size = 0;
    bool begins = false;

    Ticks bit() const { return fdl::baud(rate).bit; }
    Ticks next() const { return answer_at; }
    void advance(Ticks t) {
        now = t;
        if (answer_at > t) return;
        answer_at = kNever;
        begins = true;
    }
    void carrier(Ticks) { answer_at = kNever; }
    void hear_character(const fdl::Character&) { answer_at = kNever; }
    bool hears_all() const { return false; }
    std::uint8_t address() const { return offline ? segment::kNoAddress : own; }
    bool take(fdl::Transmission& t) {
        if (!begins) return false;
        begins = false;
        t.assign(now, bit(), std::span{buffer}.first(size));
        return true;
    }

    void hear(const fdl::Transmission& t) {
        const auto r = fdl::decode(t.bytes());
        if (!r || offline || !r->has_fc() || !r->fc.is_request()) return;
        if (log) fcs.push_back(r->fc.octet);
        if (r->destination() == fdl::kBroadcast) return command(*r);
        if (r->destination() != own) return;
        if (mute || (mute_for > 0 && mute_for-- > 0)) return;
        const bool repeat = fdl::uses_frame_count(r->fc.request()) && r->fc.fcv() && counting && r->fc.fcb() == last_fcb;
        if (fdl::uses_frame_count(r->fc.request())) {
            counting = true;
            last_fcb = r->fc.fcb();
        }
        if (repeat) ++repeats;
        else answer(*r);
        answer_at = now + bit() * tsdr_bits;
    }

    void command(const fdl::Telegram& r) {
        if (r.has_dsap() && r.dsap() == dp::kSapGlobalControl && state == State::data_exch) commands.push_back(r.data()[0]);
    }
    void sc() { buffer[0] = fdl::kSc; size = 1; }
    void negative(const fdl::Telegram& r, fdl::Response code) { size = fdl::encode_sd1(buffer, r.source(), own, fdl::response_fc(code)); }
    void data(const fdl::Telegram& r, std::span<const std::uint8_t> d, fdl::Response code = fdl::Response::dl) {
        size = fdl::encode(buffer, fdl::SapTelegram{r.source(), own, fdl::response_fc(code), r.ssap(), r.dsap(), d});
    }

    void answer(const fdl::Telegram& r) {
        if (r.fc.request() == fdl::Request::fdl_status) return negative(r, fdl::Response::ok);
        if (!r.has_dsap()) return exchange(r);
        switch (r.dsap()) {
        case dp::kSapSlaveDiag: return diagnosis(r);
        case dp::kSapSetPrm: return parameters(r);
        case dp::kSapChkCfg: return configuration(r);
        case dp::kSapGetCfg: return data(r, cfg);
        case dp::kSapRdOutput: return data(r, output_data);
        case dp::kSapSetSlaveAdd:
            if (state == State::wait_prm && r.data().size() >= 4) moved_to = r.data()[0];
            return sc();
        default:
            if (!acyclic || !acyclic(r)) negative(r, fdl::Response::rs);
            return;
        }
    }
    int moved_to = -1;
    std::function<bool(const fdl::Telegram&)> acyclic{};  ///< answers a request to another SAP, or leaves it

    void diagnosis(const fdl::Telegram& r) {
        if (state == State::wait_cfg && cfg_good && not_ready_for-- <= 0) {
            state = State::data_exch;
            status_1 = 0x00;
            status_2 = static_cast<std::uint8_t>(status_2 & ~1u);
        }
        const std::array<std::uint8_t, 6> d{status_1, status_2, 0, owner, static_cast<std::uint8_t>(ident >> 8), static_cast<std::uint8_t>(ident)};
        ++diagnoses_read;
        diagnosis_waiting = false;
        data(r, d);
    }
    bool cfg_good = false;
    void leave(std::uint8_t fault) {
        state = State::wait_prm;
        owner = 0xFF;
        status_1 = static_cast<std::uint8_t>(0x02u | fault);
        status_2 = 0x05;
        cfg_good = false;
    }
    void parameters(const fdl::Telegram& r) {
        set_prm.assign(r.data().begin(), r.data().end());
        sc();
        const bool good = set_prm.size() >= 7 && set_prm[4] == (ident >> 8) && set_prm[5] == (ident & 0xFFu) && !refuse_prm;
        if (!good) return leave(0x40);
        if (owner != 0xFF && owner != r.source()) return;
        owner = r.source();
        state = State::wait_cfg;
        status_1 = 0x02;
        status_2 = static_cast<std::uint8_t>(0x04u | (set_prm[0] & 0x08u));
    }
    void configuration(const fdl::Telegram& r) {
        sc();
        if (state == State::wait_prm || r.source() != owner) return;
        cfg_good = std::ranges::equal(r.data(), cfg);
        if (!cfg_good) leave(0x04);
    }
    void exchange(const fdl::Telegram& r) {
        if (state != State::data_exch || r.source() != owner) return negative(r, fdl::Response::rs);
        if (!r.unit.empty() && r.unit.size() != outputs) {
            leave(0x04);
            return negative(r, fdl::Response::rr);
        }
        output_data.assign(r.unit.begin(), r.unit.end());
        ++exchanges;
        if (inputs == 0 && !diagnosis_waiting) return sc();
        std::array<std::uint8_t, 244> in{};
        std::ranges::copy(std::span{output_data}.first(std::min<std::size_t>(inputs, output_data.size())), in.begin());
        const std::size_t n = std::max<std::size_t>(inputs, 1);
        size = fdl::encode(buffer, r.source(), own, fdl::response_fc(diagnosis_waiting ? fdl::Response::dh : fdl::Response::dl), std::span{in}.first(n));
    }
};
static_assert(segment::Station<ScriptedSlave>);

}  // namespace dpchip::test
