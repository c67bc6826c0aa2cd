// SPDX-License-Identifier: Apache-2.0
// What became of an acyclic service, as a value and in words with the codes (reference 5.3, 5.4).
#pragma once

#include <cstdint>
#include <string>

#include <dpchip/dp/acyclic_error.hpp>
#include <dpchip/dp/initiate.hpp>
#include <dpchip/fdl/function_code.hpp>

namespace dpchip::master {

struct ServiceResult {
    enum class Kind : std::uint8_t {
        none,        ///< nothing has been asked yet
        pending,
        done,        ///< positive answer
        refused,     ///< negative answer: `error`
        not_taken,   ///< the station answered without data: `response`
        unanswered,  ///< no answer, not even after the last repetition
        timeout,     ///< it takes requests and polls, but the answer does not come
        bad_answer,  ///< an answer that does not fit the request: `rule`
        aborted,     ///< the slave ended the connection: `abort`
        ended,       ///< this master ended the connection: `abort`
        closed,      ///< there is no connection
        invalid,     ///< cannot be asked: `rule`
    };

    Kind kind = Kind::none;
    dp::RecordError error{};
    fdl::Response response{};
    dp::AcyclicError rule{};
    dp::Abort abort{};         ///< also of a connection that ended with not_taken or unanswered: instance FDL

    bool pending() const { return kind == Kind::pending; }
    bool finished() const { return kind > Kind::pending; }
    bool done() const { return kind == Kind::done; }

    static ServiceResult of(Kind kind) {
        ServiceResult r{};
        r.kind = kind;
        return r;
    }
    static ServiceResult refused(const dp::RecordError& error) {
        ServiceResult r = of(Kind::refused);
        r.error = error;
        return r;
    }
    static ServiceResult not_taken(fdl::Response response) {
        ServiceResult r = of(Kind::not_taken);
        r.response = response;
        return r;
    }
    static ServiceResult breaks(Kind kind, dp::AcyclicError rule) {
        ServiceResult r = of(kind);
        r.rule = rule;
        return r;
    }
    static ServiceResult by_abort(Kind kind, const dp::Abort& abort) {
        ServiceResult r = of(kind);
        r.abort = abort;
        return r;
    }
};

/// "refused: invalid index (access; 80H B0H 00H)".
std::string text(const ServiceResult& result);
/// "timeout (TO) of MSAC_C2 (58H 00H 13H)".
std::string text(const dp::Abort& abort);

}  // namespace dpchip::master
