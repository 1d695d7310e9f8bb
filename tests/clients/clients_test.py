#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""clients_test.py CHECK FOLDER [STATE]: does check_CHECK.py find each fault planted in a copy?

CHECK: network, catchments, grass, saga, relief, postgis, qgis or gdal. FOLDER: what `thalweg make` left, and good; of its
network the faults of ridges where it has them, of the unit of heights where it names it. STATE: of cluster.py, for postgis.
Exits with 1 when a fault goes unseen or FOLDER itself is not good."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, ogr

gdal.UseExceptions()
ogr.UseExceptions()
HERE = pathlib.Path(__file__).parent
NET, SHP, DEM, MASK = "network.gpkg", "network_arcs.shp", "dem.tif", "network.tif"


def geopackage(change, name=NET):
    def plant(folder):
        dataset = ogr.Open(str(folder / name), update=1)
        change(dataset)
    return plant


def network(change):
    return geopackage(change)


def catchments(change):
    return geopackage(change, "catchments.gpkg")


def number(layer, field, change):
    def plant(dataset):
        table = dataset.GetLayerByName(layer)
        feature = table.GetNextFeature()
        feature[field] = change(feature[field])
        table.SetFeature(feature)
    return plant


def vertices(layer, change):
    """Changes the vertices of the first feature."""
    def plant(dataset):
        table = dataset.GetLayerByName(layer)
        feature = table.GetNextFeature()
        points = change([list(p) for p in feature.GetGeometryRef().GetPoints()])
        shape = ogr.Geometry(feature.GetGeometryRef().GetGeometryType())
        for p in points:
            shape.AddPoint(*p)
        feature.SetGeometry(shape)
        table.SetFeature(feature)
    return plant


def sql(*statements):
    def plant(dataset):
        for statement in statements:
            dataset.ExecuteSQL(statement)
    return plant


def middle(feature):
    """Of its first segment."""
    a, b = feature.GetGeometryRef().GetPoints()[:2]
    return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]


def touch(dataset):
    """Leads the first arc over the middle of the last."""
    table = dataset.GetLayerByName("arcs")
    at = middle(table.GetFeature(table.GetFeatureCount()))
    vertices("arcs", lambda p: [p[0], [*at, p[0][2]], p[-1]])(dataset)


def onto_river(dataset):
    """Leads the first ridge to the middle of the first arc."""
    at = middle(dataset.GetLayerByName("arcs").GetNextFeature())
    vertices("ridges", lambda p: [*p, [*at, p[-1][2]]])(dataset)


def nudge_end(points):
    points[-1][0] += 1e-9 * max(1.0, abs(points[-1][0]))
    return points


def lift_end(points):
    points[-1][2] = points[0][2] + 1.0
    return points


def loop(points):
    (ax, ay, z), (bx, by, end) = points[0], points[-1]
    dx, dy = bx - ax, by - ay
    return [points[0], [ax + dx, ay + 0.1 * dy, z], [ax, ay + 0.5 * dy, z], [ax + 0.5 * dx, ay - dy, z], [bx, by, end]]


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


def heights(change):
    def plant(folder):
        path = folder / DEM
        dem = gdal.Open(str(path))
        z = dem.ReadAsArray()
        changed = gdal.GetDriverByName("MEM").CreateCopy("", dem)
        changed.GetRasterBand(1).WriteArray(change(z))
        dem = None
        gdal.GetDriverByName("GTiff").CreateCopy(str(path), changed, options=["COMPRESS=DEFLATE", "TILED=YES"])
    return plant


def cut_short(name, share):
    def plant(folder):
        data = (folder / name).read_bytes()
        (folder / name).write_bytes(data[: int(len(data) * share)])
    return plant


def pit(z):
    """One cell, one bit deep."""
    row, column = z.shape[0] // 2, z.shape[1] // 2
    around = z[row - 1:row + 2, column - 1:column + 2].copy()
    around[1, 1] = np.inf
    z[row, column] = np.nextafter(around.min(), np.float32(-np.inf), dtype=np.float32)
    return z


