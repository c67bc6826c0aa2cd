// SPDX-License-Identifier: Apache-2.0
// Identification & Maintenance: the call at index 255 and the records I&M0 to I&M4 (reference 5.6).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/core/result.hpp>

namespace dpchip::dp {

inline constexpr std::uint8_t kImIndex = 255;            ///< the record that calls are written to and answers read from
inline constexpr std::size_t kImCall = 4;                ///< 08 00 IM_Index
inline constexpr std::size_t kImRecord = 64;             ///< octets of every I&M record
inline constexpr std::size_t kImAnswer = kImCall + kImRecord;
inline constexpr std::uint16_t kIm0 = 0xFDE8;            ///< IM_Index of I&M0; I&Mn is kIm0 + n
inline constexpr std::uint16_t kIm4 = kIm0 + 4;
inline constexpr std::uint16_t kImProfile = 0xFE4C;      ///< 65100: profiles' own use
inline constexpr std::uint8_t kImCallFunction = 0x08;    ///< Extended_Function_Num

enum class ImError : std::uint8_t {
    too_short,  ///< fewer than four octets
    function,   ///< does not begin with 08H 00H
    length,     ///< neither 4 nor 68 octets; a record of other than 64
    no_room,    ///< the buffer to encode into is too small
};

constexpr const char* name(ImError e) {
    switch (e) {
    case ImError::too_short: return "too few octets";
    case ImError::function: return "not an I&M call";
    case ImError::length: return "wrong length";
    case ImError::no_room: return "no room";
    }
    return "too few octets";
}

/// What is written to index 255, and what is read from it.
struct ImCall {
    std::uint16_t im_index{};
    std::span<const std::uint8_t> record{};  ///< empty in a call; 64 octets in a write and in an answer
};

constexpr core::Result<ImCall, ImError> decode_im_call(std::span<const std::uint8_t> data) {
    if (data.size() < kImCall) return ImError::too_short;
    if (data[0] != kImCallFunction || data[1] != 0) return ImError::function;
    if (data.size() != kImCall && data.size() != kImAnswer) return ImError::length;
    return ImCall{core::word(data[2], data[3]), data.subspan(kImCall)};
}

/// Returns the octets written: 4 or 68. `call.record` may lie in `out` where it belongs already.
constexpr core::Result<std::size_t, ImError> encode(const ImCall& call, std::span<std::uint8_t> out) {
    if (!call.record.empty() && call.record.size() != kImRecord) return ImError::length;
    if (out.size() < kImCall + call.record.size()) return ImError::no_room;
    out[0] = kImCallFunction;
    out[1] = 0;
    out[2] = core::high(call.im_index);
    out[3] = core::low(call.im_index);
    for (std::size_t i = 0; i < call.record.size(); ++i) out[kImCall + i] = call.record[i];
    return kImCall + call.record.size();
}

template <std::size_t N>
using ImText = std::array<char, N>;  ///< padded with blanks, not terminated

/// Letters of `text`, cut or padded with blanks.
template <std::size_t N>
constexpr ImText<N> im_text(std::span<const char> text) {
    ImText<N> t{};
    for (std::size_t i = 0; i < N; ++i) t[i] = i < text.size() ? text[i] : ' ';
    return t;
}

/// I&M0: who made it.
struct Im0 {
    std::array<std::uint8_t, 10> header{};
    std::uint16_t manufacturer_id{};
    ImText<20> order_id{im_text<20>({})};
    ImText<16> serial_number{im_text<16>({})};
    std::uint16_t hardware_revision{};
    std::array<char, 4> software_revision{'V', 0, 0, 0};  ///< a letter, then three numbers
    std::uint16_t revision_counter{};
    std::uint16_t profile_id{};
    std::uint16_t profile_specific_type{};
    std::uint16_t im_version{0x0101};
    std::uint16_t im_supported{};  ///< bit n: I&Mn

