# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the library: what they take, what they say of nonsense, how they stop, what they leave in memory."""
import copy
import gc
import inspect
import os
import pathlib
import pickle
import resource
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
import warnings

import numpy as np

import thalweg


# [s] In the gate, where other tests run beside it, long.
STOPS_WITHIN = float(os.environ.get("THALWEG_STOPS_WITHIN", "20"))


def valley(side=64):
    """A river along the middle row."""
    z = np.full((side, side), np.nan, np.float32)
    z[side // 2] = np.linspace(100, 50, side, dtype=np.float32)
    return z


def resident_bytes():
    pages = int(pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize()


def in_a_process(program, *, signal_after=None, environment=None):
    """Runs a program of Python in a process of its own: exit code, what it said, seconds since the signal."""
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(program)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, env={**os.environ, **(environment or {})})
    sent = None
    if signal_after is not None:
        assert process.stdout.readline() == "begins\n"
        time.sleep(signal_after)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=300)
    return process.returncode, said, None if sent is None else time.monotonic() - sent


class Arguments(unittest.TestCase):
    def test_results_are_arrays_that_keep_their_owner(self):
        cells = thalweg.growth.grow_dla(particles=500).cells
        gc.collect()
        self.assertEqual(cells.shape, (500, 2))
        self.assertFalse(cells.flags.writeable)
        self.assertEqual(len(np.unique(cells, axis=0)), 500)
        dem = thalweg.surface.dilate(valley()).dem.values
        gc.collect()
        self.assertFalse(dem.flags.writeable)
        self.assertTrue(np.isfinite(dem).all())
        with self.assertRaises(ValueError):
            dem[0, 0] = 1

    def test_a_raster_returned_is_shown_where_it_lies(self):
        made = thalweg.surface.dilate(valley(4096))
        before = resident_bytes()
        shown, again = made.dem.values, np.asarray(made.dem)
        other = thalweg.Raster(shown).values
        self.assertLess(resident_bytes() - before, shown.nbytes / 8)
        self.assertTrue(np.shares_memory(shown, again) and np.shares_memory(shown, other))
        del made, again, other
        gc.collect()
        self.assertEqual(float(shown[2048, 0]), 100.0)

    def test_a_raster_given_is_read_where_it_lies(self):
        big = np.zeros((4096, 4096), np.float32)
        big[2048] = 1.0
        raster = thalweg.Raster(big)
        thalweg.measure.local_extremes(raster)
        before = resident_bytes()
        for _ in range(3):
            held = thalweg.Valley(raster)
            self.assertTrue(np.shares_memory(held.z.values, big))
            thalweg.measure.local_extremes(raster)
        self.assertLess(resident_bytes() - before, big.nbytes / 8)

    def test_what_a_stage_changes_is_its_own(self):
        z = valley()
        before = z.copy()
        shifted = thalweg.skeleton.shift_mean(np.nan_to_num(z, nan=10.0).astype(np.float32), mean=7.0)
        conditioned = thalweg.flow.condition(thalweg.surface.dilate(z).dem, z)
        self.assertAlmostEqual(float(shifted.values.mean(dtype=float)), 7.0, places=4)
        self.assertEqual(conditioned.dem.shape, z.shape)
        np.testing.assert_array_equal(z, before)

    def test_every_way_to_give_a_record(self):
        grid = thalweg.Grid(30, 20, 10.0)
        self.assertEqual(thalweg.Grid(width=30, height=20, cell_m=10.0).as_dict(), grid.as_dict())
        by_dict = thalweg.growth.outline({"width": 30, "height": 20, "cell_m": 10.0})
        np.testing.assert_array_equal(by_dict, thalweg.growth.outline(grid))
        nested = thalweg.surface.dilate(valley(), increment={"increment": "uniform"}, metric="euclid")
        self.assertGreater(nested.rise_m, 0)

    def test_overloads_by_position_and_by_name(self):
        inside = np.ones((64, 64), bool)
        inside[:8] = False
        for dem in (thalweg.surface.diffuse(valley(), inside).dem, thalweg.surface.diffuse(valley(), inside=inside).dem):
            self.assertTrue(np.isnan(dem.values[:8]).all() and np.isfinite(dem.values[8:]).all())
        lines = thalweg.RiverLines(lines=[{"feature": 1, "vertices": [[-5.0, 5.0, 0.0], [5.0, 5.0, 0.0]]}], name="one")
        self.assertEqual(len(thalweg.network.clip_lines(lines, thalweg.Grid(10, 10, 1.0, 0.0, 10.0)).lines), 1)
        self.assertEqual(len(thalweg.network.clip_lines(lines, land=np.ones((10, 10), np.uint8)).lines), 1)

    def test_a_function_of_python_as_increment(self):
        given = thalweg.surface.increments(5, function=lambda x: 2.0 * x)
        np.testing.assert_allclose(given, [2, 4, 6, 8, 10])

        def fails(_):
            raise RuntimeError("from within")
        with self.assertRaisesRegex(RuntimeError, "from within"):
            thalweg.surface.dilate(valley(), increment={"function": fails})

    def test_nonsense_is_refused_in_words(self):
        net = thalweg.StreamNetwork([[0.0, 0.0], [100.0, 0.0]], [0], [1])
        cases = [
            (lambda: thalweg.surface.diffuse(), TypeError, "surface.diffuse: skeleton is missing"),
            (lambda: thalweg.surface.diffuse(valley(), tolerence=1e-3), TypeError,
             "there is no argument 'tolerence'. Did you mean 'tolerance'?"),
            (lambda: thalweg.surface.diffuse(valley(), mode="stedy"), thalweg.BadParameter, "Did you mean 'steady'?"),
            (lambda: thalweg.surface.diffuse(valley(), mode=3), TypeError, "mode is 3; it must be one of 'steady'"),
            (lambda: thalweg.surface.diffuse(valley(), sigma_cells="x"), TypeError, "sigma_cells is 'x'; it must be a number"),
            (lambda: thalweg.surface.diffuse(valley(), passes=1.5), TypeError, "passes is 1.5; it must be a whole number"),
            (lambda: thalweg.surface.diffuse(valley(), passes=2**40), TypeError, "from -2147483648 to 2147483647"),
            (lambda: thalweg.surface.diffuse(valley(), sigma_cells=-1), thalweg.BadParameter, "it must be between 0 and 100"),
            (lambda: thalweg.surface.diffuse(valley(), valley(), 3, 4), TypeError, "arguments are given without their names"),
            (lambda: thalweg.surface.diffuse(valley(), threads=-1), thalweg.BadParameter, "threads is -1"),
            (lambda: thalweg.surface.diffuse(valley(), log=3), TypeError, "log is 3; it must be a function"),
            (lambda: thalweg.surface.diffuse(valley(), device="gpu"), thalweg.BadParameter, "it must be one of cpu, opencl"),
            (lambda: thalweg.surface.diffuse(valley()[:, :, None]), thalweg.BadInput, "has 3 dimensions, a raster has two"),
            (lambda: thalweg.surface.diffuse(np.full((4, 4), np.nan, np.float32)), thalweg.BadInput, "river|skeleton|cell"),
            (lambda: thalweg.surface.diffuse("no such.tif"), thalweg.BadInput, "no such.tif"),
            (lambda: thalweg.flow.route(np.full((3, 3), np.inf, np.float32)), thalweg.BadInput, "infinite"),
            (lambda: thalweg.network.prune(net), TypeError, "length_m is missing; it has no default"),
            (lambda: thalweg.network.prune(3, length_m=1, cell_m=1), TypeError, "network is 3; it must be a StreamNetwork"),
            (lambda: thalweg.StreamNetwork([[0, 0], [1, 1]], [0], [7]), thalweg.BadInput, "names node 7, and there are 2"),
            (lambda: thalweg.StreamNetwork([[0, 0, 1]], [], []), TypeError, r"shape \(n, 2\)"),
            (lambda: thalweg.StreamNetwork([[0, 0], [1, 1]], [0], [1], lines=[]), thalweg.BadInput, "lines has 0 entries"),
            (lambda: thalweg.Tin([[0, 0, 0]], [[0, 1, -1]]), TypeError, "numbers from 0 to 4294967295"),
            (lambda: thalweg.Tin([[0, 0, 0]], [[0, 1, 0.5]]), TypeError, "that are whole"),
            (lambda: thalweg.Tin([[0, 0], [1, 2, 3]], []), TypeError, "an array of numbers"),
            (lambda: thalweg.surface.rasterise_tin(thalweg.Tin([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]]), thalweg.Grid(2, 2)),
             thalweg.BadInput, "vertex"),
            (lambda: thalweg.Grid(1, 2, 3, 4, 5, "", 7), TypeError, "7 arguments are given"),
            (lambda: thalweg.Grid(width=1, widht=2), TypeError, "Did you mean 'width'?"),
            (lambda: thalweg.growth.grow_dla(seed=2**70), TypeError, "seed"),
            (lambda: thalweg.flow.route(None), TypeError, "dem is None; it must be a raster"),
            (lambda: thalweg.network.random_turn(np.array(3.0)), TypeError, "it must be a whole number"),
            (lambda: thalweg.nearest_cells(np.zeros((4, 4), np.uint8)), thalweg.BadInput, "no cell is marked"),
            (lambda: thalweg.fractal.estimate_fractal(valley(), {"col": 60, "width": 9, "height": 1}), thalweg.BadInput, "leaves the raster"),
            (lambda: thalweg.flow.flow_lengths({"direction": np.full((4, 4), 64, np.uint8), "area_cells": np.ones((4, 4), np.int64)}),
             thalweg.BadInput, "is 64 in row 0, column 0 .from 0., which is no code"),
            (lambda: thalweg.flow.flow_lengths({"direction": np.full((4, 4), 0, np.uint8), "area_cells": np.ones((4, 4), np.int64)}),
             thalweg.BadInput, "leads off the grid"),
            (lambda: thalweg.flow.flow_lengths({"direction": np.array([[0, 4]], np.uint8), "area_cells": np.ones((1, 2), np.int64)}),
             thalweg.BadInput, "runs in a circle"),
            (lambda: thalweg.flow.first_met([{"cell": 10**7}], thalweg.flow.route(np.zeros((4, 4), np.float32))), thalweg.BadInput,
             "is none of the flow field's 16"),
            (lambda: thalweg.flow.FlowField(), thalweg.BadInput, "rasters on one grid"),
            (lambda: thalweg.ElevatedNetwork(net, [1.0], []), thalweg.BadInput, "heights are one per node"),
            (lambda: thalweg.network.fill_heights({"lines": [{"vertices": []}], "has_z": True}, 1.0), thalweg.BadInput, "it needs two"),
            (lambda: thalweg.skeleton.separable_ar(thalweg.Grid(2**40, 2**40)), thalweg.BadInput, "at most 2.40 cells"),
            (lambda: thalweg.growth.write_lsystem({}), thalweg.BadInput, "numbered from the outlet"),
            (lambda: thalweg.growth.rewrite({"axiom": "F", "rules": {"F": []}}, 1), thalweg.BadInput, "has no rule"),
            (lambda: thalweg.draw.map(np.zeros((4, 4), np.float32), np.ones((4, 4), np.uint8), orders=thalweg.network.order(net)),
             thalweg.BadInput, "orders without the network"),
            (lambda: thalweg.geometry.triangulate(np.ma.array(np.ones((3, 3)), mask=np.eye(3))), TypeError, "without masked ones"),
            (lambda: thalweg.io.write_dem(valley(), valley()), TypeError, "path"),
            (lambda: thalweg.terrain.BlendIntoParams(source=valley()), TypeError, "source"),
            (lambda: thalweg.cells_along([[0, 0], [1, 1]], {1: 2}), TypeError, "there is no argument"),
            (lambda: thalweg.flow.condition(valley(), valley(), method="\ud800"), thalweg.BadParameter, "must be one of"),
            (lambda: thalweg.terrain.MakeResult(), TypeError, "No constructor|no constructor"),
            (lambda: thalweg.measure.perched(valley(), [64 * 64], rise_m=1.0), thalweg.BadInput, "cell 4096 is not one of"),
            (lambda: thalweg.io.read_rivers(path=3), TypeError, "path: takes a path, a GeoDataFrame"),
            (lambda: thalweg.draw.lines([[[0, 0], [1, 1]]], title=3), TypeError, "title is 3; it must be a text"),
        ]
        warnings.simplefilter("ignore", thalweg.ConversionWarning)
        for call, kind, words in cases:
            with self.subTest(words), self.assertRaisesRegex(kind, words):
                call()

    def test_seeds_keep_all_their_bits(self):
        self.assertEqual(thalweg.recipe.Recipe(seed=2**63 + 5).seed, 2**63 + 5)
        repr(thalweg.io.network_formats())

    def test_grids_can_be_copied(self):
        grid = thalweg.Grid(3, 4, 5.0, crs="EPSG:32631")
        self.assertEqual(copy.copy(grid), grid)
        self.assertEqual(pickle.loads(pickle.dumps(grid)), grid)

    def test_gdal_stays_as_others_use_it(self):
        code, said, _ = in_a_process("""
            from osgeo import gdal
            gdal.UseExceptions()
            before = gdal.GetDriverCount()
            import numpy as np, thalweg
            thalweg.flow.route(thalweg.Raster(np.zeros((4, 4), np.float32), crs="EPSG:32631"))
            print(gdal.GetDriverCount() - before, gdal.GetDriverByName("netCDF") is not None)
            try:
                gdal.Open("/vsicurl/http://127.0.0.1:9/none.tif")
            except RuntimeError as e:
                print("only what the command line names" in str(e))
            try:
                thalweg.io.read_dem("/vsicurl/http://127.0.0.1:9/none.tif")
            except thalweg.Error as e:
                print("refused or not there")
            """)
        self.assertEqual((code, said), (0, "0 True\nFalse\nrefused or not there\n"))

    def test_errors_name_their_function(self):
        with self.assertRaises(thalweg.BadParameter) as caught:
            thalweg.surface.diffuse(valley(), sigma_cells=-1)
        self.assertEqual(caught.exception.where, "surface.diffuse")
        self.assertIsInstance(caught.exception, ValueError)
        self.assertIsInstance(caught.exception, thalweg.Error)
        for bad in (np.full((3, 3), np.inf, np.float32), np.zeros((3, 3), complex)):
            with self.assertRaises(thalweg.BadInput) as caught:
                thalweg.flow.route(bad)
            self.assertEqual(caught.exception.where, "flow.route")
        with self.assertRaises(thalweg.BadInput) as caught:  # of the library's module make, which Python calls terrain
            thalweg.terrain.laws_of_dem(np.full((9, 9), np.nan, np.float32))
        self.assertEqual(caught.exception.where, "terrain.laws_of_dem")
        with self.assertRaises(OSError):
            thalweg.io.write_dem(valley(), "/no/such/folder/dem.tif")

    def test_the_grid_must_fit(self):
        with self.assertRaisesRegex(thalweg.Error, "grid|frame"):
            thalweg.surface.diffuse(valley(), np.ones((64, 60), np.uint8))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(thalweg.ConversionWarning):
                thalweg.flow.route(np.zeros((4, 4)))


    def test_rasters_of_different_grids_are_refused(self):
        """Every function that takes two rasters."""
        dem = thalweg.Raster(np.random.default_rng(1).random((20, 24), np.float32) * 50, cell_m=10, crs="EPSG:32616")
        drainage = thalweg.flow.route(dem)
        dinf = thalweg.flow.route_dinf(dem, drainage)
        network = thalweg.flow.extract_streams(drainage, dem, support_cells=20).network
        reaches = thalweg.flow.reaches_of(network.planform)
        bare = dem.values  # a plain array takes the place of the other
        moved = thalweg.Raster(dem.values, cell_m=10, west=10, crs="EPSG:32616")
        smaller = thalweg.Raster(dem.values[:-1], cell_m=10, crs="EPSG:32616")
        nowhere = thalweg.Raster(dem.values, cell_m=10)
        flow, measure = thalweg.flow, thalweg.measure
        calls = [lambda r: flow.extract_streams(drainage, r), lambda r: flow.condition(dem, r), lambda r: flow.change_between(dem, r),
                 lambda r: flow.route_dinf(r, drainage), lambda r: flow.accumulate(drainage, r.astype(np.float64)),
                 lambda r: flow.heights_above_rivers(r, flow.river_cells(reaches, dem.grid), drainage),
                 lambda r: measure.wetness(r, dinf.area_cells), lambda r: measure.river_profiles(reaches, r, drainage),
                 lambda r: measure.slope_area(r, drainage), lambda r: measure.chi(r, drainage),
                 lambda r: measure.slope_area_ratio(r, drainage), lambda r: measure.certify(r, drainage, reaches),
                 lambda r: measure.zone_relief(r, np.zeros(dem.shape, np.int32), 1, flow.lengths_to_outlet(drainage)),
                 lambda r: measure.compare_terrains(dem, [r], reaches), lambda r: thalweg.surface.diffuse(r, (dem > 0).astype(np.uint8)),
                 lambda r: thalweg.blend.deform(dem, (r > 0).astype(np.uint8), []),
                 lambda r: thalweg.surface.dilate_over(thalweg.Valley(dem), r)]
        for number, call in enumerate(calls):
            with self.subTest(number), warnings.catch_warnings():
                warnings.simplefilter("ignore", thalweg.ConversionWarning)
                try:
                    call(bare)
                except thalweg.Error as other:
                    self.assertNotIn("grid", str(other))
                for wrong, words in ((moved, "of equal sizes, with north-western corners at"), (smaller, "24 x 19"),
                                     (nowhere, "of equal sizes, in (no CRS and|EPSG:32616 and) (EPSG:32616|no CRS)")):
                    with self.assertRaisesRegex(thalweg.BadInput, f"have different grids: .*{words}"):
                        call(wrong)
        # Before: 5 421.7 m of streams in place of 487 955.3.
        with self.assertRaisesRegex(thalweg.BadInput, "the DEM and its drainage have different grids: cells of 10 and 1 m; drain this DEM"):
            flow.extract_streams(flow.route(dem.values), dem)

    def test_grids_take_any_librarys_crs(self):
        self.assertEqual(thalweg.Grid(2, 2, crs="epsg:32616"), thalweg.Grid(2, 2, crs=32616))
        self.assertEqual(thalweg.Grid(2, 2, crs=None).crs, "")
        with self.assertRaisesRegex(thalweg.BadInput, "nonsense.* is not a coordinate system") as refused:
            thalweg.Grid(2, 2, crs="nonsense")
        self.assertEqual(refused.exception.where, "Grid")

    def test_errors_speak_python(self):
        words = thalweg._show.in_python
        for shell, python in [("it exists: name another or use --overwrite", "it exists: name another or use overwrite=True"),
                              ("If they should meet it: --set network.lines.snap=20", "If they should meet it: network.lines.snap = 20"),
                              ("Give it, with --set surface.mean_slope=20 or --like DEM", "Give it, with surface.mean_slope = 20 or like=DEM"),
                              ("name its cells' (--crs EPSG:n)", "name its cells' (crs=\"EPSG:n\")"),
                              ("leave --device out", "leave device out"), ("--nodata nan takes it", "nodata=nan takes it"),
                              ("name one by --classes", "name one by classes"), ("gdal_translate -a_nodata -9999 IN", "gdal_translate -a_nodata -9999 IN"),
                              ("pdal translate IN OUT --writers.las.a_srs=EPSG:n", "pdal translate IN OUT --writers.las.a_srs=EPSG:n"),
                              (os.path.join(tempfile.gettempdir(), "thalweg-x_1/rivers.gpkg: line 3"), "rivers: line 3")]:
            self.assertEqual(words(shell), python)
        with self.assertRaises(thalweg.Error) as refused:
            thalweg.io.read_network(thalweg.Raster(valley()))
        self.assertNotIn("/thalweg-", str(refused.exception))

    def test_masks_are_no_numbers(self):
        net = thalweg.StreamNetwork([[0, 0], [1, 0], [2, 0]], [0, 1], [1, 2])
        with self.assertRaisesRegex(TypeError, "not a mask: np.flatnonzero.mask. gives its numbers"):
            thalweg.network.select(net, net.length_m > 5)
        self.assertEqual(thalweg.network.select(net, np.flatnonzero(net.length_m > 0)).arc_count, 2)

    def test_networks_with_heights_have_a_plan(self):
        plan = thalweg.StreamNetwork([[0, 0], [1, 0], [2, 0]], [0, 1], [1, 2])
        raised = thalweg.ElevatedNetwork(plan, [3, 2, 1], [[3, 2], [2, 1]])
        self.assertEqual(thalweg.network.upstream_of(raised, 1).tolist(), [0, 1])
        self.assertEqual(thalweg.network.nearest_arc(thalweg.flow.ExtractedStreams(raised), (1.9, 1)), 1)

    def test_numbers_beyond_a_record_are_refused(self):
        grid = thalweg.Grid(20, 20)
        for call in (lambda: thalweg.Tin([[0, 0, 0]], [[0, 1, 99999999]]),
                     lambda: thalweg.io.write_stl({"vertices": [[0, 0, 0]], "places": [[0, 0]], "triangles": [[0, 1, 10**8]]}, "q.stl"),
                     lambda: thalweg.surface.survey_rivers({"grid": grid, "cell": [0, 10**9], "receiver": [-1, 0]}),
                     lambda: thalweg.surface.survey_rivers({"grid": grid, "cell": [0, 1], "receiver": [5, 0]}),
                     lambda: thalweg.network.flood_lakes({"channels": {"grid": grid, "cell": [0], "receiver": [-1]}, "of_arc": [[7]]},
                                                         np.ones((20, 20), np.int32)),
                     lambda: thalweg.Grid(3, 3, 0.0), lambda: thalweg.Grid(3, 3, -5.0), lambda: thalweg.Grid(3, 3, 1.0, np.nan)):
            with self.assertRaises(thalweg.BadInput):
                call()

    def test_a_flow_field_owns_its_directions(self):
        codes = np.full((100, 100), 255, np.uint8)
        field = thalweg.flow.FlowField(direction=codes, area_cells=np.ones((100, 100), np.int64))
        codes[:] = 6
        self.assertEqual(thalweg.flow.path_down(field, (50.5, 50.5)).size, 1)

    def test_areas_are_shown_as_numbers_with_signs(self):
        codes = np.full((2, 2), 255, np.uint8)
        most = 2**32 - 1
        for kind in (np.int64, np.uint32):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                areas = thalweg.flow.FlowField(direction=codes, area_cells=np.array([[0, 1], [2, most]], kind)).area_cells
            self.assertEqual(areas.dtype, np.int64)
            self.assertEqual(areas.values.tolist(), [[0, 1], [2, most]])
        for wrong in (-1, most + 1):
            with self.assertRaises(thalweg.BadInput):
                thalweg.flow.FlowField(direction=codes, area_cells=np.full((2, 2), wrong, np.int64))

    def test_signatures_can_be_read(self):
        left = []
        for module in map(lambda name: getattr(thalweg, name), thalweg._core.MODULES):
            for name, value in vars(module).items():
                if inspect.isroutine(value) and not name.startswith("_"):
                    inspect.signature(value)
                elif isinstance(value, type) and not issubclass(value, Exception):
                    try:
                        inspect.signature(value)
                    except ValueError:
                        left.append(name)
        self.assertEqual(str(inspect.signature(thalweg.flow.route)), "(dem, *others, threads=0, progress=None, log=None, device='cpu')")
        for name in left:  # what only the library makes
            self.assertRegex(name, "^[A-Z]")

    def test_records_pickle(self):
        dem = thalweg.Raster(np.random.default_rng(1).random((20, 24), np.float32) * 50, cell_m=10, crs="EPSG:32616")
        drainage = thalweg.flow.route(dem)
        streams = thalweg.flow.extract_streams(drainage, dem, support_cells=20)
        profiles = thalweg.measure.river_profiles(thalweg.flow.reaches_of(streams.network.planform), dem, drainage)

        def same(one, other):
            self.assertIs(type(one), type(other))
            if hasattr(type(one), "_fields"):
                for field in type(one)._fields:
                    same(getattr(one, field), getattr(other, field))
            elif isinstance(one, (list, tuple)):
                self.assertEqual(len(one), len(other))
                for pair in zip(one, other):
                    same(*pair)
            elif isinstance(one, dict):
                self.assertEqual(list(one), list(other))
                same(list(one.values()), list(other.values()))
            else:
                np.testing.assert_array_equal(one, other)

        for record in (drainage, streams, streams.network, streams.network.planform, profiles, dem.grid, thalweg.flow.route_dinf(dem, drainage),
                       thalweg.network.order(streams.network.planform), thalweg.measure.statistics(dem), thalweg.measure.hypsometry(dem),
                       thalweg.growth.grow_tokunaga(order=3), thalweg.flow.condition(dem, np.full(dem.shape, np.nan, np.float32)),
                       thalweg.measure.relief(dem, drainage, thalweg.measure.statistics(dem))):
            with self.subTest(type(record).__name__):
                same(pickle.loads(pickle.dumps(record)), record)
                same(copy.deepcopy(record), record)
        with self.assertRaisesRegex(TypeError, "MakeResult cannot be pickled, as only the library makes one"):
            pickle.dumps(thalweg.make({"grid": {"width": 64, "height": 64}}).made)
        # Of every kind that can be made of nothing.
        count = 0
        for module in (thalweg._core, *(getattr(thalweg, name) for name in thalweg._core.MODULES)):
            for kind in vars(module).values():
                if isinstance(kind, type) and hasattr(kind, "_fields"):
                    try:
                        record = kind()
                    except (TypeError, thalweg.Error):
                        continue
                    with self.subTest(kind.__qualname__):
                        try:
                            written = pickle.dumps(record)
                        except TypeError as refused:
                            self.assertIn("as only the library makes one", str(refused))
                            continue
                        same(pickle.loads(written), record)
                        count += 1
        self.assertGreater(count, 150)


