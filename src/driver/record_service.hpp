// SPDX-License-Identifier: Apache-2.0
// One acyclic request after the other, as an application's answer: DS_Read, DS_Write, Data_Transport and the I&M calls
// at index 255 (reference 5.3, 5.6). Knows nothing of SAPs and buffers: octets in, octets out.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/driver/acyclic_events.hpp>

namespace dpchip::driver::detail {

/// What a relation remembers from one PDU to the next.
struct RelationState {
    enum class Waiting : std::uint8_t { none, record, initiate };

    std::uint8_t serial = 0;           ///< of the request that is worked on
    Waiting waiting = Waiting::none;   ///< for the application
    bool im_called = false;            ///< an I&M call has been written, its answer not read yet
    std::uint8_t im_slot = 0;
    std::uint16_t im_index = 0;
};

/// An answer PDU in two parts: `head` lies here, `data` somewhere else.
struct Reply {
    std::array<std::uint8_t, dp::kRecordHeader> head{};
    std::uint8_t head_octets{};
    std::span<const std::uint8_t> data{};
    bool later{};

    std::span<const std::uint8_t> head_span() const { return {head.data(), head_octets}; }
};

inline constexpr Reply kLater{.later = true};

inline Reply negative(dp::AcyclicFunction function, const dp::RecordError& error) {
    Reply r{};
    static_cast<void>(dp::encode(dp::NegativeAnswer{function, error}, r.head));
    r.head_octets = dp::kNegativePdu;
    return r;
}

inline Reply positive(dp::AcyclicFunction function, const dp::RecordHead& head, std::span<const std::uint8_t> data = {}) {
    Reply r{.data = data};
    static_cast<void>(dp::encode(function, head, r.head));
    r.head_octets = dp::kRecordHeader;
    return r;
}

/// The answer to a request that began with `function slot index length`. `data`: the record, for a read and a transport.
inline Reply reply_to(dp::AcyclicFunction function, const dp::RecordHead& head, const RecordAnswer& answer,
                      std::span<const std::uint8_t> data) {
    if (answer.kind == RecordAnswer::Kind::refused) return negative(function, answer.error);
    if (function == dp::AcyclicFunction::ds_write)
        return positive(function, {head.slot, head.index, std::min(answer.octets, head.length)});
    const std::size_t octets = std::min<std::size_t>(answer.octets, data.size());
    return positive(function, {head.slot, head.index, static_cast<std::uint8_t>(octets)}, data.first(octets));
}

/// Serves requests of one relation. `max_data`: longest record. `out`: for read data, at least max_data octets, not where
/// the request lies.
template <class App>
class RecordService {
public:
    RecordService(App& app, RelationState& state, std::uint8_t max_data, bool identification, std::span<std::uint8_t> out)
        : app_{&app}, state_{&state}, max_data_{max_data}, identification_{identification}, out_{out} {}

    /// `pdu` begins with DS_Read, DS_Write or Data_Transport. `call`: handle, relation and master are filled in.
    Reply serve(RecordCall call, dp::Octets pdu) {
        const auto function = static_cast<Fn>(pdu[0]);
        if (function == Fn::ds_read) return read(call, pdu);
        return function == Fn::ds_write ? write(call, pdu) : transport(call, pdu);
    }

private:
    using Fn = dp::AcyclicFunction;

    Reply finish(Fn function, const RecordCall& call, const RecordAnswer& answer, std::span<const std::uint8_t> data) {
        if (answer.kind != RecordAnswer::Kind::later) return reply_to(function, {call.slot, call.index, call.length}, answer, data);
        state_->waiting = RelationState::Waiting::record;
        return kLater;
    }
    static void fill(RecordCall& call, std::uint8_t slot, std::uint8_t index, std::size_t length) {
        call.slot = slot;
        call.index = index;
        call.length = static_cast<std::uint8_t>(length);
    }

    Reply read(RecordCall& call, dp::Octets pdu) {
        const auto head = dp::decode_ds_read_req(pdu);
        if (!head) return negative(Fn::ds_read, dp::ErrorCode1::type_conflict);
        fill(call, head->slot, head->index, std::min(head->length, max_data_));
        const std::span<std::uint8_t> out = out_.first(call.length);
        if (identification_ && call.index == dp::kImIndex) return read_im(call);
        return finish(Fn::ds_read, call, app_->read(call, out), out);
    }

    Reply write(RecordCall& call, dp::Octets pdu) {
        const auto record = dp::decode_ds_write_req(pdu);
        if (!record) return negative(Fn::ds_write, dp::ErrorCode1::type_conflict);
        fill(call, record->slot, record->index, record->data.size());
        const bool im = identification_ && call.index == dp::kImIndex && record->data[0] == dp::kImCallFunction;
        if (im) return write_im(call, record->data);
        return finish(Fn::ds_write, call, app_->write(call, record->data), {});
    }

    Reply transport(RecordCall& call, dp::Octets pdu) {
        const auto record = dp::decode_data_transport(pdu);
        if (!record) return negative(Fn::data_transport, dp::ErrorCode1::type_conflict);
        fill(call, record->slot, record->index, record->data.size());
        const std::span<std::uint8_t> out = out_.first(max_data_);
        const RecordAnswer answer = app_->data_transport(call, record->data, out);
        return finish(Fn::data_transport, call, answer, out);
    }

    // ---- I&M: a call is written, then its answer is read; a written record gives nothing to read.
    Reply write_im(const RecordCall& call, std::span<const std::uint8_t> data) {
        state_->im_called = false;
        const auto im = dp::decode_im_call(data);
        if (!im) {
            const bool length = im.error() != dp::ImError::function;
            return negative(Fn::ds_write, length ? dp::ErrorCode1::write_length_error : dp::ErrorCode1::invalid_parameter);
        }
        if (!app_->has_im(call.slot, im->im_index)) return negative(Fn::ds_write, dp::ErrorCode1::invalid_index);
        RecordAnswer answer = answered();
        if (im->record.empty()) {
            state_->im_called = true;
            state_->im_slot = call.slot;
            state_->im_index = im->im_index;
        } else {
            answer = at_once(app_->write_im(call.slot, im->im_index, im->record.template first<dp::kImRecord>()));
        }
        return reply_to(Fn::ds_write, {call.slot, call.index, call.length}, answer, {});
    }

    Reply read_im(const RecordCall& call) {
        if (!state_->im_called || state_->im_slot != call.slot) return negative(Fn::ds_read, dp::ErrorCode1::state_conflict);
        state_->im_called = false;
        std::array<std::uint8_t, dp::kImRecord> record{};
        RecordAnswer answer = at_once(app_->read_im(call.slot, state_->im_index, record));
        std::array<std::uint8_t, dp::kImAnswer> whole{};
        static_cast<void>(dp::encode(dp::ImCall{state_->im_index, record}, whole));
        const std::size_t octets = std::min<std::size_t>(call.length, whole.size());
        std::copy_n(whole.begin(), octets, out_.begin());
        answer.octets = RecordAnswer::kAll;  // the record's length is fixed
        return reply_to(Fn::ds_read, {call.slot, call.index, call.length}, answer, out_.first(octets));
    }

    /// There is no later for I&M.
    static RecordAnswer at_once(const RecordAnswer& answer) {
        return answer.kind == RecordAnswer::Kind::later ? refused(dp::ErrorCode1::resource_busy) : answer;
    }

    App* app_;
    RelationState* state_;
    std::uint8_t max_data_;
    bool identification_;
    std::span<std::uint8_t> out_;
};

}  // namespace dpchip::driver::detail
