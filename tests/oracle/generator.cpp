// SPDX-License-Identifier: Apache-2.0
// Random steps for the differential test: a master, a second one, a stranger, and a firmware that is mostly sensible.
#include <algorithm>

#include "differential.hpp"

namespace oracle {

namespace {

/// SD1, SD2 or (sometimes) SD3 around a data unit.
Octets frame(unsigned da, unsigned sa, unsigned fc, const Octets& unit, bool sd3) {
    Octets o;
    if (unit.empty()) o = {0x10};
    else if (sd3 && unit.size() == 8) o = {0xA2};
    else o = {0x68, octet(static_cast<unsigned>(unit.size()) + 3), octet(static_cast<unsigned>(unit.size()) + 3), 0x68};
    const std::size_t head = o.size();
    o.push_back(octet(da));
    o.push_back(octet(sa));
    o.push_back(octet(fc));
    o.insert(o.end(), unit.begin(), unit.end());
    unsigned sum = 0;
    for (std::size_t i = head; i < o.size(); ++i) sum += o[i];
    o.push_back(octet(sum));
    o.push_back(0x16);
    return o;
}

}  // namespace

// Buffers one after the other, random lengths and modes; no overlap (overlaps are misuse, 4.1).
Step Generator::setup() {
    Step step;
    step.kind = Step::Kind::setup;
    auto& w = step.writes;
    fcb_.clear();
    last_.clear();
    line_baud_ = draw(10);
    const bool big = kind_.has_4k && chance(40);
    const unsigned segment = big ? 16 : 8;
    unsigned free = 0x40 / segment + 1;
    const auto place = [&](unsigned length) {
        const unsigned at = free;
        free += (std::max(length, 1u) + segment - 1) / segment;
        return at;
    };
    const unsigned sync = any({0x00, 0x40, 0x80, 0xC0, 0xC0, 0xC0});
    const unsigned polarity = any({0, 0x10}), wd_base = any({0, 4});
    const bool special = chance(15);
    const unsigned high = (chance(97) ? 1u : 0u) | any({0, 2}) | any({0, 4}) |
                          (!special && kind_.ext_prm && chance(70) ? 8u : 0u) | (special ? 0x10u : 0u) |
                          (chance(35) ? 0x20u : 0u) | (chance(30) ? 0x40u : 0u);
    w.emplace_back(0x0C, (big ? 0x80u : 0u) | (chance(30) ? 0x40u : 0u) | any({0, 4}) | any({0, 2}) | any({0, 1}));
    for (unsigned a = 0x16; a < 0x200; ++a) w.emplace_back(a, chance(30) ? draw(256) : 0);
    w.emplace_back(0x06, sync | polarity | wd_base | (chance(10) ? draw(4) : 0) |
                             (kind_.one_and_a_half_k && chance(20) ? 8u : 0u));
    w.emplace_back(0x07, high);
    w.emplace_back(0x12, draw(4));
    w.emplace_back(0x04, any({0, 0, 0x10, 0xFF}));
    w.emplace_back(0x05, any({0, 0, 0x20, 0xFF}));
    w.emplace_back(0x0A, any({0, 1, 2, 3, 16}));
    w.emplace_back(0x0B, any({11, 11, 11, 0, 1, 20, 60, 255}));
    const unsigned dout = any({0, 0, 1, 2, 4, 8, 17}), din = any({0, 0, 0, 1, 2, 4, 17});
    const unsigned aux1 = any({12, 16, 20, 30}), aux2 = any({0, 10, 16, 30});
    const unsigned user_wd = any({0, 0, 1, 2, 5, 200, 0xFFFF, 0xFFFF, 0xFFFF});
    w.emplace_back(0x16, any({8, 8, 8, 8, 126, 0}));
    w.emplace_back(0x17, place(8));
    w.emplace_back((step.writes.back().second) * segment, 0xFF);
    w.emplace_back(0x18, user_wd & 0xFF);
    w.emplace_back(0x19, user_wd >> 8);
    w.emplace_back(0x1A, dout);
    for (unsigned c : {0x1Bu, 0x1Cu, 0x1Du}) w.emplace_back(c, place(dout));
    w.emplace_back(0x1E, din);
    for (unsigned c : {0x1Fu, 0x20u, 0x21u}) w.emplace_back(c, place(din));
    for (unsigned c : {0x22u, 0x23u, 0x35u, 0x36u, 0x37u, 0x38u, 0x3Eu, 0x3Fu}) w.emplace_back(c, 0);
    for (unsigned c : {0x24u, 0x25u}) w.emplace_back(c, any({6, 6, 8, 12}));
    w.emplace_back(0x26, place(12));
    w.emplace_back(0x27, place(12));
    w.emplace_back(0x28, aux1);
    w.emplace_back(0x29, aux2);
    w.emplace_back(0x2A, (aux2 == 0 ? 0u : draw(8)) | (chance(10) ? 0xF8u : 0u));
    w.emplace_back(0x2B, place(32));
    w.emplace_back(0x2C, place(32));
    w.emplace_back(0x2D, 0);
    w.emplace_back(0x2E, chance(60) ? place(32) : 0);
    w.emplace_back(0x2F, 0);
    w.emplace_back(0x30, place(32));
    w.emplace_back(0x31, 0);
    w.emplace_back(0x32, place(32));
    w.emplace_back(0x33, any({1, 2, 6, 16}));
    w.emplace_back(0x34, place(32));
    w.emplace_back(0x39, chance(80) ? 0 : 0xFF);
    w.emplace_back(0x3A, 0x11);
    w.emplace_back(0x3B, 0x47);
    w.emplace_back(0x3C, draw(256));
    w.emplace_back(0x3D, any({10, 16, 30}));
    w.emplace_back(0x08, 1u | any({0, 0x10}) | any({0, 0x20}));
    return step;
}

Step Generator::next(const NaiveSlave& slave) {
    const unsigned dice = draw(1000);
    if (dice < 1) {
        Step s;
        s.kind = Step::Kind::reset;
        return s;
    }
    if (!slave.online) {
        if (chance(40)) return slave.ram[0x34] == 0 || chance(20) ? setup() : cpu_write(0x08, 1);
        if (chance(50)) return processor(slave);
    }
    if (dice < 480) return telegram(slave);
    if (dice < 800) return processor(slave);
    if (dice < 860) return buffer_write(slave);
    return wait();
}

Step Generator::wait() {
    Step s;
    s.kind = chance(60) ? Step::Kind::wait_next : Step::Kind::wait;
    if (s.kind == Step::Kind::wait_next) {
        s.duration = static_cast<Time>(draw(3)) * kClk - kClk;
        return s;
    }
    switch (draw(8)) {
    case 0: s.duration = static_cast<Time>(draw(2000)) * kMs; break;
    case 1: s.duration = static_cast<Time>(draw(60)) * kMs; break;
    default: s.duration = static_cast<Time>(draw(48000)) * kClk; break;
    }
    return s;
}

// ---- processor ------------------------------------------------------------------------------------------------------

Step Generator::cpu_read(unsigned address) {
    Step s;
    s.kind = Step::Kind::read;
    s.address = address;
    s.duration = static_cast<Time>(1 + draw(100)) * kClk;
    return s;
}

Step Generator::cpu_write(unsigned address, unsigned value) {
    Step s = cpu_read(address);
    s.kind = Step::Kind::write;
    s.value = value;
    return s;
}

Step Generator::processor(const NaiveSlave& slave) {
    const bool pending = slave.prm_counter > 0 || slave.cfg_counter > 0;
    if (pending && chance(45)) {
        if (slave.prm_counter > 0) return cpu_read(chance(88) ? 0x0E : 0x0F);
        return cpu_read(chance(88) ? 0x10 : 0x11);
    }
    switch (draw(slave.online ? 26 : 12)) {
    case 0: return cpu_write(0x02, draw(256));
    case 1: return cpu_write(0x03, draw(256));
    case 2: return cpu_write(0x04, any({0, 0xFF, draw(256)}));
    case 3: return cpu_write(0x05, any({0, 0xFF, draw(256)}));
    case 4: return cpu_write(draw(2), chance(60) ? 0 : 1u << draw(8));
    case 5: return cpu_write(0x08, 2);
    case 6: return cpu_write(0x08, any({0x10, 0x20, 0x12, 0x22}));
    case 7: return cpu_write(0x09, any({0x10, 0x20, 0xFE, 0xFF, 0x01, 0x30}));
    case 8: {
        // A Go_Offline on its way may be over before this write: no SYNC and no clock synchronisation, which naive has not.
        const auto offline = slave.four_k() ? 0x80 : 0;
        return cpu_write(any({0x06, 0x07, 0x0C, 0x12, 0x10, 0x11, 0x13, 0x14, 0x15}),
                         slave.online ? draw(256) & 0xE7 : static_cast<decltype(draw(256))>(offline));
    }
    case 9: return cpu_read(draw(9));
    case 10: return cpu_read(any({0x0A, 0x0C, 0x12, 0x13, 0x15}));
    case 11: return cpu_read(0x16 + draw(0x7EA));
    case 12: return cpu_write(0x0A, any({0, 1, 2, 3, 16}));
    case 13: return cpu_write(0x0B, any({11, 0, 15, 40}));
    case 14: return chance(10) ? cpu_write(0x08, 8) : cpu_read(0x09);
    case 15: return chance(10) ? cpu_write(0x08, 4) : cpu_read(0x09);
    case 16: return chance(20) ? cpu_read(0x0E + draw(4)) : cpu_read(0x0B);
    case 17:
    case 18: return cpu_read(0x0D);
    case 19: return cpu_read(0x14);
    case 20: return chance(8) && slave.kind.one_and_a_half_k ? cpu_read(0x600 + draw(0xA00)) : cpu_read(0x0B);
    case 21: return chance(30) ? cpu_write(0x39, any({0, 0, 0xFF})) : cpu_write(0x18 + draw(2), draw(4));
    case 22: return slave.dp == DpSm::data_exch ? cpu_read(0x09) : cpu_write(0x33, any({1, 2, 6, 16}));
    case 23:
        return slave.dp == DpSm::wait_cfg && slave.cfg_counter > 0 ? cpu_write(0x1E, any({0, 1, 4, 8}))
                                                                   : cpu_read(0x09);
    case 24: return slave.dp == DpSm::wait_cfg && slave.cfg_counter > 0 ? cpu_write(0x1A, any({0, 1})) : cpu_read(0x0B);
    default: return cpu_read(0x0B);
    }
}

// A buffer the user owns: inputs, diagnosis.
Step Generator::buffer_write(const NaiveSlave& slave) {
    const unsigned segment = slave.four_k() ? 16 : 8;
    if (chance(50)) return cpu_write(slave.ram[0x1F + slave.din.u - 1] * segment + draw(4), draw(256));
    const unsigned user = slave.diag_owner[1] == 1 ? 1 : slave.diag_owner[2] == 1 ? 2 : 0;
    if (user == 0) return cpu_read(0x0C);
    return cpu_write(slave.ram[0x26 + user - 1] * segment + any({0, 0, 0, 6, 7}), draw(8));
}

// ---- telegrams ------------------------------------------------------------------------------------------------------

Octets Generator::random_data(unsigned length) {
    Octets out;
    for (unsigned i = 0; i < length; ++i) out.push_back(octet(chance(30) ? draw(256) : draw(2)));
    return out;
}

// First 6x, then 5x, 7x, 5x ...; now and then a first cycle again.
unsigned Generator::frame_count(unsigned master, unsigned function) {
    int& state = fcb_[master];
    if (state == 0 || chance(3)) {
        state = 1;
        return 0x60 | function;
    }
    if (chance(2)) return 0x40 | function;
    state = state == 1 ? 2 : 1;
    return (state == 2 ? 0x50u : 0x70u) | function;
}

Octets Generator::sap_request(const NaiveSlave& slave, unsigned master, unsigned dsap, const Octets& data,
                              unsigned function) {
    Octets unit{octet(dsap)};
    const bool ssap = chance(97);
    if (ssap) unit.push_back(octet(chance(98) ? 62 : draw(256)));
    unit.insert(unit.end(), data.begin(), data.end());
    const bool acknowledged = function != 4 && function != 6;
    const unsigned fc = acknowledged ? frame_count(master, function) : 0x40 | function;
    const unsigned da = acknowledged || chance(30) ? slave.ts : 127;
    return frame(da | 0x80, master | (ssap ? 0x80u : 0u), fc, unit, chance(50));
}

Octets Generator::plain_request(const NaiveSlave& slave, unsigned master, unsigned function, const Octets& data) {
    return frame(slave.ts, master, frame_count(master, function), data, chance(50));
}

Octets Generator::set_prm(const NaiveSlave& slave, bool good) {
    Octets d{octet(0x80u | (chance(60) ? 8u : 0u)),
             octet(any({1, 2, 3, 10, 50})),
             octet(any({1, 2, 5, 20})),
             octet(any({0, 11, 11, 0, 30, 5})),
             0x47,
             0x11,
             octet(any({0, 0, 1, 3, 0xFF}))};
    const bool sync = (slave.mode0 & 0x40) != 0, freeze = (slave.mode0 & 0x80) != 0;
    if (sync && chance(40)) d[0] |= 0x20;
    if (freeze && chance(40)) d[0] |= 0x10;
    if (chance(60)) {
        d.push_back(octet(any({0, 4, 0xC0, 0xE0, 0xE4, 0x20}) | (chance(10) ? draw(4) : 0)));
        for (unsigned n = draw(4); n > 0; --n) d.push_back(0);
        if (d.size() == 11)
            for (unsigned n = draw(6); n > 0; --n) d.push_back(octet(draw(256)));
    }
    if (good) return d;
    switch (draw(10)) {
    case 0: d.resize(draw(7)); break;
    case 1: d[4 + draw(2)] ^= octet(1u << draw(8)); break;
    case 2:
        d[0] |= 8;
        d[1 + draw(2)] = 0;
        break;
    case 3: d[0] |= octet(any({0x10, 0x20, 0x30})); break;
    case 4:
        d.resize(10);
        d[7] = octet(draw(256));
        break;
    case 5:
        d.resize(10);
        d[8] = octet(draw(256));
        break;
    case 6:
        d.resize(10);
        d[9] = octet(draw(256));
        break;
    case 7: d[0] = octet(draw(256)); break;
    case 8: d.resize(20 + draw(30)); break;
    default: d[0] = octet(any({0x40, 0xC0, 0x00})); break;
    }
    return d;
}

Octets Generator::outputs(const NaiveSlave& slave) {
    const unsigned expected = slave.ram[0x1A];
    if (chance(95)) return random_data(expected);
    return random_data(any({0, expected > 0 ? expected - 1 : 0, expected + 1, draw(40)}));
}

Octets Generator::control(const NaiveSlave& slave, unsigned master) {
    const unsigned command = chance(85) ? any({0, 2, 4, 8, 0x10, 0x20, 0x30, 0x0C, 0x22, 0x2A}) : draw(256);
    Octets data{octet(command), octet(any({0, 0, 0, 1, 2, 0xFF}))};
    if (chance(4)) data.resize(draw(4));
    return sap_request(slave, master, 58, data, any({4, 6}));
}

Octets Generator::request(const NaiveSlave& slave, unsigned master) {
    const bool exchange = slave.dp == DpSm::data_exch, config = slave.dp == DpSm::wait_cfg;
    if (!exchange && chance(30)) return sap_request(slave, master, 61, set_prm(slave, chance(85)), any({12, 13}));
    if (config && chance(50))
        return sap_request(slave, master, 62, chance(98) ? random_data(chance(6) ? 40 : 1 + draw(8)) : Octets{},
                           any({12, 13}));
    if (config && !slave.cfg_seen && chance(10)) return sap_request(slave, master, 53, random_data(5 + draw(5)));
    if (exchange && chance(45)) return plain_request(slave, master, chance(85) ? any({12, 13}) : 7, outputs(slave));
    switch (draw(26)) {
    case 24: return sap_request(slave, master, any({53, 55, 60}), random_data(1 + draw(6)), any({4, 6}));
    case 25: return sap_request(slave, master, any({53, 55}), random_data(60));
    case 22: return sap_request(slave, master, 58, random_data(draw(3)));
    case 23: return sap_request(slave, master, any({55, 61, 62}), random_data(40));
    case 0: return frame(slave.ts, master, 0x49, {}, false);
    case 1: return frame(slave.ts, master, any({0x4E, 0x4F}), {}, false);
    case 2: return frame(slave.ts, master, 0x40 | draw(64), {}, false);
    case 3: return sap_request(slave, master, any({51, 50, 49, 0, 54, 52, 63, 0x7F, 0xFF, 58}), random_data(draw(8)));
    case 4: return sap_request(slave, master, 50 + draw(14), random_data(1 + draw(6)), any({3, 5}));
    case 5: return sap_request(slave, master, 53 + draw(10), random_data(1 + draw(6)), any({4, 6}));
    case 6: return plain_request(slave, master, any({3, 5, 7, 7}), random_data(draw(5)));
    case 7: return sap_request(slave, master, 53, random_data(5 + draw(chance(40) ? 60 : 8)));
    case 8: {
        Octets d{octet(any({8, 9, 9, 126, 125})), 0x47, octet(chance(85) ? 0x11 : 0x12),
                 octet(any({0, 0, 0, 0, 0xFF}))};
        for (unsigned n = draw(4); n > 0; --n) d.push_back(octet(draw(256)));
        if (chance(10)) d.resize(draw(5));
        if (chance(8)) d.resize(60);
        return sap_request(slave, master, 55, d);
    }
    case 9: return sap_request(slave, master, 56, chance(95) ? Octets{} : random_data(2));
    case 10: return sap_request(slave, master, 57, chance(95) ? Octets{} : random_data(2));
    case 11: return sap_request(slave, master, 59, chance(95) ? Octets{} : random_data(2));
    case 12:
    case 13:
    case 14: return sap_request(slave, master, 60, chance(95) ? Octets{} : random_data(2));
    case 15: return sap_request(slave, master, 61, set_prm(slave, chance(exchange ? 40 : 70)), any({12, 13}));
    case 16: return sap_request(slave, master, 62, chance(97) ? random_data(1 + draw(chance(10) ? 60 : 8)) : Octets{});
    case 17:
    case 18:
    case 19: return control(slave, master);
    default: return plain_request(slave, master, any({12, 13}), outputs(slave));
    }
}

Step Generator::telegram(const NaiveSlave& slave) {
    Step s;
    s.kind = chance(85) ? Step::Kind::telegram : Step::Kind::characters;
    s.gap_tbit = any({35, 40, 40, 40, 60, 200});
    if (slave.wd == WdSm::baud_search && chance(70)) line_baud_ = slave.probe;
    else if (slave.baud < 10 && chance(99)) line_baud_ = slave.baud;
    s.baud = line_baud_;
    s.polite = chance(96);
    unsigned master = slave.owner >= 0 && chance(slave.dp == DpSm::wait_cfg ? 65 : 75)
                          ? static_cast<unsigned>(slave.owner)
                          : any({2, 2, 2, 3, 5});
    const auto last = last_.find(master);
    if (last != last_.end() && chance(7)) {
        s.octets = last->second;  // retry, octet for octet the same
    } else {
        s.octets = request(slave, master);
        last_[master] = s.octets;
    }
    const unsigned dice = draw(100);
    if (dice == 0) s.octets = {0xDC, octet(draw(128)), octet(master)};
    else if (dice == 1) s.octets = {0xE5};
    else if (dice == 2) s.octets = frame(any({1, 9, 127}), master, 0x40 | draw(16), {}, false);
    else if (dice == 3) s.octets = frame(slave.ts, master, draw(64), random_data(draw(6)), false);
    else if (dice == 4) s.octets = frame(slave.ts | 0x80, any({master, 127}), 0x6D, random_data(draw(2)), false);
    if (s.kind == Step::Kind::characters && chance(40)) {
        s.fault = 1 + draw(3);
        s.fault_at = static_cast<int>(draw(static_cast<unsigned>(s.octets.size())));
    }
    if (chance(2)) s.octets[draw(static_cast<unsigned>(s.octets.size()))] ^= octet(1u << draw(8));
    return s;
}

}  // namespace oracle
