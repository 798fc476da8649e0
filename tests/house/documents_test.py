# SPDX-License-Identifier: GPL-3.0-or-later
"""What the documents name exists: programs, scripts, files, pictures, other pages. run_documents.py runs the commands."""
import re
import unittest

import tree

COMMANDS = re.compile(r"^```sh\n(.*?)^```", re.M | re.S)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)[^)]*\)")
ORDINARY = {"cmake", "cd", "python3", "ffmpeg", "lcm-logger", "git", "mkdir", "chmod", "od", "sleep", "kill", "wait", "parallel"}


def commands(document):
    """The shell lines of a document's ```sh blocks, continuation lines joined, comments left out."""
    for block in COMMANDS.findall(document):
        for line in block.replace("\\\n", " ").splitlines():
            line = re.sub(r"(?:^|\s)#.*", "", line).strip()
            if line:
                yield line


def documents():
    return [path for path in tree.files(".md")]


def programs():
    examples = {path.stem for path in (tree.ROOT / "apps" / "examples").glob("*.cpp")}
    return examples | set(re.findall(r"eyeslam_program\(\s*([\w-]+)", tree.text("apps/CMakeLists.txt")))


class Documents(unittest.TestCase):
    def test_every_command_exists(self):
        for path in documents():
            for line in commands(tree.text(path)):
                for part in re.split(r"&&|\|\||;|\|", line):
                    word = part.split()[0]
                    if word.startswith("./"):
                        self.assertTrue((tree.ROOT / word).exists(), f"{path}: {line}")
                    else:
                        name = word.rsplit("/", 1)[-1]
                        self.assertTrue(name in ORDINARY | programs(), f"{path}: {line}")

    def test_every_link_leads_somewhere(self):
        for path in documents():
            for target in LINK.findall(tree.text(path)):
                if "://" not in target:
                    self.assertTrue((tree.ROOT / path).parent.joinpath(target).exists(), f"{path}: {target}")

    def test_commands_are_found(self):
        document = "text\n```sh\n./demo a \\\n  b   # says so\n\n# only this\n```\n```text\nno\n```\n"
        self.assertEqual([line.split() for line in commands(document)], [["./demo", "a", "b"]])


if __name__ == "__main__":
    unittest.main()
