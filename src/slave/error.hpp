// SPDX-License-Identifier: Apache-2.0
// Why a virtual slave cannot be built, in words and as a kind.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace dpchip::slave {

class SlaveError : public std::runtime_error {
public:
    enum class Kind : std::uint8_t {
        address,      ///< above 126, or 126 without Set_Slave_Add_supp
        io_behaviour, ///< not one of the behaviours, or more octets than inputs
        ram,          ///< the chip's RAM is too small for this station
        records,      ///< two of the same slot and index, or one of an impossible length
        chip,         ///< the chip cannot do what the station needs
    };
    SlaveError(Kind kind, const std::string& message) : std::runtime_error{message}, kind_{kind} {}
    Kind kind() const { return kind_; }

private:
    Kind kind_;
};

}  // namespace dpchip::slave
