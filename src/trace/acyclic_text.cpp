// SPDX-License-Identifier: Apache-2.0
// PDUs of MS1 and MS2, alarms and status messages in words (reference 5.3 to 5.6).
#include <array>
#include <string_view>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/acyclic_error.hpp>
#include <dpchip/dp/alarm.hpp>
#include <dpchip/dp/identification.hpp>
#include <dpchip/dp/initiate.hpp>
#include <dpchip/trace/service_text.hpp>
#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

using Octets = std::span<const std::uint8_t>;
using dp::AcyclicDirection;
using dp::AcyclicFunction;

std::string octets_count(std::size_t n) { return std::to_string(n) + (n == 1 ? " octet" : " octets"); }
std::string place_text(std::uint8_t slot, std::uint8_t index) { return "slot " + std::to_string(slot) + " index " + std::to_string(index); }
std::string timeout_text(std::uint16_t send_timeout) {
    return "Send_Timeout " + std::to_string(send_timeout * dp::kSendTimeoutUnit) + " ms";
}

template <std::size_t N>
std::string im_words(const dp::ImText<N>& field) {
    std::string text;
    for (const char c : field) text += c >= ' ' && c <= '~' ? c : '?';
    while (text.ends_with(' ')) text.pop_back();
    return '"' + text + '"';
}

void im0_details(Octets record, std::vector<std::string>& details) {
    const auto r = dp::decode_im0(record);
    if (!r) return;
    details.push_back("MANUFACTURER_ID " + hex_number(r->manufacturer_id, 4));
    details.push_back("ORDER_ID " + im_words(r->order_id));
    details.push_back("SERIAL_NUMBER " + im_words(r->serial_number));
    details.push_back("HARDWARE_REVISION " + std::to_string(r->hardware_revision));
    std::string software(1, r->software_revision[0] >= ' ' ? r->software_revision[0] : '?');
    for (std::size_t i = 1; i < 4; ++i) software += (i == 1 ? "" : ".") + std::to_string(static_cast<std::uint8_t>(r->software_revision[i]));
    details.push_back("SOFTWARE_REVISION " + software);
    details.push_back("REVISION_COUNTER " + std::to_string(r->revision_counter));
    details.push_back("PROFILE_ID " + hex_number(r->profile_id, 4) + ", PROFILE_SPECIFIC_TYPE " + hex_number(r->profile_specific_type, 4));
    details.push_back("IM_VERSION " + std::to_string(r->im_version >> 8) + '.' + std::to_string(r->im_version & 0xFF));
    std::string supported;
    for (unsigned n = 1; n < 16; ++n)
        if (core::bit(r->im_supported, n)) add_word(supported, "I&M" + std::to_string(n), " ");
    details.push_back("IM_SUPPORTED " + hex_number(r->im_supported, 4) + (supported.empty() ? "" : ": " + supported));
}

/// A record at index 255 that is an I&M call or its answer.
void im_text(Octets data, DataText& text) {
    const auto call = dp::decode_im_call(data);
    if (!call) return;
    const bool known = call->im_index >= dp::kIm0 && call->im_index <= dp::kIm4;
    const std::string which = known ? "I&M" + std::to_string(call->im_index - dp::kIm0) : "IM_Index " + std::to_string(call->im_index);
    text.words += " (" + which + (call->record.empty() ? " call)" : ")");
    text.details.push_back(which + (call->record.empty() ? " call" : " record"));
    if (call->record.empty()) return;
    const auto lines = im_record_text(call->im_index, call->record);
    text.details.insert(text.details.end(), lines.begin(), lines.end());
}

void record_text(const dp::Record& r, DataText& text) {
    text.words += place_text(r.slot, r.index) + ", " + octets_count(r.data.size());
    if (!r.data.empty()) {
        text.words += ": " + hex_row(r.data);
        text.details.push_back("Record " + hex_row(r.data, dp::kMaxRecord));
    }
    if (r.index == dp::kImIndex) im_text(r.data, text);
}

std::string features_text(const dp::InitiateFeatures& f) {
    std::string words = (f.features_1 & dp::kFeatureReadWrite) != 0 ? "DS_Read and DS_Write" : "no DS_Read, no DS_Write";
    if (f.profile_ident != 0) words += ", Profile_Ident " + hex_number(f.profile_ident, 4);
    return words;
}

