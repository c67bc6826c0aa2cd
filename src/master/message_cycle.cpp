// SPDX-License-Identifier: Apache-2.0
// One request and what becomes of it: answer, repetition, silence. And the requests that are not cyclic.
#include <algorithm>
#include <utility>

#include <dpchip/dp/clock.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/master/master.hpp>

namespace dpchip::master {

const char* name(Job::Outcome outcome) {
    switch (outcome) {
    case Job::Outcome::idle: return "idle";
    case Job::Outcome::waiting: return "waiting";
    case Job::Outcome::data: return "answered with data";
    case Job::Outcome::acknowledged: return "acknowledged";
    case Job::Outcome::refused: return "refused";
    case Job::Outcome::unanswered: return "not answered";
    }
    return "unknown";
}

// ---- out ---------------------------------------------------------------------------------------------------------

bool Master::take(fdl::Transmission& t) {
    if (phase_ != Phase::ready) return false;
    if (step_ == (isochron() ? Step::synch : Step::token)) measure();
    t.start = now_;
    t.bit = bit_;
    t.damaged = t.synchronised = false;
    t.length = static_cast<std::uint16_t>(compose(t.buffer()));
    own_end_ = t.end();
    if (step_ == Step::time_event) {
        previous_event_ = event_time_;
        event_time_ = config_.time.start.plus_ns(core::to_ns(own_end_));
    }
    if (!wants_answer()) {
        phase_ = Phase::draining;
        send_at_ = own_end_;
        return true;
    }
    ++counters_.requests;
    if (!outstanding_) retries_left_ = may_repeat() ? config_.max_retry : std::uint8_t{0};
    outstanding_ = true;
    phase_ = Phase::asking;
    deadline_ = slot_end_ = own_end_ + slot_;
    return true;
}

std::size_t Master::compose(std::span<std::uint8_t> out) {
    switch (step_) {
    case Step::slave:
    case Step::absent: return slaves_[polled()]->compose(out, config_.address, mode_);
    case Step::synch:
    case Step::command: {
        const dp::GlobalControl& gc = step_ == Step::synch ? config_.isochron.synch : command_;
        const std::array<std::uint8_t, 2> data{gc.control_command, gc.group_select};
        const std::uint8_t fc = fdl::request_fc(fdl::Request::sdn_high, false, false);
        return fdl::encode(out, fdl::SapTelegram{fdl::kBroadcast, config_.address, fc, dp::kSapGlobalControl,
                                                 dp::kMasterSap, data});
    }
    case Step::time_event: return fdl::encode_sd1(out, fdl::kBroadcast, config_.address, dp::kFcTimeEvent);
    case Step::clock_value: return compose_clock_value(out);
    case Step::job:
    case Step::scan: return compose_job(out);
    case Step::gap:
        return fdl::encode_sd1(out, gap_address_, config_.address,
                               fdl::request_fc(fdl::Request::fdl_status, false, false));
    case Step::claim:
    case Step::token:
    case Step::pass:
    case Step::end: break;
    }
    return fdl::encode_token(out, config_.address, config_.address);
}

std::size_t Master::compose_clock_value(std::span<std::uint8_t> out) {
    std::array<std::uint8_t, dp::kClockValueOctets> value{};
    static_cast<void>(dp::encode(dp::ClockValue{.time_event = event_time_, .previous = previous_event_}, value));
    clock_value_due_ = false;
    return fdl::encode(out, fdl::kBroadcast, config_.address, dp::kFcClockValue, value);
}

bool Master::wants_answer() const {
    switch (step_) {
    case Step::synch:
    case Step::token:
    case Step::command:
    case Step::time_event:
    case Step::clock_value:
    case Step::pass: return false;
    case Step::job: break;
    case Step::claim:
    case Step::slave:
    case Step::absent:
    case Step::scan:
    case Step::gap:
    case Step::end: return true;
    }
    return step_ != Step::job || (!fdl::is_sdn(job_->function) && job_->address != fdl::kBroadcast);
}

bool Master::may_repeat() const {
    if (step_ == Step::slave || step_ == Step::absent) return slaves_[polled()]->state() != SlaveState::absent;
    return step_ == Step::job || (step_ == Step::scan && job_->function != fdl::Request::fdl_status);
}

std::uint8_t Master::asked() const {
    if (step_ == Step::slave || step_ == Step::absent) return slaves_[polled()]->config().address;
    return step_ == Step::gap ? gap_address_ : job_->address;
}

// ---- in ----------------------------------------------------------------------------------------------------------

void Master::carrier(Ticks at) {
    if (at < own_end_ || (phase_ != Phase::asking && phase_ != Phase::waiting)) return;
    phase_ = Phase::hearing;
    // A transmission is heard when it ends. Should it never, the master goes on.
    deadline_ = at + bits(fdl::kCharacterBits * static_cast<std::int64_t>(fdl::kMaxTelegram)) + slot_;
}

void Master::hear(const fdl::Transmission& t) {
    if (phase_ == Phase::silent) return;
    heard_ = t.end();
    const auto telegram = fdl::decode(t.bytes());
    if (outstanding_ && telegram && expected(*telegram)) return answered(*telegram, t.end());
    ++counters_.foreign;
    resume(t.end());
}

void Master::hear_character(const fdl::Character& c) {
    if (phase_ == Phase::silent) return;
    if (outstanding_ && phase_ == Phase::hearing) ++counters_.damaged;
    slot_end_ = std::min(slot_end_, c.end());  // it was an answer, if a bad one: no need to wait for another
    resume(c.end());
}

/// The line is quiet again, and what was heard is not what the master waits for.
void Master::resume(Ticks quiet_from) {
    if (phase_ == Phase::draining || phase_ == Phase::ready) return;
    const Ticks idle = quiet_from + bits(std::max(config_.times.tid1(), fdl::kTsynBits));
    if (outstanding_) {
        phase_ = Phase::asking;
        deadline_ = std::max(slot_end_, idle);
        return;
    }
    phase_ = Phase::waiting;
    if (step_ == Step::claim) send_at_ = quiet_from + bits(config_.times.tsl * (6 + 2 * config_.address));
    else send_at_ = std::max(send_at_, idle);
}

bool Master::expected(const fdl::Telegram& t) const {
    if (t.sd == fdl::kSc) return true;
    if (!t.has_fc() || t.fc.is_request() || t.source() != asked()) return false;
    if (t.destination() == config_.address) return true;
    return t.destination() == fdl::kBroadcast && step_ == Step::slave && slaves_[polled()]->multicast();
}

void Master::answered(const fdl::Telegram& t, Ticks end) {
    ++counters_.answers;
    if (step_ == Step::slave || step_ == Step::absent) slaves_[polled()]->answered(t, config_.address);
    else if (step_ != Step::gap) job_answered(t);
    step_done(end, config_.times.tid1());
}

void Master::no_answer() {
    if (!outstanding_) return resume(now_);
    ++counters_.timeouts;
    if (retries_left_ == 0) return give_up();
    --retries_left_;
    ++counters_.retries;
    if (step_ == Step::slave || step_ == Step::absent) slaves_[polled()]->note_retry();
    phase_ = Phase::ready;
}

void Master::give_up() {
    if (step_ == Step::slave || step_ == Step::absent) slaves_[polled()]->unanswered();
    else if (step_ != Step::gap) job_finished(Job::Outcome::unanswered);
    step_done(now_, 0);
}

// ---- jobs --------------------------------------------------------------------------------------------------------

bool Master::submit(Job& job) {
    if (jobs_.size() == jobs_.capacity() || job.address > fdl::kBroadcast) return false;
    job.outcome = Job::Outcome::waiting;
    job.answer_size = 0;
    jobs_.push(&job);
    return true;
}

void Master::cancel(Job& job) {
    for (std::size_t n = jobs_.size(); n != 0; --n) {
        Job* const other = jobs_.pop();
        if (other != &job) jobs_.push(other);
    }
    if (job_ == &job) forsake(job);
    job.outcome = Job::Outcome::idle;
}

/// It is being asked: the answer goes to a job of the master's own.
void Master::forsake(Job& job) {
    spare_job_ = job;
    job_ = &spare_job_;
}

void Master::attach(Relation& relation) {
    if (std::ranges::find(relations_, &relation) == relations_.end()) relations_.push_back(&relation);
}

void Master::detach(Relation& relation) {
    std::erase(relations_, &relation);
    if (asking_ != &relation) return;
    asking_ = nullptr;
    if (job_ != nullptr) forsake(*job_);
}

std::uint8_t Master::job_fc() const {
    const Job& job = *job_;
    if (!fdl::uses_frame_count(job.function)) return fdl::request_fc(job.function, false, false);
    const std::int16_t n = by_address_[job.address & 0x7Fu];
    return n < 0 ? frames_[job.address & 0x7Fu].fc(job.function) : slaves_[static_cast<std::size_t>(n)]->frame_count(job.function);
}

std::size_t Master::compose_job(std::span<std::uint8_t> out) const {
    const Job& job = *job_;
    const std::uint8_t fc = job_fc();
    const auto data = std::span{job.request}.first(std::min<std::size_t>(job.request_size, job.request.size()));
    if (job.function == fdl::Request::fdl_status) return fdl::encode_sd1(out, job.address, config_.address, fc);
    if (job.dsap == dp::kDefaultSap) return fdl::encode(out, job.address, config_.address, fc, data);
    return fdl::encode(out, fdl::SapTelegram{job.address, config_.address, fc, job.dsap, job.ssap, data});
}

void Master::job_answered(const fdl::Telegram& t) {
    Job& job = *job_;
    job.response = t.fc;
    if (t.sd == fdl::kSc) return job_finished(Job::Outcome::acknowledged);
    if (t.unit.empty()) {
        const bool good = t.fc.response() == fdl::Response::ok;
        return job_finished(good ? Job::Outcome::acknowledged : Job::Outcome::refused);
    }
    if (!t.saps_present()) return job_finished(Job::Outcome::refused);
    job.answer_size = static_cast<std::uint16_t>(t.data().size());
    std::ranges::copy(t.data(), job.answer.begin());
    job_finished(Job::Outcome::data);
}

void Master::job_finished(Job::Outcome outcome) {
    Job& job = *job_;
    if (fdl::uses_frame_count(job.function)) {
        const bool answered = outcome != Job::Outcome::unanswered;
        if (SlaveHandler* const slave = find(job.address)) slave->count_frame(answered);
        else frames_[job.address & 0x7Fu].count(answered);
    }
    job.outcome = outcome;
    job_ = nullptr;
    if (Relation* const relation = std::exchange(asking_, nullptr)) return relation->job_done(present());
    if (&job == &scan_job_) scan_goes_on();
}

// ---- scan --------------------------------------------------------------------------------------------------------

void Master::start_scan() {
    found_ = {};
    scan_address_ = config_.address == 0 ? 1 : 0;
    scan_job_ = Job::fdl_status(scan_address_);
}

void Master::scan_goes_on() {
    if (!scanning()) return;
    Found& found = found_[scan_address_];
    if (scan_job_.function == fdl::Request::fdl_status) {
        found.present = scan_job_.outcome == Job::Outcome::acknowledged;
        found.type = scan_job_.response.station_type();
        if (!found.present || found.type != fdl::StationType::slave) return scan_next();
        scan_job_ = Job::slave_diag(scan_address_);
        return;
    }
    const auto header = dp::decode_diag_header(scan_job_.data());
    found.diagnosed = scan_job_.outcome == Job::Outcome::data && header;
    if (found.diagnosed) {
        found.ident = header->ident;
        found.master_add = header->master_add;
    }
    scan_next();
}

void Master::scan_next() {
    ++scan_address_;
    if (scan_address_ == config_.address) ++scan_address_;
    if (scan_address_ > kLastAddress) {
        scan_address_ = kNotScanning;
        return;
    }
    scan_job_ = Job::fdl_status(scan_address_);
}

}  // namespace dpchip::master
