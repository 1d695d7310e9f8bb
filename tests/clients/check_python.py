#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_python.py DEM: do GDAL, SAGA and GRASS find what functions of the Python package find that no command writes?

slope and aspect: gdaldem. fill_depressions(level=True): SAGA's ta_preprocessor 4 (Wang and Liu) without slope, bit for bit.
directions_of and follow: of the directions of r.watershed -s the areas that it adds up itself, where it has them whole (below 0 it does not
count all cells). codes_of and catchment: r.water.outlet on
our directions finds the same catchments. accumulate: numpy, along receivers from the smallest area to the largest.
sample: gdallocationinfo. Aspects are compared from 0.1 degrees of slope on: gdaldem computes in Float32. Prints one JSON line and exits with 1 on any violation."""
import pathlib
import tempfile

import numpy as np
import thalweg
from check_grass import Grass, session
from check_measures import values_of
from osgeo import gdal
from report import Report, command, run

gdal.UseExceptions()
STEPS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))  # row, column; clockwise from the east
OUTLETS = 8


def different(found, wanted, tolerance=0.0):
    """Cells where values differ by more than the tolerance, or one has none."""
    with np.errstate(invalid="ignore"):
        return int(((np.abs(found - wanted) > tolerance) | (np.isnan(found) != np.isnan(wanted))).sum())


def compare_with_gdal(path, dem, folder, report):
    figures = {}
    for what, found, turn in (("slope", thalweg.measure.slope(dem), 1e9), ("aspect", thalweg.measure.aspect(dem), 360.0)):
        out = folder / f"{what}.tif"
        command("gdaldem", what, path, out)
        wanted, _ = values_of(out)
        off = np.abs(found.values - wanted)
        off = np.minimum(off, turn - off)
        off[thalweg.measure.slope(dem).values < (0.1 if what == "aspect" else 0.0)] = np.nan
        figures[f"{what}_deg"] = float(np.nanmax(off))
        report.unless(np.nanmax(off) < 2e-2, what, f"{np.nanmax(off)} degrees")
        report.equal(f"{what}_cells", int((np.isnan(found.values) != np.isnan(wanted)).sum()), 0)
    random = np.random.default_rng(3)
    west, south, east, north = dem.bounds
    x, y = random.uniform(west, east, 50), random.uniform(south, north, 50)
    asked = "\n".join(f"{a!r} {b!r}" for a, b in zip(x.tolist(), y.tolist()))
    said = command("gdallocationinfo", "-valonly", "-geoloc", path, input=asked).stdout.split("\n")[:50]
    wanted = np.array([float(word) for word in said])
    wanted[wanted == -9999] = np.nan
    report.equal("sample", different(dem.sample(x, y).astype(float), wanted, 1e-6), 0)
    return figures


def compare_with_saga(path, dem, folder, report):
    out = {name: folder / f"{name}.sgrd" for name in ("filled", "directions", "basins")}
    command("saga_cmd", "-f=s", "ta_preprocessor", "4", "-ELEV", path, "-FILLED", out["filled"], "-FDIR", out["directions"],
            "-WSHED", out["basins"], "-MINSLOPE", 0)
    wanted, _ = values_of(out["filled"].with_suffix(".sdat"))
    found = thalweg.flow.fill_depressions(dem, level=True)
    report.equal("filled", different(found.values.astype(float), wanted), 0)
    return {"raised_cells": int((found.values > dem.values).sum())}


def compare_with_grass(dem, folder, report):
    grass = Grass(report)
    filled = thalweg.flow.fill_depressions(dem)
    filled.save(folder / "filled.tif")
    grass("r.in.gdal", input=folder / "filled.tif", output="dem")
    grass("g.region", raster="dem")
    grass("r.watershed", flags="s", elevation="dem", accumulation="area", drainage="towards", memory=1000)
    towards, area = grass.raster("towards", folder), grass.raster("area", folder)
    codes = thalweg.Raster(np.where(np.isnan(towards), -2**31, towards).astype(np.int32), dem.grid)
    theirs = thalweg.flow.follow(thalweg.flow.directions_of(codes, "grass"))
    whole = area > 0
    report.equal("areas_of_grass", int((theirs.area_cells.values[whole] != area[whole]).sum()), 0)

    drainage = thalweg.flow.route(dem)
    ours = thalweg.flow.codes_of(drainage.direction, "grass")
    place = folder / "codes.tif"
    file = gdal.GetDriverByName("GTiff").Create(str(place), *dem.shape[::-1], 1, gdal.GDT_Int32)
    grid = dem.grid
    file.SetGeoTransform((grid.west, grid.cell_m, 0, grid.north, 0, -grid.cell_m))
    file.SetProjection(gdal.Open(str(folder / "filled.tif")).GetProjection())
    file.GetRasterBand(1).SetNoDataValue(-2**31)
    file.GetRasterBand(1).WriteArray(ours.values)
    del file
    grass("r.in.gdal", input=place, output="codes")
    sizes = []
    order = np.argsort(drainage.area_cells.values, axis=None)[::-1]
    for number, cell in enumerate(order[np.geomspace(1, order.size / 50, OUTLETS).astype(int)]):
        x, y = dem.xy(*np.unravel_index(cell, dem.shape))
        grass("r.water.outlet", input="codes", output=f"basin{number}", coordinates=f"{float(x)!r},{float(y)!r}")
        wanted = np.nan_to_num(grass.raster(f"basin{number}", folder)) > 0
        found = thalweg.flow.catchment(drainage, (float(x), float(y))).values == 1
        sizes.append(int(found.sum()))
        report.equal("catchment", int((found != wanted).sum()), 0)
        report.equal("catchment_size", sizes[-1], int(drainage.area_cells.values.flat[cell]))
    return {"catchments_cells": sizes, "areas_compared": int(whole.sum())}


def compare_with_numpy(dem, report):
    drainage = thalweg.flow.route(dem)
    rain = np.random.default_rng(4).random(dem.shape)
    wanted, direction = rain.ravel().copy(), drainage.direction.values.ravel()
    width = dem.shape[1]
    for cell in np.argsort(drainage.area_cells.values, axis=None, kind="stable").tolist():  # upstream cells have less
        if direction[cell] < 8:
            row, column = STEPS[direction[cell]]
            wanted[cell + row * width + column] += wanted[cell]
    wanted[direction == 254] = np.nan
    found = thalweg.flow.accumulate(drainage, thalweg.Raster(rain, dem.grid)).values.ravel()
    off = np.nanmax(np.abs(found / wanted - 1.0))
    report.unless(off < 1e-12, "accumulate", off)
    return {"accumulated": float(off)}


def check(path):
    report = Report()
    dem = thalweg.Raster.open(path)
    with tempfile.TemporaryDirectory(prefix="thalweg-python-") as place:
        folder = pathlib.Path(place)
        figures = {**compare_with_gdal(path, dem, folder, report), **compare_with_saga(path, dem, folder, report),
                   **compare_with_numpy(dem, report)}
        with session(path, folder):
            figures |= compare_with_grass(dem, folder, report)
    return report.close(figures)


if __name__ == "__main__":
    run(check, __doc__, 1)