class Running(unittest.TestCase):
    def test_progress_and_log_are_called(self):
        shares, lines = [], []
        thalweg.make({"grid": {"width": 128, "height": 128}}, progress=lambda share, stage: shares.append((share, stage)), log=lines.append)
        self.assertTrue(all(0 <= share <= 1 for share, _ in shares))
        self.assertGreater(len({stage for _, stage in shares}), 2)
        self.assertTrue(any("network" in line or "rivers" in line or "grid" in line for line in lines), lines)

    def test_what_a_callback_raises_comes_out(self):
        def stop(_share, _stage):
            raise LookupError("enough")
        with self.assertRaisesRegex(LookupError, "enough"):
            thalweg.make({"grid": {"width": 256, "height": 256}}, progress=stop)
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            thalweg.make({"grid": {"width": 256, "height": 256}}, log=lambda line: 1 / 0)

    def test_ctrl_c_stops_the_work(self):
        for name, work in {
            "equilibrium": "thalweg.make({'grid': {'width': 4096, 'height': 4096}})",
            "cluster": "thalweg.growth.grow_dla(particles=5000000)",
            "statistics": "thalweg.make({'grid': {'width': 2048, 'height': 2048}, 'statistics': {'std': 100.0, 'slope': 0.3}})",
            "diffusion": "thalweg.surface.diffuse(z, mode='explicit_sweeps', iterations=10**9)",
        }.items():
            with self.subTest(name):
                code, said, seconds = in_a_process(f"""
                    import numpy as np, thalweg
                    z = np.full((512, 512), np.nan, np.float32)
                    z[100] = 1
                    z[300] = 2
                    print("begins", flush=True)
                    try:
                        {work}
                    except KeyboardInterrupt:
                        print("stopped")
                    """, signal_after=1.0)
                self.assertEqual((code, said), (0, "stopped\n"))
                print(f"{name}: {seconds:.2f} s after Ctrl-C")
                self.assertLess(seconds, STOPS_WITHIN)

    def test_two_threads_make_at_once(self):
        made = {}

        def make(seed):
            made[seed] = thalweg.make({"grid": {"width": 192, "height": 192}}, seed=seed, threads=1).dem.values

        threads = [threading.Thread(target=make, args=(seed,)) for seed in (1, 2, 3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed, dem in made.items():
            alone = thalweg.make({"grid": {"width": 192, "height": 192}}, seed=seed).dem.values
            np.testing.assert_array_equal(dem, alone)

    def test_other_threads_go_on_meanwhile(self):
        counted = [0]
        ended = threading.Event()

        def count():
            while not ended.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        begin = time.monotonic()
        thalweg.growth.grow_dla(particles=60000)
        seconds = time.monotonic() - begin
        ended.set()
        thread.join()
        self.assertGreater(counted[0], 5 * seconds)

    def test_makes_leave_nothing(self):
        def make(seed):
            thalweg.make({"grid": {"width": 64, "height": 64}}, seed=seed, threads=1)

        for seed in range(20):
            make(seed)
        gc.collect()
        before, open_before = resident_bytes(), len(os.listdir("/proc/self/fd"))
        for seed in range(100):
            make(seed)
        gc.collect()
        self.assertLess(resident_bytes() - before, 32 << 20)  # leaks_test.py looks more closely
        self.assertEqual(len(os.listdir("/proc/self/fd")), open_before)


class Ensembles(unittest.TestCase):
    SMALL = {"grid": {"width": 64, "height": 48}}

    def test_members_are_those_of_make(self):
        members = {m.number: m for m in thalweg.ensemble(self.SMALL, members=3, vary={"surface.mean_slope": (10, 30)}, threads=2)}
        self.assertEqual(sorted(members), [0, 1, 2])
        one = members[2]
        self.assertEqual((one.seed, one.status, list(one.keys)), (9, "ok", ["surface.mean_slope"]))
        alone = thalweg.make(self.SMALL, seed=9, **{"surface.mean_slope": float(one.keys["surface.mean_slope"])})
        self.assertEqual(one.terrain.dem.values.tobytes(), alone.dem.values.tobytes())
        self.assertEqual(one.values["dem.mean"], alone.report["dem"]["mean"])
        self.assertEqual(one.values["law.drainage_density"], alone.report["network"]["laws"]["drainage_density"]["value"])

    def test_seeds_and_lists(self):
        members = {m.number: m for m in thalweg.ensemble(self.SMALL, seeds=range(20, 23), vary={"surface.mean_slope": [25, 95]})}
        self.assertEqual([members[i].seed for i in range(3)], [20, 21, 22])
        self.assertEqual([members[i].status for i in range(3)], ["ok", "failed", "ok"])
        self.assertIsNone(members[1].terrain)
        self.assertIn("surface.mean_slope = 95", members[1].reason)

    def test_what_cannot_be_is_refused(self):
        for keys in [{"vary": {"surface.mean_slop": (1, 2)}}, {"vary": {"seed": (1, 2)}}]:
            with self.assertRaises(thalweg.BadParameter):
                thalweg.ensemble(self.SMALL, 2, **keys)
        for members, seeds in [(None, None), (0, None), (2, range(3)), (None, [1, 3]), (None, [])]:
            with self.assertRaises(ValueError):
                thalweg.ensemble(self.SMALL, members, seeds=seeds)

    def test_ctrl_c_stops_all_members(self):
        code, said, waited = in_a_process("""
            import thalweg
            print("begins", flush=True)
            for member in thalweg.ensemble({"grid": {"width": 2048, "height": 2048}}, members=8, threads=2):
                pass
            """, signal_after=2.0)
        self.assertNotEqual(code, 0)
        self.assertIn("KeyboardInterrupt", said)
        self.assertNotIn("Cancelled", said)
        self.assertLess(waited, STOPS_WITHIN)

    def test_who_stops_early_waits_for_no_other(self):
        for member in thalweg.ensemble(self.SMALL, 1000, threads=1):
            break
        self.assertEqual(member.number, 0)

if __name__ == "__main__":
    unittest.main()
