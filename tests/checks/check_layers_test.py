#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/check_layers.py on trees that break the rule, one way each."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_layers


def tree(test, files):
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    root = Path(folder.name)
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


class Includes(unittest.TestCase):
    def breaches(self, name, line):
        return list(check_layers.source_breaches(tree(self, {name: line + "\n"})))

    def test_what_the_table_allows_passes(self):
        for name, line in [
            ("src/driver/a.hpp", "#include <dpchip/regmap/reg.hpp>"),
            ("src/driver/a.hpp", "#include <dpchip/driver/b.hpp>"),
            ("src/chip/services/a.cpp", "#include <dpchip/fdl/telegram.hpp>"),
            ("src/core/a.hpp", "#include <cstdint>"),
            ("src/core/a.hpp", "#include <dpchip/version.h>"),
            ("src/capi/a.cpp", "#include <dpchip/dpchip.h>"),
            ("src/live/a.cpp", "#include <boost/asio.hpp>"),
            ("src/tlm/a.cpp", "#include <systemc>"),
            ("src/tlm/a.cpp", "#include <dpchip/dpchip_pins.h>"),
            ("src/gsd/a.cpp", '#include "local.hpp"'),
            ("src/core/a.hpp", "/* #include <vector> */ // #include <thread>"),
        ]:
            self.assertEqual(self.breaches(name, line), [], (name, line))

    def test_what_it_forbids_is_found_with_file_and_line(self):
        for name, line, word in [
            ("src/driver/a.hpp", "#include <dpchip/chip/chip.hpp>", "driver may not include chip"),
            ("src/core/a.hpp", "  #  include <dpchip/fdl/baud.hpp>", "core may not include fdl"),
            ("src/segment/a.cpp", "#include <dpchip/chip/chip.hpp>", "segment may not include chip"),
            ("src/live/a.cpp", "#include <dpchip/slave/slave.hpp>", "live may not include slave"),
            ("src/chip/a.cpp", "#include <dpchip/dpchip.h>", "chip may not include <dpchip/dpchip.h>"),
            ("src/chip/a.cpp", "#include <fmt/format.h>", "nothing but the standard library"),
            ("src/trace/a.cpp", "#include <unistd.h>", "nothing but the standard library"),
            ("src/chip/a.cpp", "#include <vector>", "may never do"),
            ("src/master/a.cpp", "#include <chrono>", "may never do"),
            ("src/master/a.cpp", "#include <fstream>", "may never do"),
            ("src/fdl/a.cpp", '#include "../chip/chip.hpp"', "write <dpchip/...>"),
            ("src/tlm/a.cpp", "#include <dpchip/core/ticks.hpp>", "tlm may not include core"),
            ("src/tlm/a.cpp", "#include <span>", "may never do"),
            ("src/surprise/a.cpp", "int x;", "not a layer"),
        ]:
            found = self.breaches(name, line)
            self.assertTrue(found and word in found[0] and found[0].startswith(name), (name, line, found))


class Targets(unittest.TestCase):
    def breaches(self, text):
        return list(check_layers.cmake_breaches(tree(self, {"src/CMakeLists.txt": text})))

    def test_dependencies_of_targets_follow_the_same_table(self):
        self.assertEqual(self.breaches("dpchip_layer(gsd DEPS core dp)"), [])
        self.assertEqual(self.breaches("dpchip_layer(live DEPS core fdl LIBS Boost::headers)"), [])
        self.assertIn("gsd may not depend on chip", self.breaches("dpchip_layer(gsd DEPS core chip)")[0])
        self.assertIn("nothing but", self.breaches("dpchip_layer(gsd DEPS core LIBS fmt::fmt)")[0])

    def test_the_table_has_no_cycle(self):
        done = set()
        while len(done) < len(check_layers.MAY_INCLUDE):
            ready = {l for l, others in check_layers.MAY_INCLUDE.items() if l not in done and others <= done}
            self.assertTrue(ready)
            done |= ready


if __name__ == "__main__":
    unittest.main()
