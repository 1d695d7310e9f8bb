# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the repository to rules.py, and rules.py to planted violations. Usage: rules_test.py"""
import pathlib
import tempfile
import unittest

import rules

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPDX = "// " + rules.SPDX[0] + "\n// " + rules.SPDX[1] + "\n"
NETWORK = "lib/thalweg/network/vectorise/trace.cpp"

# file, its text below the SPDX lines, what must be said of it
PLANTED = [
    ("lib/thalweg/core/grid.hpp", "#include <gdal.h>", "foreign <gdal.h> in a header"),
    ("lib/thalweg/core/raster.hpp", "#include <boost/graph/adjacency_list.hpp>", "in a header"),
    ("lib/thalweg/core/stream_network.hpp", "#include <boost/graph/graph_traits.hpp>", "in a header"),
    ("lib/thalweg/network/order/order.hpp", "#include <thalweg/core/stream_network_graph.hpp>", "belongs in a .cpp file"),
    ("lib/thalweg/core/run/run.cpp", "#include <thalweg/network/vectorise/vectorise.hpp>", "dependencies point one way"),
    ("lib/thalweg/io/raster/read_dem.cpp", "#include <thalweg/recipe/recipe.hpp>", "dependencies point one way"),
    ("lib/thalweg/io/gdal/access.cpp", "#include <thalweg/io/network/schema.hpp>", "io's folders include those before them"),
    ("lib/thalweg/io/gdal/internal/dataset.hpp", "#include <thalweg/io/crs/internal/crs.hpp>", "io's folders include those before them"),
    ("lib/thalweg/io/clouds/read.cpp", "#include <thalweg/io/crs/crs.hpp>", "io/clouds has no place in the order of io's folders"),
    ("lib/thalweg/geometry/crossings.cpp", "#include <gdal.h>", "does not belong to geometry"),
    ("lib/thalweg/serve/serve.hpp", "#include <boost/beast/http.hpp>", "in a header"),
    ("lib/thalweg/serve/serve.cpp", "#include <thalweg/io/raster/read_dem.hpp>", "dependencies point one way"),
    ("tools/commands/make.cpp", "#include <thalweg/network/order/internal/require_trees.hpp>", "is for the .cpp files of network alone"),
    ("lib/thalweg/network/order/order.hpp", "#include <thalweg/network/order/internal/require_trees.hpp>", "of network alone"),
    (NETWORK, "#include <CGAL/Arrangement_2.h>", "does not belong to network"),
    (NETWORK, "#include <thalweg/surface/dilation/dilation.hpp>", "stage modules meet in the program's"),
    (NETWORK, "  #  include <thalweg/measure/drainage/certificate.hpp>", "stage modules meet in the program's"),
    ("lib/thalweg/fractal/match_statistics.cpp", "#include <Eigen/Dense>", "does not belong to fractal"),
    (NETWORK, "#include <strange/library.hpp>", "foreign <strange/library.hpp>"),
    (NETWORK, '#include "thin.hpp"', "write <thalweg/...>"),
    ("tools/commands/make.cpp", '#include "help.hpp"', "FOLDER one of"),
    ("tools/terminal/progress.cpp", '#include "help/help.hpp"', "dependencies point one way"),
    (NETWORK, 'run.say("warning: too short");', "a warning is a finding"),
    ("qgis/thalweg_processing/a.py", 'if line.startswith("warning"):', "read findings, not words"),
    ("lib/thalweg/io/raster/polygons.cpp", "open_file(source, GDAL_OF_RASTER, what);", "OpenedHeights alone"),
    ("lib/thalweg/io/raster/read_dem.cpp", "band.GetMaskFlags();", "OpenedHeights alone"),
    (NETWORK, "#include <random>", "not the same everywhere"),
    (NETWORK, "#include <execution>", "not the same everywhere"),
    (NETWORK, "std::shuffle(a, b, c);", "not the same everywhere"),
    (NETWORK, "double a = std::pow(b, 2);", "libm"),
    (NETWORK, "double a = sin(b);", "libm"),
    (NETWORK, "double a = ::atan2(b, c);", "libm"),
    (NETWORK, "auto f = std::hypot;", "libm"),
    (NETWORK, "#include <cmath>\ndouble a = log(b);", "libm"),
    ("lib/thalweg/rivers/flow.cpp", "", "is no module"),
    ("tests/network/trace_test.cpp", "std::normal_distribution<double> d;", "distributions differ"),
    ("tests/core/b_test.cpp", '    rc::check("a law", [] {', "its verdict is not looked at"),
    (NETWORK, "namespace a {\n\nstruct B {\n};\n\n} // namespace a\nnamespace a {\nstruct B : C {",
     "a::B is also defined in " + NETWORK),
    (NETWORK, 'throw BadInput(where, "network.prune: too long");', "takes its function as an argument"),
    ("tools/commands/make.cpp", 'say("io.read_dem: x");', "takes its function as an argument"),
    ("lib/thalweg/make/rivers.cpp", 'throw BadInput("network.prune", "too long");', "names its own module"),
    (NETWORK, 'throw BadInput(\n    "network.prune", "too long");', "no header of network declares it"),
    (NETWORK, "refuse_if<BadInput>(a(b, ',') > 1'000, \"network.prune\", \"), too long\");", "no header of network declares it"),
    (NETWORK, 'require_in("network.prune", "a", a, Range::finite());', "no header of network declares it"),
    (NETWORK, 'require_same_grid(a, "b, c)", "network.prune", "d", "e");', "no header of network declares it"),
    ("lib/thalweg/io/raster/png.cpp", 'About const about{"io.write_png", path};', "no header of io declares it"),
    ("lib/thalweg/make/rivers.cpp", "#include <thalweg/report/report.hpp>", "dependencies point one way"),
    ("lib/thalweg/recipe/key.hpp", "#include <thalweg/make/make.hpp>", "dependencies point one way"),
    ("lib/thalweg/make/rivers.cpp", "void fill(Terrain& terrain, Run const& run);", "Terrain&: values that flow"),
    ("tools/commands/make.cpp", "void set(int key,\n         recipe::Recipe& recipe) {", "Recipe&: values that flow"),
    ("tests/core/a_test.cpp", "#include <thalweg/core/grid.cpp>", "a .cpp file is included"),
    ("samples/1.cpp", 'auto where = "/' + 'home/somebody/a.tif";', "a path of one machine"),
    ("docs/a.md", "see /" + "tmp/x", "a path of one machine"),
    ("docs/b.md", "see /" + "work", "a path of one machine"),
    ("cmake/a.cmake", "FetchContent_Declare(x)", "only Debian packages"),
    ("scripts/a.sh", "pip install x", "only Debian packages"),
    ("scripts/b.sh", "curl -O x", "only Debian packages"),
    ("web/package-lock.json", '"resolved": "https://mirror.example/x.tgz"', "a foreign registry"),
    ("web/src/report.html", "see /" + "home/somebody", "a path of one machine"),
    ("web/dist/other.html", "see /" + "home/somebody", "a path of one machine"),
    ("CMakeLists.txt", "add_compile_options(-march=native)", "changes bits"),
]
# What looks like a violation and is none.
INNOCENT = [
    ("lib/thalweg/core/stream_network_graph.hpp", "#include <boost/graph/graph_traits.hpp>"),
    (NETWORK, "#include <thalweg/core/stream_network_graph.hpp>"),
    ("lib/thalweg/core/run/run.hpp", "if (log) {\n    log(line);\n}"),
    (NETWORK, "double a = exact::pow(b, 2) + thalweg::exact::sin(c); // sin(x) of old"),
    (NETWORK, "#include <thalweg/network/order/internal/require_trees.hpp>"),
    (NETWORK, "#include <boost/graph/depth_first_search.hpp>\n#include <fmt/format.h>\n#include <cmath>\n#include <sys/stat.h>"),
    (NETWORK, "#include <thalweg/geometry/crossings.hpp>\n#include <thalweg/core/grid.hpp>"),
    (NETWORK, "double lesin(double); double a = lesin(1) + o.log(2) + std::sqrt(2);"),
    (NETWORK, "namespace a {\nstruct B;\nstruct B {\n};\nnamespace {\nstruct B {\n};\n} // namespace\n} // namespace a\n"
              "namespace c {\nstruct B {"),
    ("tests/core/b_test.cpp", '    ASSERT_TRUE(rc::check("a law", [] {'),
    ("lib/thalweg/geometry/crossings.cpp", "#include <CGAL/Arrangement_2.h>"),
    ("lib/thalweg/solver/spectral/fft.cpp", "#include <unsupported/Eigen/FFT>"),
    ("lib/thalweg/make/terrain.cpp", "#include <thalweg/surface/dilation/dilation.hpp>\n#include <thalweg/network/vectorise/vectorise.hpp>"),
    ("lib/thalweg/report/report.cpp", "#include <thalweg/recipe/recipe.hpp>\n"
     "#include <thalweg/make/file_values.hpp>\n#include <thalweg/report/pictures.hpp>"),
    ("lib/thalweg/make/rivers.cpp", "Terrain f(Terrain terrain, Recipe const& recipe, Plan&& plan);"),
    ("lib/thalweg/recipe/recipe.hpp", "void set_key(Recipe& recipe, std::string const& assignment);"),
    ("lib/thalweg/io/mesh/read_tin.cpp", "#include <thalweg/io/raster/raster_files.hpp>\n#include <thalweg/io/mesh/internal/las_ply.hpp>"),
    ("lib/thalweg/draw/map.cpp", "#include <cairo.h>\ndouble a = std::cos(b);"),
    (NETWORK, 'throw std::logic_error("network.prune: too long"); // "io.read: x"'),
    ("lib/thalweg/network/a.hpp", 'class Pruned;\nvoid prune(int a);\nrefuse_if<BadInput>(b, "network.prune", "c");\n'
     'throw BadInput("network.Pruned", "c"); throw BadInput(where, "network.none"); throw BadInput(f("network.none"), "d");'),
    ("lib/thalweg/make/rivers.cpp", 'text("network.heights = file"); throw BadInput("[network.dla]: none");'),
    ("tests/network/a_test.cpp", "#include <random>\n#include <gdal.h>\nstd::mt19937_64 g; double p = std::pow(2, 3);"),
    ("tools/commands/make.cpp", '#include <CLI/CLI.hpp>\n#include "commands/commands.hpp"\n#include <unistd.h>'),
    ("tools/main.cpp", '#include "commands/commands.hpp"\n#include "terminal/progress.hpp"'),
    ("tools/help/roff.cpp", '#include "help/roff.hpp"'),
    ("docs/a.md", "${ROOT}/work and file/home and https://x.example/tmp.html"),
    ("docs/a.md", "pip install --no-index x"),
    ("web/package-lock.json", '"resolved": "https://registry.npmjs.org/x.tgz"'),
    ("web/dist/report.html", 'a="/' + 'home/";b="curl -O x and pip install x"'),
]


