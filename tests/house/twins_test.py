# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds lib, tools and tests to the pairs of equal places that have a reason, and twins.py to planted ones. Usage: twins_test.py"""
import pathlib
import unittest

import twins

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_PAIRS = 10

# Pairs that stay, each with its reason.
ALLOWED = {
    ("lib/thalweg/pipeline/make/drawn_terrain.hpp", "lib/thalweg/pipeline/make/terrain.hpp"):
        "a terrain has the fields of its drawn land; together() moves them",
    ("lib/thalweg/io/network/write_graph.cpp", "lib/thalweg/pipeline/report/page.cpp"):
        "XML 1.0 forbids control characters, HTML escapes apostrophes: two formats, five entities in common",
    ("tests/blend/paste_tin_test.cpp", "tests/geometry/cotangents_test.cpp"):
        "the two ways to halve a square, each in a lattice of its own module's",
    ("tests/flow/catchments/areas_test.cpp", "tests/flow/catchments/catchments_test.cpp"):
        "rivers by chance, with cells alone and with a land: rapidcheck draws inside the generator",
    ("tests/network/growth/forest/grow_forest_test.cpp", "tests/network/growth/forest/plant_forest_test.cpp"):
        "using declarations",
    ("tests/tools/commands/points_test.cpp", "tests/tools/commands/tin_test.cpp"):
        "a folder that make has left is what both commands begin with",
}

SIX = [f"step_{k}();" for k in range(6)]


def code(*lines):
    return "\n".join(lines) + "\n"


class Planted(unittest.TestCase):
    def test_nothing(self):
        self.assertEqual(twins.twins({}), [])
        self.assertEqual(twins.twins({"a.cpp": "", "b.cpp": "\n\n"}), [])

    def test_five_equal_lines_are_none(self):
        self.assertEqual(twins.twins({"a.cpp": code(*SIX[:5], "x();"), "b.cpp": code(*SIX[:5], "y();")}), [])

    def test_six_equal_lines(self):
        found = twins.twins({"a.cpp": code("x();", *SIX), "b.cpp": code(*SIX, "y();")})
        self.assertEqual(found, [("a.cpp", 2, "b.cpp", 1, 6)])

    def test_a_longer_run_is_one_pair(self):
        self.assertEqual(twins.twins({"a.cpp": code(*SIX, "z();"), "b.cpp": code(*SIX, "z();")}),
                         [("a.cpp", 1, "b.cpp", 1, 7)])

    def test_within_one_file(self):
        self.assertEqual(twins.twins({"a.cpp": code(*SIX, "x();", *SIX)}), [("a.cpp", 1, "a.cpp", 8, 6)])

    def test_three_places_are_three_pairs(self):
        self.assertEqual(len(twins.twins({name: code(*SIX) for name in ("a.cpp", "b.cpp", "c.cpp")})), 3)

    def test_white_space_comments_and_braces_do_not_hide_a_pair(self):
        spread = code(*(f"  {line}\n// {k}\n  }}\n" for k, line in enumerate(SIX)))
        self.assertEqual(twins.twins({"a.cpp": code(*SIX), "b.cpp": spread}), [("a.cpp", 1, "b.cpp", 1, 6)])

    def test_includes_licences_and_braces_are_no_code(self):
        head = code("// SPDX-License-Identifier: A", *(f"#include <a{k}>" for k in range(9)), *("}" for _ in range(9)))
        self.assertEqual(twins.twins({"a.cpp": head, "b.cpp": head}), [])


class House(unittest.TestCase):
    def test_every_pair_has_a_reason(self):
        found = twins.twins(twins.files_of(ROOT))
        self.assertEqual([pair for pair in found if (pair[0], pair[2]) not in ALLOWED], [])
        self.assertLessEqual(len(found), MOST_PAIRS)

    def test_every_reason_has_a_pair(self):
        self.assertEqual(set(ALLOWED) - {(pair[0], pair[2]) for pair in twins.twins(twins.files_of(ROOT))}, set())


if __name__ == "__main__":
    unittest.main()
