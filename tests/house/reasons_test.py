# SPDX-License-Identifier: GPL-3.0-or-later
"""Every reason has its own number and its own name as its word."""
import re
import unittest

import tree

ENUMERATOR = re.compile(r"^\s*(\w+) = (\d+),", re.M)
WORD = re.compile(r'Word\{Reason::(\w+), "(\w*)"\}')


class Reasons(unittest.TestCase):
    def setUp(self):
        self.enumerators = ENUMERATOR.findall((tree.ROOT / "src/retina/reason.h").read_text())
        self.words = WORD.findall((tree.ROOT / "src/retina/reason.cpp").read_text())

    def test_numbers_differ(self):
        numbers = [number for _, number in self.enumerators]
        self.assertGreater(len(numbers), 20)
        self.assertEqual(len(numbers), len(set(numbers)))

    def test_each_has_its_name_as_its_word(self):
        self.assertEqual(sorted(name for name, _ in self.enumerators), sorted(name for name, _ in self.words))
        for name, word in self.words:
            self.assertEqual(word, "" if name == "none" else name)


if __name__ == "__main__":
    unittest.main()
