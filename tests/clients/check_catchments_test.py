#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_catchments_test.py DIR: does check_catchments.py find each fault planted in a copy of good catchments?

Exits with 1 when a fault goes unseen or the folder itself is not good.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from osgeo import ogr

ogr.UseExceptions()
CHECK = pathlib.Path(__file__).with_name("check_catchments.py")
NEEDED = ("catchments.gpkg", "network.gpkg", "dem.tif", "report.json")


def faults_in(folder):
    run = subprocess.run([str(CHECK), str(folder)], capture_output=True, text=True, check=False)
    return set(json.loads(run.stdout)["violations"]) if run.returncode < 2 else {run.stderr}


def number(layer, field, change):
    def plant(dataset):
        table = dataset.GetLayerByName(layer)
        feature = table.GetNextFeature()
        feature[field] = change(feature[field])
        table.SetFeature(feature)
    return plant


def shape(layer, change):
    """Changes the outline of the first feature."""
    def plant(dataset):
        table = dataset.GetLayerByName(layer)
        feature = table.GetNextFeature()
        feature.SetGeometry(change(feature.GetGeometryRef().Clone()))
        table.SetFeature(feature)
    return plant


def moved(whole):
    """Half its width to the east."""
    west, east, _, _ = whole.GetEnvelope()
    for i in range(whole.GetGeometryCount()):
        for k in range(whole.GetGeometryRef(i).GetGeometryCount()):
            ring = whole.GetGeometryRef(i).GetGeometryRef(k)
            for n in range(ring.GetPointCount()):
                ring.SetPoint_2D(n, ring.GetX(n) + (east - west) / 2, ring.GetY(n))
    return whole


def bow_tie(whole):
    west, east, south, north = whole.GetEnvelope()
    text = f"{west} {south},{east} {north},{east} {south},{west} {north},{west} {south}"
    return ogr.CreateGeometryFromWkt(f"MULTIPOLYGON((({text})))")


def pierced(dataset):
    """Takes a cell out of the middle of the largest catchment and of its basin."""
    table = dataset.GetLayerByName("catchments")
    largest = max(table, key=lambda feature: feature["cells"])
    cell = (largest["area"] / largest["cells"]) ** 0.5
    inner = largest.GetGeometryRef().Buffer(-2 * cell).PointOnSurface()
    hole = inner.Buffer(cell / 2)
    for layer, rows in (("catchments", [largest]), ("basins", list(dataset.GetLayerByName("basins")))):
        for feature in rows:
            cut = ogr.ForceToMultiPolygon(feature.GetGeometryRef().Difference(hole))
            feature.SetGeometry(cut)
            dataset.GetLayerByName(layer).SetFeature(feature)


def without_first(dataset):
    table = dataset.GetLayerByName("catchments")
    table.DeleteFeature(table.GetNextFeature().GetFID())


PLANTED = [
    ("overlap", shape("catchments", moved)),
    ("basins_are_not_their_catchments", shape("catchments", moved)),
    ("gap", pierced),
    ("invalid", shape("catchments", bow_tie)),
    ("invalid", shape("basins", bow_tie)),
    ("area_is_not_its_cells", number("catchments", "area", lambda v: v + 1)),
    ("area_is_not_its_outline", number("basins", "area", lambda v: v * 2)),
    ("ds_arc_is_not_the_arc's", number("catchments", "ds_arc", lambda v: v + 1)),
    ("basin_id_is_not_the_arc's", number("catchments", "basin_id", lambda v: v + 1)),
    ("ds_area_is_not_the_arc's", number("catchments", "ds_area", lambda v: v + 1)),
    ("ds_area_is_no_sum", number("catchments", "ds_area", lambda v: v * 2)),
    ("id_twice", number("catchments", "arc_id", lambda v: v + 1)),
    ("no_such_arc", number("catchments", "arc_id", lambda v: 10**8)),
    ("catchment_missing", without_first),
    ("cells_lost", without_first),
    ("basin_cells", number("basins", "cells", lambda v: v + 1)),
    ("basin_arcs", number("basins", "arcs", lambda v: v + 1)),
]


def main(folder):
    folder = pathlib.Path(folder)
    unseen = [f"{folder} itself has {fault}" for fault in sorted(faults_in(folder))]
    with tempfile.TemporaryDirectory() as name:
        copy = pathlib.Path(name)
        for fault, plant in PLANTED:
            for needed in NEEDED:
                shutil.copy(folder / needed, copy / needed)
            dataset = ogr.Open(str(copy / "catchments.gpkg"), update=1)
            plant(dataset)
            dataset = None
            found = faults_in(copy)
            if fault not in found:
                unseen.append(f"{fault} planted, {sorted(found)} found")
    print(json.dumps({"planted": len(PLANTED), "unseen": unseen}, indent=1))
    return 1 if unseen else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
