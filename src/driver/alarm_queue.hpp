// SPDX-License-Identifier: Apache-2.0
// Alarms and status messages on their way to the master: one at a time in the diagnosis, sequence numbers, how many may
// be outstanding, acknowledgements (reference 5.5, 10.12).
//
// A block leaves the diagnosis when the master has fetched it (status), when it has been acknowledged (alarm), or when
// it has been fetched and the next one may follow. While Stat_Diag is set nobody can tell that a diagnosis has been
// fetched: then an alarm leaves it only when it is acknowledged, and a status message when Stat_Diag is gone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/alarm.hpp>

namespace dpchip::driver {

/// What became of an alarm or status message.
enum class AlarmResult : std::uint8_t {
    queued,      ///< the master will be told; alarm_acknowledged() or alarm_dropped() ends an alarm
    closed,      ///< not in data exchange with DP-V1 enabled, or the first Data_Exchange has not come yet
    not_enabled, ///< the configuration or the master's DPV1_Status_2 does not allow this type
    queue_full,  ///< too many are waiting or outstanding
    too_long,    ///< longer than max_alarm
    malformed,   ///< no such type, slot or specifier
};

/// The number that an alarm was given, with what became of it.
struct AlarmRaised {
    AlarmResult result{};
    std::uint8_t seq_nr{};  ///< of an alarm that is queued
};

namespace detail {

template <std::size_t Capacity>
class AlarmQueue {
public:
    using Block = std::span<const std::uint8_t>;

    /// `enabled`: bits of DPV1_Status_2; `limit`: alarms outstanding in total, 0: one of each type, and no other limit.
    /// `each_type`: one of each type in any case.
    void open(std::uint8_t enabled, std::uint8_t limit, bool each_type) {
        is_open_ = true;
        enabled_ = enabled;
        limit_ = limit;
        each_type_ = each_type || limit == 0;
    }
    bool is_open() const { return is_open_; }

    /// Tells `dropped` about every alarm that nobody will acknowledge.
    template <class Dropped>
    void close(Dropped&& dropped) {
        const bool was_open = is_open_;
        is_open_ = false;
        current_ = kNone;
        const std::size_t count = count_;
        count_ = 0;
        for (std::size_t i = 0; i < count && was_open; ++i)
            if (!entries_[i].is_status) dropped(entries_[i].id);
    }

    AlarmRaised raise(dp::AlarmStatus a, std::size_t max_octets) {
        a.seq_nr = a.status ? std::uint8_t{0} : next_seq_nr_;
        Entry e{};
        const auto length = dp::encode(a, e.octets);
        if (!length) return {length.error() == dp::BlockError::too_long ? AlarmResult::too_long : AlarmResult::malformed};
        if (*length > max_octets) return {AlarmResult::too_long};
        if (!is_open_) return {AlarmResult::closed};
        const std::uint8_t bit = dp::alarm_enable_bit(a.type);
        if (!a.status && bit == 0) return {AlarmResult::malformed};
        if (!a.status && (bit & enabled_) == 0) return {AlarmResult::not_enabled};
        if (count_ == Capacity || (!a.status && seq_nr_used(a.seq_nr))) return {AlarmResult::queue_full};
        e.id = dp::alarm_ack(a);
        e.is_status = a.status;
        e.length = static_cast<std::uint8_t>(*length);
        entries_[count_++] = e;
        if (!a.status) next_seq_nr_ = static_cast<std::uint8_t>((next_seq_nr_ + 1) % dp::kSeqNumbers);
        return {AlarmResult::queued, a.seq_nr};
    }

    /// What is to stand in the diagnosis now; empty when there is nothing.
    Block block() const { return current_ == kNone ? Block{} : Block{entries_[current_].octets.data(), entries_[current_].length}; }
    /// The diagnosis with block() has been handed to the chip.
    void handed_over() {
        if (current_ != kNone && entries_[current_].stage == Stage::chosen) entries_[current_].stage = Stage::in_diagnosis;
    }
    /// True when block() waits to be fetched: somebody has to look.
    bool waits_for_fetch() const { return current_ != kNone && entries_[current_].stage == Stage::in_diagnosis; }
    /// The master has fetched it.
    void fetched() {
        if (!waits_for_fetch()) return;
        if (entries_[current_].is_status) remove(current_);
        else entries_[current_].stage = Stage::outstanding;
    }
    /// True when the diagnosis has to change: block() is another one now. Call it after everything that may matter.
    bool advance() {
        if (current_ != kNone && entries_[current_].stage != Stage::outstanding) return false;
        for (std::size_t i = 0; i < count_; ++i) {
            if (entries_[i].stage != Stage::waiting || !may_start(entries_[i])) continue;
            entries_[i].stage = Stage::chosen;
            current_ = i;
            stale_ = false;
            return true;
        }
        const bool leaves = stale_;
        stale_ = false;
        return leaves;
    }
    /// False when no such alarm is outstanding. `id` becomes the alarm's own, specifier included.
    bool acknowledge(dp::AlarmAck& id) {
        for (std::size_t i = 0; i < count_; ++i) {
            const Entry& e = entries_[i];
            const bool told = e.stage == Stage::in_diagnosis || e.stage == Stage::outstanding;
            if (e.is_status || !told || e.id.slot != id.slot || e.id.type != id.type || e.id.seq_nr() != id.seq_nr()) continue;
            id = e.id;
            remove(i);
            return true;
        }
        return false;
    }

private:
    static constexpr std::size_t kNone = Capacity;
    enum class Stage : std::uint8_t { waiting, chosen, in_diagnosis, outstanding };
    struct Entry {
        dp::AlarmAck id{};
        Stage stage{};
        bool is_status{};
        std::uint8_t length{};
        std::array<std::uint8_t, dp::kMaxDeviceBlock> octets{};
    };

    bool seq_nr_used(std::uint8_t seq_nr) const {
        for (std::size_t i = 0; i < count_; ++i)
            if (!entries_[i].is_status && entries_[i].id.seq_nr() == seq_nr) return true;
        return false;
    }
    bool may_start(const Entry& e) const {
        if (e.is_status) return true;
        std::size_t outstanding = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const Entry& other = entries_[i];
            if (other.is_status || other.stage == Stage::waiting) continue;
            if (each_type_ && other.id.type == e.id.type) return false;
            ++outstanding;
        }
        return limit_ == 0 || outstanding < limit_;
    }
    void remove(std::size_t at) {
        if (at == current_) {
            current_ = kNone;
            stale_ = true;
        } else if (current_ != kNone && at < current_) --current_;
        for (std::size_t i = at; i + 1 < count_; ++i) entries_[i] = entries_[i + 1];
        --count_;
    }

    std::array<Entry, Capacity> entries_{};
    std::size_t count_ = 0;
    std::size_t current_ = kNone;   // the one in the diagnosis
    std::uint8_t next_seq_nr_ = 0;
    std::uint8_t enabled_ = 0, limit_ = 0;
    bool is_open_ = false, each_type_ = true;
    bool stale_ = false;            // the diagnosis still shows a block that is done
};

}  // namespace detail
}  // namespace dpchip::driver
