// SPDX-License-Identifier: Apache-2.0
// From octets to words: addresses, function codes, services.
#include <dpchip/trace/service_text.hpp>
#include <dpchip/trace/telegram_text.hpp>
#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

const char* format_name(std::uint8_t sd) {
    switch (sd) {
    case fdl::kSd1: return "SD1";
    case fdl::kSd2: return "SD2";
    case fdl::kSd3: return "SD3";
    case fdl::kSd4: return "SD4";
    case fdl::kSc: return "SC";
    default: return "?";
    }
}

std::string route(std::uint8_t from, std::uint8_t to) {
    return std::to_string(from) + "->" + (to == fdl::kBroadcast ? std::string{"all"} : std::to_string(to));
}

const char* meaning(fdl::Response response) {
    switch (response) {
    case fdl::Response::ok: return "positive";
    case fdl::Response::ue: return "user error";
    case fdl::Response::rr: return "no resource";
    case fdl::Response::rs: return "service or SAP not activated";
    case fdl::Response::dl: return "data";
    case fdl::Response::nr: return "no data ready";
    case fdl::Response::dh: return "data, diagnosis waiting";
    case fdl::Response::rdl: return "data, request not accepted";
    case fdl::Response::rdh: return "data high, request not accepted";
    }
    return "reserved";
}

const char* name(fdl::StationType type) {
    switch (type) {
    case fdl::StationType::slave: return "slave";
    case fdl::StationType::master_not_ready: return "master not ready";
    case fdl::StationType::master_ready: return "master ready";
    case fdl::StationType::master_in_ring: return "master in ring";
    }
    return "slave";
}

bool negative(fdl::Response response) {
    return response == fdl::Response::ue || response == fdl::Response::rr || response == fdl::Response::rs ||
           response == fdl::Response::nr;
}

dp::Service service_of(bool has_sap, std::uint8_t sap) { return dp::service(has_sap ? sap : dp::kDefaultSap); }

/// The service's words; a SAP that means nothing in DP is named by its number.
std::string service_name(dp::Service service, std::uint8_t sap) {
    if (service == dp::Service::none && sap != dp::kDefaultSap) return "SAP " + std::to_string(sap);
    if (service == dp::Service::ms2) return "MS2 SAP " + std::to_string(sap);
    return dp::name(service);
}

std::string request_name(const Request& request) {
    if (request.function == fdl::Request::fdl_status) return "FDL_Status";
    if (request.service == dp::Service::none && request.dsap == dp::kDefaultSap) return fdl::name(request.function);
    return service_name(request.service, request.dsap);
}

std::string sap_detail(const fdl::Telegram& t) {
    std::string text;
    if (t.has_dsap()) text = std::string{"DSAP "} + std::to_string(t.dsap());
    if (t.has_ssap()) add_word(text, std::string{"SSAP "} + std::to_string(t.ssap()));
    return text;
}

std::string head(const fdl::Telegram& t) { return std::string{format_name(t.sd)} + ' ' + route(t.source(), t.destination()) + ' '; }

void merge(Explanation& into, const DataText& text) {
    if (!text.words.empty()) into.line += (into.line.ends_with(':') ? " " : into.line.ends_with(' ') ? "" : " ") + text.words;
    into.details.insert(into.details.end(), text.details.begin(), text.details.end());
}

void explain_request(const fdl::Telegram& t, const Context& context, Explanation& into) {
    const fdl::Request function = t.fc.request();
    std::string words = t.fc.clock_value() ? "Clock_Value" : fdl::name(function);
    if (!t.fc.clock_value() && words == "reserved") words = std::string{"reserved function "} + std::to_string(t.fc.function());
    std::string detail = std::string{"FC "} + hex_number(t.fc.octet) + ": request " + words;
    if (fdl::uses_frame_count(function)) {
        words += t.fc.fcb() ? " FCB=1" : " FCB=0";
        if (!t.fc.fcv()) words += " first";
        detail += std::string{", FCB "} + (t.fc.fcb() ? "1" : "0") + ", FCV " + (t.fc.fcv() ? "1" : "0");
    }
    if (context.repeated) words += " repeated";
    into.details.push_back(detail);
    into.line += words;
    const dp::Service service = requested_service(t);
    if (t.has_dsap() || service == dp::Service::data_exchange)
        into.line += ' ' + service_name(service, t.has_dsap() ? t.dsap() : dp::kDefaultSap);
    const std::string saps = sap_detail(t);
    if (!saps.empty()) into.details.push_back(saps + ": " + service_name(service, t.has_dsap() ? t.dsap() : dp::kDefaultSap));
    merge(into, request_text(service, t.data()));
}