std::string address_text(const char* name, const dp::ConnectionAddress& a) {
    std::string words = std::string{name} + " API " + std::to_string(a.api()) + " SCL " + std::to_string(a.scl());
    if (a.type != 0) words += ", network address " + hex_row(a.octets.subspan(dp::kMinAddressPart));
    return words;
}

void initiate_details(const dp::InitiateFeatures& f, const dp::ConnectionAddress& s, const dp::ConnectionAddress& d, DataText& text) {
    text.details.push_back("Features_Supported " + hex_number(f.features_1) + ' ' + hex_number(f.features_2) + ", Profile_Features_Supported " +
                           hex_number(f.profile_features_1) + ' ' + hex_number(f.profile_features_2) + ": " + features_text(f));
    text.details.push_back(address_text("S_Addr", s));
    text.details.push_back(address_text("D_Addr", d));
}

void initiate_text(AcyclicDirection way, Octets pdu, DataText& text) {
    if (way == AcyclicDirection::request) {
        const auto req = *dp::decode_initiate_req(pdu);
        text.words += timeout_text(req.send_timeout) + ", " + features_text(req.features);
        text.details.push_back(timeout_text(req.send_timeout));
        return initiate_details(req.features, req.source, req.destination, text);
    }
    const auto res = *dp::decode_initiate_res(pdu);
    text.words += "longest record " + octets_count(res.max_length) + ", " + features_text(res.features);
    text.details.push_back("Max_Len_Data_Unit " + std::to_string(res.max_length));
    initiate_details(res.features, res.source, res.destination, text);
}

std::string abort_text(const dp::Abort& a) {
    const std::string_view known = dp::abort_reason_name(a.instance, a.reason);
    const bool words = a.instance != dp::AbortInstance::user && (a.instance == dp::AbortInstance::msac_c2 || known != "reserved");
    const std::string reason = words ? std::string{known} : "reason " + std::to_string(a.reason);
    return std::string{"by "} + dp::name(a.instance) + ": " + reason + (a.subnet == 0 ? "" : std::string{", "} + dp::abort_subnet_name(a.subnet));
}

std::string ack_text(const dp::AlarmAck& a) {
    return std::string{dp::alarm_type_name(a.type)} + " slot " + std::to_string(a.slot) + " Seq_Nr " + std::to_string(a.seq_nr());
}

DataText negative_text(const dp::NegativeAnswer& n) {
    const dp::RecordError& e = n.error;
    DataText text{std::string{dp::name(n.function)} + " refused: ", {}};
    if (e.error_decode == core::to_underlying(dp::ErrorDecode::dpv1))
        text.words += std::string{dp::error_code_name(e.error_code_1)} + " (" + dp::error_class_name(e.error_code_1) + ')';
    else text.words += std::string{"error of "} + dp::error_decode_name(e.error_decode);
    text.details.push_back("Error_Decode " + hex_number(e.error_decode) + ": " + dp::error_decode_name(e.error_decode));
    text.details.push_back("Error_Code_1 " + hex_number(e.error_code_1) + ", Error_Code_2 " + hex_number(e.error_code_2));
    text.words += ", " + hex_row(std::array{e.error_decode, e.error_code_1, e.error_code_2});
    return text;
}

/// A PDU that keeps the rules, and is not negative.
DataText good_text(AcyclicDirection way, Octets pdu) {
    const auto function = static_cast<AcyclicFunction>(pdu[0]);
    const bool request = way == AcyclicDirection::request;
    DataText text{std::string{dp::name(function)} + ' ', {}};
    switch (function) {
    case AcyclicFunction::idle: text.words = "Idle"; break;
    case AcyclicFunction::data_transport: record_text(*dp::decode_data_transport(pdu), text); break;
    case AcyclicFunction::resource_manager: {
        const auto rm = *dp::decode_resource_manager(pdu);
        text.words += "SAP " + std::to_string(rm.sap) + ", " + timeout_text(rm.send_timeout);
        break;
    }
    case AcyclicFunction::initiate: initiate_text(way, pdu, text); break;
    case AcyclicFunction::abort: text.words += abort_text(*dp::decode_abort(pdu)); break;
    case AcyclicFunction::alarm_ack: text.words += ack_text(*dp::decode_alarm_ack(pdu)); break;
    case AcyclicFunction::ds_read:
        if (request) {
            const auto head = *dp::decode_ds_read_req(pdu);
            text.words += place_text(head.slot, head.index) + ", up to " + octets_count(head.length);
        } else {
            record_text(*dp::decode_ds_read_res(pdu), text);
        }
        break;
    case AcyclicFunction::ds_write:
        if (request) {
            record_text(*dp::decode_ds_write_req(pdu), text);
        } else {
            const auto head = *dp::decode_ds_write_res(pdu);
            text.words += place_text(head.slot, head.index) + ", " + octets_count(head.length) + " taken";
        }
        break;
    }
    return text;
}

