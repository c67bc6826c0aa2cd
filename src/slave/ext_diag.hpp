// SPDX-License-Identifier: Apache-2.0
// Ext_Diag_Data of a virtual slave, put together from those who have something to say: the process behind it, and the
// status messages of DP-V2 (VPC3+C 7.2.2, figure 7-10; reference 6.4).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/driver/diagnosis.hpp>

namespace dpchip::slave {

/// Holds the blocks of each part; plain values, no heap.
class ExtDiag {
public:
    enum class Part : std::uint8_t { process, redundancy, links };
    static constexpr std::size_t kMost = 238;

    /// Octets that the diagnosis has for all parts together.
    explicit ExtDiag(std::size_t room) : room_{std::min(room, kMost)} {}
    std::size_t room() const { return room_; }

    /// False when nothing has changed, or `octets` are more than there is room for: then nothing changes either.
    bool set(Part part, std::span<const std::uint8_t> octets) {
        Octets& mine = parts_[static_cast<std::size_t>(part)];
        if (octets.size() > room_ || std::ranges::equal(mine.span(), octets)) return false;
        mine.size = octets.size();
        std::ranges::copy(octets, mine.octets.begin());
        return true;
    }
    /// One part behind the other, in the order of Part. What finds no room is left out.
    std::span<const std::uint8_t> all() {
        whole_.size = 0;
        for (const Octets& part : parts_) {
            if (whole_.size + part.size > room_) continue;
            std::ranges::copy(part.span(), whole_.octets.begin() + static_cast<std::ptrdiff_t>(whole_.size));
            whole_.size += part.size;
        }
        return whole_.span();
    }

private:
    struct Octets {
        std::array<std::uint8_t, kMost> octets{};
        std::size_t size = 0;
        std::span<const std::uint8_t> span() const { return {octets.data(), size}; }
    };
    std::size_t room_;
    std::array<Octets, 3> parts_{};
    Octets whole_{};
};

}  // namespace dpchip::slave
