// SPDX-License-Identifier: Apache-2.0
// Choosing signals by patterns.
#include <gtest/gtest.h>

#include <string>

#include <dpchip/waves/pattern.hpp>

namespace dpchip::waves {
namespace {

TEST(Pattern, star_stands_for_anything_and_a_question_mark_for_one) {
    struct Row { const char* pattern; const char* text; bool fit; };
    for (const Row& r : {Row{"line.level", "line.level", true}, {"line.level", "line.levels", false}, {"line", "line.level", false},
                         {"*", "", true}, {"*", "Press.IRR.Baud", true}, {"", "", true}, {"", "a", false}, {"?", "", false}, {"?", "a", true},
                         {"Press.?XD", "Press.TXD", true}, {"Press.?XD", "Press.XD", false}, {"*.X_INT", "a.b.X_INT", true},
                         {"*a*b", "xaxaxb", true}, {"*a*b", "xaxaxbc", false}, {"a*", "ba", false}, {"**a**", "a", true},
                         {"[ab]", "a", false}, {"[ab]", "[ab]", true}, {"a\\*", "a*", false}, {"a?c", "a*c", true}})
        EXPECT_EQ(fits(r.pattern, r.text), r.fit) << r.pattern << " on " << r.text;
}

TEST(Pattern, many_stars_take_no_time_to_speak_of) {
    std::string stars;
    for (int i = 0; i < 200; ++i) stars += "*a";
    EXPECT_FALSE(fits(stars + "b", std::string(20'000, 'a')));
    EXPECT_TRUE(fits(stars, std::string(20'000, 'a')));
}

}  // namespace
}  // namespace dpchip::waves
