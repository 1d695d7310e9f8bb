# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the Python of README.md, docs/python.md and docs/scale.md: blocks marked python, in their order, in one namespace for each
page, in a folder with a copy of samples/. A line print(...)  # TEXT must print TEXT; THALWEG_RENEW=1 writes what it prints."""
import contextlib
import io
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/clients"))
import figures  # noqa: E402


def run_page(page):
    """The page with what its Python prints, and how many blocks it has. Tracebacks name lines of the page."""
    text, space, right, end, count = page.read_text(encoding="utf-8"), {"__name__": "page"}, "", 0, 0
    for block in re.finditer(r"^```python\n(.*?)^```", text, re.S | re.M):
        said, lines = io.StringIO(), "\n" * text.count("\n", 0, block.start(1))
        with contextlib.redirect_stdout(said):
            exec(compile(lines + block[1], str(page), "exec"), space)
        right += text[end:block.start(1)] + figures.with_prints(block[1], said.getvalue().splitlines())
        end, count = block.end(1), count + 1
    return right + text[end:], count


class Pages(unittest.TestCase):
    def test_pages_print_what_they_say(self):
        for name in ("README.md", "docs/python.md", "docs/scale.md"):
            with self.subTest(name), tempfile.TemporaryDirectory() as place, contextlib.chdir(place):
                shutil.copytree(ROOT / "samples", "samples")
                right, count = run_page(ROOT / name)
                self.assertGreater(count, 0, f"{name} has no Python")
                if os.environ.get("THALWEG_RENEW") == "1":
                    (ROOT / name).write_text(right, encoding="utf-8")
                self.assertEqual(figures.differences(name, (ROOT / name).read_text(encoding="utf-8"), right), [])


if __name__ == "__main__":
    unittest.main()
