#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tool that ties tests to the manuals must itself not be fooled: made-up lists and sources, and what it says."""
import contextlib
import io
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import conformance  # noqa: E402

STATEMENTS = """# head
VPC3C 5.3.2-01 | the IAR clears | test | figure 5-11
VPC3C 5.3.2-02 | the IAR leaves | test
VPC3C 1-01 | an introduction | test
VPC3C 10-01 | a voltage | untestable: electrical
"""
INDEX = """# count: section 4
# count: figure 1
section 1 | Introduction
section 5 | ASIC Interface | heading
section 5.3.2 | IAR
section 10 | Electrical
figure 5-11 | IAR
"""
APC3 = "APC3 4.3-01 | the same | test\n"
APC3_INDEX = "# count: section 1\nsection 4.3 | Interrupts\n"
ERRATA = """# head
E001 | M 1 | one or two | two | test
E002 | M 10 | volts | more | untestable: electrical
"""
PROOF = """// proves: VPC3C 5.3.2-01..02
TEST(Iar, clears_and_leaves) {
}
// proves: APC3 4.3-01, E001
TEST_P(Apc3, does_the_same) {
}
"""


class House(unittest.TestCase):
    """A small house in a temporary folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.put("docs/statements/vpc3c.txt", STATEMENTS)
        self.put("docs/statements/vpc3c_index.txt", INDEX)
        self.put("docs/statements/apc3.txt", APC3)
        self.put("docs/statements/apc3_index.txt", APC3_INDEX)
        self.put("docs/statements/errata.txt", ERRATA)
        self.put("tests/chip/a_test.cpp", PROOF)

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_tool(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = conformance.main(["--root", str(self.root), *arguments])
        return code, out.getvalue(), err.getvalue()

    def assert_refused(self, words):
        self.run_tool()
        code, _, err = self.run_tool("--check")
        self.assertEqual(code, 1)
        self.assertIn(words, err)

    def test_a_complete_house_passes_and_its_page_names_the_tests(self):
        self.assertEqual(self.run_tool()[0], 0)
        code, out, err = self.run_tool("--check")
        self.assertEqual((code, err), (0, ""))
        self.assertIn("5 statements: 3 covered, 1 open (0 of DP-V0), 0 later, 1 untestable; 2 errata, 0 open", out)
        page = (self.root / "docs/conformance.md").read_text()
        self.assertIn("| VPC3C 5.3.2-02 | the IAR leaves |  | covered | `Iar.clears_and_leaves` |", page)
        self.assertIn("`Apc3.does_the_same`", page)
        errata = (self.root / "docs/errata.md").read_text()
        self.assertIn("| E001 | M 1 | one or two | two | `Apc3.does_the_same` |", errata)
        self.assertIn("| E002 | M 10 | volts | more | electrical |", errata)

    def test_a_stale_page_is_refused(self):
        self.run_tool()
        self.put("tests/chip/b_test.cpp", "// proves: VPC3C 1-01\nTEST(A, b) {\n}\n")
        code, _, err = self.run_tool("--check")
        self.assertEqual(code, 1)
        self.assertIn("stale", err)

    def test_a_missing_page_is_refused(self):
        self.assertIn("stale", self.run_tool("--check")[2])

    def test_an_unknown_id_is_refused(self):
        self.put("tests/chip/b_test.cpp", "// proves: VPC3C 5.3.2-77\nTEST(A, b) {\n}\n")
        self.assert_refused("A.b claims VPC3C 5.3.2-77")

    def test_a_statement_marked_untestable_cannot_be_claimed(self):
        self.put("tests/chip/b_test.cpp", "// proves: VPC3C 10-01\nTEST(A, b) {\n}\n")
        self.assert_refused("marked untestable")

    def test_a_malformed_mark_is_refused(self):
        self.put("tests/chip/b_test.cpp", "// proves: VPC3C 5.3.2\nTEST(A, b) {\n}\n")
        self.assert_refused("not a statement id: `VPC3C 5.3.2`")

    def test_an_empty_mark_is_refused(self):
        self.put("tests/chip/b_test.cpp", "// proves:\nTEST(A, b) {\n}\n")
        self.assert_refused("a mark without ids")

    def test_a_mark_at_the_end_of_a_file_is_refused(self):
        self.put("tests/chip/b_test.cpp", "// proves: VPC3C 1-01\n")
        self.assert_refused("no test below it")

    def test_an_open_DP_V0_statement_is_refused_unless_allowed(self):
        self.put("tests/chip/a_test.cpp", PROOF.replace("-01..02", "-01"))
        self.assert_refused("VPC3C 5.3.2-02 has no test")
        self.assertEqual(self.run_tool("--check", "--allow-open")[0], 0)
        self.assertIn("VPC3C 5.3.2-02 | the IAR leaves", self.run_tool("--open")[1])

    def test_an_open_erratum_is_refused_unless_allowed(self):
        self.put("tests/chip/a_test.cpp", PROOF.replace(", E001", ""))
        self.assert_refused("E001 has no test: one or two")
        self.assertEqual(self.run_tool("--check", "--allow-open")[0], 0)

    def test_a_malformed_or_misnumbered_erratum_is_refused(self):
        self.put("docs/statements/errata.txt", ERRATA + "E004 | M 1 | two or three | three | test\n")
        self.assert_refused("not the next `id | where | contradiction | decision | how`")

    def test_a_malformed_statement_is_refused(self):
        self.put("docs/statements/apc3.txt", APC3 + "APC3 4.3-02 | no way to show it | maybe\n")
        self.assert_refused("not `id | statement | how | place`")

    def test_a_statement_that_stands_twice_is_refused(self):
        self.put("docs/statements/apc3.txt", APC3 + APC3)
        self.assert_refused("stands twice")

    def test_a_forgotten_section_is_refused(self):
        self.put("docs/statements/apc3_index.txt", "# count: section 2\nsection 4.3 | Interrupts\nsection 5 | DP\n")
        self.assert_refused("section 5 has no statement")

    def test_a_forgotten_figure_is_refused(self):
        self.put("docs/statements/vpc3c.txt", STATEMENTS.replace(" | figure 5-11", ""))
        self.assert_refused("figure 5-11 has no statement")

    def test_a_wrong_count_is_refused(self):
        self.put("docs/statements/apc3_index.txt", APC3_INDEX.replace("section 1\n", "section 3\n", 1))
        self.assert_refused("1 sections listed, 3 counted")

    def test_a_section_that_no_manual_has_is_refused(self):
        self.put("docs/statements/apc3.txt", APC3 + "APC3 4.9-01 | invented | test\n")
        self.assert_refused("section 4.9, which the manual does not have")

    def names(self, text, suffix=".cpp"):
        self.put("tests/x/probe" + suffix, text)
        problems = conformance.Problems()
        found = conformance.scan_file(self.root / ("tests/x/probe" + suffix), problems)
        self.assertEqual(problems, [])
        return found

    def test_a_mark_above_a_table_row_takes_the_name_of_the_row(self):
        text = 'constexpr Row kRows[]{\n    // proves: VPC3C 1-01\n    {"low_active", 1},\n};\n'
        self.assertEqual(self.names(text), [("probe: low_active", ["VPC3C 1-01"])])

    def test_a_mark_in_a_body_belongs_to_the_test_around_it(self):
        text = "TEST_F(A, b) {\n    // proves: VPC3C 1-01\n    int x = 0;\n}\n"
        self.assertEqual(self.names(text), [("A.b", ["VPC3C 1-01"])])

    def test_a_mark_in_a_text_table_takes_the_first_word_of_the_row(self):
        self.assertEqual(self.names("# proves: APC3 4.3-01\nwait_prm | FDL_Status | 10\n", ".txt"),
                         [("probe: wait_prm", ["APC3 4.3-01"])])

    def test_a_mark_goes_on_behind_a_comma_and_names_runs(self):
        text = "// proves: VPC3C 5.3.2-01..02,\n//   APC3 4.3-01\n// what it is about\nTEST(A, b) {\n}\n"
        self.assertEqual(self.names(text), [("A.b", ["VPC3C 5.3.2-01", "VPC3C 5.3.2-02", "APC3 4.3-01"])])


class Manuals(unittest.TestCase):
    """The lists against the manuals themselves, where they are at hand."""

    def setUp(self):
        shared = Path(os.environ.get("DPCHIP_SHARED", ROOT.parent / "shared"))
        self.folder = shared / "manuals"
        if not self.folder.is_dir():
            print("left out: no manuals here, lists of sections and figures are checked by their counts only")
            self.folder = None

    def index(self, name):
        problems = conformance.Problems()
        index = conformance.read_index(ROOT / "docs" / "statements" / name, problems)
        self.assertEqual(problems, [])
        return index

    def listed(self, index, kind):
        return {number for k, number in index.names if k == kind}

    def test_every_section_and_figure_of_the_VPC3C_manual_is_listed(self):
        index = self.index("vpc3c_index.txt")
        if self.folder is None:
            return
        text = (self.folder / "vpc3plus_c_user_manual_r3.04.txt").read_text(encoding="utf-8")
        sections = set(re.findall(r"^[ \t]*(\d+(?:\.\d+)*)[ \t]+[A-Z][^\n]*?\.{2,} ?\d+\s*$", text, re.M))
        self.assertEqual(self.listed(index, "section"), {s for s in sections if int(s.split(".")[0]) <= 10})
        self.assertEqual(self.listed(index, "figure"), set(re.findall(r"Figure (\d+-\d+) ?:", text)))

    def test_every_table_and_figure_of_both_APC3_editions_is_listed(self):
        index = self.index("apc3_index.txt")
        if self.folder is None:
            return
        english = (self.folder / "apc3_user_manual_v2.2_en.txt").read_text(encoding="utf-8")
        chinese = (self.folder / "apc3_user_manual_zh.txt").read_text(encoding="utf-8")
        tables = set(re.findall(r"^Table ([\dA]\.\d+)", english, re.M)) | set(re.findall(r"表 ([\dA]\.\d+) ", chinese))
        self.assertEqual(self.listed(index, "table"), tables)
        figures = set(re.findall(r"^Figure ([\dA]\.\d)", english, re.M)) | set(re.findall(r"图 ([\dA]\.\d) ", chinese))
        self.assertEqual(self.listed(index, "figure"), figures)
        contents = english[english.index("\nContents"):english.rindex("Chapter 1. Function Overview")]
        sections = set(re.findall(r"^(?:Chapter |Appendix )?([\dA](?:\.\d+)*)\.?[ \t]+[A-Z]", contents, re.M))
        sections |= set(re.findall(r"^(5\.2\.\d\.\d)[ \t]", english, re.M))
        self.assertEqual(self.listed(index, "section"), sections)



class ThisHouse(unittest.TestCase):
    def test_the_lists_of_this_house_agree_with_each_other_and_with_the_marks(self):
        problems = conformance.Problems()
        lists, errata = conformance.load(ROOT, problems)
        self.assertGreater(len(errata), 70)
        self.assertEqual(problems, [])
        self.assertGreater(sum(len(statements) for statements, _ in lists.values()), 1000)


if __name__ == "__main__":
    unittest.main()
