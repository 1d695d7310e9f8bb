#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_network_test.py NETWORK.gpkg: does check_network.py find each fault planted in a copy of a good network?

Where the network has ridges, the faults are theirs alone; where it names the unit of its heights, that unit's.
Exits with 1 when a fault goes unseen or the network itself is not good.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from osgeo import ogr

ogr.UseExceptions()
CHECK = pathlib.Path(__file__).with_name("check_network.py")


def faults_in(path):
    run = subprocess.run([str(CHECK), str(path)], capture_output=True, text=True, check=False)
    return set(json.loads(run.stdout)["violations"]) if run.returncode < 2 else {run.stderr}


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


def touch(dataset):
    """Leads the first arc over the middle of the last."""
    table = dataset.GetLayerByName("arcs")
    first, last = table.GetFeature(1), table.GetFeature(table.GetFeatureCount())
    a, b = last.GetGeometryRef().GetPoints()[:2]
    points = first.GetGeometryRef().GetPoints()
    shape = ogr.Geometry(ogr.wkbLineString25D)
    for p in (points[0], [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, points[0][2]], points[-1]):
        shape.AddPoint(*p)
    first.SetGeometry(shape)
    table.SetFeature(first)


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


PLANTED = [
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


def onto_river(dataset):
    """Leads the first ridge to the middle of the first arc."""
    arc = dataset.GetLayerByName("arcs").GetNextFeature()
    a, b = arc.GetGeometryRef().GetPoints()[:2]
    vertices("ridges", lambda p: [*p, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, p[-1][2]]])(dataset)


RIDGES_PLANTED = [
    ("ridge_in_one_stream", sql("UPDATE ridges SET left = right WHERE ridge_id = 1")),
    ("ridge_z_order", number("ridges", "z_min", lambda v: v + 1e6)),
    ("ridge_z", number("ridges", "z_max", lambda v: v + 1)),
    ("ridge_length", number("ridges", "length", lambda v: v + 1)),
    ("ridge_meets_river", onto_river),
]


UNITS_PLANTED = [
    ("z_unit", sql("UPDATE arcs SET z_unit = 'yd' WHERE arc_id = 1")),
    ("several_units", sql("ALTER TABLE nodes DROP COLUMN z_unit")),
    ("length_3d", sql("ALTER TABLE arcs DROP COLUMN z_unit")),
    ("slope", sql("ALTER TABLE arcs DROP COLUMN z_unit")),
    ("slope", number("arcs", "slope", lambda v: v / 0.3048)),
    ("field_type", sql("ALTER TABLE arcs DROP COLUMN z_unit", "ALTER TABLE arcs ADD COLUMN z_unit INTEGER DEFAULT 1")),
]


def planted_in(path):
    dataset = ogr.Open(str(path))
    if dataset.GetLayerByName("arcs").FindFieldIndex("z_unit", 1) >= 0:
        return UNITS_PLANTED
    return PLANTED if dataset.GetLayerByName("ridges") is None else RIDGES_PLANTED


def main(path):
    planted = planted_in(path)
    unseen = [f"{path} itself has {fault}" for fault in sorted(faults_in(path))]
    with tempfile.TemporaryDirectory() as folder:
        for fault, plant in planted:
            copy = pathlib.Path(folder) / "planted.gpkg"
            shutil.copy(path, copy)
            dataset = ogr.Open(str(copy), update=1)
            plant(dataset)
            dataset = None
            found = faults_in(copy)
            if fault not in found:
                unseen.append(f"{fault} planted, {sorted(found)} found")
    print(json.dumps({"planted": len(planted), "unseen": unseen}, indent=1))
    return 1 if unseen else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
