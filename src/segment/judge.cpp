// SPDX-License-Identifier: Apache-2.0
// The rules the judge knows.
#include <dpchip/segment/judge.hpp>

namespace dpchip::segment {

const char* name(Violation violation) {
    switch (violation) {
    case Violation::early_answer: return "answer before min TSDR";
    case Violation::late_answer: return "answer after max TSDR";
    case Violation::short_idle: return "request before TID1";
    case Violation::short_idle_sdn: return "request before TID2";
    case Violation::impatient: return "request inside a slot time";
    case Violation::out_of_turn: return "answer out of turn";
    case Violation::malformed: return "no telegram";
    case Violation::gap: return "gap in a telegram";
    case Violation::parity: return "parity error";
    case Violation::stop_bit: return "stop bit missing";
    case Violation::collision: return "collision";
    case Violation::address: return "impossible source address";
    case Violation::rate: return "unknown rate";
    }
    return "unknown";
}

namespace {

bool wants_answer(const fdl::Telegram& t) {
    const fdl::Request r = t.fc.request();
    if (t.destination() == fdl::kBroadcast) return false;
    return fdl::is_srd(r) || fdl::is_sda(r) || r == fdl::Request::msrd || r == fdl::Request::fdl_status ||
           r == fdl::Request::ident || r == fdl::Request::lsap_status;
}

}  // namespace

void Judge::clear() {
    total_ = telegrams_ = answers_ = unanswered_ = 0;
    counts_ = {};
    kept_count_ = 0;
}

void Judge::broken(Violation v, const Sighting& s, Ticks time) {
    ++total_;
    ++counts_[static_cast<std::size_t>(v)];
    if (kept_count_ == kept_.size()) return;
    kept_[kept_count_++] = {v, s.sent.start, s.sender, time / s.sent.bit};
}

fdl::BusTimes Judge::times(const Sighting& s) {
    if (times_) return *times_;
    for (const fdl::Baud& b : fdl::kBaud)
        if (b.bit == s.sent.bit) return fdl::bus_times(b.code);
    broken(Violation::rate, s);
    return fdl::bus_times(fdl::BaudCode::not_found);
}

void Judge::see(const Sighting& s) {
    ++telegrams_;
    const auto t = fdl::decode(s.sent.bytes());
    if (s.sent.damaged) {
        damaged(s);
        if (!t || t->size != s.sent.length) broken(Violation::malformed, s);
        before_ = Before::garbage;
    } else if (!t || t->size != s.sent.length) {
        broken(Violation::malformed, s);
        before_ = Before::garbage;
    } else if (t->sd == fdl::kSc || (t->has_fc() && !t->fc.is_request())) {
        answer(s, *t);
    } else {
        request(s, *t);
    }
    before_end_ = s.sent.end();
}

void Judge::damaged(const Sighting& s) {
    unsigned faults = 0;
    for (std::size_t i = 0; i < s.sent.length; ++i) faults |= s.sent.faults[i];
    if ((faults & fdl::fault_parity) != 0) broken(Violation::parity, s);
    if ((faults & fdl::fault_stop) != 0) broken(Violation::stop_bit, s);
    if ((faults & fdl::fault_collision) != 0) broken(Violation::collision, s);
    const Ticks pause = s.sent.start - before_end_;
    if (before_ == Before::garbage && pause > Ticks{} && pause < s.sent.bit * fdl::kTsynBits)
        broken(Violation::gap, s, pause);
}

void Judge::idle_before_request(const Sighting& s) {
    const fdl::BusTimes limits = times(s);
    const Ticks idle = s.sent.start - before_end_, bit = s.sent.bit;
    switch (before_) {
    case Before::nothing: break;
    case Before::request:
        ++unanswered_;
        if (idle < bit * limits.tsl) broken(Violation::impatient, s, idle);
        break;
    case Before::no_answer:
        if (idle < bit * limits.tid2()) broken(Violation::short_idle_sdn, s, idle);
        break;
    case Before::answer:
    case Before::token:
        if (idle < bit * limits.tid1()) broken(Violation::short_idle, s, idle);
        break;
    case Before::garbage:
        if (idle < bit * fdl::kTsynBits) broken(Violation::short_idle, s, idle);
        break;
    }
}

void Judge::request(const Sighting& s, const fdl::Telegram& t) {
    idle_before_request(s);
    if (t.source() > 126) broken(Violation::address, s);
    asker_ = t.source();
    asked_ = t.destination();
    multicast_ = t.has_fc() && t.fc.request() == fdl::Request::msrd;
    if (t.sd == fdl::kSd4) before_ = Before::token;
    else before_ = wants_answer(t) ? Before::request : Before::no_answer;
}

void Judge::answer(const Sighting& s, const fdl::Telegram& t) {
    ++answers_;
    const bool asked = before_ == Before::request;
    const bool addressed = !t.has_addresses() || (t.source() == asked_ && (t.destination() == asker_ ||
                                                  (multicast_ && t.destination() == fdl::kBroadcast)));
    if (!asked || !addressed) {
        broken(Violation::out_of_turn, s);
    } else {
        const fdl::BusTimes limits = times(s);
        const Ticks tsdr = s.sent.start - before_end_;
        if (tsdr < s.sent.bit * limits.min_tsdr) broken(Violation::early_answer, s, tsdr);
        if (tsdr > s.sent.bit * limits.max_tsdr) broken(Violation::late_answer, s, tsdr);
    }
    before_ = Before::answer;
}

}  // namespace dpchip::segment
