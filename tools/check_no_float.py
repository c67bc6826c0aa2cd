#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No floating point below cli/: no float or double, no floating literal, no <cmath>.

Times are written as literals such as 6.25_ns, which C++ hands to dpchip as text; those are allowed.
Usage: check_no_float.py [ROOT]. Prints one line per breach and exits with 1 when there is one.
"""

import re
import sys
from pathlib import Path

LAYERS = "core regmap fdl dp gsd chip segment master driver slave trace live pins".split()
TIME_UNITS = "ns us ms s clk".split()

# In the order a compiler would see them: what is skipped first, then what is looked at.
TOKEN = re.compile(
    r"""
      (?P<skip> //(?:[^\n\\]|\\.|\\\n)* | /\*.*?\*/
              | R"(?P<delimiter>[^()\\\s]*)\(.*?\)(?P=delimiter)"
              | "(?:[^"\\\n]|\\.)*" | (?<![0-9A-Fa-f])'(?:[^'\\\n]|\\.)+' )
    | (?P<number> (?<![\w.]) \.?[0-9] (?: [eEpP][+-] | '?[\w.] )* )
    | (?P<word> [A-Za-z_]\w* )
    """,
    re.VERBOSE | re.DOTALL,
)
WORDS = {"float", "double", "float_t", "double_t", "cmath", "cfloat", "_Float16", "__float128"}


def is_floating(number):
    digits, _, suffix = number.replace("'", "").partition("_")
    if suffix in TIME_UNITS:
        return False
    if digits.lower().startswith("0x"):
        return "." in digits or "p" in digits.lower()
    return "." in digits or re.fullmatch(r"[0-9]+[eE].*", digits) is not None


def breaches(text):
    """Pairs of line number and offending token."""
    for token in TOKEN.finditer(text):
        word, number = token["word"], token["number"]
        if (word in WORDS) or (number and is_floating(number)):
            yield text.count("\n", 0, token.start()) + 1, token.group()


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    failed = False
    for layer in LAYERS:
        for path in sorted((root / "src" / layer).rglob("*")):
            if path.suffix not in {".hpp", ".cpp", ".h", ".c", ".inc"}:
                continue
            for line, token in breaches(path.read_text(encoding="utf-8")):
                print(f"{path.relative_to(root)}:{line}: floating point: {token}")
                failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