def arc_again(ends):
    """One arc more: the first as `ends` draws it."""
    def plant(dataset):
        table = dataset.GetLayerByName("arcs")
        first = table.GetNextFeature()
        more = first.Clone()
        more.SetFID(-1)
        more["arc_id"] = 10**6
        points = first.GetGeometryRef().GetPoints()
        shape = ogr.Geometry(ogr.wkbLineString25D)
        for p in ends(points):
            shape.AddPoint(*p)
        more.SetGeometry(shape)
        table.CreateFeature(more)
    return plant


def detour(points):
    (ax, ay, az), (bx, by, bz) = points[0], points[-1]
    return [points[0], [(ax + bx) / 2 + 1.37, (ay + by) / 2 + 0.71, (az + bz) / 2], points[-1]]


def onto_interior(dataset):
    """Moves a source's node onto the middle of an arc that is not its own."""
    arcs, nodes = dataset.GetLayerByName("arcs"), dataset.GetLayerByName("nodes")
    arc = arcs.GetFeature(arcs.GetFeatureCount())
    a, b = arc.GetGeometryRef().GetPoints()[:2]
    # A quarter of a half of a coordinate loses no bits that would take the point off the line.
    line = ogr.Geometry(ogr.wkbLineString25D)
    middle = [float(round((a[0] + b[0]) / 2)), float(round((a[1] + b[1]) / 2)), a[2]]
    for p in (a, middle, *arc.GetGeometryRef().GetPoints()[1:]):
        line.AddPoint(*p)
    arc.SetGeometry(line)
    arcs.SetFeature(arc)
    nodes.SetAttributeFilter(f"kind = 'source' AND node_id <> {arc['from_node']}")
    node = nodes.GetNextFeature()
    shape = ogr.Geometry(ogr.wkbPoint25D)
    shape.AddPoint(*middle)
    node.SetGeometry(shape)
    nodes.SetFeature(node)


def flat(folder):
    """Lines without heights."""
    path = folder / NET
    gdal.VectorTranslate(str(folder / "flat.gpkg"), str(path), layers=["arcs", "nodes"], dim="XY")
    (folder / "flat.gpkg").replace(path)


def other_figures(folder):
    """A report that tells of another land."""
    path = folder / "report.json"
    told = json.loads(path.read_text())
    for figure in told["dem"]["relief"]["figures"].values():
        figure["value"] = 1.1 * (figure["value"] or 0.0) + 10
    told["dem"]["relief"]["extremes"] = {"pits": -1, "peaks": -1}
    told["dem"]["relief"]["forms"]["valley"] += 0.05
    path.write_text(json.dumps(told))


def no_ridges(folder):
    """A figure that is unknown to the report alone."""
    path = folder / "report.json"
    told = json.loads(path.read_text())
    told["dem"]["relief"]["figures"]["valleys_over_ridges"]["value"] = None
    path.write_text(json.dumps(told))