/// The service an answer belongs to: its SSAP is the DSAP of the request; without SAPs the request decides.
dp::Service answered_service(const fdl::Telegram& t, const Request& request) {
    if (t.has_ssap()) return service_of(true, t.ssap());
    if (request.known) return request.service;
    return t.unit.empty() ? dp::Service::none : dp::Service::data_exchange;
}

void explain_answer(const fdl::Telegram& t, const Context& context, Explanation& into) {
    const fdl::Response response = t.fc.response();
    std::string word = fdl::name(response);
    if (word == "reserved") word = std::string{"reserved response "} + std::to_string(t.fc.function());
    into.details.push_back(std::string{"FC "} + hex_number(t.fc.octet) + ": response " + word + ", " + meaning(response) + ", " + name(t.fc.station_type()));
    const std::string saps = sap_detail(t);
    if (!saps.empty()) into.details.push_back(saps);
    const Request& request = context.request;
    if (t.unit.empty() && response == fdl::Response::ok) {
        into.line += "OK " + (request.known ? request_name(request) : std::string{"FDL_Status"}) + ": " + name(t.fc.station_type());
        return;
    }
    const dp::Service service = answered_service(t, request);
    into.line += word;
    if (request.known && !t.has_ssap()) into.line += ' ' + request_name(request);
    else if (service != dp::Service::none || t.has_ssap()) into.line += ' ' + service_name(service, t.has_ssap() ? t.ssap() : dp::kDefaultSap);
    if (negative(response)) into.line += std::string{" refused: "} + meaning(response);
    if (response == fdl::Response::dh) into.line += " diagnosis waiting";
    if (!t.data().empty()) into.line += service == dp::Service::data_exchange ? "" : ":";
    merge(into, answer_text(service, t.data(), t.source(), context.texts));
}

Explanation explain_sc(const Request& request) {
    if (!request.known) return {"SC acknowledged", {}};
    return {"SC " + route(request.da, request.sa) + ' ' + request_name(request) + " acknowledged", {}};
}

}  // namespace

dp::Service requested_service(const fdl::Telegram& t) {
    if (!t.has_fc() || !t.fc.is_request() || t.fc.clock_value() || !t.saps_present()) return dp::Service::none;
    const fdl::Request function = t.fc.request();
    if (t.has_dsap()) return dp::service(t.dsap());
    return fdl::is_srd(function) || function == fdl::Request::msrd ? dp::Service::data_exchange : dp::Service::none;
}

Request request_of(const fdl::Telegram& t) {
    if (!t.has_fc() || !t.fc.is_request() || t.destination() == fdl::kBroadcast || t.fc.clock_value()) return {};
    const fdl::Request function = t.fc.request();
    if (!fdl::uses_frame_count(function) && function != fdl::Request::fdl_status && function != fdl::Request::ident &&
        function != fdl::Request::lsap_status)
        return {};
    const std::uint8_t dsap = t.has_dsap() && t.saps_present() ? t.dsap() : dp::kDefaultSap;
    return {true, t.destination(), t.source(), function, requested_service(t), dsap};
}

bool answers(const fdl::Telegram& t, const Request& request) {
    if (!request.known) return false;
    if (t.sd == fdl::kSc) return true;
    return t.has_fc() && !t.fc.is_request() && t.source() == request.da &&
           (t.destination() == request.sa || t.destination() == fdl::kBroadcast);
}

Explanation explain(const fdl::Telegram& t, const Context& context) {
    if (t.sd == fdl::kSc) return explain_sc(context.request);
    if (t.sd == fdl::kSd4) return {"SD4 " + route(t.source(), t.destination()) + " token", {}};
    Explanation result{head(t), {}};
    result.details.push_back(std::string{"DA "} + hex_number(t.da) + ": station " + std::to_string(t.destination()) + (t.has_dsap() ? ", DSAP follows" : ""));
    result.details.push_back(std::string{"SA "} + hex_number(t.sa) + ": station " + std::to_string(t.source()) + (t.has_ssap() ? ", SSAP follows" : ""));
    if (!t.saps_present()) {
        result.line += std::string{"no room for the SAP octets that DA and SA announce: "} + hex_row(t.unit);
        return result;
    }
    if (t.fc.is_request() || t.fc.clock_value()) explain_request(t, context, result);
    else explain_answer(t, context, result);
    return result;
}

Explanation explain_reject(fdl::Reject reason, std::span<const std::uint8_t> octets) {
    return {std::string{"rejected, "} + fdl::name(reason) + ": " + hex_row(octets), {}};
}

}  // namespace dpchip::trace
