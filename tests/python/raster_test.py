# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasters are numpy arrays without copies; what is converted is said, what is wrong is said with its place."""
import copy
import gc
import os
import pathlib
import pickle
import re
import tempfile
import unittest
import warnings

import matplotlib
import matplotlib.pyplot
import numpy as np
import pyproj
import rasterio.crs
import rioxarray
import xarray
from osgeo import gdal, osr

import thalweg
from thalweg import BadInput, ConversionWarning, Grid, Raster
from thalweg._raster import to_core

matplotlib.use("Agg")
SAMPLES = pathlib.Path(__file__).parents[2] / "samples"
DEM = SAMPLES / "jacksboro_utm16.tif"


def slope(width=5, height=4):
    """Heights that differ everywhere."""
    return np.arange(width * height, dtype=np.float32).reshape(height, width)


class Systems(unittest.TestCase):
    def test_any_library_names_a_coordinate_system(self):
        reference = osr.SpatialReference()
        reference.ImportFromEPSG(32616)
        for crs in ("EPSG:32616", 32616, np.int64(32616), pyproj.CRS(32616), rasterio.crs.CRS.from_epsg(32616), reference):
            self.assertEqual(Raster(slope(), cell_m=30, crs=crs).crs, "EPSG:32616", type(crs))
            self.assertEqual(Grid(5, 4, 30, crs=crs).crs, "EPSG:32616", type(crs))
        for crs in ("", None):
            self.assertEqual(Raster(slope(), crs=crs).crs, "")
        albers = pyproj.CRS("+proj=aea +lat_1=29.5 +lat_2=45.5 +lat_0=37.5 +lon_0=-96 +datum=NAD83 +units=m")
        self.assertEqual(pyproj.CRS(Raster(slope(), crs=albers).crs), albers)

    def test_what_is_none_is_refused(self):
        for crs in ("nonsense", 1):
            with self.assertRaisesRegex(BadInput, "is not a coordinate system"):
                Raster(slope(), crs=crs)
        for crs in (3.5, True, ["EPSG:32616"]):
            with self.assertRaisesRegex(TypeError, "it must be a text, a number or a CRS"):
                Raster(slope(), crs=crs)


