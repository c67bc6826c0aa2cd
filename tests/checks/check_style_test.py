#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/check_style.py on files that break one rule each."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_style

HEAD = "// SPDX-License-Identifier: Apache-2.0\n"


class Style(unittest.TestCase):
    def complaints(self, name, text):
        return [complaint for _, complaint in check_style.breaches(name, text)]

    def test_a_well_kept_file_passes(self):
        self.assertEqual(self.complaints("src/core/a.hpp", HEAD + "int x;\n"), [])
        self.assertEqual(self.complaints("tools/a.py", "#!/usr/bin/env python3\n# " + HEAD[3:] + "x = 1\n"), [])
        self.assertEqual(self.complaints("README.md", "any\ttext\n"), [])
        self.assertEqual(self.complaints("src/core/a.cpp", HEAD + "// network/root, .." + "/work" + "/x, <root/y>\n"), [])

    def test_each_breach_has_its_own_complaint(self):
        for name, text, word in [
            ("src/core/a.hpp", "int x;\n", "SPDX"),
            ("run", "#!/bin/bash\n", "SPDX"),
            ("tools/a.py", "#!/usr/bin/env python3\nx = 1\n", "SPDX"),
            ("src/core/a.hpp", HEAD + "int x;\n" * 500, "501 lines"),
            ("src/core/a.hpp", HEAD + "\tint x;\n", "tab"),
            ("src/core/a.hpp", HEAD + "int x; \n", "blanks"),
            ("src/core/a.hpp", HEAD + "int x;\r\n", "blanks"),
            ("src/core/a.hpp", HEAD + "int x;", "newline"),
            ("docs/a.md", "see /" + "work/main\n", "path of one machine"),
            ("docs/a.md", "see /" + "root/x\n", "path of one machine"),
            ("src/core/a.hpp", HEAD + "// TODO: more\n", "open end"),
            ("tests/core/a_test.cpp", HEAD + "GTEST_SKIP();\n", "silenced"),
            ("tests/core/a_test.cpp", HEAD + "TEST(A, DISABLED_b) {}\n", "silenced"),
        ]:
            found = self.complaints(name, text)
            self.assertEqual(len(found), 1, (name, found))
            self.assertIn(word, found[0])

    def test_tables_may_be_long(self):
        name = sorted(check_style.TABLES)[0]
        self.assertEqual(self.complaints(name, HEAD + "int x;\n" * 600), [])


if __name__ == "__main__":
    unittest.main()
