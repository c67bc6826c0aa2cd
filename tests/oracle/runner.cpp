// SPDX-License-Identifier: Apache-2.0
// One step on the model and on the naive slave, and the comparison of everything that can be seen from outside.
#include <algorithm>
#include <cstdio>

#include <dpchip/fdl/telegram.hpp>

#include "differential.hpp"

namespace oracle {

namespace {

using dpchip::core::Ticks;

std::string hex(unsigned value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*X", digits, value);
    return text;
}
std::string hex(const Octets& octets) {
    std::string out;
    for (const Octet o : octets) out += hex(o, 2) + ' ';
    return out;
}
std::string clk(Time t) {
    char text[48];
    std::snprintf(text, sizeof text, "%lld clk", static_cast<long long>(t / kClk));
    return t % kClk == 0 ? text : std::string{text} + " + " + std::to_string(t % kClk);
}

const char* state_name(DpSm dp) {
    static constexpr const char* kNames[]{"WAIT-PRM", "WAIT-CFG", "DATA-EXCH"};
    return kNames[static_cast<int>(dp)];
}

/// "Set_Prm", "SDA", ... as in table 3.2; empty for what is none of its rows.
std::string service(const dpchip::fdl::Telegram& t) {
    const bool sdn = t.fc.function() == 4 || t.fc.function() == 6;
    if (t.destination() == 127) return sdn && t.has_dsap() && t.dsap() == 58 ? "Global_Control" : "";
    switch (t.fc.function()) {
    case 3:
    case 5: return "SDA";
    case 7: return t.has_dsap() ? "" : "MSRD";
    case 9: return "FDL_Status";
    case 14:
    case 15: return "Ident";
    case 4:
    case 6: return t.has_dsap() && t.dsap() == 58 ? "Global_Control" : "SDN";
    case 12:
    case 13: break;
    default: return "reserved function";
    }
    if (!t.has_dsap()) return "Data_Exchange";
    switch (t.dsap()) {
    case 53: return "Set_Ext_Prm";
    case 55: return "Set_Slave_Add";
    case 56: return "RD_Input";
    case 57: return "RD_Output";
    case 58: return "SRD to 58";
    case 59: return "Get_Cfg";
    case 60: return "Slave_Diag";
    case 61: return "Set_Prm";
    case 62: return "Chk_Cfg";
    default: return "other SAP";
    }
}

std::string answer_kind(const Octets& o) {
    if (o[0] == 0xE5) return "SC";
    if (o[0] == 0x68) return o[6] == 0x0A ? "DH" : "DL";
    static const std::map<unsigned, std::string> kCodes{{0, "OK"}, {2, "RR"}, {3, "RS"}};
    const auto at = kCodes.find(o[3]);
    return at == kCodes.end() ? "code " + hex(o[3], 2) : at->second;
}

}  // namespace

std::string describe(const Step& s) {
    const std::string sender = " at baud code " + std::to_string(s.baud) + ", " + std::to_string(s.gap_tbit) +
                               " tBit idle" + (s.polite ? ": " : ", answer not awaited: ");
    static constexpr const char* kFaults[]{"",
                                           " parity",
                                           " stop bit low",
                                           " 3 tBit gap before",
                                           " 1/4 tBit gap before",
                                           " 1/2 tBit gap before",
                                           " 40 tBit gap before"};
    switch (s.kind) {
    case Step::Kind::telegram: return "telegram" + sender + hex(s.octets);
    case Step::Kind::characters:
        return "characters" + sender + hex(s.octets) +
               (s.fault_at < 0 ? "" : "fault at " + std::to_string(s.fault_at) + kFaults[s.fault]);
    case Step::Kind::read: return "after " + clk(s.duration) + " read " + hex(s.address, 3);
    case Step::Kind::write: return "after " + clk(s.duration) + " write " + hex(s.address, 3) + " = " + hex(s.value, 2);
    case Step::Kind::wait: return "wait " + clk(s.duration);
    case Step::Kind::wait_next: return "wait until the model's next() " + clk(s.duration);
    case Step::Kind::reset: return "RESET";
    case Step::Kind::setup: {
        std::string out = "setup";
        for (const auto& [address, value] : s.writes)
            if (value != 0 && address < 0x40) out += ' ' + hex(address, 2) + '=' + hex(value, 2);
        return out;
    }
    }
    return {};
}

Pair::Pair(Variant variant, bool motorola)
    : naive{kKind[static_cast<std::size_t>(variant)], motorola}, chip{variant,
                                                                      {},
                                                                      motorola ? dpchip::chip::BusMode::motorola
                                                                               : dpchip::chip::BusMode::intel} {}

void Pair::advance(Time to) {
    const auto collect = [this] {
        dpchip::fdl::Transmission t;
        if (!chip.take(t)) return;
        chip_sent_.push_back({t.start.n, t.bit.n, {t.bytes().begin(), t.bytes().end()}, Reply::none});
    };
    int rounds = 0;
    while (chip.next().n <= to && stuck_.empty()) {
        chip.advance(chip.next());
        collect();
        if (++rounds > 1'000'000) stuck_ = "next() does not move on";
    }
    chip.advance(Ticks{to});
    collect();
    naive.advance(to);
}

std::string Pair::run(const Step& step, Coverage* coverage) {
    switch (step.kind) {
    case Step::Kind::telegram:
    case Step::Kind::characters: {
        const std::string difference = send(step, coverage);
        if (!difference.empty()) return difference;
        advance(naive.now + 2 * kClk);
        break;
    }
    case Step::Kind::read:
    case Step::Kind::write: {
        const std::string difference = access(step, coverage);
        if (!difference.empty()) return difference;
        break;
    }
    case Step::Kind::wait: advance(naive.now + step.duration); break;
    case Step::Kind::wait_next: {
        const Time next = chip.next().n;
        const Time limit = naive.now + 3000 * kMs;
        advance(std::clamp(next > limit ? limit : next + step.duration, naive.now, limit));
        break;
    }
    case Step::Kind::reset:
        chip.reset();
        naive.reset();
        open_request_.clear();
        break;
    case Step::Kind::setup:
        for (const auto& [address, value] : step.writes) {
            Step write{};
            write.kind = Step::Kind::write;
            write.address = address;
            write.value = value;
            const std::string difference = access(write, nullptr);
            if (!difference.empty()) return difference;
        }
        break;
    }
    note_answer(coverage);
    return compare();
}

// Intel address to the address of this bus.
static unsigned bus_address(unsigned address, bool motorola) {
    return motorola && (address <= 0x07 || address == 0x18 || address == 0x19) ? address ^ 1 : address;
}

std::string Pair::access(const Step& step, Coverage* coverage) {
    advance(naive.now + step.duration);
    const unsigned address = bus_address(step.address, naive.motorola);
    if (step.kind == Step::Kind::write) {
        chip.write(static_cast<std::uint16_t>(address), octet(step.value));
        naive.write(address, step.value);
        return {};
    }
    const unsigned got = chip.read(static_cast<std::uint16_t>(address));
    const unsigned expected = naive.read(address);
    if (coverage != nullptr && step.address < 0x16)
        coverage->effects.insert(hex(step.address, 2) + " -> " + hex(expected, 2));
    if (got != expected)
        return "read " + hex(step.address, 3) + ": model " + hex(got, 2) + ", oracle " + hex(expected, 2);
    return {};
}

std::string Pair::send(const Step& step, Coverage* coverage) {
    const Time bit = kBitClk[step.baud] * kClk;
    if (no_master_sends(step.octets)) return compare();
    while (naive.plan.active && (step.polite || naive.now + step.gap_tbit * bit >= naive.plan.rts))
        advance(naive.plan.composed ? naive.plan.begun ? naive.plan.end : naive.plan.start : naive.plan.rts);
    note_answer(coverage);
    const Time start = naive.now + step.gap_tbit * bit;
    advance(start);
    open_request_.clear();  // an answer that has not begun is given up
    chip.carrier(Ticks{start});
    naive.carrier(start);
    note_answer(coverage);
    if (std::string difference = compare(); !difference.empty()) return "when the telegram begins: " + difference;
    if (step.kind == Step::Kind::telegram) {
        dpchip::fdl::Transmission t;
        t.assign(Ticks{start}, Ticks{bit}, step.octets);
        advance(t.end().n);
        note_request(step);
        chip.hear(t);
        naive.hear(start, bit, step.octets);
    } else {
        static constexpr Time kGapQuarters[]{0, 0, 0, 12, 1, 2, 160};
        Time at = start;
        for (std::size_t i = 0; i < step.octets.size(); ++i) {
            if (static_cast<int>(i) == step.fault_at) at += kGapQuarters[step.fault] * bit / 4;
            const bool here = static_cast<int>(i) == step.fault_at;
            const unsigned faults = here && step.fault <= 2 ? step.fault : 0;
            advance(at + 11 * bit);
            if (i + 1 == step.octets.size() && step.fault_at < 0) note_request(step);
            chip.hear_character({Ticks{at}, Ticks{bit}, step.octets[i], octet(faults)});
            naive.hear_character({at, bit, step.octets[i], faults == 1, faults == 2});
            at += 11 * bit;
        }
    }
    if (open_request_.empty() || naive.plan.active) {
        if (naive.plan.retry) open_request_ += " retry";
        return compare();
    }
    if (coverage != nullptr) coverage->answers.insert(open_request_ + " -");
    open_request_.clear();
    return compare();
}

// Same sender, same frame count bit, other telegram: not a repetition and not a new request. The reference is silent.
bool Pair::no_master_sends(const Octets& octets) const {
    const auto t = dpchip::fdl::decode(octets);
    if (!t || !t->has_fc() || !t->fc.is_request() || !dpchip::fdl::uses_frame_count(t->fc.request())) return false;
    return t->fc.fcv() && naive.fcb_valid && naive.fcb_sa == t->source() && naive.fcb_last == t->fc.fcb() &&
           octets != naive.fcb_octets;
}

void Pair::note_request(const Step& step) {
    open_request_.clear();
    const auto t = dpchip::fdl::decode(step.octets);
    if (step.baud != naive.baud || naive.rts()) return;
    if (!t || !t->has_fc() || !t->saps_present() || !t->fc.is_request() || (t->fc.octet & 0x80) != 0 ||
        t->source() == 127)
        return;
    if (naive.wd == WdSm::baud_search || !naive.online || naive.hears_all()) return;
    if (t->destination() != naive.ts && t->destination() != 127) return;
    if ((naive.mode0 & 0x100) == 0) return;
    const std::string what = service(*t);
    if (what.empty()) return;
    const char* sender = naive.owner < 0 ? "nobody's" : naive.owner == t->source() ? "owner" : "other";
    open_request_ = std::string{state_name(naive.dp)} + ' ' + sender + ' ' + what;
}

void Pair::note_answer(Coverage* coverage) {
    for (std::size_t i = 0; i < naive.sent.size(); ++i) {
        if (!open_request_.empty() && coverage != nullptr) {
            const std::string key = open_request_ + ' ' + answer_kind(naive.sent[i].octets);
            // Table 3.2 supposes a configuration to read; without octets in Read_Cfg there is only SC to say (3.10).
            const bool nothing_to_read = naive.cell(0x33) == 0 && key.ends_with("Get_Cfg SC");
            if (!nothing_to_read) coverage->answers.insert(key);
        }
        open_request_.clear();
    }
}

std::string Pair::compare() {
    if (!stuck_.empty()) return stuck_;
    const auto differ = [](const std::string& what, auto model, auto oracle_value) {
        return model == oracle_value
                   ? std::string{}
                   : what + ": model " + std::to_string(model) + ", oracle " + std::to_string(oracle_value) + "; ";
    };
    std::string out;
    for (std::size_t i = 0; i < std::max(chip_sent_.size(), naive.sent.size()); ++i) {
        const auto text = [i](const std::vector<Sent>& sent) {
            if (i >= sent.size()) return std::string{"nothing"};
            return hex(sent[i].octets) + "at " + clk(sent[i].start) + " bit " + clk(sent[i].bit);
        };
        if (text(chip_sent_) == text(naive.sent)) continue;
        out += "answer: model " + text(chip_sent_) + ", oracle " + text(naive.sent) + "; ";
        break;
    }
    chip_sent_.clear();
    naive.sent.clear();
    NaiveSlave plain{naive};
    for (unsigned a = 0; a < 0x16; ++a) {
        const unsigned model = chip.peek(static_cast<std::uint16_t>(bus_address(a, naive.motorola)));
        const bool command = a == 0x09 || a == 0x0B || (a >= 0x0D && a <= 0x11);  // act; read from a copy each
        const unsigned oracle_value =
            command ? naive.peek(bus_address(a, naive.motorola)) : plain.read(bus_address(a, naive.motorola));
        if (model != oracle_value)
            out += "peek " + hex(a, 2) + ": model " + hex(model, 2) + ", oracle " + hex(oracle_value, 2) + "; ";
    }
    for (unsigned a = 0x16; a < naive.ram_size(); ++a) {
        const unsigned bus = bus_address(a, naive.motorola);
        const unsigned model = chip.peek(static_cast<std::uint16_t>(bus));
        if (model != naive.ram[a])
            out += "RAM " + hex(a, 3) + ": model " + hex(model, 2) + ", oracle " + hex(naive.ram[a], 2) + "; ";
        if (out.size() > 2000) return out;
    }
    out += differ("X/INT active", chip.interrupt_active() ? 1u : 0u, naive.x_int_active ? 1u : 0u);
    out += differ("X/INT level", static_cast<unsigned>(chip.level(dpchip::chip::Pin::x_int)), naive.pin_x_int());
    out += differ("RTS level", static_cast<unsigned>(chip.level(dpchip::chip::Pin::rts)), naive.rts() ? 1u : 0u);
    out += differ("XDATAEXCH level", static_cast<unsigned>(chip.level(dpchip::chip::Pin::xdataexch_sync)),
                  naive.dp == DpSm::data_exch ? 0u : 1u);
    out += differ("owner", unsigned{chip.owner()}, naive.owner < 0 ? 255u : static_cast<unsigned>(naive.owner));
    out += differ("address", unsigned{chip.address()}, naive.ts);
    out += differ("User_WD_Timer", unsigned{chip.user_wd_timer()}, naive.user_wd);
    if (naive.hears_all() && !chip.hears_all()) out += "hears_all is false; ";
    out += differ("RAM octets", unsigned{chip.ram_bytes()}, naive.ram_size());
    return out;
}

}  // namespace oracle
