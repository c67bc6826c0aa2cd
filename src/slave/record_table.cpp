// SPDX-License-Identifier: Apache-2.0
// Looking up, reading and writing records.
#include <dpchip/slave/record_table.hpp>

#include <algorithm>
#include <utility>

#include <dpchip/dp/acyclic.hpp>

namespace dpchip::slave {

namespace {

constexpr unsigned key(std::uint8_t slot, std::uint8_t index) { return unsigned{slot} << 8 | index; }
unsigned key(const Record& r) { return key(r.slot, r.index); }

}  // namespace

const char* name(RecordAccess access) {
    switch (access) {
    case RecordAccess::ro: return "ro";
    case RecordAccess::rw: return "rw";
    case RecordAccess::wo: return "wo";
    }
    return "unknown";
}

const char* name(RecordTable::Error error) {
    switch (error) {
    case RecordTable::Error::none: return "no error";
    case RecordTable::Error::twice: return "two records have the same slot and index";
    case RecordTable::Error::too_long: return "a record is longer than 240 octets";
    case RecordTable::Error::empty: return "a record that can never hold an octet";
    }
    return "unknown";
}

RecordTable::RecordTable(std::vector<Record> records) : records_{std::move(records)} {
    std::ranges::stable_sort(records_, {}, [](const Record& r) { return key(r); });
    for (Record& r : records_) {
        if (r.max < r.octets.size()) r.max = r.octets.size();
        if (r.max > dp::kMaxRecord) error_ = Error::too_long;
        else if (r.max == 0) error_ = Error::empty;
        r.octets.reserve(r.max);
    }
    for (std::size_t i = 1; i < records_.size(); ++i)
        if (key(records_[i]) == key(records_[i - 1])) error_ = Error::twice;
}

const Record* RecordTable::find(std::uint8_t slot, std::uint8_t index) const {
    const auto at = std::ranges::lower_bound(records_, key(slot, index), {}, [](const Record& r) { return key(r); });
    return at != records_.end() && key(*at) == key(slot, index) ? &*at : nullptr;
}

/// A slot without any record is no slot. Slot 0 is the station itself and always there.
dp::ErrorCode1 RecordTable::missing(std::uint8_t slot) const {
    const bool known = slot == 0 || std::ranges::any_of(records_, [slot](const Record& r) { return r.slot == slot; });
    return known ? dp::ErrorCode1::invalid_index : dp::ErrorCode1::invalid_slot;
}

RecordTable::Result<RecordTable::Octets> RecordTable::read(std::uint8_t slot, std::uint8_t index) const {
    const Record* const r = find(slot, index);
    if (r == nullptr) return missing(slot);
    if (r->access == RecordAccess::wo) return dp::ErrorCode1::access_denied;
    return Octets{r->octets};
}

RecordTable::Result<std::size_t> RecordTable::write(std::uint8_t slot, std::uint8_t index, Octets octets) {
    const Record* const r = find(slot, index);
    if (r == nullptr) return missing(slot);
    if (r->access == RecordAccess::ro) return dp::ErrorCode1::access_denied;
    if (!set(slot, index, octets)) return dp::ErrorCode1::write_length_error;
    return octets.size();
}

RecordTable::Octets RecordTable::octets(std::uint8_t slot, std::uint8_t index) const {
    const Record* const r = find(slot, index);
    return r == nullptr ? Octets{} : Octets{r->octets};
}

bool RecordTable::set(std::uint8_t slot, std::uint8_t index, Octets octets) {
    const Record* const found = find(slot, index);
    if (found == nullptr || octets.size() > found->max) return false;
    Record& r = records_[static_cast<std::size_t>(found - records_.data())];
    r.octets.assign(octets.begin(), octets.end());  // within what was reserved
    return true;
}

}  // namespace dpchip::slave
