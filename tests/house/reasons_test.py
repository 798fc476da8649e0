# SPDX-License-Identifier: GPL-3.0-or-later
"""Every reason has its word, which is its name, and a number of its own."""
import re
import unittest

import tree

NUMBERED = re.compile(r"^\s*(\w+) = (\d+),", re.M)
WORDED = re.compile(r"\{Reason::(\w+), \"(\w*)\"\}")


class Reasons(unittest.TestCase):
    def test_every_reason_has_its_name_as_word(self):
        names = [name for name, _ in NUMBERED.findall(tree.text("src/retina/reason.h"))]
        words = WORDED.findall(tree.text("src/retina/reason.cpp"))
        self.assertEqual(names, [name for name, _ in words])
        for name, word in words:
            self.assertEqual(word, "" if name == "none" else name)

    def test_numbers_are_unique(self):
        numbers = [number for _, number in NUMBERED.findall(tree.text("src/retina/reason.h"))]
        self.assertEqual(len(numbers), len(set(numbers)))


if __name__ == "__main__":
    unittest.main()
