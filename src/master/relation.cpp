// SPDX-License-Identifier: Apache-2.0
// Requests into PDUs, and whether an answer fits its request.
#include <dpchip/master/relation.hpp>

#include <algorithm>

namespace dpchip::master {

using Kind = ServiceResult::Kind;
using dp::AcyclicError;
using dp::AcyclicFunction;

bool Relation::read(std::uint8_t slot, std::uint8_t index, std::size_t length) {
    if (busy()) return false;
    if (length == 0 || length > dp::kMaxRecord)
        return begin(length == 0 ? AcyclicError::length_zero : AcyclicError::length_range);
    return begin(dp::encode(AcyclicFunction::ds_read, dp::RecordHead{slot, index, static_cast<std::uint8_t>(length)}, request_));
}

bool Relation::write(std::uint8_t slot, std::uint8_t index, std::span<const std::uint8_t> data) {
    if (busy()) return false;
    if (data.empty()) return begin(AcyclicError::length_zero);
    if (data.size() > max_data()) return begin(AcyclicError::length_range);
    return begin(dp::encode(AcyclicFunction::ds_write, dp::Record{slot, index, data}, request_));
}

std::span<const std::uint8_t> Relation::data() const { return std::span{data_}.first(data_size_); }

bool Relation::begin(const dp::AcyclicResult<std::size_t>& octets) {
    ++counters_.services;
    data_size_ = 0;
    accepted_ = 0;
    ServiceResult why{};
    if (!octets) {
        finish(ServiceResult::breaks(Kind::invalid, octets.error()));
    } else if (!usable(why)) {
        finish(why);
    } else {
        request_size_ = *octets;
        result_ = ServiceResult::of(Kind::pending);
        begun();
    }
    return true;
}

void Relation::finish(const ServiceResult& result) {
    result_ = result;
    if (result.done()) ++counters_.done;
    if (result.kind == Kind::refused) ++counters_.refused;
}

ServiceResult Relation::judge(std::span<const std::uint8_t> pdu) {
    const auto function = static_cast<AcyclicFunction>(request_[0]);
    const auto bad = [](AcyclicError rule) { return ServiceResult::breaks(Kind::bad_answer, rule); };
    if (dp::is_negative(pdu)) {
        const auto negative = dp::decode_negative(pdu);
        if (!negative) return bad(negative.error());
        return negative->function == function ? ServiceResult::refused(negative->error) : bad(AcyclicError::function);
    }
    if (function == AcyclicFunction::ds_write) {
        const auto head = dp::decode_ds_write_res(pdu);
        if (!head) return bad(head.error());
        if (head->slot != request_[1] || head->index != request_[2] || head->length > request_[3]) return bad(AcyclicError::length_mismatch);
        accepted_ = head->length;
        return ServiceResult::of(Kind::done);
    }
    if (function == AcyclicFunction::alarm_ack || function == AcyclicFunction::idle)
        return std::ranges::equal(pdu, request()) ? ServiceResult::of(Kind::done) : bad(AcyclicError::function);
    const bool read = function == AcyclicFunction::ds_read;
    const auto record = read ? dp::decode_ds_read_res(pdu) : dp::decode_data_transport(pdu);
    if (!record) return bad(record.error());
    if (record->slot != request_[1] || record->index != request_[2] || (read && record->data.size() > request_[3]))
        return bad(AcyclicError::length_mismatch);
    std::ranges::copy(record->data, data_.begin());
    data_size_ = record->data.size();
    return ServiceResult::of(Kind::done);
}

Job& Relation::ask(std::uint8_t dsap, std::uint8_t ssap, std::span<const std::uint8_t> pdu) {
    job_.address = address_;
    job_.dsap = dsap;
    job_.ssap = ssap;
    job_.request_size = static_cast<std::uint16_t>(std::min(pdu.size(), job_.request.size()));
    std::copy_n(pdu.begin(), job_.request_size, job_.request.begin());
    if (pdu.empty()) ++counters_.polls;
    return job_;
}

}  // namespace dpchip::master
