# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds docs/pipeline.md to the pipeline: make() and its steps stand there in full, and are short. Usage: steps_test.py"""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_LINES = 60
STEPS = [("make/make.cpp", "Made make("), ("plan/resolve.cpp", "Plan resolve("), ("make/rivers.cpp", "Rivers make_rivers("),
         ("make/terrain.cpp", "Terrain make_terrain("), ("make/assess.cpp", "Assessment assess(")]
SHOWN = re.compile(r"<!-- make -->\n```cpp\n(.*?)```\n<!-- end -->", re.DOTALL)


def function(text, head):
    """The text of the function whose definition begins so."""
    begin = text.index("\n" + head) + 1
    return text[begin:text.index("\n}\n", begin) + 3]


class Steps(unittest.TestCase):
    def setUp(self):
        self.steps = [function((ROOT / "lib/thalweg/pipeline" / file).read_text(encoding="utf-8"), head)
                      for file, head in STEPS]

    def test_the_page_shows_them(self):
        page = (ROOT / "docs/pipeline.md").read_text(encoding="utf-8")
        self.assertEqual(SHOWN.findall(page), ["\n".join(self.steps)])

    def test_they_are_short(self):
        self.assertLessEqual(sum(len(step.splitlines()) for step in self.steps), MOST_LINES)

    def test_make_calls_them_in_their_order(self):
        calls = re.findall(r"= (\w+)\(", self.steps[0])
        self.assertEqual(calls, ["resolve", "make_rivers", "make_terrain", "assess", "recipe_of"])

    def test_a_function_ends_where_it_does(self):
        self.assertEqual(function("int a;\nint f() {\n    g();\n}\n\nint h() {\n}\n", "int f("), "int f() {\n    g();\n}\n")


if __name__ == "__main__":
    unittest.main()
