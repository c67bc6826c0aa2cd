#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What no compiler and no clang-tidy check sees: licence lines, file lengths, tabs, machine paths, silenced tests.

Usage: check_style.py [ROOT]. Looks at the files git tracks, and at new ones it does not ignore.
Prints one line per breach and exits with 1 when there is one.
"""

import re
import subprocess
import sys
from pathlib import Path

SPDX = "SPDX-License-Identifier: Apache-2.0"
SOURCE = {".hpp", ".cpp", ".h", ".c", ".inc"}
SCRIPT = {".py", ".sh", ".lua"}
TEXT = {".md", ".txt", ".cmake", ".json", ".toml"}
CODE_FOLDERS = {"src", "include", "tests", "fuzz", "bench", "examples", "tools"}
MAX_LINES = 500
# Data tables may be long, because splitting a table hides it. Everything else is one idea a file.
TABLES = {
    "src/regmap/bus_timing.hpp",
    "src/regmap/control_parameters.hpp",
    "src/regmap/organizational_parameters.hpp",
}

MACHINE_PATH = re.compile(r"(?<![\w.$}])/(?:work|root|farm|home/\w+|tmp/bash_jobs)(?:/|\b(?![\w-]))")
OPEN_END = re.compile(r"\b(?:TODO|FIXME|XXX)\b")
SILENCED = re.compile(r"\bGTEST_SKIP\b|\bDISABLED_|@unittest\.skip|\.skipTest\(")
# This file and its test spell out what they look for.
EXEMPT_FROM_WORDS = {"tools/check_style.py", "tests/checks/check_style_test.py"}


def tracked_files(root):
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, capture_output=True, check=True).stdout.decode().split("\0")
    return sorted(name for name in listed if name and (root / name).is_file())


def breaches(name, text):
    """Pairs of line number (0: the whole file) and complaint."""
    path = Path(name)
    lines = text.split("\n")
    folder = path.parts[0] if len(path.parts) > 1 else ""
    is_source = path.suffix in SOURCE and folder in CODE_FOLDERS
    is_script = path.suffix in SCRIPT or lines[0].startswith("#!")

    if is_source and SPDX not in lines[0]:
        yield 1, f"the first line is not the SPDX line ({SPDX})"
    if is_script and not any(SPDX in line for line in lines[:2]):
        yield 1, f"no SPDX line below the #! line ({SPDX})"
    if (is_source or is_script) and len(lines) - 1 > MAX_LINES and name not in TABLES:
        yield 0, f"{len(lines) - 1} lines; {MAX_LINES} are the limit"
    if text and not text.endswith("\n") and (is_source or is_script or path.suffix in TEXT):
        yield len(lines), "no newline at the end of the file"

    exempt = name in EXEMPT_FROM_WORDS
    for number, line in enumerate(lines, 1):
        if (is_source or is_script) and "\t" in line:
            yield number, "a tab"
        if (is_source or is_script) and line != line.rstrip():
            yield number, "blanks at the end of the line"
        if exempt:
            continue
        if MACHINE_PATH.search(line):
            yield number, "a path of one machine"
        if (is_source or is_script) and OPEN_END.search(line):
            yield number, "an open end: finish it or file it"
        if folder == "tests" and SILENCED.search(line):
            yield number, "a silenced test"


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    failed = False
    for name in tracked_files(root):
        try:
            text = (root / name).read_bytes().decode("utf-8")
        except UnicodeDecodeError:
            continue  # binary: corpora, recorded traces, Latin-1 GSD files
        if name.startswith("fuzz/corpus/") or Path(name).suffix.lower() in {".gsd", ".gse", ".gsg"}:
            continue  # as they are in the field: CRLF, tabs and all
        for line, complaint in breaches(name, text):
            print(f"{name}:{line}: {complaint}")
            failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
