# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""make() takes what `thalweg make` takes, and arrays and tables besides; a Terrain is plain values."""
import contextlib
import io
import json
import os
import pathlib
import re
import tempfile
import unittest
import warnings

import geopandas
import matplotlib
import matplotlib.pyplot
import numpy as np
import rioxarray
import shapely.geometry

import thalweg
from thalweg import BadInput, BadParameter, Raster

ROOT = pathlib.Path(__file__).resolve().parents[2]

matplotlib.use("Agg")
SAMPLES = pathlib.Path(__file__).parents[2] / "samples"
LINES = SAMPLES / "walker_nhdplus.gpkg"
DEM = SAMPLES / "jacksboro_utm16.tif"
SMALL = {"grid": {"width": 96, "height": 80}}
DILATED = {**SMALL, "network": {"slope": 0.02, "dla": {"particles": 600}, "prune": 5}, "surface": {"method": "dilate"}}


def same(one, other):
    """Whether two terrains have the same grid and heights, bit for bit."""
    return one.grid == other.grid and one.dem.values.tobytes() == other.dem.values.tobytes()


class Recipes(unittest.TestCase):
    def test_a_recipe_is_a_dict_text_path_or_keywords(self):
        expected = thalweg.make(DILATED, seed=8)
        text = ('seed = 8\n[grid]\nwidth = 96\nheight = 80\n[network]\nslope = 0.02\nprune = 5\n'
                '[network.dla]\nparticles = 600\n[surface]\nmethod = "dilate"\n')
        dotted = {"seed": 8, "grid.width": 96, "grid.height": np.int64(80), "network.slope": np.float64(0.02),
                  "network.prune": 5, "network": {"dla": {"particles": 600, "radius": None}}, "surface": {},
                  "surface.method": "dilate"}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "recipe.toml"
            path.write_text(text)
            for recipe, keys in [(text, {}), (path, {}), (str(path), {}), (dotted, {}), ({**DILATED, "seed": 3}, {"seed": 8}),
                                 (text.replace("96", "64"), {"grid": {"width": 96}}),
                                 (path, {"grid.width": 96, "seed": 8}), (expected.recipe, {}), (expected.recipe_toml, {})]:
                with self.subTest(recipe=recipe, keys=keys):
                    self.assertTrue(same(thalweg.make(recipe, **keys), expected))
        self.assertFalse(same(thalweg.make(DILATED, seed=9), expected))

    def test_a_preset_goes_behind_what_is_set(self):
        preset = thalweg.recipe.presets()[0]
        keys = {key.path: key.text for key in preset.keys}
        by_hand = {path: text if path == "surface.uplift_pattern" else float(text) for path, text in keys.items()}
        self.assertTrue(same(thalweg.make(SMALL, preset=preset.name), thalweg.make(SMALL, **by_hand)))
        steep = thalweg.make(SMALL, preset="hills", **{"surface.mean_slope": 20}).recipe["surface"]
        self.assertEqual((steep["mean_slope"], steep["lake_share"]), (20, 0.1))
        self.assertEqual(thalweg.forecast(SMALL, preset="hills")["cells"], 96 * 80)
        self.assertEqual(next(thalweg.ensemble(SMALL, 1, preset="hills")).terrain.recipe["surface"]["lake_share"], 0.1)
        with self.assertRaisesRegex(BadParameter, "Did you mean 'hills'"):
            thalweg.make(SMALL, preset="hill")
        with self.assertRaisesRegex(BadParameter, "of equilibrium terrain"):
            thalweg.make(DILATED, preset="hills")

    def test_without_a_recipe_there_are_rivers_that_suit_the_grid(self):
        expected = thalweg.make(SMALL)
        self.assertEqual(expected.dem.shape, (80, 96))
        self.assertTrue(same(thalweg.make(grid={"width": 96, "height": 80}), expected))
        self.assertTrue(same(thalweg.make(None, **{"grid.width": 96, "grid.height": 80}), expected))
        self.assertTrue(same(thalweg.make(expected.recipe), expected))
        self.assertEqual(expected.recipe["network"]["source"], "forest")
        cluster = thalweg.make(SMALL, network={"dla": {"particles": 600}, "prune": 5})
        self.assertEqual(cluster.recipe["network"]["source"], "dla")

    def test_all_faults_are_named_at_once(self):
        with self.assertRaises(BadParameter) as refused:
            thalweg.make({"grid": {"widht": 9, "height": "many"}, "network": {"heights": "nix"}, "surfase": {}})
        for word in ("grid.widht", "grid.width", "grid.height: an integer", "network.heights", "'surfase"):
            self.assertIn(word, str(refused.exception))
        with self.assertRaisesRegex(BadParameter, "grid.widht"):
            thalweg.make(**{"grid.widht": 9})
        with self.assertRaisesRegex(BadParameter, "surface.noise"):
            thalweg.make(SMALL, surface={"noise": 3})
        with self.assertRaisesRegex(BadInput, "no_such_file.toml does not exist"):
            thalweg.make("no_such_file.toml")

    def test_what_is_no_recipe_or_value_is_refused_in_words(self):
        with self.assertRaisesRegex(TypeError, "make takes a recipe .* not set"):
            thalweg.make({1})
        for value in ({1}, 1j, np.zeros(2, complex)):
            with self.assertRaisesRegex(TypeError, "grid.origin: takes text, a number"):
                thalweg.make({"grid": {"origin": value}})
        with self.assertRaisesRegex(BadParameter, "two numbers"):  # words are values of other keys
            thalweg.make({"grid": {"origin": ["a"]}})
        with self.assertRaisesRegex(BadParameter, "detail = {}: over another recipe, name a key of the section"):
            thalweg.make(SMALL, detail={})

    def test_text_of_any_kind_is_a_value(self):
        for title in ('a "b" \\ c', "two\nlines\t\x7f\x01", "Äöü 水系", "[x]", "true", "7"):
            recipe = {**DILATED, "output": {"title": title}}
            self.assertEqual(thalweg.make(recipe).recipe["output"]["title"], title)
            self.assertEqual(thalweg.make(SMALL, output={"title": title}).recipe["output"]["title"], title)

    def test_patches_are_a_list(self):
        relief = Raster(np.add.outer(np.arange(20.0), np.arange(20.0)).astype(np.float32), cell_m=30.0, crs="EPSG:32631")
        recipe = thalweg.make({**DILATED, "patch": [{"source": relief, "feather": 2}, {"source": DEM, "gain": 0.5}]}).recipe
        self.assertEqual([patch["feather"] for patch in recipe["patch"]], [2.0, 0.0])
        self.assertEqual(recipe["patch"][1]["gain"], 0.5)

    def test_names_of_files_start_from_the_working_folder(self):
        expected = thalweg.make(SAMPLES / "lines.toml", grid={"cell": 120})
        recipe = {"grid": {"cell": 120}, "network": {"source": "lines", "slope": 0.01, "lines": {"path": LINES.name}},
                  "surface": {"method": "dilate", "increment": "rise_fall", "metric": "euclid", "relief": 350}}
        with contextlib.chdir(SAMPLES):
            here = thalweg.make(recipe)
        self.assertTrue(same(here, expected))
        self.assertTrue(same(thalweg.make(expected.recipe), expected))

    def test_forecast(self):
        found = thalweg.forecast(DILATED, seed=3)
        self.assertEqual(set(found), {"stages", "grid", "cells", "memory_bytes", "seconds", "findings"})
        self.assertIn("grow", found["stages"])
        self.assertGreater(found["memory_bytes"], 0)
        self.assertEqual((found["grid"].width, found["cells"]), (96, 96 * 80))
        with self.assertRaises(BadParameter):
            thalweg.forecast({"network": {"x": 1}})


