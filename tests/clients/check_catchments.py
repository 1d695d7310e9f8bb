#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_catchments.py DIR: do the catchments of a folder that make left tile the land that drains to its rivers?

DIR holds catchments.gpkg, network.gpkg, dem.tif and report.json. GEOS judges the outlines: each valid, none over
another, no hole between them that the DEM has no data for, together the same as the basins. Areas must be those of the
outlines, of their cells, and downstream those of the network. Nothing of thalweg is used, only GDAL, GEOS and numpy.
Prints one JSON object and exits with 1 on any violation, 2 when there is nothing to check.
"""
import json
import pathlib
from collections import defaultdict

import numpy as np
from osgeo import gdal, ogr
from report import Report, run

gdal.UseExceptions()
ogr.UseExceptions()


def same(a, b, total):
    return abs(a - b) <= 1e-9 * max(abs(a), abs(b), total * 1e-3)


def rows_of(dataset, name, key):
    """Rows of a layer by their id, with their shape."""
    layer = dataset.GetLayerByName(name)
    fields = [layer.GetLayerDefn().GetFieldDefn(i).GetName() for i in range(layer.GetLayerDefn().GetFieldCount())]
    rows = []
    for feature in layer:
        row = {field: feature[field] for field in fields}
        shape = feature.GetGeometryRef()
        row["shape"] = shape.Clone() if shape is not None else None
        row["name"] = f"{name} {row.get(key)}"
        rows.append(row)
    return rows


def union_of(rows):
    parts = ogr.Geometry(ogr.wkbMultiPolygon)
    for row in rows:
        for i in range(row["shape"].GetGeometryCount()):
            parts.AddGeometry(row["shape"].GetGeometryRef(i))
    return parts.UnionCascaded()


def holes_of(shape):
    if shape.GetGeometryName() == "POLYGON":
        for i in range(1, shape.GetGeometryCount()):
            hole = ogr.Geometry(ogr.wkbPolygon)
            hole.AddGeometry(shape.GetGeometryRef(i))
            yield hole
    else:
        for i in range(shape.GetGeometryCount()):
            yield from holes_of(shape.GetGeometryRef(i))


def check_shapes(rows, cell_m2, report):
    good = []
    for row in rows:
        shape = row["shape"]
        if shape is None or shape.GetGeometryName() != "MULTIPOLYGON" or shape.IsEmpty():
            report.unless(False, "no_multipolygon", row["name"])
            continue
        report.unless(shape.IsValid(), "invalid", row["name"])
        report.unless(row["area"] == row["cells"] * cell_m2, "area_is_not_its_cells", row["name"])
        report.unless(same(shape.Area(), row["area"], 0.0), "area_is_not_its_outline", f"{row['name']}: {shape.Area()}")
        good.append(row)
    return good


def check_links(catchments, arcs, report):
    """Links and areas downstream, against the network's own."""
    by_id = {row["arc_id"]: row for row in catchments}
    report.unless(len(by_id) == len(catchments), "id_twice", len(catchments) - len(by_id))
    below = defaultdict(float)
    for arc_id in arcs:
        own = by_id[arc_id]["area"] if arc_id in by_id else 0.0
        at, steps = arc_id, 0
        while at in arcs and steps <= len(arcs):
            below[at] += own
            at, steps = arcs[at]["ds_arc"], steps + 1
    for row in catchments:
        arc = arcs.get(row["arc_id"])
        if arc is None:
            report.unless(False, "no_such_arc", row["name"])
            continue
        for field in ("ds_arc", "basin_id", "ds_area"):
            report.unless(row[field] == arc[field], f"{field}_is_not_the_arc's", row["name"])
        report.unless(same(row["ds_area"], below[row["arc_id"]], 0.0), "ds_area_is_no_sum", row["name"])
    for arc_id, arc in arcs.items():
        report.unless(arc_id in by_id or same(arc["ds_area"], below[arc_id], 0.0), "catchment_missing", f"arc {arc_id}")


def main(folder):
    report = Report()
    folder = pathlib.Path(folder)
    dem = gdal.Open(str(folder / "dem.tif"))
    place, band = dem.GetGeoTransform(), dem.GetRasterBand(1)
    heights = band.ReadAsArray()
    data = np.isfinite(heights) & (heights != band.GetNoDataValue())
    cell_m2 = place[1] * -place[5]

    file = ogr.Open(str(folder / "catchments.gpkg"))
    network = ogr.Open(str(folder / "network.gpkg"))
    for layer in ("catchments", "basins"):
        srs = file.GetLayerByName(layer).GetSpatialRef()
        report.unless(srs is not None and srs.IsSame(dem.GetSpatialRef()), "crs", layer)
    arcs = {row["arc_id"]: row for row in rows_of(network, "arcs", "arc_id")}
    catchments = check_shapes(rows_of(file, "catchments", "arc_id"), cell_m2, report)
    basins = check_shapes(rows_of(file, "basins", "basin_id"), cell_m2, report)
    if not catchments:
        raise RuntimeError("there are no catchments")
    check_links(catchments, arcs, report)

    answer = {"catchments": len(catchments), "basins": len(basins)}
    if not report.counts["invalid"]:
        whole, total = union_of(catchments), sum(row["shape"].Area() for row in catchments)
        report.unless(same(whole.Area(), total, total), "overlap", f"{total - whole.Area()} m2 of {total}")
        apart = whole.SymDifference(union_of(basins)).Area()
        report.unless(apart <= 1e-9 * total, "basins_are_not_their_catchments", f"{apart} m2")
        for hole in holes_of(whole):
            west, east, south, north = hole.GetEnvelope()
            cols = slice(round((west - place[0]) / place[1]), round((east - place[0]) / place[1]))
            rows = slice(round((north - place[3]) / place[5]), round((south - place[3]) / place[5]))
            report.unless(not data[rows, cols].all(), "gap", [west, south])
    for basin in basins:
        own = [row for row in catchments if row["basin_id"] == basin["basin_id"]]
        report.unless(basin["cells"] == sum(row["cells"] for row in own), "basin_cells", basin["name"])
        report.unless(basin["arcs"] == len(own), "basin_arcs", basin["name"])
    without = json.loads((folder / "report.json").read_text())["catchments"]["cells_without"]
    cells = sum(row["cells"] for row in catchments)
    report.unless(cells + without == int(data.sum()), "cells_lost", f"{cells} + {without} of {int(data.sum())}")
    return report.close({**answer, "cells": cells, "cells_without": without})


if __name__ == "__main__":
    run(main, __doc__, 1)
