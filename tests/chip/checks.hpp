// SPDX-License-Identifier: Apache-2.0
// The conformance checks of the reference (chapter 8) as GoogleTest suites: one suite per set of chips a check is for.
#pragma once

#include <ostream>

#include <gtest/gtest.h>

#include "bench.hpp"

namespace dpchip::checks {

using namespace bench;
using namespace core::literals;

/// One chip, spoken to one way.
struct Case {
    Variant variant{};
    Path path{};
};
inline std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << regmap::traits(c.variant).name << ", " << bench::name(c.path);
}

/// Checks that hold for every chip of the family.
class Checks : public ::testing::TestWithParam<Case> {
protected:
    Recipe recipe() const {
        Recipe s;
        s.variant = GetParam().variant;
        s.path = GetParam().path;
        return s;
    }
    const regmap::Traits& traits() const { return regmap::traits(GetParam().variant); }
};
/// Checks for the VPC3+ family: Mode Register 2.
class ChecksVpc3 : public Checks {};
/// Checks for VPC3+B and VPC3+C: 4 KB RAM, SAP 53, Mode Register 3, checks 5 to 8 of Set_Prm.
class ChecksStepBC : public Checks {};
/// Checks for chips with clock synchronisation: VPC3+C.
class ChecksClockSync : public Checks {};
/// Checks for chips without checks 5 to 8 of Set_Prm.
class ChecksPlainPrm : public Checks {};
/// Checks for APC3 and SPC3.
class ChecksSpc3Class : public Checks {};

}  // namespace dpchip::checks
