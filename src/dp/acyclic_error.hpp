// SPDX-License-Identifier: Apache-2.0
// Negative answers of the acyclic services: Error_Decode, Error_Code_1 and Error_Code_2, with their words (reference 5.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/acyclic.hpp>

namespace dpchip::dp {

/// Whose error codes these are.
enum class ErrorDecode : std::uint8_t { dpv1 = 0x80, fms = 0xFE, hart = 0xFF };

constexpr const char* error_decode_name(std::uint8_t error_decode) {
    switch (static_cast<ErrorDecode>(error_decode)) {
    case ErrorDecode::dpv1: return "DPV1";
    case ErrorDecode::fms: return "FMS";
    case ErrorDecode::hart: return "HART";
    }
    return "reserved";
}

/// Error_Code_1 of Error_Decode DPV1: class in bits 7..4, code in bits 3..0. Any octet is a legal value: the ones that
/// are not named here are reserved or the application's own.
enum class ErrorCode1 : std::uint8_t {
    read_error = 0xA0,
    write_error = 0xA1,
    module_failure = 0xA2,
    version_conflict = 0xA8,
    feature_not_supported = 0xA9,
    invalid_index = 0xB0,
    write_length_error = 0xB1,
    invalid_slot = 0xB2,
    type_conflict = 0xB3,
    invalid_area = 0xB4,
    state_conflict = 0xB5,
    access_denied = 0xB6,
    invalid_range = 0xB7,
    invalid_parameter = 0xB8,
    invalid_type = 0xB9,
    read_constrain_conflict = 0xC0,
    write_constrain_conflict = 0xC1,
    resource_busy = 0xC2,
    resource_unavailable = 0xC3,
};

/// An Error_Code_1 of the application's own: class D, or the codes of A, B and C that are left to it.
constexpr bool is_user_specific(std::uint8_t error_code_1) {
    const unsigned code = error_code_1 & 0x0Fu;
    switch (error_code_1 >> 4) {
    case 0xA:
    case 0xB: return code >= 0xA;
    case 0xC: return code >= 8;
    case 0xD: return true;
    default: return false;
    }
}

constexpr const char* error_class_name(std::uint8_t error_code_1) {
    switch (error_code_1 >> 4) {
    case 0xA: return "application";
    case 0xB: return "access";
    case 0xC: return "resource";
    case 0xD: return "user specific";
    default: return "reserved";
    }
}

constexpr const char* error_code_name(std::uint8_t error_code_1) {
    switch (static_cast<ErrorCode1>(error_code_1)) {
    case ErrorCode1::read_error: return "read error";
    case ErrorCode1::write_error: return "write error";
    case ErrorCode1::module_failure: return "module failure";
    case ErrorCode1::version_conflict: return "version conflict";
    case ErrorCode1::feature_not_supported: return "feature not supported";
    case ErrorCode1::invalid_index: return "invalid index";
    case ErrorCode1::write_length_error: return "write length error";
    case ErrorCode1::invalid_slot: return "invalid slot";
    case ErrorCode1::type_conflict: return "type conflict";
    case ErrorCode1::invalid_area: return "invalid area";
    case ErrorCode1::state_conflict: return "state conflict";
    case ErrorCode1::access_denied: return "access denied";
    case ErrorCode1::invalid_range: return "invalid range";
    case ErrorCode1::invalid_parameter: return "invalid parameter";
    case ErrorCode1::invalid_type: return "invalid type";
    case ErrorCode1::read_constrain_conflict: return "read constrain conflict";
    case ErrorCode1::write_constrain_conflict: return "write constrain conflict";
    case ErrorCode1::resource_busy: return "resource busy";
    case ErrorCode1::resource_unavailable: return "resource unavailable";
    }
    return is_user_specific(error_code_1) ? "user specific" : "reserved";
}

/// What a negative answer says.
struct RecordError {
    std::uint8_t error_decode{core::to_underlying(ErrorDecode::dpv1)};
    std::uint8_t error_code_1{};
    std::uint8_t error_code_2{};  ///< the application's own

    constexpr RecordError() = default;
    constexpr RecordError(ErrorCode1 code, std::uint8_t code_2 = 0)
        : error_code_1{core::to_underlying(code)}, error_code_2{code_2} {}
    constexpr RecordError(std::uint8_t decode, std::uint8_t code_1, std::uint8_t code_2)
        : error_decode{decode}, error_code_1{code_1}, error_code_2{code_2} {}
    friend constexpr bool operator==(const RecordError&, const RecordError&) = default;
};

/// A negative answer, taken apart.
struct NegativeAnswer {
    AcyclicFunction function{};
    RecordError error{};
};

inline constexpr std::size_t kNegativePdu = 4;

constexpr bool is_negative(Octets pdu) { return !pdu.empty() && (pdu[0] & kNegative) != 0; }

constexpr AcyclicResult<NegativeAnswer> decode_negative(Octets pdu) {
    if (pdu.empty()) return AcyclicError::empty;
    const auto function = static_cast<std::uint8_t>(pdu[0] & ~unsigned{kNegative});
    if (!is_negative(pdu) || !has_negative_answer(function)) return AcyclicError::function;
    if (pdu.size() < kNegativePdu) return AcyclicError::too_short;
    if (pdu.size() > kNegativePdu) return AcyclicError::too_long;
    return NegativeAnswer{static_cast<AcyclicFunction>(function), {pdu[1], pdu[2], pdu[3]}};
}

constexpr AcyclicResult<std::size_t> encode(const NegativeAnswer& n, std::span<std::uint8_t> out) {
    if (!has_negative_answer(core::to_underlying(n.function))) return AcyclicError::function;
    if (out.size() < kNegativePdu) return AcyclicError::no_room;
    out[0] = static_cast<std::uint8_t>(core::to_underlying(n.function) | kNegative);
    out[1] = n.error.error_decode;
    out[2] = n.error.error_code_1;
    out[3] = n.error.error_code_2;
    return kNegativePdu;
}

}  // namespace dpchip::dp
