// SPDX-License-Identifier: Apache-2.0
// Results of acyclic services in words.
#include <dpchip/master/service_result.hpp>

#include <array>
#include <initializer_list>

namespace dpchip::master {

namespace {

std::string octets_text(std::initializer_list<std::uint8_t> octets) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::string text;
    for (const std::uint8_t o : octets) {
        if (!text.empty()) text += ' ';
        text += kDigits[o >> 4];
        text += kDigits[o & 15];
        text += 'H';
    }
    return text;
}

std::string error_text(const dp::RecordError& e) {
    const std::string codes = octets_text({e.error_decode, e.error_code_1, e.error_code_2});
    if (e.error_decode != core::to_underlying(dp::ErrorDecode::dpv1))
        return std::string{"error of "} + dp::error_decode_name(e.error_decode) + " (" + codes + ')';
    return std::string{dp::error_code_name(e.error_code_1)} + " (" + dp::error_class_name(e.error_code_1) + "; " + codes + ')';
}

const char* response_text(fdl::Response r) {
    switch (r) {
    case fdl::Response::rs: return "the SAP is closed (RS): no such service, not in data exchange with it, or all connections are taken";
    case fdl::Response::rr: return "no resource (RR): busy with another request, or the request is too long for it";
    case fdl::Response::ue: return "user error (UE)";
    case fdl::Response::nr: return "no data ready (NR)";
    case fdl::Response::ok:
    case fdl::Response::dl:
    case fdl::Response::dh:
    case fdl::Response::rdl:
    case fdl::Response::rdh: break;
    }
    return "an answer that the service does not know";
}

}  // namespace

std::string text(const dp::Abort& a) {
    const auto instance_reason = static_cast<std::uint8_t>(unsigned{core::to_underlying(a.instance)} << 4 | (a.reason & 15u));
    const std::string reason = a.instance == dp::AbortInstance::user ? "reason " + std::to_string(a.reason)
                                                                     : dp::abort_reason_name(a.instance, a.reason);
    return reason + " of " + dp::name(a.instance) + " (" +
           octets_text({core::to_underlying(dp::AcyclicFunction::abort), a.subnet, instance_reason}) + ')';
}

std::string text(const ServiceResult& r) {
    using Kind = ServiceResult::Kind;
    switch (r.kind) {
    case Kind::none: return "nothing has been asked";
    case Kind::pending: return "not answered yet";
    case Kind::done: return "done";
    case Kind::refused: return "refused: " + error_text(r.error);
    case Kind::not_taken: return std::string{"not taken: "} + response_text(r.response);
    case Kind::unanswered: return "the station does not answer";
    case Kind::timeout: return "the station works on it for too long: given up";
    case Kind::bad_answer: return std::string{"the answer does not fit: "} + dp::name(r.rule);
    case Kind::aborted: return "the slave has ended the connection: " + text(r.abort);
    case Kind::ended: return "this master has ended the connection: " + text(r.abort);
    case Kind::closed: return "there is no connection";
    case Kind::invalid: return std::string{"cannot be asked: "} + dp::name(r.rule);
    }
    return "unknown";
}

}  // namespace dpchip::master
