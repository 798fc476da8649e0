# SPDX-License-Identifier: GPL-3.0-or-later
"""Licence lines, names that say nothing, paths of one machine, work left open."""
import re
import unittest

import tree

SPDX = "SPDX-License-Identifier: GPL-3.0-or-later"
EMPTY_NAME = re.compile(r"^(?:utils?|common|misc|helpers?|manager|tools)$|_(?:utils?|manager|helpers?)$")
EMPTY_TYPE = re.compile(r"\b(?:class|struct|namespace)\s+\w*(?:Utils?|Manager|Helper|Misc|Common|utils?|misc|common)\b")
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:work|home|root|Users|mnt)/\w|\b[A-Z]:\\\w")
LEFT_OPEN = re.compile(r"\b(?:TODO|FIXME|XXX)\b(?!.*#\d)")


class Words(unittest.TestCase):
    def test_sources_begin_with_their_licence(self):
        for path in tree.files():
            if path.suffix in {".h", ".cpp", ".py", ".sh", ".cmake", ".lcm"} or path.name == "CMakeLists.txt" or tree.is_script(path):
                self.assertIn(SPDX, "\n".join(tree.text(path).splitlines()[:2]), path)

    def test_names_say_something(self):
        for path in tree.files():
            for part in (*path.parts[:-1], path.stem):
                self.assertIsNone(EMPTY_NAME.search(part), path)
            if path.suffix in {".h", ".cpp"}:
                self.assertIsNone(EMPTY_TYPE.search(tree.without_comments(tree.text(path))), path)

    def test_no_path_of_one_machine(self):
        for path in tree.files():
            if path.name != "words_test.py":
                self.assertIsNone(MACHINE_PATH.search(tree.text(path)), path)

    def test_nothing_is_left_open_without_an_issue(self):
        for path in tree.files(".h", ".cpp", ".py", ".sh", ".cmake"):
            if path.name != "words_test.py":
                self.assertIsNone(LEFT_OPEN.search(tree.text(path)), path)

    def test_headers_are_included_once(self):
        for path in tree.files(".h"):
            self.assertIn("#pragma once", tree.text(path), path)

    def test_planted_violations_are_found(self):
        self.assertTrue(EMPTY_NAME.search("image_utils") and EMPTY_TYPE.search("class MapManager"))
        self.assertTrue(MACHINE_PATH.search('"/home/me/video.mp4"') and MACHINE_PATH.search("D:\\data"))
        self.assertTrue(LEFT_OPEN.search("// TODO later") and not LEFT_OPEN.search("// TODO #12"))


if __name__ == "__main__":
    unittest.main()
