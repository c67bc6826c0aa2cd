// SPDX-License-Identifier: Apache-2.0
// The course of an MS2 connection.
#include <dpchip/master/ms2.hpp>

#include <algorithm>
#include <utility>

namespace dpchip::master {

namespace {

using Kind = ServiceResult::Kind;
using dp::AbortReason;
using dp::AcyclicFunction;

constexpr std::array<std::uint8_t, dp::kIdlePdu> kIdlePdu{0x48, 0x00};
/// Between two tries of a busy resource manager.
constexpr Ticks kRetryInterval = core::milliseconds(1);

dp::Abort own(AbortReason reason) { return {dp::AbortSubnet::local, dp::AbortInstance::msac_c2, core::to_underlying(reason)}; }

dp::Abort of_fdl(std::uint8_t reason) { return {dp::AbortSubnet::local, dp::AbortInstance::fdl, reason}; }

}  // namespace

const char* name(Ms2State state) {
    switch (state) {
    case Ms2State::closed: return "closed";
    case Ms2State::initiating: return "initiating";
    case Ms2State::connecting: return "connecting";
    case Ms2State::open: return "open";
    case Ms2State::requesting: return "requesting";
    case Ms2State::polling: return "polling";
    case Ms2State::idle_request: return "sending Idle";
    case Ms2State::idle_polling: return "polling for Idle";
    case Ms2State::aborting: return "aborting";
    }
    return "unknown";
}

// ---- what the user wants -----------------------------------------------------------------------------------------

bool Ms2::open() {
    if (busy()) return false;
    if (closing_ || state_ == Ms2State::aborting) {
        finish(ServiceResult::by_abort(Kind::ended, own(AbortReason::waiting_for_confirmation)));
        return true;
    }
    if (state_ != Ms2State::closed) return false;
    const dp::InitiateReq req{config_.send_timeout, config_.features, {0, config_.source}, {0, config_.destination}};
    const auto size = dp::encode(req, initiate_);
    initiate_size_ = size ? *size : 0;
    std::ranges::copy(initiate_pdu(), request_.begin());
    send_timeout_ = dp::agreed_send_timeout(dp::min_send_timeout(9), config_.send_timeout);  // until the slave says its own
    max_length_ = dp::kMaxRecord;
    closing_ = rm_poll_ = false;
    sap_ = dp::kSapResourceManager;
    deadline_ = core::kNever;
    again_ = {};
    state_ = Ms2State::initiating;
    begin(size);
    wanted_ = false;
    return true;
}

bool Ms2::transport(std::uint8_t slot, std::uint8_t index, std::span<const std::uint8_t> data) {
    if (busy()) return false;
    if (data.size() > max_data()) return begin(dp::AcyclicError::length_range);
    return begin(dp::encode(AcyclicFunction::data_transport, dp::Record{slot, index, data}, request_));
}

void Ms2::close(std::uint8_t reason) {
    if (state_ == Ms2State::closed || state_ == Ms2State::aborting) return;
    closing_ = true;
    abort_ = {dp::AbortSubnet::local, dp::AbortInstance::user, static_cast<std::uint8_t>(reason & 15u)};
}

bool Ms2::usable(ServiceResult& why) const {
    if (is_open() || state_ == Ms2State::initiating) return true;
    why = ServiceResult::of(Kind::closed);
    return false;
}

// ---- what is sent next -------------------------------------------------------------------------------------------

Job* Ms2::next_job(Ticks now) {
    if (state_ == Ms2State::closed || now < again_) return nullptr;
    if (state_ == Ms2State::initiating && deadline_ == core::kNever) {  // the first turn
        enter(Ms2State::initiating, now);
        patient_until_ = now + config_.patience;
    }
    if (closing_ && state_ != Ms2State::initiating && state_ != Ms2State::aborting)
        break_off(abort_, ServiceResult::by_abort(Kind::ended, abort_), now);
    if (expired(now)) give_up(now);
    if (state_ == Ms2State::open) {
        if (wanted_) enter(Ms2State::requesting, now);
        else if (config_.keep_alive && now >= last_sent_ + send_timeout_ticks()) enter(Ms2State::idle_request, now);
    }
    const auto on_sap = [this](std::span<const std::uint8_t> pdu) { return &ask(sap_, dp::kMasterSapMs2, pdu); };
    switch (state_) {
    case Ms2State::closed:
    case Ms2State::open: return nullptr;
    case Ms2State::initiating: return on_sap(rm_poll_ ? std::span<const std::uint8_t>{} : initiate_pdu());
    case Ms2State::connecting:
    case Ms2State::polling:
    case Ms2State::idle_polling: return on_sap({});
    case Ms2State::requesting: return on_sap(draining_ ? std::span<const std::uint8_t>{} : request());
    case Ms2State::idle_request: return on_sap(draining_ ? std::span<const std::uint8_t>{} : kIdlePdu);
    case Ms2State::aborting: {
        std::array<std::uint8_t, dp::kAbortPdu> pdu{};
        static_cast<void>(dp::encode(abort_, pdu));
        return on_sap(pdu);
    }
    }
    return nullptr;
}

void Ms2::enter(Ms2State state, Ticks now) {
    state_ = state;
    draining_ = false;
    again_ = now;
    if (state == Ms2State::open) {
        last_sent_ = now;
        deadline_ = core::kNever;
        return;
    }
    // The wait for an answer counts from the request.
    if (state == Ms2State::polling || state == Ms2State::idle_polling) return;
    deadline_ = now + (config_.response_timeout != Ticks{} ? config_.response_timeout : send_timeout_ticks() * 3);
}

void Ms2::give_up(Ticks now) {
    const ServiceResult why = ServiceResult::of(Kind::timeout);
    if (state_ == Ms2State::initiating || state_ == Ms2State::aborting) return shut(state_ == Ms2State::aborting ? after_abort_ : why);
    break_off(own(AbortReason::timeout), why, now);
}

/// Abort is the next thing to be sent; the service under way has ended.
void Ms2::break_off(const dp::Abort& abort, const ServiceResult& why, Ticks now) {
    abort_ = abort;
    after_abort_ = why;
    closing_ = false;
    wanted_ = false;
    if (busy()) finish(why);
    enter(Ms2State::aborting, now);
}

void Ms2::shut(const ServiceResult& why) {
    state_ = Ms2State::closed;
    closing_ = wanted_ = false;
    ending_ = why;
    if (why.kind == Kind::unanswered) ending_.abort = of_fdl(core::to_underlying(dp::FdlReason::na));
    if (why.kind == Kind::not_taken) ending_.abort = of_fdl(core::to_underlying(why.response));  // the codes are the same
    if (busy()) finish(ending_);
}

// ---- what comes back ---------------------------------------------------------------------------------------------

void Ms2::job_done(Ticks now) {
    if (state_ == Ms2State::aborting) return shut(after_abort_);
    switch (job_.outcome) {
    case Job::Outcome::data: return take_data(now);
    case Job::Outcome::acknowledged: return acknowledged(now);
    case Job::Outcome::refused: return refused(now);
    case Job::Outcome::idle:
    case Job::Outcome::waiting:
    case Job::Outcome::unanswered: break;
    }
    shut(ServiceResult::of(Kind::unanswered));
}

void Ms2::put_off(Ticks now) {
    ++counters_.busy;
    again_ = now + kRetryInterval;
}

void Ms2::refused(Ticks now) {
    const fdl::Response response = job_.response.response();
    const bool busy_now = response == fdl::Response::rr || response == fdl::Response::rs;
    if (state_ == Ms2State::initiating || state_ == Ms2State::connecting) {
        if (!busy_now || now >= patient_until_) return shut(ServiceResult::not_taken(response));
        if (closing_ && state_ == Ms2State::initiating) return shut(ServiceResult::by_abort(Kind::ended, abort_));
        rm_poll_ = false;
        return put_off(now);
    }
    // RR: something waits to be fetched first, an Abort most likely.
    if (response == fdl::Response::rr && !draining_ && (state_ == Ms2State::requesting || state_ == Ms2State::idle_request)) {
        draining_ = true;
        return put_off(now);
    }
    shut(ServiceResult::not_taken(response));
}

void Ms2::acknowledged(Ticks now) {
    if (std::exchange(draining_, false)) return put_off(now);
    if (state_ == Ms2State::initiating) rm_poll_ = true;
    else if (state_ == Ms2State::requesting) enter(Ms2State::polling, now);
    else if (state_ == Ms2State::idle_request) enter(Ms2State::idle_polling, now);
    again_ = now + config_.poll_interval;
}

void Ms2::take_data(Ticks now) {
    const auto pdu = job_.data();
    if (state_ == Ms2State::initiating) return initiated(pdu, now);
    if (!pdu.empty() && pdu[0] == core::to_underlying(AcyclicFunction::abort)) {
        const auto abort = dp::decode_abort(pdu);
        return shut(abort ? ServiceResult::by_abort(Kind::aborted, *abort) : ServiceResult::breaks(Kind::bad_answer, abort.error()));
    }
    if (state_ == Ms2State::connecting) return connected(pdu, now);
    if (std::exchange(draining_, false)) {
        ++counters_.stale;
        return;
    }
    if (state_ == Ms2State::idle_polling || state_ == Ms2State::idle_request) {
        if (!std::ranges::equal(pdu, kIdlePdu))
            return break_off(own(AbortReason::invalid_response), ServiceResult::breaks(Kind::bad_answer, dp::AcyclicError::function), now);
        ++idles_;
        return enter(Ms2State::open, now);
    }
    const ServiceResult result = judge(pdu);
    if (result.kind == Kind::bad_answer) return break_off(own(AbortReason::invalid_response), result, now);
    wanted_ = false;
    finish(result);
    enter(Ms2State::open, now);
}

/// The resource manager's answer: which SAP.
void Ms2::initiated(std::span<const std::uint8_t> pdu, Ticks now) {
    const auto rm = dp::decode_resource_manager(pdu);
    if (!rm || rm->sap > dp::kLastMs2Sap)
        return shut(ServiceResult::breaks(Kind::bad_answer, rm ? dp::AcyclicError::function : rm.error()));
    sap_ = rm->sap;
    send_timeout_ = dp::agreed_send_timeout(rm->send_timeout, config_.send_timeout);
    if (config_.longest_send_timeout != 0 && send_timeout_ > config_.longest_send_timeout) {
        const dp::Abort abort = own(AbortReason::send_timeout_too_small);
        break_off(abort, ServiceResult::by_abort(Kind::ended, abort), now);
        again_ = now + config_.settle;
        return;
    }
    enter(Ms2State::connecting, now);
    again_ = now + config_.settle;
    patient_until_ = again_ + config_.patience;
}

void Ms2::connected(std::span<const std::uint8_t> pdu, Ticks now) {
    const auto res = dp::decode_initiate_res(pdu);
    if (!res)
        return break_off(own(AbortReason::invalid_response), ServiceResult::breaks(Kind::bad_answer, res.error()), now);
    max_length_ = std::min<std::uint8_t>(res->max_length, dp::kMaxRecord);
    features_ = res->features;
    finish(ServiceResult::of(Kind::done));
    enter(Ms2State::open, now);
}

}  // namespace dpchip::master
