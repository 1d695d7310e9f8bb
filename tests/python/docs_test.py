# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the Python of README.md, docs/python.md and docs/scale.md: blocks marked python, in their order, in one namespace for each page, in a
folder with a copy of samples/. A line print(...)  # TEXT must print TEXT."""
import contextlib
import io
import pathlib
import re
import shutil
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def blocks_of(page):
    """Blocks as long as the page, so that tracebacks name its lines."""
    text = page.read_text(encoding="utf-8")
    for block in re.finditer(r"^```python\n(.*?)^```", text, re.S | re.M):
        yield "\n" * text.count("\n", 0, block.start(1)) + block[1]


class Pages(unittest.TestCase):
    def test_pages_print_what_they_say(self):
        for name in ("README.md", "docs/python.md", "docs/scale.md"):
            with self.subTest(name), tempfile.TemporaryDirectory() as place, contextlib.chdir(place):
                shutil.copytree(ROOT / "samples", "samples")
                space, count = {"__name__": "page"}, 0
                for block in blocks_of(ROOT / name):
                    said = io.StringIO()
                    with contextlib.redirect_stdout(said):
                        exec(compile(block, str(ROOT / name), "exec"), space)
                    self.assertEqual(said.getvalue().splitlines(), re.findall(r"^ *print\(.*\)  # (.*)$", block, re.M))
                    count += 1
                self.assertGreater(count, 0, f"{name} has no Python")


if __name__ == "__main__":
    unittest.main()