OF_NETWORK = [
    *[(field, number("arcs", field, lambda v: v + 1)) for field in
      "ds_arc n_up basin_id topo_ord strahler shreve hack length length_3d straight z_up z_down dist_out slope".split()],
    *[(field, number("nodes", field, lambda v: v + 1)) for field in "deg_in deg_out basin_id strahler z dist_out".split()],
    ("kind", number("nodes", "kind", lambda v: "source" if v == "outlet" else "outlet")),
    ("area_below_zero", number("arcs", "us_area", lambda v: -1.0)),
    ("area_below_zero", number("nodes", "area", lambda v: -1.0)),
    ("id_twice", number("arcs", "arc_id", lambda v: v + 1)),
    ("id_below_one", number("nodes", "node_id", lambda v: 0)),
    ("node_missing", number("arcs", "from_node", lambda v: 10**8)),
    ("several_outflows", sql("UPDATE arcs SET from_node = (SELECT max(from_node) FROM arcs)")),
    ("cycle", sql("UPDATE arcs SET to_node = from_node WHERE arc_id = 1")),
    ("end_is_not_its_node", vertices("arcs", nudge_end)),
    ("end_is_not_its_node", vertices("nodes", nudge_end)),
    ("uphill", vertices("arcs", lift_end)),
    ("repeated_vertex", vertices("arcs", lambda p: p[:1] + p)),
    ("not_simple", vertices("arcs", loop)),
    ("isolated_node", sql("DELETE FROM arcs WHERE arc_id = 1")),
    ("field_missing", sql("ALTER TABLE arcs DROP COLUMN hack")),
    ("field_name_too_long", sql("ALTER TABLE nodes ADD COLUMN eleven_char INTEGER DEFAULT 1")),
    ("null", sql("ALTER TABLE nodes ADD COLUMN empty INTEGER")),
    ("field_type", sql("ALTER TABLE arcs RENAME COLUMN strahler TO a", "ALTER TABLE arcs RENAME COLUMN length TO strahler",
                       "ALTER TABLE arcs RENAME COLUMN a TO length")),
    ("no_arcs", sql("DELETE FROM arcs")),
    ("crossing", touch),
]
OF_RIDGES = [
    ("ridge_in_one_stream", sql("UPDATE ridges SET left = right WHERE ridge_id = 1")),
    ("ridge_z_order", number("ridges", "z_min", lambda v: v + 1e6)),
    ("ridge_z", number("ridges", "z_max", lambda v: v + 1)),
    ("ridge_length", number("ridges", "length", lambda v: v + 1)),
    ("ridge_meets_river", onto_river),
]
OF_UNITS = [
    ("z_unit", sql("UPDATE arcs SET z_unit = 'yd' WHERE arc_id = 1")),
    ("several_units", sql("ALTER TABLE nodes DROP COLUMN z_unit")),
    ("length_3d", sql("ALTER TABLE arcs DROP COLUMN z_unit")),
    ("slope", sql("ALTER TABLE arcs DROP COLUMN z_unit")),
    ("slope", number("arcs", "slope", lambda v: v / 0.3048)),
    ("field_type", sql("ALTER TABLE arcs DROP COLUMN z_unit", "ALTER TABLE arcs ADD COLUMN z_unit INTEGER DEFAULT 1")),
]
OF_CATCHMENTS = [
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
UPSIDE_DOWN = heights(np.flipud)
TURNED_OVER = heights(lambda z: np.where(np.abs(z) < 1e5, -z, z))
NO_APPLICATION = network(sql("PRAGMA application_id = 1"))
PLANTED = {
    "network": [(fault, network(plant)) for fault, plant in OF_NETWORK],
    "ridges": [(fault, network(plant)) for fault, plant in OF_RIDGES],
    "units": [(fault, network(plant)) for fault, plant in OF_UNITS],
    "catchments": [(fault, catchments(plant)) for fault, plant in OF_CATCHMENTS],
    "grass": [
        ("clean_break", network(touch)),
        ("clean_rmdupl", network(arc_again(lambda points: points))),
        ("bridges", network(arc_again(detour))),
        ("nodes_off_arc_ends", network(vertices("nodes", nudge_end))),
        ("nodes_at_arc_ends", network(sql("DELETE FROM nodes WHERE node_id = 1"))),
        ("clean_rmline", network(vertices("arcs", lambda p: [p[0], p[0]]))),
        ("clean_snap", network(vertices("arcs", lambda p: [[p[0][0] + 1e-4, *p[0][1:]], *p[1:]]))),
        ("module_failed", network(sql("DROP TABLE nodes"))),
        ("precision_at_one_cell", UPSIDE_DOWN),
        ("recall_at_one_cell", UPSIDE_DOWN),
        ("f_in_network_cells", UPSIDE_DOWN),
        ("f_at_one_cell", UPSIDE_DOWN),
        ("recall_by_area", UPSIDE_DOWN),
    ],
    "saga": [("depression", heights(pit))],
    "relief": [
        *((fault, other_figures) for fault in ("slope_mean", "slope_p5", "slope_p50", "slope_p95", "slope_cv", "form_distance",
                                               "valleys_over_ridges", "aspects_along_grid", "aspects_on_grid", "theta", "forms",
                                               "pits", "peaks", "perched")),
        *((fault, TURNED_OVER) for fault in ("valleys_over_ridges", "forms", "perched")),
        ("valleys_over_ridges", no_ridges),
    ],
    "postgis": [
        ("crossing", network(touch)),
        ("edges_faces_nodes", network(touch)),
        ("edges_faces_nodes", network(arc_again(detour))),
        ("twice", network(arc_again(lambda points: points))),
        ("invalid", network(vertices("arcs", lambda p: [p[0], p[0]]))),
        ("not_simple", network(vertices("arcs", loop))),
        ("invalid", network(vertices("arcs", lambda p: [p[0], [float("nan"), p[0][1], p[0][2]], *p[1:]]))),
        ("end_is_not_its_node", network(vertices("arcs", nudge_end))),
        ("end_is_not_its_node", network(vertices("arcs", lift_end))),
        ("end_is_not_its_node", network(number("arcs", "to_node", lambda v: 10**8))),
        ("node_inside_an_arc", network(onto_interior)),
        ("not_a_line_in_3d", flat),
        ("cycle", network(sql("UPDATE arcs SET from_node = (SELECT to_node FROM arcs WHERE ds_arc = 0 LIMIT 1), to_node = "
                              "(SELECT from_node FROM arcs WHERE ds_arc = 0 LIMIT 1) WHERE arc_id = (SELECT min(arc_id) FROM arcs WHERE ds_arc <> 0)"))),
        ("components", network(sql("DELETE FROM arcs WHERE arc_id = (SELECT arc_id FROM arcs WHERE n_up > 0 AND ds_arc <> 0 LIMIT 1)"))),
        ("source_without_outlet", network(sql("DELETE FROM arcs WHERE ds_arc = 0"))),
        ("warning", NO_APPLICATION),
        ("no_arcs", network(sql("DELETE FROM arcs"))),
    ],
    "qgis": [
        ("invalid_geometry", network(vertices("arcs", loop))),
        ("features", network(sql("DROP TRIGGER trigger_insert_feature_count_arcs",
                                 "UPDATE gpkg_ogr_contents SET feature_count = feature_count + 1"))),
        ("no_crs", lambda folder: (folder / "network_arcs.prj").unlink()),
        ("no_geometry", network(vertices("arcs", lambda p: []))),
        ("gdal", cut_short(DEM, 0.6)),
        ("unread_raster", cut_short(DEM, 0.6)),
        ("gdal", NO_APPLICATION),
        ("not_opened", cut_short(NET, 0.1)),
    ],
    "gdal": [
        ("warning", NO_APPLICATION),
        ("warning", cut_short("network_arcs.dbf", 0.6)),
        ("unread_band", cut_short(DEM, 0.6)),
        ("features", network(sql("UPDATE gpkg_ogr_contents SET feature_count = feature_count + 1"))),
        ("not_opened", cut_short(NET, 0.0)),
    ],
}
WORDS = {
    "network": lambda folder, state: [folder / NET],
    "catchments": lambda folder, state: [folder],
    "grass": lambda folder, state: [folder / DEM, folder / MASK, folder / NET, "recall=0.7"],
    "saga": lambda folder, state: [folder / DEM],
    "relief": lambda folder, state: [folder],
    "postgis": lambda folder, state: [state, folder / NET],
    "qgis": lambda folder, state: [folder / NET, folder / SHP, folder / DEM],
    "gdal": lambda folder, state: [folder],
}


def faults_in(client, folder, state):
    words = [HERE / f"check_{client}.py", *WORDS[client](folder, state)]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        return {f"exit {done.returncode}: {done.stderr.strip()[-300:]}"}
    return set(json.loads(done.stdout)["violations"])


def planted_in(client, folder):
    """The faults for a folder, one after another."""
    if client == "network":
        data = ogr.Open(str(folder / NET))
        if data.GetLayerByName("arcs").FindFieldIndex("z_unit", 1) >= 0:
            return PLANTED["units"]
        return PLANTED["network" if data.GetLayerByName("ridges") is None else "ridges"]
    return PLANTED[client]


def main(client, folder, state=None):
    folder = pathlib.Path(folder)
    planted = planted_in(client, folder)
    unseen = [f"{folder} itself has {fault}" for fault in sorted(faults_in(client, folder, state))]
    seen = {}
    with tempfile.TemporaryDirectory(prefix="thalweg-planted-") as place:
        for fault, plant in planted:
            if plant not in seen:
                copy = pathlib.Path(place) / f"copy{len(seen)}"
                shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("*.html", "*.svg", "*.png", "inputs"))
                plant(copy)
                seen[plant] = faults_in(client, copy, state)
                shutil.rmtree(copy)
            if fault not in seen[plant]:
                unseen.append(f"{fault} planted, {sorted(seen[plant])} found")
    print(json.dumps({"planted": len(planted), "unseen": unseen}))
    return 1 if unseen else 0


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in WORDS:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
