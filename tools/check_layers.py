#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The layer rule of docs/architecture.md, held against every #include and against the CMake targets.

Usage: check_layers.py [ROOT]. Prints one line per breach and exits with 1 when there is one.
"""

import re
import sys
from pathlib import Path

# What each folder under src/ may include, besides itself.
MAY_INCLUDE = {
    "core": "",
    "regmap": "core",
    "fdl": "core",
    "dp": "core",
    "gsd": "core dp",
    "chip": "core regmap fdl",
    "driver": "core regmap dp",
    "pins": "core regmap fdl chip",
    "segment": "core fdl",
    "master": "core fdl dp gsd segment",
    "slave": "core regmap fdl dp gsd driver chip",
    "trace": "core regmap fdl dp gsd",
    "live": "core fdl segment trace",
    "waves": "core regmap fdl chip segment trace",
    "capi": "core regmap fdl chip pins segment live trace waves",
    "cli": "core regmap fdl dp gsd chip pins segment master driver slave trace live waves",
    "tlm": "",
}
MAY_INCLUDE = {layer: set(others.split()) for layer, others in MAY_INCLUDE.items()}

# Only these may include anything beyond the standard library.
THIRD_PARTY = {"live", "capi", "cli", "tlm"}
# The public C headers: who implements them may include them. version.h is for everybody.
C_HEADERS = {"dpchip.h": {"capi", "tlm"}, "dpchip_pins.h": {"capi", "tlm"}}

STANDARD = set(
    """algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes
    climits clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg
    cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception execution filesystem
    forward_list fstream functional future initializer_list iomanip ios iosfwd iostream istream iterator latch limits
    list locale map memory memory_resource mutex new numbers numeric optional ostream queue random ranges ratio regex
    scoped_allocator semaphore set shared_mutex source_location span sstream stack stdexcept stop_token streambuf
    string string_view strstream syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map
    unordered_set utility valarray variant vector version
    assert.h ctype.h errno.h float.h inttypes.h limits.h math.h stdarg.h stdbool.h stddef.h stdint.h stdio.h stdlib.h
    string.h""".split()
)

CLOCKS_AND_THREADS = set(
    """barrier chrono condition_variable coroutine ctime future latch mutex random semaphore shared_mutex stop_token
    thread""".split()
)
INPUT_AND_OUTPUT = set("cstdio filesystem fstream iostream stdio.h syncstream".split())
HEAP = set(
    """any deque forward_list functional iomanip istream list locale map memory memory_resource new ostream queue regex
    set sstream stack streambuf string unordered_map unordered_set valarray vector""".split()
)
# The packaged SystemC is C++17, so what includes it is too.
CXX20 = set(
    """barrier bit compare concepts coroutine format latch numbers ranges semaphore source_location span stop_token
    syncstream version""".split()
)
# Standard headers that would let a layer do what its row in the table says it never does.
NEVER = {
    **{layer: CLOCKS_AND_THREADS | INPUT_AND_OUTPUT | HEAP for layer in "core regmap fdl dp chip driver pins".split()},
    **{layer: CLOCKS_AND_THREADS | INPUT_AND_OUTPUT for layer in "segment master slave".split()},
    **{layer: CLOCKS_AND_THREADS for layer in "gsd trace waves".split()},
    "tlm": CXX20 | CLOCKS_AND_THREADS,
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
CMAKE_LAYER = re.compile(r"^\s*dpchip_layer\(\s*(\w+)((?:\s+[\w:$<>.{}]+)*)\s*\)", re.MULTILINE)


def without_block_comments(text):
    return re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.DOTALL)


def include_breach(layer, quote, header):
    """Why `layer` may not write this #include, or None."""
    if quote == '"':
        return None if "/" not in header else f'"{header}": write <dpchip/...>'
    if header.startswith("dpchip/"):
        parts = header.split("/")
        if len(parts) == 2:
            allowed = header == "dpchip/version.h" or layer in C_HEADERS.get(parts[1], set())
            return None if allowed else f"{layer} may not include <{header}>"
        other = parts[1]
        if other == layer or other in MAY_INCLUDE[layer]:
            return None
        return f"{layer} may not include {other} (<{header}>)"
    if header in NEVER.get(layer, set()):
        return f"{layer} may never do what <{header}> is for"
    if header not in STANDARD and layer not in THIRD_PARTY:
        return f"{layer} may include nothing but the standard library (<{header}>)"
    return None


def source_breaches(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix not in {".hpp", ".cpp", ".h", ".c", ".inc"}:
            continue
        layer = path.relative_to(root / "src").parts[0]
        name = path.relative_to(root)
        if layer not in MAY_INCLUDE:
            yield f"{name}: src/{layer} is not a layer of the table"
            continue
        text = without_block_comments(path.read_text(encoding="utf-8"))
        for number, line in enumerate(text.split("\n"), 1):
            found = INCLUDE.match(line)
            breach = found and include_breach(layer, found[1], found[2])
            if breach:
                yield f"{name}:{number}: {breach}"


def cmake_breaches(root):
    for path in sorted((root / "src").rglob("CMakeLists.txt")):
        text = re.sub(r"#.*", "", path.read_text(encoding="utf-8"))
        for layer, rest in CMAKE_LAYER.findall(text):
            words = rest.split()
            if "DEPS" not in words:
                continue
            dependencies = words[words.index("DEPS") + 1 :]
            if "LIBS" in dependencies:
                dependencies = dependencies[: dependencies.index("LIBS")]
            for other in dependencies:
                if other not in MAY_INCLUDE.get(layer, set()):
                    yield f"{path.relative_to(root)}: {layer} may not depend on {other}"
            if "LIBS" in words and layer not in THIRD_PARTY:
                yield f"{path.relative_to(root)}: {layer} may depend on nothing but the standard library"


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    breaches = [*source_breaches(root), *cmake_breaches(root)]
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
