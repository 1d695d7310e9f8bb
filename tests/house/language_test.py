# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds what users read to language.py, and language.py to planted phrases. Usage: language_test.py"""
import pathlib
import unittest

import language
import rules

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESSAGE = "lib/thalweg/io/raster/read_dem.cpp"
HEADER = "lib/thalweg/io/raster/read_dem.hpp"

# file, its text, line and beginning of what must be said of it
PLANTED = [
    ("README.md", "Heights of paper 000\nrun uphill.", 1, "'paper 000'"),
    ("docs/decisions/0003-pruning.md", "After paper 001.", 1, "'paper 001'"),
    ("docs/a.md", "One line.\n\nas the\npaper has it.", 3, "'the paper'"),
    ("docs/a.md", "One line,\nthe same as that\n  which was there.", 2, "'that which'"),
    ("docs/a.md", "The figures by which experts judge.", 1, "'figures by which'"),
    ("CHANGELOG.md", "* Each is found anew.", 1, "'anew'"),
    ("samples/a.toml", "seed = 7\n# points by chance", 2, "'by chance'"),
    ("scripts/demo", "cat <<END\nmade land\nEND", 2, "'made land'"),
    (MESSAGE, 'x();\nthrow BadInput(path + " is no DEM");', 2, "'is no '"),
    (MESSAGE, 'f("a number "\n  "is wanted, not {}");', 1, "'is wanted'"),
    (MESSAGE, 'f(R"(whence\nit came)");', 1, "'whence'"),
    (MESSAGE, 'f("a\\n' + 'first; the rest is told");', 1, "'is told'"),
    ("tools/commands/make.cpp", 'app.add_flag("-a", a, "Files of others stay.");', 1, "'Files of others'"),
    ("tools/commands/make.cpp", 'app.add_flag("-a", a, "Make it so many times as high.");', 1, "'so many times'"),
    ("tools/commands/draw.cpp", 'app.add_option("S", s, "A folder that make left.");', 1, "'make left'"),
    (HEADER, "int a; // whence\n/// Gives a file, that\n/// which was there.\nint b;", 2, "'that which'"),
    (HEADER, "int a; ///< at places by chance", 1, "'by chance'"),
    ("web/src/a.js", "const a = `nearer than ${real} land`;\nconst b = 'beside real land';", 2, "'real land'"),
]
# What users do not read, and what only looks like a phrase that is ruled out.
INNOCENT = [
    (MESSAGE, "// that which was told; anew, whence\nint is_no = 1; /* paper 000 */"),
    (MESSAGE, '#include "paper 000.hpp"\nchar const a = \'"\'; // "whence"'),
    (MESSAGE, 'f("there is no folder {}"); f("arc 3 is no longer than a cell"); f("its is", " no DEM");'),
    (MESSAGE, 'f("the rivers lie so close that they cannot be told apart");'),
    ("tests/io/read_dem_test.cpp", 'EXPECT_EQ(a, "found anew");'),
    (HEADER, "// whence\nint anew; /// plain"),
    ("lib/thalweg/io/internal/a.hpp", "/// whence"),
    ("docs/a.md", 'The key `surface.base = "paper"` and the land around paper mills; has its own.'),
    ("docs/decisions/0001-a.md", "Found anew by chance, as the paper has it."),
    ("web/src/a.js", "// whence\nconst anew = 'again'; // 'whence'"),
    ("samples/1_valley.cpp", '// by chance'),
]


def said_of(name, text):
    return list(language.faults_of(name, text)) if language.is_read_by_users(name) else []


class Language(unittest.TestCase):
    def test_every_planted_phrase_is_found(self):
        for name, text, line, words in PLANTED:
            with self.subTest(name=name, text=text):
                said = said_of(name, text)
                self.assertTrue(any(n == line and w.startswith(words) for n, w in said), said)

    def test_what_users_do_not_read_is_left_alone(self):
        for name, text in INNOCENT:
            with self.subTest(name=name, text=text):
                self.assertEqual(said_of(name, text), [])

    def test_every_phrase_has_a_text_that_it_finds(self):
        """A phrase that nothing matches would be a rule that cannot fail."""
        texts = " ".join([
            "paper 003", "the papers", "what is none", "hence", "anew", "so many cells", "as nature has it, here", "out come", "by chance", "made land",
            "real lands", "was told", "nobody", "this is no tree", "are none of", "programs of others", "other people's", "is wanted",
            "make left", "brought into", "passed over", "taken for", "in the words of", "by which experts", "says no format",
            "keep their water", "shall", "upon"])
        for pattern, _ in language.COMPILED:
            with self.subTest(pattern=pattern.pattern):
                self.assertRegex(texts, pattern)

    def test_users_read_none_of_them(self):
        names = rules.files_of(ROOT)
        self.assertGreater(sum(map(language.is_read_by_users, names)), 400)
        self.assertEqual(language.violations(ROOT, names), [])


if __name__ == "__main__":
    unittest.main()
