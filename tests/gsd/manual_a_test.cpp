// SPDX-License-Identifier: Apache-2.0
// What appendix A of the APC3 manual says about GSD files.
#include <string>

#include <gtest/gtest.h>

#include <dpchip/gsd/parse.hpp>

namespace gsd = dpchip::gsd;

// proves: APC3 A.1-03, E058
TEST(ManualA1, Set_Slave_Add_supp_says_whether_the_address_can_be_changed) {
    for (const bool can : {false, true}) {
        const std::string text = std::string{"#Profibus_DP\nSet_Slave_Add_supp = "} + (can ? "1\n" : "0\n");
        EXPECT_EQ(gsd::parse(text).gsd.set_slave_add, can);
    }
}
