#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/approve.py: shows first, copies only with --yes, and leaves nothing behind that was taken over."""

import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import approve


class Approve(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = Path(folder.name)
        self.build, self.golden = root / "build", root / "golden"
        (self.build / "golden" / "sub").mkdir(parents=True)
        self.golden.mkdir()
        (self.golden / "old.trace").write_text("one\ntwo\n")
        (self.golden / "same.trace").write_text("same\n")
        (self.build / "golden" / "old.trace.actual").write_text("one\n2\n")
        (self.build / "golden" / "same.trace.actual").write_text("same\n")
        (self.build / "golden" / "sub" / "new.trace.actual").write_text("new\n")

    def run_with(self, *arguments):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            code = approve.main(["--build", str(self.build), "--golden", str(self.golden), *arguments])
        return code, out.getvalue()

    def test_without_yes_nothing_changes_and_the_difference_is_shown(self):
        code, text = self.run_with()
        self.assertEqual(code, 1)
        self.assertIn("-two", text)
        self.assertIn("+2", text)
        self.assertIn("+new", text)
        self.assertNotIn("same", text)
        self.assertEqual((self.golden / "old.trace").read_text(), "one\ntwo\n")

    def test_yes_takes_over_what_was_produced(self):
        self.assertEqual(self.run_with("--yes")[0], 0)
        self.assertEqual((self.golden / "old.trace").read_text(), "one\n2\n")
        self.assertEqual((self.golden / "sub" / "new.trace").read_text(), "new\n")
        self.assertEqual(self.run_with(), (0, "0 golden files differ\n"))

    def test_names_narrow_it_down(self):
        self.assertEqual(self.run_with("--yes", "sub/new.trace")[0], 0)
        self.assertEqual((self.golden / "old.trace").read_text(), "one\ntwo\n")
        self.assertEqual(self.run_with("--yes", "no.trace")[0], 2)


if __name__ == "__main__":
    unittest.main()
