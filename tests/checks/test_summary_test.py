#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/test_summary.py: nothing that went wrong may be counted as passed."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import test_summary

GOOD = '<testcase name="{0}" status="run"/>'
BAD = '<testcase name="{0}" status="fail"><failure message=""/></testcase>'
CASE = '<testcase name="a" status="run" result="completed"/>'
FAILED_CASE = '<testcase name="a" status="run" result="completed"><failure/></testcase>'
SKIPPED_CASE = '<testcase name="a" status="run" result="skipped"><skipped/></testcase>'


class Summary(unittest.TestCase):
    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return Path(folder.name)

    def count(self, entries, reports):
        build = self.folder()
        (build / "tests").mkdir()
        (build / "ctest.xml").write_text("<testsuite>" + "".join(entries) + "</testsuite>")
        for name, cases in reports.items():
            (build / "tests" / f"{name}.xml").write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>")
        return test_summary.count(build)

    def test_cases_are_counted_one_by_one_and_other_tests_as_one(self):
        self.assertEqual(self.count([GOOD.format("core"), GOOD.format("check.layers")], {"core": CASE * 7}), (8, 0))

    def test_failed_and_skipped_cases_are_failures(self):
        self.assertEqual(self.count([BAD.format("core")], {"core": CASE * 3 + FAILED_CASE + SKIPPED_CASE}), (3, 2))

    def test_a_program_that_crashed_before_its_report_failed_once(self):
        self.assertEqual(self.count([BAD.format("core"), GOOD.format("fdl")], {"fdl": CASE}), (1, 1))

    def test_a_program_that_failed_after_its_last_case_failed_once(self):
        self.assertEqual(self.count([BAD.format("core")], {"core": CASE * 4}), (4, 1))

    def test_a_program_without_a_case_failed(self):
        self.assertEqual(self.count([GOOD.format("core")], {"core": ""}), (0, 1))

    def test_a_test_that_did_not_run_failed(self):
        self.assertEqual(self.count(['<testcase name="x" status="notrun"><skipped/></testcase>'], {}), (0, 1))

    def test_no_report_of_ctest_and_no_test_at_all_are_failures(self):
        self.assertEqual(test_summary.count(self.folder()), (0, 1))
        self.assertEqual(self.count([], {}), (0, 1))


if __name__ == "__main__":
    unittest.main()