class Inputs(unittest.TestCase):
    def test_columns_of_the_user_come_back(self):
        table = geopandas.read_file(LINES)
        arcs = thalweg.make(LINES, grid={"cell": 120}).to_geodataframe()
        known = set(arcs.columns) & set(table.columns) - {"geometry"}
        self.assertGreater(len(known), 3, sorted(arcs.columns))

    def test_a_table_of_lines_is_a_river_file(self):
        expected = thalweg.make(LINES, grid={"cell": 120})
        table = geopandas.read_file(LINES)
        terrain = thalweg.make(table, grid={"cell": 120})
        self.assertTrue(same(terrain, expected))
        self.assertTrue(same(thalweg.make({"grid": {"cell": 120}, "network": {"source": "lines", "lines": {"path": table}},
                                           "surface": {}}), expected))
        self.assertEqual(len(thalweg.make(table.geometry, grid={"cell": 120}).network.planform.from_nodes),
                         len(terrain.network.planform.from_nodes))
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("inputs", str(os.listdir(folder) + terrain.write(folder + "/out")))
            kept = os.listdir(folder + "/out/inputs")
            self.assertEqual(kept, ["rivers.gpkg"])

    def test_temporary_files_go_with_the_terrain(self):
        terrain = thalweg.make(geopandas.read_file(LINES), grid={"cell": 240})
        path = terrain.recipe["network"]["lines"]["path"]
        self.assertTrue(os.path.exists(path))
        self.assertTrue(same(thalweg.make(terrain.recipe), terrain))
        del terrain
        self.assertFalse(os.path.exists(os.path.dirname(path)))

    def test_a_table_without_rivers_is_refused_in_words(self):
        point = shapely.geometry.Point(500000, 4000000)
        line = shapely.geometry.LineString([(500000, 4000000), (501000, 4000000)])
        for geometry, crs, words in [([], 32610, "rivers: the table is empty"), ([line], None, "rivers: the table has no CRS"),
                                     ([point], 32610, "rivers: no lines in the table, but Point"),
                                     ([None], 32610, "rivers: no lines in the table, but no geometry")]:
            with self.subTest(words), self.assertRaisesRegex(BadInput, words):
                thalweg.make(geopandas.GeoDataFrame(geometry=geometry, crs=crs))

    def test_an_array_is_a_dem(self):
        expected = thalweg.make(DEM)
        dem = thalweg.io.read_dem(str(DEM))
        np.testing.assert_array_equal(expected.dem, dem)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for given in (dem, dem.to_xarray(), rioxarray.open_rasterio(DEM, masked=True).astype(np.float32), DEM, str(DEM)):
                self.assertTrue(same(thalweg.make(given), expected))
        part = Raster(dem[:40, :50].copy(), cell_m=dem.cell_m, west=dem.grid.west, north=dem.grid.north, crs=dem.crs)
        of_key = thalweg.make({"surface": {"method": "raster", "source": part}})
        np.testing.assert_array_equal(of_key.dem, part)
        plain = thalweg.make(part.array())
        np.testing.assert_array_equal(plain.dem, part)
        self.assertEqual(plain.dem.cell_m, 1.0)
        with self.assertWarnsRegex(thalweg.ConversionWarning, "dem: float64 converted to float32") as said:
            thalweg.make(part.array().astype(np.float64))
        self.assertEqual(said.filename, __file__)

    def test_a_dem_without_rivers(self):
        terrain = thalweg.make(DEM)
        self.assertEqual((terrain.has_dem, terrain.has_network), (True, False))
        for name in ("network", "orders", "areas"):
            with self.assertRaisesRegex(thalweg.BadInput, "the terrain has no rivers: its recipe has no .network."):
                getattr(terrain, name)
        for take in (terrain.to_networkx, terrain.to_geodataframe):
            with self.assertRaisesRegex(BadInput, "the terrain has no rivers"):
                take()
        self.assertNotIn("arcs", repr(terrain))


