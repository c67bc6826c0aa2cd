#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""clang-tidy over every source file of ours in a build tree's compile_commands.json, two at a time.

Usage: tidy.py BUILD [WORD...]. WORD: only files whose path contains one of them.
Prints the findings, then how many files passed and failed. A file without a finding is remembered by the content of
all sources, so that a second run over an unchanged tree is quick.
"""

import hashlib
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OURS = ("src", "tests", "fuzz", "bench", "examples")


def sources(build):
    commands = json.loads((build / "compile_commands.json").read_text())
    files = {Path(entry["directory"], entry["file"]).resolve() for entry in commands}
    ours = (f for f in files if f.suffix == ".cpp" and f.is_file() and f.is_relative_to(ROOT))
    return sorted(f for f in ours if f.relative_to(ROOT).parts[0] in OURS)


def headers_digest():
    """One digest of everything any file may depend on: a changed header makes every file stale."""
    digest = hashlib.sha256()
    folders = [ROOT / "include", *(ROOT / folder for folder in OURS)]
    everything = (f for folder in folders for f in folder.rglob("*"))
    files = [f for f in everything if f.suffix in {".hpp", ".h", ".inc"} or f.name == ".clang-tidy"]
    for file in sorted([*files, ROOT / ".clang-tidy"]):
        digest.update(file.read_bytes())
    return digest.hexdigest()


def check(build, file, common):
    stamp = build / "tidy" / hashlib.sha256((common + str(file)).encode() + file.read_bytes()).hexdigest()
    if stamp.exists():
        return True, ""
    done = subprocess.run(["clang-tidy", "-p", str(build), "--quiet", str(file)], capture_output=True, text=True)
    if done.returncode == 0:
        stamp.parent.mkdir(exist_ok=True)
        stamp.touch()
        return True, ""
    return False, done.stdout + "\n".join(l for l in done.stderr.splitlines() if " warnings generated" not in l)


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    build, words = Path(arguments[0]).resolve(), arguments[1:]
    files = [f for f in sources(build) if not words or any(word in str(f) for word in words)]
    common, failed = headers_digest(), 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, (good, text) in zip(files, pool.map(lambda f: check(build, f, common), files)):
            if not good:
                failed += 1
                print(f"{file.relative_to(ROOT)}:\n{text}", flush=True)
    print(f"clang-tidy: {len(files) - failed} files passed, {failed} failed")
    return 1 if failed or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
