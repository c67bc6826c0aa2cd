#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts what a ctest run did: GoogleTest cases one by one, every other test as one.

Usage: test_summary.py BUILD [BUILD...]. Reads BUILD/ctest.xml (ctest --output-junit) and, for each entry, the
report BUILD/tests/ENTRY.xml that a GoogleTest program wrote. Prints "PASSED FAILED".

A program that crashed, ran no case or left no ctest.xml counts as failed; so does a skipped case.
"""

import sys
import xml.etree.ElementTree as xml
from pathlib import Path


def count_cases(report):
    """(passed, failed) of one GoogleTest report; None when it cannot be read."""
    try:
        cases = xml.parse(report).getroot().findall(".//testcase")
    except (OSError, xml.ParseError):
        return None
    good = sum(1 for case in cases if case.get("result") == "completed" and case.find("failure") is None)
    return good, len(cases) - good


def count(build):
    try:
        entries = xml.parse(build / "ctest.xml").getroot().findall("testcase")
    except (OSError, xml.ParseError):
        return 0, 1
    passed = failed = 0
    for entry in entries:
        ran_well = entry.get("status") == "run" and entry.find("failure") is None
        report = build / "tests" / (entry.get("name") + ".xml")
        cases = count_cases(report) if report.exists() else None
        if cases is None or cases == (0, 0):
            # Not a GoogleTest program, or one that did not come to write its report.
            alone = ran_well and not report.exists()
            passed, failed = (passed + 1, failed) if alone else (passed, failed + 1)
            continue
        good, bad = cases
        if not ran_well and bad == 0:
            bad = 1  # every case passed and yet the program failed: a sanitizer, or a crash at its end
        passed, failed = passed + good, failed + bad
    return passed, (failed if entries else 1)


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    totals = [count(Path(build)) for build in arguments]
    print(sum(good for good, _ in totals), sum(bad for _, bad in totals))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
