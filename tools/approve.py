#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden files: shows what tests produced instead of them, and takes it over when told to.

A golden test compares with tests/golden/NAME and, when it differs, leaves what it got in
BUILD/golden/NAME.actual (see tests/support/golden.hpp).

Usage: approve.py [--build FOLDER] [--yes] [NAME...]
  --build FOLDER  the build tree to look in (default: build/release)
  --yes           copy; without it only the differences are shown, and the exit code is 1 when there are any
  NAME...         only these golden files
"""

import argparse
import difflib
import sys
from pathlib import Path


def show(name, old, new):
    before, after = ([line + "\n" for line in text.splitlines()] for text in (old, new))
    sys.stdout.writelines(difflib.unified_diff(before, after, f"golden/{name}", f"golden/{name}.actual"))


def main(arguments):
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=root / "build" / "release")
    parser.add_argument("--golden", type=Path, default=root / "tests" / "golden", help=argparse.SUPPRESS)
    parser.add_argument("--yes", action="store_true")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args(arguments)

    differ = 0
    produced = {
        str(path.relative_to(options.build / "golden"))[: -len(".actual")]: path
        for path in sorted((options.build / "golden").rglob("*.actual"))
    }
    for name in options.names:
        if name not in produced:
            print(f"{name}: no test left anything for it in {options.build / 'golden'}", file=sys.stderr)
            return 2
    for name, actual in produced.items():
        if options.names and name not in options.names:
            continue
        golden = options.golden / name
        old = golden.read_bytes() if golden.exists() else b""
        new = actual.read_bytes()
        if golden.exists() and old == new:
            actual.unlink()
            continue
        differ += 1
        show(name, old.decode("utf-8", "replace"), new.decode("utf-8", "replace"))
        if options.yes:
            golden.parent.mkdir(parents=True, exist_ok=True)
            golden.write_bytes(new)
            actual.unlink()
    print(f"{differ} golden files {'updated' if options.yes else 'differ'}")
    return 1 if differ and not options.yes else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