class Rules(unittest.TestCase):
    def said_of(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            comments = SPDX if name.endswith((".cpp", ".hpp")) else SPDX.replace("//", "#")
            path.write_text((comments if not name.endswith((".md", ".json")) else "") + text + "\n")
            return rules.violations(folder)

    def test_every_planted_violation_is_found(self):
        for name, text, expected in PLANTED:
            with self.subTest(name=name, text=text):
                said = self.said_of(name, text)
                self.assertEqual(len(said), 1, said)
                self.assertIn(expected, said[0])
                self.assertTrue(said[0].startswith(name + ":"), said)

    def test_what_is_allowed_is_left_alone(self):
        for name, text in INNOCENT:
            with self.subTest(name=name, text=text):
                self.assertEqual(self.said_of(name, text), [])

    def test_an_umbrella_with_a_gap_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "lib/thalweg")
            (place / "core/internal").mkdir(parents=True)
            for name in ("core/grid.hpp", "core/internal/own.hpp"):
                (place / name).write_text(SPDX)
            (place / "core.hpp").write_text(SPDX)
            said = rules.violations(folder)
            self.assertEqual(len(said), 1, said)
            self.assertIn("lib/thalweg/core.hpp:1: thalweg/core/grid.hpp", said[0])
            (place / "core.hpp").write_text(SPDX + "#include <thalweg/core/grid.hpp>\n")
            self.assertEqual(rules.violations(folder), [])

    def test_missing_spdx_lines_are_found(self):
        for name, text in [("a.cpp", "int main() {}"), ("scripts/x", "#!/bin/sh"), ("b.hpp", SPDX.splitlines()[0]), ("c.py", "")]:
            with self.subTest(name=name), tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, name)
                path.parent.mkdir(exist_ok=True)
                path.write_text(text + "\n")
                self.assertEqual(rules.violations(folder), [f"{name}:1: the two SPDX lines are missing"])

    def test_the_repository_keeps_every_rule(self):
        names = rules.files_of(ROOT)
        self.assertIn("lib/thalweg/core/raster.hpp", names)
        self.assertEqual(rules.violations(ROOT), [])


if __name__ == "__main__":
    unittest.main()
