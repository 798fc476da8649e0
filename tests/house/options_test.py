# SPDX-License-Identifier: GPL-3.0-or-later
"""Every option is listed with range, unit and what it does."""
import re
import unittest

import tree

STRUCT = re.compile(r"struct (\w*Options)\s*\{(.*?)\n\};", re.S)
MEMBER = re.compile(r"^  [\w:<>,]+(?:\s+[\w:<>,]+)* (\w+)(?:\s*=\s*[^;]*|\{[^;]*\})?;", re.M)
CALL = re.compile(r"visitor\.(field|choice|group)\(\s*\"(\w+)\"\s*,\s*self\.(\w+)\s*(.*?)\);\s*(?=visitor|\})", re.S)
FIELD = re.compile(r',\s*(?:retina::)?Range\s*\{\s*[^,{}]+,\s*[^,{}]+\}\s*,\s*"([^"]*)"\s*,\s*("(?:[^"]|"\s*")+")\s*$', re.S)
CHOICE = re.compile(r',\s*\{\s*"[^{}]*\}\s*,\s*("(?:[^"]|"\s*")+")\s*$', re.S)


def complaints(code):
    for name, body in STRUCT.findall(code):
        if " visit(" not in body:
            continue  # arguments of one program's call, not configuration
        calls = CALL.findall(body)
        members = set(MEMBER.findall(body.split("template <class Self")[0]))
        for missing in sorted(members - {member for _, _, member, _ in calls}):
            yield f"{name}.{missing} is not visited"
        for kind, key, member, rest in calls:
            if key != member:
                yield f"{name}.{member} is called '{key}'"
            if kind == "field" and not FIELD.match(rest):
                yield f"{name}.{key} lacks range, unit or explanation"
            if kind == "choice" and not CHOICE.match(rest):
                yield f"{name}.{key} lacks its words or explanation"


def without_source(code):
    for name, body in STRUCT.findall(code):
        for _, key, _, rest in CALL.findall(body):
            if '"' in rest and "source:" not in re.sub(r'"\s*"', "", rest):
                yield f"{name}.{key} does not say where its value is from (source: ...)"


class Options(unittest.TestCase):
    def test_every_option_has_range_unit_and_explanation(self):
        for path in tree.files(".h", folders=("src", "apps")):
            self.assertEqual(list(complaints(tree.text(path))), [], path)

    def test_every_option_of_tracker_and_simulation_names_its_source(self):
        for path in tree.files(".h", folders=("src/tracking", "src/simulation")):
            if "Source, unless said:" not in tree.text(path):  # one for all of a struct's options
                self.assertEqual(list(without_source(tree.text(path))), [], path)

    def test_planted_violations_are_found(self):
        good = ('struct AOptions {\n  double a = 1.0;\n\n  template <class Self, class V>\n'
                '  static void visit(Self& self, V& visitor)\n  {\n    visitor.field("a", self.a, Range{0.0, 1.0}, "px",\n "does it; "\n "source: paper");\n  }\n};')
        self.assertEqual(list(complaints(good)), [])
        self.assertEqual(len(list(complaints(good.replace("double a = 1.0;", "double a = 1.0;\n  int b = 2;")))), 1)
        self.assertEqual(len(list(complaints(good.replace("Range{0.0, 1.0}, ", "")))), 1)
        self.assertEqual(len(list(complaints(good.replace('"px",', "")))), 1)
        self.assertEqual(list(without_source(good)), [])
        self.assertEqual(len(list(without_source(good.replace("source", "from")))), 1)


if __name__ == "__main__":
    unittest.main()
