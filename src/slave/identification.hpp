// SPDX-License-Identifier: Apache-2.0
// The I&M records of a virtual slave (reference 5.6), from what its GSD tells of it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <dpchip/dp/acyclic_error.hpp>
#include <dpchip/dp/identification.hpp>
#include <dpchip/gsd/gsd.hpp>

namespace dpchip::slave {

/// I&M0 to I&M4; 1 to 4 can be written by a master.
struct Identification {
    dp::Im0 im0{};
    dp::Im1 im1{};
    dp::Im2 im2{};
    dp::Im3 im3{};
    dp::Im4 im4{};

    /// The record behind an IM_Index; nothing when there is none.
    std::optional<dp::ImOctets> record(std::uint16_t im_index) const;
    /// False for I&M0 and for indices that do not exist.
    bool write(std::uint16_t im_index, std::span<const std::uint8_t, dp::kImRecord> octets);
};

/// Order_ID from OrderNumber, or else Model_Name; revisions from Hardware_Release and Software_Release. A GSD knows neither
/// manufacturer number nor serial number: 0 and "0" stand for them.
Identification identification(const gsd::Gsd& gsd);

}  // namespace dpchip::slave
