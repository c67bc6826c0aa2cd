// SPDX-License-Identifier: Apache-2.0
// The board around the package, its processor and its UART.
#include "tlm/pin_board.hpp"

namespace dpchip::tlm::test {

namespace {

const sc_logic& logic(bool high) { return high ? sc_dt::SC_LOGIC_1 : sc_dt::SC_LOGIC_0; }
constexpr Ticks kBitsOfCharacter = 11;

}  // namespace

PinBoard::PinBoard(const sc_core::sc_module_name& name, const PackageSettings& settings, Bus bus)
    : sc_core::sc_module{name}, xwr{"xwr", logic(bus == Bus::async_intel)}, as{"as", logic(bus == Bus::async_motorola)},
      xint_mot{"xint_mot", logic(bus != Bus::async_intel)}, mode{"mode", logic(bus == Bus::sync_motorola)},
      package{"package", settings}, bus_{bus} {
    using SC_CURRENT_USER_MODULE = PinBoard;
    package.ab.bind(ab);
    package.db.bind(db);
    package.xcs_ab11(xcs);
    package.xrd_r_w(xrd);
    package.xwr_e_clock_ab11(xwr);
    package.ale_as_ab11(as);
    package.xint_mot(xint_mot);
    package.mode(mode);
    package.reset(reset);
    package.xready_xdtack(xready);
    package.x_int(x_int);
    package.xdataexch_sync(xdataexch);
    package.rxd(rxd);
    package.txd(txd);
    package.rts(rts);
    package.xcts(xcts);
    SC_THREAD(run);
}

PinBoard::~PinBoard() = default;

void PinBoard::run() {
    if (program) program();
}

void PinBoard::power_up() {
    drive_data(sc_dt::SC_LOGIC_Z);
    reset.write(sc_dt::SC_LOGIC_1);
    sc_core::wait(ns(200));
    reset.write(sc_dt::SC_LOGIC_0);
    sc_core::wait(us(1));
}

void PinBoard::drive_data(const sc_logic& level, std::uint8_t value) {
    for (unsigned i = 0; i < db.size(); ++i) db[i].write(level == sc_dt::SC_LOGIC_Z ? level : logic((value >> i & 1) != 0));
}

void PinBoard::begin(std::uint16_t address, bool write, std::uint8_t value) {
    for (unsigned i = 0; i < ab.size(); ++i) ab[i].write(logic((address >> i & 1) != 0));
    if (bus_ != Bus::async_intel) {
        xrd.write(logic(!write));  // R_W
        if (bus_ == Bus::async_motorola) xcs.write(sc_dt::SC_LOGIC_0);
        sc_core::wait(ns(10));
    }
    xcs.write(sc_dt::SC_LOGIC_0);
    if (write) drive_data(sc_dt::SC_LOGIC_1, value);
    if (bus_ == Bus::async_intel) (write ? xwr : xrd).write(sc_dt::SC_LOGIC_0);
    if (bus_ == Bus::async_motorola) as.write(sc_dt::SC_LOGIC_0);
    if (bus_ == Bus::sync_motorola) xwr.write(sc_dt::SC_LOGIC_1);  // E_CLOCK
    sc_core::wait(ns(140));
}

void PinBoard::end() {
    xcs.write(sc_dt::SC_LOGIC_1);
    xwr.write(logic(bus_ == Bus::async_intel));
    if (bus_ == Bus::async_intel) {
        xrd.write(sc_dt::SC_LOGIC_1);
        for (PinBoard::Wire& wire : ab) wire.write(sc_dt::SC_LOGIC_1);
    }
    if (bus_ == Bus::async_motorola) as.write(sc_dt::SC_LOGIC_1);
    sc_core::wait(ns(20));
    drive_data(sc_dt::SC_LOGIC_Z);
    sc_core::wait(ns(14));
}

std::uint8_t PinBoard::read(std::uint16_t address) {
    begin(address, false);
    unsigned value = 0;
    for (unsigned i = 0; i < db.size(); ++i) {
        EXPECT_TRUE(db[i].read().is_01()) << "DB" << i << " after the access time";
        value |= db[i].read() == sc_dt::SC_LOGIC_1 ? 1u << i : 0u;
    }
    end();
    return static_cast<std::uint8_t>(value);
}

void PinBoard::write(std::uint16_t address, std::uint8_t value) {
    begin(address, true, value);
    end();
}

std::string PinBoard::data() const {
    std::string levels;
    for (unsigned i = 8; i-- > 0;) levels += db[i].read().to_char();
    return levels;
}

Scope::Scope(const sc_core::sc_module_name& name, const sc_core::sc_signal<sc_logic>& wire) : sc_core::sc_module{name}, wire_{&wire} {
    using SC_CURRENT_USER_MODULE = Scope;
    SC_METHOD(note);
    dont_initialize();
    sensitive << wire.value_changed_event();
}

void Scope::note() { edges.push_back({to_ticks(sc_core::sc_time_stamp()), wire_->read() != sc_dt::SC_LOGIC_0}); }

bool Scope::level(Ticks at) const {
    bool high = true;
    for (const Edge& e : edges) {
        if (e.at > at) break;
        high = e.high;
    }
    return high;
}

void send_bits(PinBoard::Wire& wire, Ticks at, Ticks bit, const Octets& octets) {
    for (const std::uint8_t octet : octets) {
        unsigned parity = 0;
        for (unsigned i = 0; i < 8; ++i) parity ^= octet >> i & 1u;
        const unsigned frame = static_cast<unsigned>(octet) << 1 | parity << 9 | 1u << 10;
        for (Ticks i = 0; i < kBitsOfCharacter; ++i, at += bit) {
            until(to_sc_time(at));
            wire.write(logic((frame >> i & 1) != 0));
        }
    }
    until(to_sc_time(at));
}

std::vector<Burst> bursts(const Scope& scope, Ticks bit) {
    std::vector<Burst> all;
    Ticks character_end = 0;
    for (const Scope::Edge& edge : scope.edges) {
        if (edge.high || edge.at < character_end) continue;
        unsigned frame = 0, ones = 0;
        for (Ticks i = 0; i < kBitsOfCharacter; ++i) frame |= (scope.level(edge.at + i * bit + bit / 2) ? 1u : 0u) << i;
        for (unsigned i = 1; i < 10; ++i) ones += frame >> i & 1u;
        EXPECT_EQ(frame & 0x401u, 0x400u) << "start and stop bit at " << edge.at;
        EXPECT_EQ(ones % 2, 0u) << "even parity at " << edge.at;
        if (all.empty() || edge.at > character_end + kBitsOfCharacter * bit) all.push_back({edge.at, {}});
        all.back().octets.push_back(static_cast<std::uint8_t>(frame >> 1));
        character_end = edge.at + kBitsOfCharacter * bit - bit / 2;
    }
    return all;
}

}  // namespace dpchip::tlm::test