const char* specifier_text(std::uint8_t specifier) {
    switch (static_cast<dp::Specifier>(specifier & 3u)) {
    case dp::Specifier::general: return "";
    case dp::Specifier::appears: return " appears";
    case dp::Specifier::disappears: return " disappears";
    case dp::Specifier::disappears_but_others: return " disappears, others remain";
    }
    return "";
}

std::string modul_status_text(Octets data) {
    static constexpr const char* kStates[]{"ok", "fault", "wrong module", "no module"};
    std::string words;
    for (std::size_t n = 0; n < 4 * data.size(); ++n)
        if (const auto state = dp::modul_state(data, n); state != dp::ModulState::ok)
            add_word(words, "slot " + std::to_string(n + 1) + ' ' + kStates[static_cast<std::size_t>(state)]);
    return words.empty() ? "all slots ok" : words;
}

}  // namespace

std::vector<std::string> im_record_text(std::uint16_t im_index, Octets record) {
    std::vector<std::string> lines;
    switch (im_index) {
    case dp::kIm0: im0_details(record, lines); break;
    case dp::kIm0 + 1:
        if (const auto r = dp::decode_im1(record)) lines = {"TAG_FUNCTION " + im_words(r->tag_function), "TAG_LOCATION " + im_words(r->tag_location)};
        break;
    case dp::kIm0 + 2:
        if (const auto r = dp::decode_im2(record)) lines = {"INSTALLATION_DATE " + im_words(r->installation_date)};
        break;
    case dp::kIm0 + 3:
        if (const auto r = dp::decode_im3(record)) lines = {"DESCRIPTOR " + im_words(r->descriptor)};
        break;
    case dp::kIm4:
        if (const auto r = dp::decode_im4(record)) lines = {"SIGNATURE " + hex_row(r->signature, 54)};
        break;
    default: break;
    }
    return lines;
}

std::string alarm_text(const dp::AlarmStatus& a) {
    std::string words = a.status ? dp::status_type_name(a.type) : dp::alarm_type_name(a.type);
    if (words == "reserved" || a.type >= 32) words += ' ' + std::to_string(a.type);
    if (a.status && a.type == core::to_underlying(dp::StatusType::modul_status)) return words + ": " + modul_status_text(a.data);
    words += " slot " + std::to_string(a.slot);
    if (!a.status) words += " Seq_Nr " + std::to_string(a.seq_nr);
    words += specifier_text(a.specifier);
    if (a.add_ack) words += ", Add_Ack";
    if (!a.data.empty()) words += ": " + hex_row(a.data, dp::kMaxDeviceBlock);
    return words;
}

DataText acyclic_text(dp::AcyclicDirection way, Octets pdu) {
    if (pdu.empty()) return way == AcyclicDirection::request ? DataText{"poll", {}} : DataText{};
    const dp::AcyclicError rule = dp::check_pdu(way, pdu);
    DataText text{};
    if (rule != dp::AcyclicError::none) {
        const auto function = static_cast<AcyclicFunction>(pdu[0] & 0x7Fu);
        const bool known = dp::is_acyclic_function(pdu[0] & 0x7Fu);
        text.words = std::string{known ? dp::name(function) : "unknown function"} + " damaged (" + dp::name(rule) + "): " + hex_row(pdu);
        text.details.push_back(std::string{"PDU "} + hex_row(pdu, dp::kMaxAcyclicPdu) + ": " + dp::name(rule));
        return text;
    }
    text = dp::is_negative(pdu) ? negative_text(*dp::decode_negative(pdu)) : good_text(way, pdu);
    text.details.insert(text.details.begin(), std::string{"Function_Num "} + hex_number(pdu[0]) + ": " + text.words);
    return text;
}

}  // namespace dpchip::trace
