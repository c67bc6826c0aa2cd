#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""./run, ./test and tools/house.sh: packages, exit codes, and what a failed build shows."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def bash(script):
    return subprocess.run(["bash", "-c", ". tools/house.sh\n" + script], cwd=ROOT, capture_output=True, text=True)


class Packages(unittest.TestCase):
    def test_every_line_names_a_package_and_what_it_is_for(self):
        for line in (ROOT / "packages.txt").read_text().splitlines():
            self.assertRegex(line, r"^($|#|\[\w+\]$|[a-z0-9][a-z0-9.+-]+ +# \S)")

    def test_sections_are_read_apart_and_together(self):
        run, test = bash("packages run").stdout.split(), bash("packages test").stdout.split()
        self.assertIn("g++", run)
        self.assertIn("libgtest-dev", test)
        self.assertFalse(set(run) & set(test))
        self.assertEqual(sorted(bash("packages run test").stdout.split()), sorted(run + test))

    def test_without_root_the_apt_get_line_is_printed_and_the_code_is_3(self):
        done = bash('packages() { echo no-such-package; echo bash; }; id() { echo 1000; }; need run; echo "went on"')
        self.assertEqual(done.returncode, 3)
        self.assertNotIn("went on", done.stdout)
        self.assertIn("apt-get install -y --no-install-recommends no-such-package\n", done.stderr)

    def test_nothing_is_said_when_nothing_is_missing(self):
        done = bash("packages() { echo bash; }; id() { echo 1000; }; need run; echo went on")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "went on\n", ""))


class Quietly(unittest.TestCase):
    def test_success_is_silent_and_failure_shows_the_error_and_passes_its_code_on(self):
        with tempfile.TemporaryDirectory() as folder:
            good = bash(f"quietly {folder}/log sh -c 'echo fine'")
            self.assertEqual((good.returncode, good.stdout, good.stderr), (0, "", ""))
            bad = bash(f"quietly {folder}/log sh -c 'echo a.cpp:1: error: bad; exit 7'")
            self.assertEqual(bad.returncode, 7)
            self.assertIn("a.cpp:1: error: bad", bad.stderr)
            self.assertIn("bad", Path(folder, "log").read_text())


class Usage(unittest.TestCase):
    def call(self, *arguments):
        return subprocess.run([ROOT / "test", *arguments], cwd="/", capture_output=True, text=True)

    def test_help_names_every_option_the_script_knows(self):
        done = self.call("--help")
        self.assertEqual(done.returncode, 0)
        known = set(re.findall(r"--[a-z]+(?=[ )|])", re.search(r"case \$1 in(.*?)esac", (ROOT / "test").read_text(), re.S)[1]))
        self.assertTrue(known)
        for option in known:
            self.assertIn(option, done.stdout)

    def test_an_unknown_option_is_an_error(self):
        for option in ("--bogus", "word", "--fuzzy"):
            done = self.call(option)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(option, done.stderr)


if __name__ == "__main__":
    unittest.main()
