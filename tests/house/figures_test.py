#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What compares the figures of docs/ with runs (tests/clients/figures.py) sees each wrong one, and mends it."""
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/clients"))
import figures  # noqa: E402

PRINTED = """grow       6 trees of 689 particles                              0.2 s
lakes      3 lakes                                               0.0 s
fill       1024x1024, in equilibrium with 15817 cells of rivers  0.7 s
compare    dem.tif: r 0.984 (cone 0.979), above rivers 0.78, same reach 79.9 %  3.9 s
check      38 checks                                               ok
437 arcs, 466 nodes
"""
PAGE = """# A page

```sh
$ thalweg recipe
$ thalweg make -o out/a
```

    grow       6 trees of 689 particles                              0.3 s
    lakes      3 lakes                                               0.0 s
    fill       1024x1024, in equilibrium with 15817 cells of rivers  1.9 s
    ...
    check      38 checks                                               ok

It compares:

<!-- printed by thalweg make -o out/a -->

    compare    dem.tif: r 0.984 (cone 0.979), ...

```sh
$ thalweg make --set a=b  # exit 2
error: a = b has no effect
```

The river falls -3.50 m over 15 817
cells, a share of .98.

| streams | 94 % | 96 % |
|---|---|---|
<!-- figures
The river falls {} m over {} cells, a share of {}. <- report("out/a").fall_m, found(r"with (\\d+) cells", said("thalweg make -o out/a")), 0.9804
| streams | {} % | {} % | <- *(100 * share for share in (0.944, 0.956))
-->

    cmake is indented too
"""


def right(page, printed=PRINTED):
    said = {"thalweg make -o out/a": printed, "thalweg make --set a=b": "error: a = b has no effect\n"}.__getitem__
    with tempfile.TemporaryDirectory() as place:
        (pathlib.Path(place) / "out/a").mkdir(parents=True)
        (pathlib.Path(place) / "out/a/report.json").write_text('{"fall_m": -3.501}')
        return figures.with_figures(figures.with_blocks(page, said), figures.values_of(place, said))


class Pages(unittest.TestCase):
    def test_a_right_page_stays(self):
        self.assertTrue(figures.quotes(PAGE))
        self.assertEqual(figures.commands_of(PAGE), ["thalweg recipe", "thalweg make -o out/a", "thalweg make --set a=b  # exit 2"])
        self.assertEqual(right(PAGE), PAGE)
        self.assertEqual(figures.differences("page.md", PAGE, PAGE), [])

    def test_each_wrong_figure_is_seen_and_mended(self):
        wrong = [("689 part", "690 part"), ("with 15817", "with 15711"), ("38 checks", "36 checks"), ("    lakes      3 lakes" + 47 * " " + "0.0 s\n", ""),
                 ("(cone 0.979)", "(cone 0.978)"), ("no effect", "an effect"), ("-3.50 m", "-3.51 m"), ("15 817\n", "15 711\n"),
                 ("of .98", "of .97"), ("94 %", "95 %"), ("96 %", "9 %")]
        for old, new in wrong:
            with self.subTest(old):
                page = PAGE.replace(old, new)
                self.assertNotEqual(page, PAGE)
                self.assertEqual(re.sub(r"\d\.\d s$", "", right(page), flags=re.M), re.sub(r"\d\.\d s$", "", PAGE, flags=re.M))
                self.assertEqual(len(figures.differences("page.md", page, right(page))), 1)

    def test_lines_come_go_and_change(self):
        printed = PRINTED.replace("lakes ", "ponds ").replace("check ", "proof  1 proof\ncheck ").replace("15817 cells of rivers ", "9817 cells of rivers  ")
        page = right(PAGE, printed)
        self.assertIn("    ponds      3 ponds", page)
        self.assertNotIn("lakes  ", page)
        self.assertNotIn("proof", page)  # stands between "..." and check
        self.assertIn("    fill       1024x1024, in equilibrium with 9817 cells of rivers   1.9 s\n", page)  # a time stays, in its column
        self.assertIn("over 9 817\ncells", page)
        self.assertEqual(right(page, printed), page)

    def test_what_cannot_be_found_is_a_fault(self):
        for old, new in (("    check  ", "    chick  "), ("    compare ", "    compares "), ("    compare ", "compare "), ("The river falls", "A river falls"),
                         ("report(\"out/a\").fall_m, ", ""), (" <- *", " = "), ('r"with', 'r"without')):
            with self.subTest(new), self.assertRaises(figures.Fault):
                right(PAGE.replace(old, new, 1))
        with self.assertRaises(AttributeError):
            right(PAGE.replace(".fall_m", ".rise_m"))

    def test_numbers_keep_their_form(self):
        for old, value, new in (("15 711", 15841.0, "15 841"), ("999", 12345, "12 345"), ("252420", 252421, "252421"), (".984", 0.9837, ".984"),
                                (".984", 1.02, "1.020"), ("0.5", 0.449, "0.4"), ("−3", -4.2, "−4"), ("12 345", 999, "999")):
            with self.subTest(old):
                self.assertEqual(figures.as_quoted(old, value), new)

    def test_python_prints(self):
        block = "a = 1\nprint(a)  # 1\nif a:\n    print(-a)  # -1\n"
        self.assertEqual(figures.with_prints(block, ["1", "-1"]), block)
        self.assertEqual(figures.with_prints(block, ["2", "-2"]), block.replace("# 1", "# 2").replace("# -1", "# -2"))
        self.assertRaises(figures.Fault, figures.with_prints, block, ["1"])


if __name__ == "__main__":
    unittest.main()
