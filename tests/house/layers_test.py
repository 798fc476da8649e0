# SPDX-License-Identifier: GPL-3.0-or-later
"""Who includes whom, and what only programs may do."""
import re
import unittest

import tree

# What a library may include besides itself; apps and tests may include everything.
ALLOWED = {
    "retina": set(),
    "configuration": {"retina"},
    "tracking": {"retina"},
    "fixtures": {"retina"},
    "messaging": {"retina"},
    "baselines": {"retina", "tracking"},
    "vision": {"retina", "tracking", "messaging"},
    "files": {"retina", "configuration", "tracking", "fixtures"},
    "servo": {"retina", "fixtures", "messaging"},
    "robot": {"retina", "messaging", "servo"},
    "simulation": {"retina", "messaging"},
}
ALLOWED["trials"] = set(ALLOWED)
ALLOWED["replay"] = set(ALLOWED)
LCM_USERS = {"messaging", "vision", "servo", "robot", "simulation", "replay", "trials"}  # of the generated types
INCLUDE = re.compile(r'^\s*#include\s*["<]([^">]+)[">]', re.M)
STREAMS = re.compile(r"<iostream>|\bstd::(?:cout|cerr|clog)\b|\b(?:std::)?f?printf\s*\(\s*(?:std|\")|\bfmt::print\b|\bspdlog::")
CLOCKS = re.compile(r"_clock::now|\bclock_gettime\b|\bgettimeofday\b|\bgetTickCount\b|\bstd::time\b|\brandom_device\b")


def forbidden_includes(library, code):
    for path in INCLUDE.findall(code):
        if path.startswith("lcm/") and library != "messaging":
            yield path
        if not path.startswith("eyeslam/"):
            continue
        owner = path.split("/")[1]
        if owner.endswith("_t.hpp"):
            if library not in LCM_USERS:
                yield path
        elif owner != library and owner not in ALLOWED[library]:
            yield path


class Layers(unittest.TestCase):
    def libraries(self):
        for path in tree.files(".h", ".cpp", folders=("src",)):
            yield path.parts[1], path

    def test_libraries_include_only_lower_layers(self):
        for library, path in self.libraries():
            self.assertIn(library, ALLOWED, f"{path}: a library that tests/house/layers_test.py does not know")
            self.assertEqual(list(forbidden_includes(library, tree.text(path))), [], path)

    def test_libraries_write_to_no_stream(self):
        for library, path in self.libraries():
            if library != "trials":
                self.assertEqual(STREAMS.findall(tree.text(path)), [], path)

    def test_only_programs_and_the_loops_read_a_clock(self):
        for library, path in self.libraries():
            if library not in ("servo", "trials"):
                self.assertEqual(CLOCKS.findall(tree.text(path)), [], path)

    def test_a_planted_violation_is_found(self):
        code = '#include "eyeslam/tracking/frame.h"\n#include <lcm/lcm-cpp.hpp>\n#include "eyeslam/retina_pose_t.hpp"\n'
        self.assertEqual(len(list(forbidden_includes("retina", code))), 3)
        self.assertEqual(len(list(forbidden_includes("messaging", code))), 1)
        self.assertTrue(STREAMS.search('std::cout << 1; printf("x");'))
        self.assertTrue(CLOCKS.search("std::chrono::steady_clock::now()"))


if __name__ == "__main__":
    unittest.main()
