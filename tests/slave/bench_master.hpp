// SPDX-License-Identifier: Apache-2.0
// A test's own master: telegrams to one station, in line time, and what it answers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/fdl/baud.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/slave/virtual_slave.hpp>

namespace dpchip::slave::testing {

using Octets = std::vector<std::uint8_t>;
using core::Ticks;

class BenchMaster {
public:
    VirtualSlave& s;
    Ticks now{};
    std::uint8_t master = 2, slave, fc = 0x6D, group = 0;
    Ticks bit = fdl::baud(fdl::BaudCode::mbit_1_5).bit;
    Ticks last_answer_start{}, last_request_end{};

    BenchMaster(VirtualSlave& station, std::uint8_t address) : s{station}, slave{address} {}

    bool find_baud() {
        for (int i = 0; i < 400 && !s.baud(); ++i) fdl_status();
        return s.baud() == fdl::BaudCode::mbit_1_5;
    }
    Octets fdl_status() { return send({slave, master, 0x49}, {}); }
    Octets set_prm(const Octets& user = {}) {
        Octets data{0x88, 2, 50, 11, static_cast<std::uint8_t>(s.ident() >> 8), static_cast<std::uint8_t>(s.ident()), group};
        data.insert(data.end(), user.begin(), user.end());
        return request(61, data);
    }
    Octets chk_cfg(const Octets& cfg) { return request(62, cfg); }
    Octets diag() { return data_of(request(60, {})); }
    Octets get_cfg() { return data_of(request(59, {})); }
    bool is_ready() {
        const Octets d = diag();
        return d.size() >= 6 && (d[0] & 0x46) == 0 && (d[1] & 0x01) == 0 && d[3] == master;
    }
    Octets exchange(const Octets& outputs) {
        const Octets got = send({slave, master, next_fc()}, outputs);
        return got.size() > 9 ? Octets(got.begin() + 7, got.end() - 2) : got;
    }
    Octets request(std::uint8_t sap, Octets data) {
        data.insert(data.begin(), {sap, 0x3E});
        return send({static_cast<std::uint8_t>(slave | 0x80), static_cast<std::uint8_t>(master | 0x80), next_fc()}, data);
    }
    static Octets data_of(const Octets& a) { return a.size() > 11 ? Octets(a.begin() + 9, a.end() - 2) : Octets{}; }

    Octets send(Octets head, const Octets& data) {
        head.insert(head.end(), data.begin(), data.end());
        std::uint8_t fcs = 0;
        for (const std::uint8_t o : head) fcs = static_cast<std::uint8_t>(fcs + o);
        const auto le = static_cast<std::uint8_t>(head.size());
        Octets t = data.empty() ? Octets{0x10} : Octets{0x68, le, le, 0x68};
        t.insert(t.end(), head.begin(), head.end());
        t.insert(t.end(), {fcs, 0x16});
        prepare(t);
        transmit();
        return {answer.bytes().begin(), answer.bytes().begin() + answer.length};
    }
    /// The telegram that transmit() sends; apart, so that a test can watch transmit() alone.
    void prepare(const Octets& octets) { telegram.assign({}, bit, octets); }
    void transmit() {
        run(bit * 60);
        telegram.start = now;
        s.carrier(now);
        run(telegram.end() - now);
        last_request_end = now;
        s.hear(telegram);
        answer.length = 0;
        const Ticks patience = now + bit * 2000;
        while (s.next() <= patience) {
            now = s.next();
            s.advance(now);
            if (!s.take(answer)) continue;
            last_answer_start = answer.start;
            run(answer.end() - now);
            return;
        }
        run(patience - now);
    }
    void run(Ticks duration) {
        const Ticks end = now + duration;
        while (s.next() <= end) s.advance(s.next());
        s.advance(end);
        now = end;
    }

    fdl::Transmission telegram{}, answer{};

private:
    std::uint8_t next_fc() {
        const std::uint8_t present = fc;
        fc = fc == 0x5D ? 0x7D : 0x5D;
        return present;
    }
};

}  // namespace dpchip::slave::testing
