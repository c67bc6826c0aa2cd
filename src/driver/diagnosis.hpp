// SPDX-License-Identifier: Apache-2.0
// Diagnoses on their way to the chip: what the user said last, and a short queue for those that have to wait for a buffer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dpchip::driver {

/// The user's bits of a diagnosis: octet 0 of the diagnosis buffer (reference 3.7).
struct DiagFlags {
    bool ext_diag{};           ///< a fault; without it Ext_Diag_Data is status information
    bool stat_diag{};          ///< static diagnosis: the master shall go on fetching it
    bool ext_diag_overflow{};  ///< there is more than fits

    constexpr std::uint8_t octet() const {
        return static_cast<std::uint8_t>((ext_diag ? 1u : 0u) | (stat_diag ? 2u : 0u) | (ext_diag_overflow ? 4u : 0u));
    }
};

enum class DiagResult : std::uint8_t {
    handed_over,  ///< the chip has it
    queued,       ///< it waits for a buffer; poll() or the interrupt hands it over
    replaced,     ///< as queued, but the one queued before it is lost
    too_long,     ///< longer than max_diag allows: nothing has changed
    not_ready,    ///< not configured: nothing has changed
};

namespace detail {

struct Diagnosis {
    std::uint8_t flags{};
    std::uint8_t octets{};
    std::array<std::uint8_t, 238> ext_diag{};

    constexpr std::span<const std::uint8_t> data() const { return {ext_diag.data(), octets}; }
    constexpr void assign(std::span<const std::uint8_t> data, DiagFlags f) {
        flags = f.octet();
        octets = static_cast<std::uint8_t>(data.size());
        for (std::size_t i = 0; i < data.size(); ++i) ext_diag[i] = data[i];
    }
};

/// First in, first out; a full queue gives up its newest entry, so that the latest diagnosis is never lost.
template <std::size_t Capacity>
class DiagQueue {
    static_assert(Capacity >= 1);

public:
    /// False when an entry was lost.
    constexpr bool push(const Diagnosis& d) {
        const bool room = count_ < Capacity;
        if (room) ++count_;
        entries_[(first_ + count_ - 1) % Capacity] = d;
        return room;
    }
    constexpr bool empty() const { return count_ == 0; }
    constexpr const Diagnosis& front() const { return entries_[first_]; }
    constexpr void pop() {
        first_ = (first_ + 1) % Capacity;
        --count_;
    }
    constexpr void clear() { count_ = 0; }

private:
    std::array<Diagnosis, Capacity> entries_{};
    std::size_t first_{}, count_{};
};

}  // namespace detail
}  // namespace dpchip::driver