class Quiet(unittest.TestCase):
    """Conversions that nobody expects fail."""

    def setUp(self):
        caught = warnings.catch_warnings()
        caught.__enter__()
        self.addCleanup(caught.__exit__, None, None, None)
        warnings.simplefilter("error", ConversionWarning)

    def said(self, thing, dtype, what="dem"):
        """The raster, and what is said of its conversion."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            raster = to_core(thing, dtype, what)
        self.assertTrue(all(one.filename == __file__ for one in caught), caught)
        return raster, [str(one.message) for one in caught]


class Values(Quiet):
    def test_a_raster_shows_the_array_and_cannot_be_written(self):
        array = slope()
        raster = Raster(array)
        self.assertTrue(np.shares_memory(raster.values, array))
        self.assertFalse(raster.values.flags.writeable)
        self.assertTrue(array.flags.writeable)
        with self.assertRaises(ValueError):
            raster.array()[0, 0] = 1
        with self.assertRaises(ValueError):
            raster += 1
        own = raster.array(copy=True)
        own[0, 0] = 7
        self.assertEqual(array[0, 0], 0)

    def test_shape_and_place(self):
        raster = Raster(slope(), cell_m=10.0, west=100.0, north=500.0, crs="EPSG:32616")
        self.assertEqual((raster.shape, raster.ndim, raster.size, len(raster)), ((4, 5), 2, 20, 4))
        self.assertEqual(raster.bounds, (100.0, 460.0, 150.0, 500.0))
        self.assertEqual((raster.dtype, raster.crs, raster.cell_m), (np.float32, "EPSG:32616", 10.0))
        self.assertIn("5 × 4 cells of 10", repr(raster))
        self.assertEqual(Raster(slope()).grid, Grid(5, 4, 1.0, 0.0, 4.0))
        self.assertEqual(Raster(slope(), raster.grid).grid, raster.grid)

    def test_the_grid_fits(self):
        with self.assertRaisesRegex(BadInput, "4 rows and 5 columns do not fit a grid of 5 rows and 4 columns"):
            Raster(slope(), Grid(4, 5))
        with self.assertRaisesRegex(BadInput, "cell_m = 0 is not above 0"):
            Raster(slope(), cell_m=0)

    def test_numpy_takes_it(self):
        array, raster = slope(), Raster(slope())
        for take in (lambda a: a[1:, ::2], np.maximum.accumulate, np.flipud, lambda a: np.array(list(a)), lambda a: np.concatenate([a, a]),
                     lambda a: np.add.reduce(a), lambda a: a[a > 3], lambda a: a[0, a[0] > 1], lambda a: a + np.zeros((2, 4, 5)),
                     lambda a: np.add.outer(a, [1, 2])):
            result, expected = take(raster), take(array)
            self.assertIs(type(result), np.ndarray)
            self.assertEqual(result.dtype, expected.dtype)
            np.testing.assert_array_equal(result, expected)
        for reduce in ("min", "max", "mean", "std", "sum", "any", "all"):
            for axis in (None, 0, 1):
                np.testing.assert_array_equal(getattr(raster, reduce)(axis=axis), getattr(array, reduce)(axis=axis))
                np.testing.assert_array_equal(getattr(np, reduce)(raster, axis=axis), getattr(np, reduce)(array, axis=axis))
        self.assertEqual(np.nanmean(raster), array.mean())
        out = np.empty_like(array)
        np.add(raster, 1, out=out)
        np.testing.assert_array_equal(out, array + 1)

    def test_arithmetic_keeps_grid_and_crs(self):
        array, raster = slope() + 1, Raster(slope() + 1, cell_m=30, west=7.0, crs="EPSG:32616")
        for take in (lambda a: a + 1, lambda a: 2 * a, lambda a: a - a, lambda a: -a, lambda a: a > 3, np.sqrt, abs,
                     lambda a: 1 / a, lambda a: a ** 2, lambda a: ~(a > 2), lambda a: (a > 2) & (a < 9), lambda a: a - slope(),
                     lambda a: slope() - a, lambda a: a - slope()[0], lambda a: np.hypot(a, a), np.isnan,
                     lambda a: np.add(a, 1, where=a > 2, out=None) * 0, lambda a: np.where(a > 2, a, 0), lambda a: np.clip(a, 2, 5),
                     lambda a: np.round(a, 1), np.nan_to_num, np.zeros_like, lambda a: np.full_like(a, 7), lambda a: a.clip(2, 5),
                     lambda a: a.round(), lambda a: a.copy()):
            result, expected = take(raster), take(array)
            self.assertIsInstance(result, Raster)
            self.assertEqual(result.grid, raster.grid)
            self.assertEqual(result.dtype, expected.dtype)
            np.testing.assert_array_equal(result, expected)
        for part, expected in zip(np.modf(raster), np.modf(array)):
            self.assertEqual(part.grid, raster.grid)
            np.testing.assert_array_equal(part, expected)
        metres = (raster * 0.3048).astype(np.float32)
        self.assertEqual((metres.grid, metres.dtype), (raster.grid, np.float32))
        moved = Raster(slope(), cell_m=30, west=8.0, crs="EPSG:32616")
        with self.assertRaisesRegex(BadInput, "subtract: rasters of different grids.*west=7.0.*west=8.0"):
            raster - moved
        self.assertEqual(type(raster - moved.values), Raster)
        for call in (lambda: np.where(raster > 2, raster, moved), lambda: np.add(raster, 1, where=moved > 2)):
            with self.assertRaisesRegex(BadInput, "rasters of different grids"):
                call()
        with self.assertRaisesRegex(ValueError, "a raster cannot be written: array"):
            raster[0, 0] = 3
        square = Raster(np.eye(3, dtype=np.float32))
        self.assertIs(type(square @ square), np.ndarray)

    def test_what_has_a_place_keeps_it(self):
        raster = Raster(slope(), cell_m=30, west=60.0, crs="EPSG:32616")
        for given in (raster, raster.to_xarray()):
            self.assertEqual(Raster(given).grid, raster.grid)
        self.assertEqual(Raster(slope(), raster).grid, raster.grid)
        with self.assertRaisesRegex(BadInput, "give a grid or cell_m, west, north and crs, not both"):
            Raster(slope(), raster.grid, cell_m=5)
        with self.assertRaisesRegex(BadInput, "not both"):  # its place would be lost
            Raster(raster, crs=32616)
        with self.assertRaisesRegex(TypeError, "grid is tuple; it must be a Grid, a Raster or a dict"):
            Raster(slope(), (4, 5))
        self.assertEqual(Raster(slope(), crs="epsg:32616").crs, "EPSG:32616")

    def test_masks_of_the_library_are_masks(self):
        dem = Raster(slope(), cell_m=10)
        drainage = thalweg.flow.route(dem)
        inside = thalweg.flow.catchment(drainage, (5.0, 35.0))
        self.assertEqual(dem[inside].tolist(), dem.values[inside.values == 1].tolist())

    def test_codes_of_files(self):
        drainage = thalweg.flow.route(Raster.open(DEM))
        with tempfile.TemporaryDirectory() as place:
            for of in ("esri", "taudem", "whitebox"):
                codes = thalweg.flow.codes_of(drainage.direction, of)
                wanted = thalweg.flow.directions_of(codes, of)
                codes.save(f"{place}/{of}.tif")
                np.testing.assert_array_equal(thalweg.flow.directions_of(f"{place}/{of}.tif", of), wanted)
            drainage.direction.save(f"{place}/own.tif")
            again = Raster.open(f"{place}/own.tif", values="codes").astype(np.uint8)
            np.testing.assert_array_equal(again, drainage.direction)
            file = gdal.GetDriverByName("GTiff").Create(f"{place}/declared.tif", 3, 2, 1, gdal.GDT_Byte)
            file.GetRasterBand(1).SetNoDataValue(255)
            file.GetRasterBand(1).WriteArray(np.array([[255, 1, 1], [64, 0, 255]], np.uint8))
            del file
            self.assertEqual(thalweg.flow.directions_of(f"{place}/declared.tif", "esri").values.tolist(), [[254, 0, 255], [255, 255, 254]])
        small = np.array([[1, -32768]], np.int16)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConversionWarning)
            self.assertEqual(thalweg.flow.directions_of(small, "whitebox").values.tolist(), [[255, 254]])

    def test_numbers_for_no_data_are_refused_as_of_files(self):
        for number in (-9999, -32768, -3.4e38, 1e20, float(np.finfo(np.float32).min)):
            heights = slope()
            heights[1, 2] = number
            words = f"dem: 1 cells are {re.escape(f'{np.float32(number):g}')}, the first in row 1, column 2 .from 0.: no terrain has this"
            for given in (heights, Raster(heights), xarray.DataArray(heights, dims=("y", "x"))):
                with self.assertRaisesRegex(BadInput, words) as refused:
                    thalweg.flow.route(given)
                self.assertEqual(refused.exception.where, "flow.route")
            with self.assertRaisesRegex(BadInput, words):
                thalweg.measure.statistics(heights)
            test = re.search(r"np.where.(.*), np.nan", str(refused.exception))[1]  # as the message says
            known = np.where(eval(test, {"dem": heights, "abs": abs}), np.nan, heights)
            self.assertEqual(thalweg.measure.statistics(known.astype(np.float32)).nodata, 1)
        sea = slope() - 10005  # deeper than 9999 m, too
        self.assertEqual(thalweg.measure.statistics(sea.astype(np.float32)).nodata, 0)
        self.assertEqual(to_core(np.array([[-9999]], np.int32), np.int32, "codes")[0, 0], -9999)

    def test_opened_saved_sampled(self):
        dem = Raster.open(DEM)
        self.assertEqual(dem.grid, thalweg.io.read_dem(str(DEM)).grid)
        source = gdal.Open(str(DEM))
        west, width, _, north, _, height = source.GetGeoTransform()
        self.assertEqual(dem.transform, (width, 0.0, west, 0.0, height, north))
        with tempfile.TemporaryDirectory() as place:
            for values, kind in ((dem, np.float32), (dem > 400, np.uint8), (dem.astype(np.float64), np.float64)):
                path = pathlib.Path(place) / f"{np.dtype(kind).name}.tif"
                values.save(path)
                with self.assertRaises(thalweg.IoError):
                    values.save(path)
                values.save(path, overwrite=True)
                self.assertEqual(sorted(one.name for one in path.parent.iterdir() if one.name.startswith(".")), [])
                again = Raster.open(path, values="codes" if kind is np.uint8 else "numbers")
                self.assertEqual(again.grid, dem.grid)
                np.testing.assert_array_equal(again, values.astype(np.float32))
                file = gdal.Open(str(path))
                self.assertEqual(file.GetRasterBand(1).DataType,
                                 {np.float32: gdal.GDT_Float32, np.uint8: gdal.GDT_Byte, np.float64: gdal.GDT_Float64}[kind])
            for name in ("dem.png", "dem.asc", "dem.npy"):
                with self.assertRaisesRegex(thalweg.BadParameter, "a GeoTIFF is written, whose name ends in .tif, not"):
                    thalweg.io.write_dem(dem, f"{place}/{name}")
            self.assertEqual(sorted(os.listdir(place)), ["float32.tif", "float64.tif", "uint8.tif"])
        random = np.random.default_rng(5)
        grid = dem.grid
        x = random.uniform(dem.bounds[0] - 300, dem.bounds[2] + 300, 500)
        y = random.uniform(dem.bounds[1] - 300, dem.bounds[3] + 300, 500)
        rows, columns = dem.index(x, y)
        inside = (rows >= 0) & (rows < grid.height) & (columns >= 0) & (columns < grid.width)
        found = dem.sample(x, y)
        np.testing.assert_array_equal(np.isnan(found), ~inside | np.isnan(dem.values[rows * inside, columns * inside]))
        np.testing.assert_array_equal(found[inside], dem.values[rows[inside], columns[inside]])
        np.testing.assert_array_equal(dem.sample(*dem.xy([3, 7], [5, 6]), method="bilinear"), dem.values[[3, 7], [5, 6]])
        # As SciPy interpolates between centres.
        plane = Raster(np.add.outer(np.arange(6.0), 10.0 * np.arange(8.0)), cell_m=2.0, west=50.0, north=40.0)
        x, y = random.uniform(51.0, 65.0, 100), random.uniform(29.0, 39.0, 100)
        np.testing.assert_allclose(plane.sample(x, y, method="bilinear"), (39.0 - y) / 2 + 10 * (x - 51.0) / 2, atol=1e-9)
        self.assertEqual(plane.sample(50.0, 40.0, method="bilinear"), 0.0)
        self.assertEqual(plane.sample(66.0, 28.0), plane.values[-1, -1])
        self.assertEqual([int(one) for one in plane.index(66.0, 28.0)], [5, 7])
        self.assertEqual([int(one) for one in plane.index(66.1, 40.1)], [-1, 8])
        self.assertTrue(np.isnan(plane.sample([np.nan, np.inf, 1e300], 35.0)).all())
        self.assertTrue(np.isnan(plane.sample([49.9, np.nan], 35.0, method="bilinear")).all())
        with self.assertRaisesRegex(thalweg.BadParameter, "cubic"):
            plane.sample(55.0, 35.0, method="cubic")

    def test_both_protocols_of_array(self):
        raster = Raster(slope())
        self.assertTrue(np.shares_memory(np.asarray(raster), raster.values))
        self.assertFalse(np.shares_memory(raster.__array__(copy=True), raster.values))
        self.assertTrue(raster.__array__(copy=True).flags.writeable)
        self.assertEqual(np.asarray(raster, dtype=np.float64).dtype, np.float64)
        with self.assertRaises(ValueError):
            raster.__array__(np.float64, copy=False)

    def test_copies_and_pickles(self):
        raster = Raster(slope(), cell_m=3.0, west=9.0, north=70.0, crs="EPSG:32616")
        for again in (pickle.loads(pickle.dumps(raster)), copy.deepcopy(raster)):
            np.testing.assert_array_equal(again, raster)
            self.assertEqual(again.grid, raster.grid)

    def test_a_raster_of_the_library_keeps_its_memory(self):
        dem = thalweg.io.read_dem(str(DEM))
        array, first = dem.array(), dem.array(copy=True)
        self.assertFalse(array.flags.writeable)
        del dem
        gc.collect()
        rubbish = [np.full(array.shape, 7, np.float32) for _ in range(8)]
        np.testing.assert_array_equal(array, first)
        del rubbish


class Conversions(Quiet):
    def test_nothing_is_copied_that_is_as_the_library_reads_it(self):
        for dtype in (np.float32, np.float64, np.uint8, np.int32, np.int64):
            array = slope().astype(dtype)
            self.assertTrue(np.shares_memory(to_core(array, dtype, "dem").values, array))
            raster = Raster(array)
            self.assertIs(to_core(raster, dtype, "dem"), raster)
        rows = slope()[1:3]
        self.assertTrue(np.shares_memory(to_core(rows, np.float32, "dem").values, rows))
        mask = slope() > 3
        self.assertTrue(np.shares_memory(to_core(mask, np.uint8, "mask").values, mask))

    def test_what_is_converted_is_said(self):
        array = slope()
        unaligned = np.frombuffer(b"\0" + array.tobytes(), dtype=np.uint8)[1:].view(np.float32).reshape(array.shape)
        for given, dtype, text in [(array.astype(np.float64), np.float32, "dem: float64 converted to float32"),
                                   (array.astype(np.int16), np.float32, "dem: int16 converted to float32"),
                                   (array.astype(np.float16), np.float32, "dem: float16 converted to float32"),
                                   (array, np.float64, "dem: float32 converted to float64"),
                                   (array, np.uint8, "dem: float32 converted to uint8"),
                                   (array > 3, np.float32, "dem: bool converted to float32"),
                                   (np.asfortranarray(array), np.float32, "dem: copied, not in C order"),
                                   (array[:, ::2], np.float32, "dem: copied, not in C order"),
                                   (array.astype(">f4"), np.float32, "dem: copied, not in native byte order"),
                                   (unaligned, np.float32, "dem: copied, not aligned")]:
            raster, texts = self.said(given, dtype)
            self.assertEqual(texts, [text])
            self.assertEqual(raster.dtype, dtype)
            flags = raster.values.flags
            self.assertTrue(flags.c_contiguous and flags.aligned and not flags.writeable)
            np.testing.assert_array_equal(raster.values, given)

    def test_any_layout_and_type_has_the_values_of_numpy(self):
        random = np.random.default_rng(7)
        for _ in range(200):
            dtype = random.choice(["b", "i2", ">i4", "u8", "f2", ">f8", "f4"])
            array = random.integers(0, 100, random.integers(1, 9, 2)).astype(dtype)
            array = random.choice([-1, 1]) * array if array.dtype.kind == "f" else array
            array = array[::random.choice([-1, 1, 2]), ::random.choice([-1, 1])]
            array = array.T if random.random() < 0.5 else array
            raster, _ = self.said(array, np.float32)
            np.testing.assert_array_equal(raster.values, array.astype(np.float32))

    def test_masked_cells_are_nan(self):
        for dtype in (np.float32, np.int16):
            given = np.ma.masked_equal(slope().astype(dtype), 3)
            raster, texts = self.said(given, np.float32)
            self.assertEqual(texts, ["dem: copied, masked cells become NaN"])
            self.assertEqual(np.argwhere(np.isnan(raster.values)).tolist(), [[0, 3]])
        whole = np.ma.masked_equal(slope(), 99)
        self.assertTrue(np.shares_memory(to_core(whole, np.float32, "dem").values, whole.data))
        with self.assertRaisesRegex(BadInput, "mask: masked cells, and uint8 has no value for them"):
            to_core(np.ma.masked_equal(slope(), 3), np.uint8, "mask")

    def test_what_is_no_raster_is_refused_in_words(self):
        table = slope().astype(np.float64)

        def with_one(value):
            other = table.copy()
            other[2, 3] = value
            return other

        beyond = "row 2, column 3 .from 0. is beyond the range of"
        for given, dtype, words in [(np.zeros(3), np.float32, "dem: has 1 dimensions, a raster has two"),
                                    (np.zeros((0, 3)), np.float32, "dem: is empty: 0 rows, 3 columns"),
                                    (table.astype(complex), np.float32, "dem: values are complex128, not real numbers"),
                                    (table.astype(object), np.float32, "dem: values are object"),
                                    (table.astype(str), np.float32, "dem: values are str"),
                                    (with_one(1e39), np.float32, f"1e[+]39 in {beyond} float32"),
                                    (with_one(np.nan), np.int64, "nan in row 2, column 3 .from 0. is no value of int64"),
                                    (with_one(np.nan), np.uint8, "nan in row 2, column 3"),
                                    (with_one(np.inf), np.int32, f"inf in {beyond} int32"),
                                    (with_one(-1), np.uint8, f"-1.0 in {beyond} uint8, .0, 255."),
                                    (with_one(256).astype(int), np.uint8, "256 in row 2, column 3"),
                                    (with_one(2**63).astype(np.uint64), np.int64, "9223372036854775808 in row 2, column 3"),
                                    (with_one(0.5), np.int32, "0.5 in row 2, column 3 .from 0. is not an integer")]:
            with self.subTest(words), warnings.catch_warnings(), self.assertRaisesRegex(BadInput, words):
                warnings.simplefilter("ignore", ConversionWarning)
                to_core(given, dtype, "dem")
        for given in (None, 3.0, [[1.0]]):
            with self.assertRaisesRegex(TypeError, "dem: takes a Raster, a numpy array, an xarray.DataArray or a path, not"):
                to_core(given, np.float32, "dem")
        infinite, _ = self.said(with_one(np.inf), np.float32)
        self.assertEqual(infinite[2, 3], np.inf)

    def test_a_stage_says_it_at_the_callers_line(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            shade = thalweg.io.hillshade(slope().astype(np.float64))
        said = [(one.filename, str(one.message)) for one in caught]
        self.assertEqual(said, [(__file__, "dem: float64 converted to float32")])
        self.assertEqual((shade.shape, shade.dtype), ((4, 5), np.uint8))
        with self.assertRaises(BadInput) as refused:
            thalweg.io.hillshade(np.zeros(3))
        self.assertTrue(refused.exception.where)

    def test_a_path_is_read(self):
        for path in (DEM, str(DEM)):
            np.testing.assert_array_equal(to_core(path, np.float32, "dem"), thalweg.io.read_dem(str(DEM)))
        with self.assertRaises(BadInput):
            to_core("no such file.tif", np.float32, "dem")


class Units(unittest.TestCase):
    def test_degrees_are_said(self):
        degrees = Raster(np.zeros((8, 8), np.float32), Grid(8, 8, 1 / 1200, 8.0, 47.0, "EPSG:4326"))
        with self.assertWarnsRegex(thalweg.UnitWarning, "dem: its coordinates are degrees"):
            thalweg.measure.slopes(degrees)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            thalweg.io.ground_cell(degrees.grid)
            thalweg.measure.slopes(Raster(np.zeros((8, 8), np.float32), Grid(8, 8, 30.0, 5e5, 5e6, "EPSG:32631")))


class Xarray(Quiet):
    def setUp(self):
        super().setUp()
        self.dem = Raster(slope(), cell_m=30.0, west=500010.0, north=4000020.0, crs="EPSG:32616")

    def test_rioxarray_reads_it(self):
        array = self.dem.to_xarray("dem")
        self.assertTrue(np.shares_memory(array.values, self.dem.values))
        self.assertEqual((array.dims, array.name), (("y", "x"), "dem"))
        self.assertEqual(array.x.values.tolist(), [500025.0, 500055.0, 500085.0, 500115.0, 500145.0])
        self.assertEqual(array.y.values.tolist(), [4000005.0, 3999975.0, 3999945.0, 3999915.0])
        self.assertEqual(array.rio.crs.to_epsg(), 32616)
        self.assertEqual(tuple(array.rio.transform())[:6], (30.0, 0.0, 500010.0, 0.0, -30.0, 4000020.0))
        self.assertEqual(array.rio.bounds(), self.dem.bounds)
        self.assertTrue(np.isnan(array.rio.nodata))
        self.assertIsNone(Raster(slope()).to_xarray().rio.crs)
        self.assertNotIn("_FillValue", Raster(slope() > 3).to_xarray().attrs)

    def test_there_and_back_is_the_same(self):
        for raster in (self.dem, Raster(slope(), cell_m=0.1, west=1 / 3, north=2 / 3), Raster(slope(1, 1), cell_m=7.0),
                       Raster(slope(1, 3), cell_m=7.0, west=2.0), thalweg.io.read_dem(str(DEM))):
            again = to_core(raster.to_xarray(), np.float32, "dem")
            self.assertTrue(np.shares_memory(again.values, raster.values))
            self.assertEqual(again.grid, raster.grid)

    def test_a_file_that_rioxarray_reads_is_what_the_library_reads(self):
        expected = thalweg.io.read_dem(str(DEM))
        for options in ({}, {"masked": True}):
            raster, _ = self.said(rioxarray.open_rasterio(DEM, **options), np.float32)
            np.testing.assert_array_equal(raster, expected)
            self.assertEqual(raster.grid, expected.grid)

    def test_rows_and_columns_are_turned(self):
        array = self.dem.to_xarray()
        for turned in (array[::-1], array[:, ::-1], array[::-1, ::-1], array.T, array.expand_dims(band=[1]),
                       array.rename(y="lat", x="lon").T):
            raster, texts = self.said(turned, np.float32)
            np.testing.assert_array_equal(raster, self.dem)
            self.assertEqual(raster.grid, self.dem.grid)
            self.assertLessEqual(set(texts), {"dem: copied, not in C order"})

    def test_a_part_lies_where_it_was(self):
        part, _ = self.said(self.dem.to_xarray()[1:3, 2:], np.float32)
        np.testing.assert_array_equal(part, slope()[1:3, 2:])
        self.assertEqual(part.grid, Grid(3, 2, 30.0, 500070.0, 3999990.0, "EPSG:32616"))
        every_second, _ = self.said(self.dem.to_xarray()[::2, ::2], np.float32)
        self.assertEqual(every_second.grid, Grid(3, 2, 60.0, 499995.0, 4000035.0, "EPSG:32616"))

    def test_without_coordinates_it_has_no_place(self):
        self.assertEqual(to_core(xarray.DataArray(slope()), np.float32, "dem").grid, Raster(slope()).grid)

    def test_nodata_scale_and_units(self):
        array = self.dem.to_xarray().astype(np.int16).assign_attrs(_FillValue=3)
        raster, texts = self.said(array, np.float32)
        self.assertEqual(texts, ["dem: copied, cells without data become NaN"])
        self.assertEqual(np.argwhere(np.isnan(raster.values)).tolist(), [[0, 3]])
        scaled, texts = self.said(self.dem.to_xarray().assign_attrs(scale_factor=0.5, add_offset=10.0), np.float32)
        self.assertEqual(texts, ["dem: copied, scale and offset applied"])
        np.testing.assert_array_equal(scaled, slope() * 0.5 + 10)
        with self.assertRaisesRegex(BadInput, "mask: cells without data, and uint8"):
            to_core(array, np.uint8, "mask")
        with self.assertRaisesRegex(BadInput, "dem: heights are in feet"):
            to_core(self.dem.to_xarray().assign_attrs(units="ft"), np.float32, "dem")

    def test_what_is_no_grid_is_refused_in_words(self):
        array = self.dem.to_xarray()
        rotated = array.copy()
        rotated.coords["spatial_ref"] = ((), 0, {"GeoTransform": "0 1 0.5 0 0.5 -1"})
        for given, words in [(array.assign_coords(x=array.x * 2), "dem: cells are not square: 60 x 30"),
                             (array.assign_coords(x=[0, 30, 60, 90, 150]), "dem: coordinates x are not evenly spaced"),
                             (rotated, "dem: is rotated"),
                             (xarray.concat([array, array], "band"), "more than one band"),
                             (array[0], "dem: has 1 dimensions"),
                             (array.to_dataset(name="z"), "dem: a Dataset holds several arrays .z.: choose one")]:
            with self.subTest(words), self.assertRaisesRegex(BadInput, words):
                to_core(given, np.float32, "dem")


class Pictures(Quiet):
    def test_plot_has_the_rasters_coordinates(self):
        heights = Raster(slope(), cell_m=10.0, west=100.0, north=500.0)
        axes = heights.plot()
        self.assertEqual(len(axes.images), 2)
        self.assertEqual(tuple(axes.images[0].get_extent()), (100.0, 150.0, 460.0, 500.0))
        self.assertIs(Raster(slope() > 3).plot(axes), axes)
        matplotlib.pyplot.close("all")

    def test_a_notebook_shows_it(self):
        empty = np.full((3, 3), np.nan, np.float32)
        for raster in (Raster(slope()), Raster(slope() > 3), Raster(empty), Raster(slope(2000, 3))):
            page = raster._repr_html_()
            self.assertRegex(page, "data:image/(png|jpeg);base64,")
            self.assertIn(f"{raster.grid.width} × {raster.grid.height} cells", page)

    def test_written_and_read_it_is_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/dem.tif"
            raster = Raster(slope(), cell_m=30.0, west=500010.0, north=4000020.0, crs="EPSG:32616")
            thalweg.io.write_dem(raster, path)
            again = to_core(path, np.float32, "dem")
        np.testing.assert_array_equal(again, raster)
        self.assertEqual(again.grid, raster.grid)


if __name__ == "__main__":
    unittest.main()
