# SPDX-License-Identifier: GPL-3.0-or-later
"""No file over 400 lines, no function over 60."""
import re
import unittest

import tree

FILE_LINES = 400
FUNCTION_LINES = 60
# What opens a brace without being a function: the text since the last statement says so.
SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum)\b[^()]*$|\bextern\b\s*\"\"\s*$|=\s*$|[\w>]\s*$(?<!const)(?<!noexcept)(?<!override)")


def functions(code):
    """(first line, lines) of each function, nested ones and lambdas counted with the outer one."""
    code = tree.without_comments(code)
    depth_of_function, start, stack, begin = None, 0, [], 0
    for match in re.finditer(r"[{};]|\n\s*#[^\n]*", code):
        mark = match.group(0)
        if mark == "{":
            head = code[begin:match.start()].strip()
            is_function = ")" in head and not SCOPE.search(re.sub(r"\)\s*(?:->\s*[\w:<>,&* ]+)$", ")", head))
            if depth_of_function is None and is_function:
                depth_of_function, start = len(stack), begin + len(code[begin:]) - len(code[begin:].lstrip())
            stack.append("{")
        elif mark == "}" and stack:
            stack.pop()
            if depth_of_function == len(stack):
                first = code.count("\n", 0, start) + 1
                yield first, code.count("\n", 0, match.start()) + 2 - first
                depth_of_function = None
        begin = match.end()


class Lengths(unittest.TestCase):
    def test_files_stay_below_400_lines(self):
        for path in tree.files(".h", ".cpp", ".py", ".sh", ".cmake", ".txt", ".lcm"):
            self.assertLessEqual(tree.text(path).count("\n"), FILE_LINES, path)

    def test_functions_stay_below_60_lines(self):
        for path in tree.files(".h", ".cpp"):
            for first, lines in functions(tree.text(path)):
                self.assertLessEqual(lines, FUNCTION_LINES, f"{path}:{first}")

    def test_python_functions_stay_below_60_lines(self):
        import ast
        for path in tree.files(".py"):
            for node in ast.walk(ast.parse(tree.text(path))):
                if isinstance(node, ast.FunctionDef):
                    self.assertLessEqual(node.end_lineno - node.lineno + 1, FUNCTION_LINES, f"{path}:{node.lineno}")

    def test_a_long_function_is_found(self):
        body = "  call();\n" * 70
        for head in ("int f(int a)", "A::A() : a_{1}, b_(2)", "auto f() -> int", "int f() const noexcept"):
            code = "namespace n {\nclass C {\n int x = 0;\n" + head + "\n{\n" + body + "}\n};\n}\n"
            self.assertGreater(max(lines for _, lines in functions(code)), FUNCTION_LINES, head)
        self.assertEqual(list(functions("struct A {\n" + "  int a = 0;\n" * 70 + "};\n")), [])


if __name__ == "__main__":
    unittest.main()
