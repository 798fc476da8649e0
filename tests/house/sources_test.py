# SPDX-License-Identifier: GPL-3.0-or-later
"""Every source is built: it stands in the CMakeLists.txt above it."""
import re
import unittest

import tree


def list_above(path):
    folder = tree.ROOT / path.parent
    while not (folder / "CMakeLists.txt").exists():
        folder = folder.parent
    return folder


def words(cmake):
    return set(re.split(r"[\s()\"]+", re.sub(r"#[^\n]*", "", cmake)))


class Sources(unittest.TestCase):
    def test_every_source_is_listed(self):
        for path in tree.files(".cpp", folders=("src", "apps", "tests")):
            folder = list_above(path)
            name = (tree.ROOT / path).relative_to(folder)
            subject = name.stem.removesuffix("_test").removesuffix("_benchmark")  # lists may add the ending in a loop
            listed = words((folder / "CMakeLists.txt").read_text())
            self.assertTrue({str(name), str(name.with_suffix("")), name.name, name.stem, subject} & listed,
                            f"{path} is not in {folder.relative_to(tree.ROOT)}/CMakeLists.txt")

    def test_every_message_is_generated(self):
        listed = words(tree.text("lcmtypes/CMakeLists.txt"))
        for path in tree.files(".lcm"):
            self.assertIn(path.stem, listed)

    def test_every_library_and_test_folder_is_part_of_the_build(self):
        top = words(tree.text("CMakeLists.txt"))
        for path in (tree.ROOT / "src").iterdir():
            if path.is_dir():
                self.assertIn(f"src/{path.name}", top)


if __name__ == "__main__":
    unittest.main()
