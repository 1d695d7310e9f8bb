#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""clients_test.py grass|saga|relief|postgis|qgis|gdal FOLDER [STATE]: does check_grass.py, ... find each fault planted in a copy?

FOLDER: what `thalweg make` left, and good. STATE: of cluster.py, for postgis.
Exits with 1 when a fault goes unseen or FOLDER itself is not good."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from check_network_test import lift_end, loop, nudge_end, number, sql, touch, vertices
from osgeo import gdal, ogr

gdal.UseExceptions()
HERE = pathlib.Path(__file__).parent
NET, SHP, DEM, MASK = "network.gpkg", "network_arcs.shp", "dem.tif", "network.tif"


def network(change):
    def plant(folder):
        dataset = ogr.Open(str(folder / NET), update=1)
        change(dataset)
    return plant


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


UPSIDE_DOWN = heights(np.flipud)
TURNED_OVER = heights(lambda z: np.where(np.abs(z) < 1e5, -z, z))
NO_APPLICATION = network(sql("PRAGMA application_id = 1"))
PLANTED = {
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


def main(client, folder, state=None):
    folder = pathlib.Path(folder)
    unseen = [f"{folder} itself has {fault}" for fault in sorted(faults_in(client, folder, state))]
    seen = {}
    with tempfile.TemporaryDirectory(prefix="thalweg-planted-") as place:
        for fault, plant in PLANTED[client]:
            if plant not in seen:
                copy = pathlib.Path(place) / f"copy{len(seen)}"
                shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("*.html", "*.svg", "*.png", "inputs"))
                plant(copy)
                seen[plant] = faults_in(client, copy, state)
                shutil.rmtree(copy)
            if fault not in seen[plant]:
                unseen.append(f"{fault} planted, {sorted(seen[plant])} found")
    print(json.dumps({"planted": len(PLANTED[client]), "unseen": unseen}))
    return 1 if unseen else 0


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in PLANTED:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
