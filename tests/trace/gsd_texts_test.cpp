// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include <dpchip/trace/dialogue.hpp>
#include <dpchip/trace/gsd_texts.hpp>

#include "octets.hpp"

namespace dpchip::trace {
namespace {

gsd::Gsd device() {
    gsd::Gsd g;
    g.diag.bits = {{0, "Overload", ""}, {9, "Fuse blown", ""}};
    g.diag.not_bits = {{1, "Load voltage missing", ""}, {99, "never in the data", ""}};
    g.diag.areas = {{4, 7, {{2, "Warm"}, {3, "Hot"}}}, {96, 103, {{0, "never in the data"}}}};
    g.diag.channel = {{17, "Sensor dirty"}};
    g.unit_diag_types = {{0x81, {{{24, "Drive stopped", ""}}, {}, {}, {}}}};
    return g;
}

TEST(GsdTexts, NameBitsAreasAndChannelErrorsOfTheirStationOnly) {
    const gsd::Gsd g = device();
    GsdTexts texts;
    texts.set(8, &g);
    using Words = std::vector<std::string>;
    EXPECT_EQ(texts.device_diag(8, octets("33 02")), (Words{"bit 0 \"Overload\"", "bit 9 \"Fuse blown\"", "bits 4-7 \"Hot\""}));
    EXPECT_EQ(texts.device_diag(8, octets("00")), Words{"not bit 1 \"Load voltage missing\""});
    EXPECT_EQ(texts.device_diag(8, octets("82 00 00 01")), Words{});
    EXPECT_EQ(texts.device_diag(8, {}), Words{});
    EXPECT_EQ(texts.device_diag(9, octets("33 02")), Words{});
    EXPECT_EQ(texts.device_diag(200, octets("33 02")), Words{});
    EXPECT_EQ(texts.channel_error(8, 17), "Sensor dirty");
    EXPECT_EQ(texts.channel_error(8, 18), "");
    EXPECT_EQ(texts.channel_error(9, 17), "");
}

TEST(GsdTexts, NameTheBlocksOfADpV1SlaveByTheirType) {
    const gsd::Gsd g = device();
    GsdTexts texts;
    texts.set(8, &g);
    const auto words = texts.device_diag(8, octets("81 00 00 01"));
    EXPECT_NE(std::find(words.begin(), words.end(), "bit 24 \"Drive stopped\""), words.end());
}

}  // namespace
}  // namespace dpchip::trace
