#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/check_no_float.py on lines with and without floating point."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_no_float


class NoFloat(unittest.TestCase):
    def test_integers_times_comments_and_strings_pass(self):
        for text in [
            "int x = 1'000'000 + 0xE1 + 0x1'E5u + 077;",
            "constexpr auto t = 6.25_ns + 0.1_ms + 4_clk;",
            "// float, double, 1.5\nint y;",
            "/* 3.14\n double */ int y;",
            'auto s = "1.5 Mbit/s"; auto r = R"x(double 1.0 )" )x"; char c = \'.\';',
            "s.f(1); a[1].b; int float_count; case 1: f(...);",
            "auto q = '\"'; int z = 2; auto w = '\\'';",
        ]:
            self.assertEqual(list(check_no_float.breaches(text)), [], text)

    def test_every_form_of_floating_point_is_found(self):
        for text, token in [
            ("double x;", "double"),
            ("using T = float;", "float"),
            ("#include <cmath>", "cmath"),
            ("auto x = 1.5;", "1.5"),
            ("auto x = .5f;", ".5f"),
            ("auto x = 1e9;", "1e9"),
            ("auto x = 1'000.;", "1'000."),
            ("auto x = 0x1p-3;", "0x1p-3"),
            ("auto x = 2.5_kg;", "2.5_kg"),
            ("/* */ auto x = 1e+3;", "1e+3"),
            ("auto s = \"a\"; double y;", "double"),
            ("int n = 1'000; double y; char c = 'a';", "double"),
        ]:
            self.assertEqual([t for _, t in check_no_float.breaches(text)], [token], text)

    def test_the_line_is_named(self):
        self.assertEqual(list(check_no_float.breaches("int a;\n/* \n */\nfloat b;\n")), [(4, "float")])


if __name__ == "__main__":
    unittest.main()