class Values(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.terrain = thalweg.make(DILATED)

    def test_its_parts(self):
        terrain = self.terrain
        self.assertEqual(terrain.dem.shape, (80, 96))
        self.assertEqual(terrain.dem.dtype, np.float32)
        self.assertEqual(terrain.grid, terrain.dem.grid)
        self.assertEqual(terrain.crs, "EPSG:32631")
        arcs = terrain.network.planform.arc_count
        self.assertGreater(arcs, 0)
        self.assertEqual(len(terrain.orders.strahler), arcs)
        self.assertEqual(len(terrain.areas.us_area_m2), arcs)
        self.assertIsNotNone(terrain.flow)
        self.assertIsNotNone(terrain.catchments)
        self.assertIsNone(terrain.tin)
        self.assertIsNone(terrain.ridges)
        self.assertIs(terrain.dem, terrain.dem)

    def test_reports_are_plain_values(self):
        terrain = self.terrain
        self.assertTrue(terrain.passed)
        self.assertEqual(set(terrain.checks[0]), {"name", "value", "limit", "ok", "bound"})
        for finding in terrain.findings:
            self.assertEqual(set(finding), {"kind", "severity", "feature", "where", "amount", "unit", "text", "remedy", "key", "layer",
                                            "numbers"})
        self.assertEqual([check["name"] for check in terrain.report["checks"]], [check["name"] for check in terrain.checks])
        self.assertEqual(terrain.report["network"]["arcs"], terrain.network.planform.arc_count)
        self.assertEqual([(finding["kind"], finding["text"]) for finding in terrain.findings],
                         [(finding["kind"], finding["text"]) for finding in terrain.report["findings"]])
        self.assertEqual(terrain.recipe["surface"]["method"], "dilate")
        self.assertEqual(list(terrain.timings), list(terrain.report["timings_s"]))
        json.dumps([terrain.report, terrain.recipe, terrain.timings, terrain.checks])

    def test_rivers_alone(self):
        terrain = thalweg.make({key: DILATED[key] for key in ("grid", "network")})
        self.assertEqual((terrain.has_dem, terrain.has_network), (False, True))
        for name in ("dem", "flow"):
            with self.assertRaisesRegex(thalweg.BadInput, "its recipe asks for rivers alone"):
                getattr(terrain, name)
        self.assertGreater(len(terrain.to_geodataframe()), 0)
        with self.assertRaisesRegex(BadInput, "the terrain has no DEM"):
            terrain.to_xarray()
        self.assertNotIn("<img", terrain._repr_html_())
        self.assertEqual(len(terrain.plot().collections), 1)
        matplotlib.pyplot.close("all")

    def test_tin_and_ridges(self):
        recipe = {**DILATED, "surface": {"method": "tin"}, "skeleton": {"ridges": "voronoi"}}
        terrain = thalweg.make(recipe)
        vertices, triangles = terrain.tin.vertices, terrain.tin.triangles
        self.assertEqual((vertices.shape[1], triangles.shape[1]), (3, 3))
        self.assertLess(triangles.max(), len(vertices))
        self.assertGreater(len(terrain.ridges.lines), 0)

    def test_warnings_are_warned_of(self):
        text = (ROOT / "tests/zero_height.hpp").read_text("utf-8")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "r.geojson"
            path.write_text(re.search(r'R"\((.*)\)";', text, re.DOTALL)[1], "utf-8")
            recipe = {"grid": {"cell": 50}, "network": {"source": "lines", "lines": {"path": path}}, "surface": {}}
            with self.assertWarns(thalweg.TerrainWarning) as caught:
                terrain = thalweg.make(recipe)
            self.assertEqual(caught.filename, __file__)
            warned = [(str(one.message), one.message.finding["kind"]) for one in caught.warnings]
            self.assertEqual([kind for _, kind in warned][:2], ["placeholder_heights", "filled_heights"])
            self.assertTrue(warned[0][0].startswith("heights of 0 in r.geojson count as missing (vertices: 1; "), warned)
            found = [finding for finding in terrain.report["findings"] if finding["severity"] == "warning"]
            self.assertEqual([thalweg._show.in_python(". ".join((finding["text"], finding["remedy"]))) for finding in found],
                             [words for words, _ in warned])
            with self.assertWarns(thalweg.TerrainWarning) as caught:
                planned = thalweg.forecast(recipe)
            self.assertEqual([one.message.finding["kind"] for one in caught.warnings], ["placeholder_heights", "filled_heights"])
            self.assertEqual([finding["kind"] for finding in planned["findings"]][:2], ["placeholder_heights", "filled_heights"])

    def test_the_folder_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            names = self.terrain.write(out)
            self.assertLessEqual({"dem.tif", "network.gpkg", "report.json", "recipe.toml"}, set(names))
            np.testing.assert_array_equal(thalweg.io.read_dem(str(out / "dem.tif")), self.terrain.dem)
            with self.assertRaises(BadInput):
                self.terrain.write(out)
            self.terrain.write(out, overwrite=True)
            stages = []
            with self.assertRaisesRegex(BadInput, "out is not empty"):
                thalweg.make(DILATED, output=out, progress=lambda share, stage: stages.append(stage))
            self.assertEqual(stages, [])
            self.assertTrue(same(thalweg.make(DILATED, output=str(out), overwrite=True), self.terrain))
            again = thalweg.make(DILATED, output=pathlib.Path(folder) / "new")
            self.assertEqual((pathlib.Path(folder) / "new/dem.tif").read_bytes(), (out / "dem.tif").read_bytes())
            self.assertTrue(same(again, self.terrain))

    def test_rioxarray_reads_the_dem(self):
        array = self.terrain.to_xarray()
        self.assertEqual((array.name, array.rio.crs.to_epsg()), ("dem", 32631))
        self.assertEqual(array.rio.bounds(), self.terrain.dem.bounds)

    def test_a_notebook_shows_it(self):
        page = self.terrain._repr_html_()
        self.assertIn("data:image/jpeg;base64,/9j/", page)
        self.assertLess(len(page), 300_000)
        for words in ("96 × 80 cells of 30 m", "relief", f"{self.terrain.network.planform.arc_count} arcs", "checks ok"):
            self.assertIn(words, page)
            self.assertIn(words, repr(self.terrain))

    def test_plot_draws_rivers_wider_by_order(self):
        axes = self.terrain.plot()
        west, south, east, north = self.terrain.dem.bounds
        self.assertEqual((axes.get_xlim(), axes.get_ylim()), ((west, east), (south, north)))
        rivers = axes.collections[0]
        self.assertEqual(len(rivers.get_paths()), self.terrain.network.planform.arc_count)
        np.testing.assert_allclose(rivers.get_linewidths(), 0.4 + 0.5 * np.asarray(self.terrain.orders.strahler))
        self.assertIs(self.terrain.plot(axes), axes)
        matplotlib.pyplot.close("all")


class Progress(unittest.TestCase):
    def test_a_function_sees_every_stage(self):
        seen = []
        terrain = thalweg.make(DILATED, progress=lambda share, stage: seen.append((share, stage)))
        self.assertTrue(all(0.0 <= share <= 1.0 for share, _ in seen))
        stages = {stage.split()[0] for _, stage in seen}
        self.assertLessEqual({"grow", "fill", "check"}, stages & set(terrain.timings))

    def test_what_it_raises_ends_the_work(self):
        def refuse(share, stage):
            raise KeyError(stage)

        with self.assertRaises(KeyError):
            thalweg.make(DILATED, progress=refuse)
        with self.assertRaisesRegex(TypeError, "progress takes a function of .share, stage., True or None, not int"):
            thalweg.make(DILATED, progress=3)

    def test_a_bar_or_a_line(self):
        for show_of in (lambda: thalweg._show.progress_of(True), lambda: thalweg._show._line):
            out = io.StringIO()
            with contextlib.redirect_stderr(out):
                show = show_of()
                show(0.0, "grow 100 particles")
                show(1.0, "grow")
                show(0.5, "fill")
                show(1.0, "check")
            self.assertIn("fill", out.getvalue())
            if show is thalweg._show._line:
                self.assertEqual(out.getvalue(), "\rgrow         0%\rgrow       100%\n\rfill        50%\rcheck      100%\n")
        self.assertIsNone(thalweg._show.progress_of(None))
        self.assertIsNone(thalweg._show.progress_of(False))

    def test_the_log_is_lines(self):
        lines = []
        thalweg.make(DILATED, log=lines.append)
        self.assertTrue(all(isinstance(line, str) for line in lines))


if __name__ == "__main__":
    unittest.main()
