// SPDX-License-Identifier: Apache-2.0
// Reading an I&M record over a relation: a call is written to index 255, then its answer is read there (reference 5.6).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <dpchip/dp/identification.hpp>
#include <dpchip/master/relation.hpp>

namespace dpchip::master {

/// Owns the relation's services until finished(). Call step() now and then, best once a cycle.
class ImReader {
public:
    explicit ImReader(Relation& relation) : relation_{&relation} {}

    /// False while the relation is busy.
    bool start(std::uint16_t im_index, std::uint8_t slot = 0) {
        std::array<std::uint8_t, dp::kImCall> call{};
        static_cast<void>(dp::encode(dp::ImCall{im_index, {}}, call));
        if (!relation_->write(slot, dp::kImIndex, call)) return false;
        im_index_ = im_index;
        slot_ = slot;
        reading_ = false;
        result_ = ServiceResult::of(ServiceResult::Kind::pending);
        return true;
    }
    void step() {
        if (!result_.pending() || relation_->busy()) return;
        if (reading_ || !relation_->result().done()) return conclude();
        reading_ = relation_->read(slot_, dp::kImIndex, dp::kImAnswer);
    }
    bool finished() const { return result_.finished(); }
    const ServiceResult& result() const { return result_; }
    /// After a good end: 64 octets. Valid until the relation's next service.
    std::span<const std::uint8_t> record() const { return relation_->data().subspan(dp::kImCall); }

private:
    void conclude() {
        result_ = relation_->result();
        if (!result_.done()) return;
        const auto answer = dp::decode_im_call(relation_->data());
        if (!answer || answer->record.empty() || answer->im_index != im_index_)
            result_ = ServiceResult::breaks(ServiceResult::Kind::bad_answer, dp::AcyclicError::length_mismatch);
    }

    Relation* relation_;
    std::uint16_t im_index_ = 0;
    std::uint8_t slot_ = 0;
    bool reading_ = false;
    ServiceResult result_{};
};

}  // namespace dpchip::master