    friend constexpr bool operator==(const Im0&, const Im0&) = default;
};

struct Im1 {
    ImText<32> tag_function{im_text<32>({})};
    ImText<22> tag_location{im_text<22>({})};
    friend constexpr bool operator==(const Im1&, const Im1&) = default;
};
struct Im2 {
    ImText<16> installation_date{im_text<16>({})};  ///< "YYYY-MM-DD hh:mm"
    friend constexpr bool operator==(const Im2&, const Im2&) = default;
};
struct Im3 {
    ImText<54> descriptor{im_text<54>({})};
    friend constexpr bool operator==(const Im3&, const Im3&) = default;
};
struct Im4 {
    std::array<std::uint8_t, 54> signature{};
    friend constexpr bool operator==(const Im4&, const Im4&) = default;
};

namespace detail {

/// Goes over the 64 octets of a record, one field after the other, ten header octets first for I&M1 to 4.
class ImWriter {
public:
    constexpr explicit ImWriter(std::array<std::uint8_t, kImRecord>& out, std::size_t from = 0) : out_{&out}, at_{from} {}
    template <class Octet, std::size_t N>
    constexpr ImWriter& operator()(const std::array<Octet, N>& field) {
        for (const Octet o : field) (*out_)[at_++] = static_cast<std::uint8_t>(o);
        return *this;
    }
    constexpr ImWriter& operator()(std::uint16_t field) {
        (*out_)[at_++] = core::high(field);
        (*out_)[at_++] = core::low(field);
        return *this;
    }

private:
    std::array<std::uint8_t, kImRecord>* out_;
    std::size_t at_;
};

class ImReader {
public:
    constexpr explicit ImReader(std::span<const std::uint8_t> in, std::size_t from = 0) : in_{in}, at_{from} {}
    template <class Octet, std::size_t N>
    constexpr ImReader& operator()(std::array<Octet, N>& field) {
        for (Octet& o : field) o = static_cast<Octet>(in_[at_++]);
        return *this;
    }
    constexpr ImReader& operator()(std::uint16_t& field) {
        field = core::word(in_[at_], in_[at_ + 1]);
        at_ += 2;
        return *this;
    }

private:
    std::span<const std::uint8_t> in_;
    std::size_t at_;
};

inline constexpr std::size_t kImHeader = 10;

/// The fields of a record in their order, for reader and writer alike.
template <class Walk, class Record>
constexpr void im0_fields(Walk& walk, Record& r) {
    walk(r.header)(r.manufacturer_id)(r.order_id)(r.serial_number)(r.hardware_revision)(r.software_revision)(r.revision_counter)(
        r.profile_id)(r.profile_specific_type)(r.im_version)(r.im_supported);
}

}  // namespace detail

using ImOctets = std::array<std::uint8_t, kImRecord>;

constexpr ImOctets encode(const Im0& r) {
    ImOctets out{};
    detail::ImWriter w{out};
    detail::im0_fields(w, r);
    return out;
}
constexpr ImOctets encode(const Im1& r) {
    ImOctets out{};
    detail::ImWriter{out, detail::kImHeader}(r.tag_function)(r.tag_location);
    return out;
}
/// The 38 octets behind the date are reserved and zero.
constexpr ImOctets encode(const Im2& r) {
    ImOctets out{};
    detail::ImWriter{out, detail::kImHeader}(r.installation_date);
    return out;
}
constexpr ImOctets encode(const Im3& r) {
    ImOctets out{};
    detail::ImWriter{out, detail::kImHeader}(r.descriptor);
    return out;
}
constexpr ImOctets encode(const Im4& r) {
    ImOctets out{};
    detail::ImWriter{out, detail::kImHeader}(r.signature);
    return out;
}

constexpr core::Result<Im0, ImError> decode_im0(std::span<const std::uint8_t> record) {
    if (record.size() != kImRecord) return ImError::length;
    Im0 r{};
    detail::ImReader reader{record};
    detail::im0_fields(reader, r);
    return r;
}
constexpr core::Result<Im1, ImError> decode_im1(std::span<const std::uint8_t> record) {
    if (record.size() != kImRecord) return ImError::length;
    Im1 r{};
    detail::ImReader{record, detail::kImHeader}(r.tag_function)(r.tag_location);
    return r;
}
constexpr core::Result<Im2, ImError> decode_im2(std::span<const std::uint8_t> record) {
    if (record.size() != kImRecord) return ImError::length;
    Im2 r{};
    detail::ImReader{record, detail::kImHeader}(r.installation_date);
    return r;
}
constexpr core::Result<Im3, ImError> decode_im3(std::span<const std::uint8_t> record) {
    if (record.size() != kImRecord) return ImError::length;
    Im3 r{};
    detail::ImReader{record, detail::kImHeader}(r.descriptor);
    return r;
}
constexpr core::Result<Im4, ImError> decode_im4(std::span<const std::uint8_t> record) {
    if (record.size() != kImRecord) return ImError::length;
    Im4 r{};
    detail::ImReader{record, detail::kImHeader}(r.signature);
    return r;
}

}  // namespace dpchip::dp
