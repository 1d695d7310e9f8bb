# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/library.md promises to people who build on thalweg: headers, samples, params, results."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).parents[2]

# Structs of public headers that refer to values of others, and why they may.
REFERRING = {
    "draw/comparison.hpp": "an argument, for the time of a call",
    "draw/map.hpp": "an argument, for the time of a call",
    "draw/wireframe.hpp": "an argument, for the time of a call",
    "io/network/write_network.hpp": "an argument, for the time of a call; names are literals",
    "io/raster/polygons.hpp": "an argument, for the time of a call",
    "io/raster/web_tiles.hpp": "an argument, for the time of a call",
    "studio/engine.hpp": "an argument, for the time of a call",
    "core/finding_kinds.hpp": "a row of a table of literals",
    "core/run/run.hpp": "what the caller asks to be handed back to its own callback",
    "network/import/import_lines.hpp": "an argument, for the time of a call",
    "io/mesh/tin.hpp": "names are literals",
    "io/mesh/points.hpp": "names are literals",
    "io/network/schema.hpp": "tables of literals",
    "recipe/stages.hpp": "a table of literals",
    "measure/relief/relief.hpp": "names are literals, and tables of them",
    "make/relief.hpp": "names are literals",
    "make/laws.hpp": "names are literals, and a row of a table of them",
    "recipe/recipe_fields.hpp": "a field of a recipe, for the time of a call",
    "recipe/recipe_keys.hpp": "a row of a table of literals",
    "recipe/recipe_files.hpp": "a row of a table of literals",
    "ensemble/draw_ensemble.hpp": "names are literals",
    "commands/convert.hpp": "names are literals",
    "export/export.hpp": "names are literals",
}
# A member: indented by one level, without parentheses, of a type that owns nothing.
MEMBER = re.compile(r"^    (?:[\w:<> ]+ const[*&]|[\w:<>]+[*&]|std::(?:string_view|span<[^;]*>|reference_wrapper<[^;]*>))"
                    r" \w+(?: = [^;()]*|\{[^;()]*\})?;")
SIZE_BY_DEFAULT = re.compile(r"^    double (?:cell_m|cell_size_m) = (?!0(?:\.0)?;)")


def lines_in_structs(text):
    """Lines of the structs of a header that are no argument's default: (name of the struct, line)."""
    struct = None
    for line in text.splitlines():
        opened = re.match(r"struct (\w+)[^;]*\{$", line)
        if opened:
            struct = opened[1]
        elif line.startswith("}"):
            struct = None
        elif struct:
            yield struct, line


def refers(text):
    """Whether a struct of a header refers to what it does not own."""
    return any(MEMBER.match(line) for _, line in lines_in_structs(text))


def sizes_by_default(text):
    """Params that take a cell of some size where none is given."""
    return [name for name, line in lines_in_structs(text) if name.endswith("Params") and SIZE_BY_DEFAULT.match(line)]


def faults_of_sample(text):
    """What is wrong with a sample's text."""
    if not re.match(r"(?://.*\n){2}//\n// Sample \d: ", text):
        yield "does not begin by saying what it shows"
    for header in re.findall(r"#include <(thalweg/[^>]*)>", text):
        if "/internal/" in header or not (ROOT / "lib" / header).is_file():
            yield f"<{header}> is no public header"
    marks = re.findall(r"^ *//! \[(\w+)\]$", text, re.MULTILINE)
    if not marks or marks[0::2] != marks[1::2] or len(set(marks)) * 2 != len(marks):
        yield "snippets do not begin and end"


class Library(unittest.TestCase):
    def setUp(self):
        self.page = (ROOT / "docs/library.md").read_text()
        self.samples = sorted(path.name for path in (ROOT / "samples").glob("*.cpp"))
        self.headers = {str(path.relative_to(ROOT / "lib/thalweg")): path.read_text()
                        for path in (ROOT / "lib/thalweg").rglob("*.hpp") if "internal" not in path.parts}

    def test_every_umbrella_header_is_named(self):
        umbrellas = {f"<thalweg/{path.name}>" for path in (ROOT / "lib/thalweg").glob("*.hpp")}
        rows = dict(re.findall(r"^\| (\w+) \| `(<[^`]*>)` \|", self.page, re.MULTILINE))
        self.assertEqual(set(rows.values()), umbrellas)
        self.assertEqual({module: f"<thalweg/{module}.hpp>" for module in rows}, rows)

    def test_every_sample_is_named_in_order_and_run(self):
        rows = re.findall(r"^\| \[(\S+\.cpp)\]\(\.\./samples/(\S+)\) \|", self.page, re.MULTILINE)
        self.assertEqual(rows, [(name, name) for name in self.samples])
        self.assertEqual([name.split("_")[0] for name in self.samples], [str(i + 1) for i in range(len(self.samples))])
        built = re.findall(r"^sample\(\w+ (\S+) ", (ROOT / "samples/CMakeLists.txt").read_text(), re.MULTILINE)
        self.assertEqual(built, self.samples)

    def test_the_readme_links_the_page(self):
        self.assertIn("(docs/library.md)", (ROOT / "README.md").read_text())

    def test_samples_use_public_headers(self):
        self.assertEqual([(name, fault) for name in self.samples
                          for fault in faults_of_sample((ROOT / "samples" / name).read_text())], [])

    def test_results_own_what_they_hold(self):
        self.assertEqual({name for name, text in self.headers.items() if refers(text)}, set(REFERRING))

    def test_no_params_take_a_cell_of_some_size(self):
        self.assertEqual([(name, struct) for name, text in self.headers.items() for struct in sizes_by_default(text)], [])


class Checks(unittest.TestCase):
    def test_references_are_found(self):
        for member in ("Raster<float> const& dem;", "Raster<float> const* dem = nullptr;", "std::string_view name;",
                       "std::span<double const> z;", "char const* name{};", "std::string_view name = {}; ///< a name"):
            self.assertTrue(refers(f"struct Out {{\n    {member}\n}};\n"), member)
        for member in ("Raster<float> dem;", "std::string const& name() const { return name_; }", "double z = 0.0;"):
            self.assertFalse(refers(f"struct Out {{\n    {member}\n}};\n"), member)

    def test_sizes_by_default_are_found(self):
        self.assertEqual(sizes_by_default("struct AParams {\n    double cell_m = 1.0; ///< [m]\n};\n"), ["AParams"])
        self.assertEqual(sizes_by_default("struct AParams {\n    double cell_m = 0.0; ///< 0: chosen\n};\n"), [])
        self.assertEqual(sizes_by_default("struct AParams {\n    Required<double> cell_m;\n};\n"), [])

    def test_faults_of_samples_are_found(self):
        good = "// a\n// b\n//\n// Sample 1: x.\n#include <thalweg/core.hpp>\n//! [x]\n//! [x]\n"
        self.assertEqual(list(faults_of_sample(good)), [])
        for bad in (good.replace("Sample 1: ", ""), good.replace("//! [x]\n", "", 1),
                    good.replace("core.hpp", "core/nothing.hpp"), good.replace("core.hpp", "flow/internal/priority_flood.hpp")):
            self.assertEqual(len(list(faults_of_sample(bad))), 1, bad)


if __name__ == "__main__":
    unittest.main()
