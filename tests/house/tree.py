# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of this project, for the house tests."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("apps", "cmake", "docs", "lcmtypes", "scripts", "scenarios", "src", "tests", ".ci")
ROOT_FILES = ("CMakeLists.txt", "CMakePresets.json", "README.md", "packages.txt", "demo", "test", ".clang-format",
              ".clang-tidy")
NOT_TEXT = {".png", ".jpg", ".gif", ".svg", ".lcmlog"}


def files(*endings, folders=FOLDERS):
    """All files, or those with one of the endings, as paths relative to the root."""
    found = [ROOT / name for name in ROOT_FILES if folders is FOLDERS]
    for folder in folders:
        found += (ROOT / folder).rglob("*")
    return sorted(path.relative_to(ROOT) for path in found
                  if path.is_file() and "__pycache__" not in path.parts and path.suffix not in NOT_TEXT
                  and (not endings or path.suffix in endings))


def text(path):
    return (ROOT / path).read_text(encoding="utf-8")


def is_script(path):
    return (ROOT / path).read_bytes().startswith(b"#!")


def without_comments(code):
    """C++ with comments and the insides of strings blanked; lines stay where they are."""
    def blank(match):
        token = match.group(0)
        if token.startswith(("//", "/*")):
            return re.sub(r"[^\n]", " ", token)
        if token.startswith("R"):
            return '""' + "\n" * token.count("\n")
        return token[0] * 2
    return re.sub(r'//[^\n]*|/\*.*?\*/|R"(?P<d>\w*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"|(?<!\d)\'(?:\\.|[^\'\\\n])\'', blank, code,
                  flags=re.S)
