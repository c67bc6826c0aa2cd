// SPDX-License-Identifier: Apache-2.0
// The course of an MS1 service: request, polls, answer.
#include <dpchip/master/ms1.hpp>

#include <algorithm>

namespace dpchip::master {

using Kind = ServiceResult::Kind;

bool Ms1::acknowledge(const dp::AlarmAck& alarm) {
    if (acks_.size() == acks_.capacity()) return false;
    acks_.push(alarm);
    return true;
}

void Ms1::start(Ticks now) {
    acknowledging_ = !acks_.empty() && !(wanted_ && service_next_);
    service_next_ = acknowledging_;
    if (acknowledging_) {
        ack_ = acks_.pop();
        static_cast<void>(dp::encode(ack_, ack_pdu_));
        ack_result_ = ServiceResult::of(Kind::pending);
    } else if (!wanted_) {
        return;
    }
    state_ = State::request;
    again_ = now;
    deadline_ = now + config_.response_timeout;
}

Job* Ms1::next_job(Ticks now) {
    if (state_ == State::idle) start(now);
    if (state_ == State::idle || now < again_) return nullptr;
    if (now >= deadline_) {
        end(ServiceResult::of(Kind::timeout));
        return nullptr;
    }
    if (state_ != State::request) return &ask(sap(), dp::kMasterSapMs1, {});
    if (acknowledging_) return &ask(sap(), dp::kMasterSapMs1, ack_pdu_);
    return &ask(sap(), dp::kMasterSapMs1, request());
}

void Ms1::job_done(Ticks now) {
    switch (job_.outcome) {
    case Job::Outcome::data: return take_data(now);
    case Job::Outcome::acknowledged:
    case Job::Outcome::refused: return answered_without_data(now);
    case Job::Outcome::idle:
    case Job::Outcome::waiting:
    case Job::Outcome::unanswered: break;
    }
    end(ServiceResult::of(Kind::unanswered));
}

void Ms1::answered_without_data(Ticks now) {
    again_ = now + config_.poll_interval;
    if (job_.outcome == Job::Outcome::refused) {
        const fdl::Response response = job_.response.response();
        if (state_ != State::request || response != fdl::Response::rr) return end(ServiceResult::not_taken(response));
        ++counters_.busy;
        state_ = State::draining;
        return;
    }
    // After a poll of a busy SAP it is the request's turn again.
    if (state_ == State::request) state_ = State::polling;
    else if (state_ == State::draining) state_ = State::request;
}

void Ms1::take_data(Ticks now) {
    if (state_ == State::draining) {
        ++counters_.stale;
        state_ = State::request;
        again_ = now;
        return;
    }
    if (!acknowledging_) return end(judge(job_.data()));
    if (dp::is_negative(job_.data())) {
        const auto negative = dp::decode_negative(job_.data());
        return end(negative ? ServiceResult::refused(negative->error) : ServiceResult::breaks(Kind::bad_answer, negative.error()));
    }
    const bool same = std::ranges::equal(job_.data(), ack_pdu_);
    end(same ? ServiceResult::of(Kind::done) : ServiceResult::breaks(Kind::bad_answer, dp::AcyclicError::function));
}

void Ms1::end(const ServiceResult& result) {
    state_ = State::idle;
    if (!acknowledging_) {
        wanted_ = false;
        return finish(result);
    }
    acknowledging_ = false;
    ack_result_ = result;
    if (result.done()) ++acknowledged_;
}

}  // namespace dpchip::master
