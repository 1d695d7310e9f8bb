#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_land.py FOLDER: is what `thalweg make` left of a recipe without rivers, or with triangles, what was asked?

dem.tif: a tiled Float32 COG with a height for every cell. Where recipe.toml has [statistics]: each of them, reckoned from
dem.tif alone as docs/statistics.md defines it, within 1 % (the dimension within 0.02), extremes at their places and nowhere
else. Points of a file, where statistics start from them: each is its cell's height. tin.ply with a network: every
segment of every arc runs along edges of triangles, at its heights. Nothing of thalweg is used.
Prints one JSON object and exits with 1 on any violation, 2 when there is nothing to check."""
import csv
import pathlib
import tomllib

import meshio
import numpy as np
from check_dem import check_cog
from osgeo import gdal, ogr
from report import Report, run

gdal.UseExceptions()
ogr.UseExceptions()


def check_raster(path, report):
    dem = check_cog(str(path), report)
    nodata = dem.GetRasterBand(1).GetNoDataValue()
    z = dem.ReadAsArray().astype(float)
    holes = ~np.isfinite(z) | (z == nodata) | (np.abs(z) > 1e5)
    report.unless(not holes.any(), "cells_without_height", int(holes.sum()))
    return z, dem.GetGeoTransform()


def correlation_length(z):
    """Along rows: the first lag, between whole ones, at which the autocorrelation is 1/e; else the fit stands for it."""
    deviation, variance, most = z - z.mean(), z.var(), z.shape[1] // 2
    r = np.array([1.0] + [(deviation[:, k:] * deviation[:, :-k]).mean() / variance for k in range(1, most + 1)])
    below = np.flatnonzero(r <= np.exp(-1))
    if len(below):
        k = below[0]
        return k - 1 + (r[k - 1] - np.exp(-1)) / (r[k - 1] - r[k])
    lags = np.array([k for k in range(1, most + 1) if 0 < r[k] < 1])
    alpha, crossing = np.polyfit(np.log(lags), np.log(-np.log(r[lags])), 1)
    return float(np.exp(-crossing / alpha))


def dimension(z):
    lags = np.arange(1, 6)
    squares = [((z[:, k:] - z[:, :-k]) ** 2).mean() / 2 + ((z[k:] - z[:-k]) ** 2).mean() / 2 for k in lags]
    return 3 - np.polyfit(np.log(lags), np.log(squares) / 2, 1)[0]


def check_statistics(z, wanted, report):
    down, along = np.gradient(z)
    found = {"mean": z.mean(), "std": z.std(), "slope": np.arctan(np.hypot(along, down)).mean(), "dimension": dimension(z)}
    if "length" in wanted:
        found["lx"], found["ly"] = correlation_length(z), correlation_length(z.T)
        wanted = dict(wanted, lx=wanted["length"][0], ly=wanted["length"][1])
    for key, value in found.items():
        if key in wanted:
            limit = 0.02 if key == "dimension" else 0.01 * abs(wanted[key])
            report.unless(abs(value - wanted[key]) <= limit, key, [float(value), wanted[key]])
    for key, extreme in (("max", z.max()), ("min", z.min())):
        if key in wanted:
            height, column, row = wanted[key]
            places = [[int(c), int(r)] for r, c in np.argwhere(z == extreme)]
            report.unless(places == [[column, row]] and extreme == np.float32(height), key, [float(extreme), places])
    return {key: round(float(value), 4) for key, value in found.items()}


def check_points(z, place, path, report):
    with open(path) as text:
        points = [[float(row[k]) for k in "xyz"] for row in csv.DictReader(text)]
    for x, y, height in points:
        column, row = int((x - place[0]) // place[1]), int((place[3] - y) // -place[5])
        report.unless(z[row, column] == np.float32(height), "point_not_kept", [x, y, height, z[row, column]])
    return len(points)


def check_breaklines(tin, network, report):
    mesh = meshio.read(tin)
    triangles = np.vstack([block.data for block in mesh.cells if block.type == "triangle"])
    number = {tuple(p): i for i, p in enumerate(mesh.points)}
    neighbours = [set() for _ in mesh.points]
    for a, b in [(t[i], t[i - 1]) for t in triangles for i in range(3)]:
        neighbours[a].add(b)
        neighbours[b].add(a)
    segments = 0
    data = ogr.Open(str(network))  # kept alive: its layers die with it
    for feature in data.GetLayerByName("arcs"):
        points = [tuple(p) for p in feature.GetGeometryRef().GetPoints()]
        for a, b in zip(points, points[1:]):
            segments += 1
            where = f"arc {feature['arc_id']}: {a} {b}"
            if a not in number or b not in number:
                report.unless(False, "river_vertex_not_in_tin", where)
                continue
            report.unless(number[b] in neighbours[number[a]], "river_segment_not_in_tin", where)
    return segments


def main(folder):
    report = Report()
    recipe = tomllib.loads((folder / "recipe.toml").read_text())
    answer = {"folder": str(folder)}
    z, place = check_raster(folder / "dem.tif", report)
    statistics = recipe.get("statistics", {})
    if statistics:
        answer["statistics"] = check_statistics(z, statistics, report)
    points = recipe.get("skeleton", {}).get("points", "")
    if points and statistics.get("skeleton") == "points":
        answer["points"] = check_points(z, place, folder / points, report)
    if (folder / "tin.ply").exists() and (folder / "network.gpkg").exists():
        answer["segments"] = check_breaklines(folder / "tin.ply", folder / "network.gpkg", report)
    return report.close(answer)


if __name__ == "__main__":
    run(lambda folder: main(pathlib.Path(folder)), __doc__, 1)
