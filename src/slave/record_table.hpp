// SPDX-License-Identifier: Apache-2.0
// The records of a virtual slave by slot and index: who may read and write them, and what they hold (reference 5.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <dpchip/core/result.hpp>
#include <dpchip/dp/acyclic_error.hpp>

namespace dpchip::slave {

enum class RecordAccess : std::uint8_t { ro, rw, wo };
const char* name(RecordAccess access);

/// One record as it is at power-up.
struct Record {
    std::uint8_t slot{};
    std::uint8_t index{};
    RecordAccess access = RecordAccess::rw;
    std::vector<std::uint8_t> octets;  ///< at most 240
    std::size_t max = 0;               ///< longest write that is taken; 0: as long as octets are
};

/// Holds records; after construction it allocates nothing. A write replaces the record, also by a shorter one.
class RecordTable {
public:
    enum class Error : std::uint8_t { none, twice, too_long, empty };

    RecordTable() = default;
    /// `error()` is not none when the table cannot be: the first fault counts.
    explicit RecordTable(std::vector<Record> records);
    Error error() const { return error_; }

    using Octets = std::span<const std::uint8_t>;
    template <class T>
    using Result = core::Result<T, dp::ErrorCode1>;

    /// What a master may read.
    Result<Octets> read(std::uint8_t slot, std::uint8_t index) const;
    /// What a master writes: octets taken.
    Result<std::size_t> write(std::uint8_t slot, std::uint8_t index, Octets octets);

    /// For the process behind the slave: regardless of access. Empty when there is no such record.
    Octets octets(std::uint8_t slot, std::uint8_t index) const;
    /// False when there is no such record, or it is too short for this.
    bool set(std::uint8_t slot, std::uint8_t index, Octets octets);
    std::size_t size() const { return records_.size(); }

private:
    const Record* find(std::uint8_t slot, std::uint8_t index) const;
    dp::ErrorCode1 missing(std::uint8_t slot) const;

    std::vector<Record> records_;  ///< in the order of slot and index
    Error error_ = Error::none;
};
const char* name(RecordTable::Error error);

}  // namespace dpchip::slave
