#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_tin.py THALWEG DEM NETWORK: TINs of a DEM, of a network and of two meshes blended, in every format others read,
judged by meshio and OGR.

Every format must hold the same vertices and triangles; no vertex unused or twice in plan, every triangle
counterclockwise, no edge of more than two triangles and none run through twice the same way."""
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy
from osgeo import gdal, ogr

gdal.UseExceptions()
ogr.UseExceptions()
thalweg, dem, network = sys.argv[1:]
faults = 0


def fault(text):
    global faults
    faults += 1
    print(text)


def by_meshio(path):
    mesh = meshio.read(path)
    return mesh.points, numpy.vstack([block.data for block in mesh.cells if block.type == "triangle"])


def by_2dm(path):
    points, triangles = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split()
        if word == "ND":
            points.append([float(v) for v in rest[1:]])
        elif word == "E3T":
            triangles.append([int(v) - 1 for v in rest[1:4]])
    return numpy.array(points), numpy.array(triangles)


def by_ogr(path):
    data = ogr.Open(str(path))  # kept alive: its layers die with it
    points, triangles = {}, []
    for feature in data.GetLayer("faces"):
        ring = feature.GetGeometryRef().GetGeometryRef(0)
        corners = [ring.GetPoint(i) for i in range(4)]
        if ring.GetPointCount() != 4 or corners[0] != corners[3]:
            fault(f"{path.name}: face {feature.GetFID()} is no closed triangle")
        triangles.append([points.setdefault(c, len(points)) for c in corners[:3]])
    return numpy.array(list(points)), numpy.array(triangles)


def judge(name, points, triangles):
    """Counts and area; says what is wrong."""
    def wrong(what, count):
        if count:
            fault(f"{name}: {count} {what}")
    wrong("vertices unused", len(points) - len(numpy.unique(triangles)))
    wrong("vertices twice in plan", len(points) - len(numpy.unique(points[:, :2], axis=0)))
    a, b, c = (points[triangles[:, k]] for k in range(3))
    twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    wrong("triangles not counterclockwise", int((twice <= 0).sum()))
    edges = numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    wrong("edges run through twice the same way", len(edges) - len(numpy.unique(edges, axis=0)))
    _, count = numpy.unique(numpy.sort(edges, axis=1), axis=0, return_counts=True)
    wrong("edges of more than two triangles", int((count > 2).sum()))
    return len(points), len(triangles), round(float(twice.sum()) / 2, 3), round(float(points[:, 2].sum()), 3)


with tempfile.TemporaryDirectory() as place:
    land = pathlib.Path(place) / "land.off"
    subprocess.run([thalweg, "tin", dem, "--error", "5", "-o", land, "-q"], check=True, stdout=subprocess.DEVNULL)
    for kind, words in (("dem", ["tin", dem, "--error", "5"]), ("network", ["tin", network]),
                        ("blended", ["blend", land, land, "--scale", "0.3", "--rotate", "25", "--gain", "0.5"])):
        seen = {}
        for ending, read in (("ply", by_meshio), ("obj", by_meshio), ("off", by_meshio), ("2dm", by_2dm), ("gpkg", by_ogr)):
            path = pathlib.Path(place) / f"{kind}.{ending}"
            subprocess.run([thalweg, *words, "-o", path, "-q"], check=True, stdout=subprocess.DEVNULL)
            seen[ending] = judge(path.name, *read(path))
        if len(set(seen.values())) != 1:
            fault(f"{kind}: the formats differ: {seen}")
        print(kind, seen["ply"])
sys.exit(1 if faults else 0)
