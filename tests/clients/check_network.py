#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_network.py NETWORK: does a file keep every law of the network schema?

NETWORK is a GeoPackage, one shapefile of a pair, or a folder with network.gpkg or NAME_arcs.shp and NAME_nodes.shp
(arcs.shp and nodes.shp do too). Heights are in the unit that the column z_unit names, in m without it. Nothing of thalweg is used: OGR reads, networkx walks, shapely finds crossings.
Prints one JSON object and exits with 1 on any violation, 2 when there is nothing to check.
"""
import math
import pathlib
import warnings
from collections import Counter

import networkx as nx
from osgeo import ogr
from report import Report, run
from shapely.geometry import LineString
from shapely.strtree import STRtree

ogr.UseExceptions()
warnings.filterwarnings("ignore", message="STRtree will be changed")

ARC_FIELDS = {
    "int": "arc_id from_node to_node ds_arc n_up basin_id topo_ord strahler shreve hack".split(),
    "real": "length length_3d straight z_up z_down dist_out slope us_area ds_area".split(),
}
NODE_FIELDS = {
    "int": "node_id deg_in deg_out basin_id strahler".split(),
    "real": "z area dist_out".split(),
    "text": ["kind"],
}
RIDGE_FIELDS = {"int": "ridge_id left right".split(), "real": "length z_min z_max".split()}
OTHER_FIELDS = set("survives feature type braided given z_unit".split())
UNITS = {"ft": 0.3048}
TYPES = {"int": {ogr.OFTInteger, ogr.OFTInteger64}, "real": {ogr.OFTReal}, "text": {ogr.OFTString}}


def near(a, b):
    """Equal but for the decimals of a dBase field and the order of a sum."""
    return abs(a - b) <= 1e-6 + 1e-9 * max(abs(a), abs(b))


def files_of(path):
    path = pathlib.Path(path)
    if path.is_dir():
        if (path / "network.gpkg").exists():
            path = path / "network.gpkg"
        else:
            found = sorted(p for p in path.glob("*.shp") if p.stem == "arcs" or p.stem.endswith("_arcs"))
            if len(found) != 1:
                raise FileNotFoundError(f"{path} holds {len(found)} shapefiles of arcs")
            path = found[0]
    if path.suffix.lower() != ".shp":
        return path, path
    for one, other in (("arcs", "nodes"), ("nodes", "arcs")):
        if path.stem.endswith(one):
            pair = {one: path, other: path.with_name(path.stem[: -len(one)] + other + path.suffix)}
            return pair["arcs"], pair["nodes"]
    raise FileNotFoundError(f"{path} is neither arcs nor nodes")


def read(path, name, fields, shape, report):
    """The features of a layer as dicts, their vertices under 'xyz'."""
    dataset = ogr.Open(str(path))
    layer = dataset.GetLayer(0) if path.suffix.lower() == ".shp" else dataset.GetLayerByName(name)
    if layer is None:
        raise FileNotFoundError(f"{path} has no layer {name}")
    definition = layer.GetLayerDefn()
    report.unless(layer.GetGeomType() == shape, "layer_type", f"{name}: {ogr.GeometryTypeToName(layer.GetGeomType())}")
    columns = [definition.GetFieldDefn(i).GetName() for i in range(definition.GetFieldCount())]
    own = {field for of_kind in fields.values() for field in of_kind} | OTHER_FIELDS
    own = own if name == "arcs" else set(columns)  # a user's columns, which arcs alone have, are as the user has them
    for field in own & set(columns):
        report.unless(len(field) <= 10, "field_name_too_long", f"{name}.{field}")
    wanted = []
    has_unit = "z_unit" in columns
    if has_unit:
        kind = definition.GetFieldDefn(columns.index("z_unit")).GetType()
        report.unless(kind in TYPES["text"], "field_type", f"{name}.z_unit")
    for kind, names in fields.items():
        for field in names:
            i = definition.GetFieldIndex(field)
            if i < 0:
                report.fault("field_missing", f"{name}.{field}")
                continue
            report.unless(definition.GetFieldDefn(i).GetType() in TYPES[kind], "field_type", f"{name}.{field}")
            wanted.append(field)
    rows = []
    for feature in layer:
        where = f"{name} {feature.GetFID()}"
        for i, field in enumerate(columns):
            report.unless(field not in own or feature.IsFieldSetAndNotNull(i), "null", f"{where}: {field}")
        geometry = feature.GetGeometryRef()
        row = {field: feature.GetField(field) for field in wanted}
        for field, value in row.items():
            if isinstance(value, float) and not math.isfinite(value):
                report.fault("not_finite", f"{where}: {field}")
        if geometry is None or geometry.IsEmpty():
            report.fault("no_geometry", where)
            continue
        if geometry.GetGeometryType() != shape:
            report.fault("geometry_type", where)
            continue
        unit = feature.GetField("z_unit") if has_unit else "m"
        report.unless(not has_unit or unit in UNITS, "z_unit", f"{where}: {unit}")
        row["unit"] = UNITS.get(unit, 1.0)
        row["xyz"] = geometry.GetPoints()
        if not all(math.isfinite(c) for p in row["xyz"] for c in p):
            report.fault("not_finite", where)
            continue
        rows.append(row)
    report.unless(len(rows) == layer.GetFeatureCount(), "unread_features", name)
    return rows


def by_id(rows, key, report):
    found = {}
    for row in rows:
        report.unless(row[key] >= 1, "id_below_one", row[key])
        report.unless(row[key] not in found, "id_twice", f"{key} {row[key]}")
        found[row[key]] = row
    return found


def check_shapes(arcs, nodes, report):
    for i, arc in arcs.items():
        xyz = arc["xyz"]
        plan = [p[:2] for p in xyz]
        z = [p[2] for p in xyz]
        for end, vertex in (("from_node", xyz[0]), ("to_node", xyz[-1])):
            if arc[end] not in nodes:
                report.fault("node_missing", f"arc {i}: {end} {arc[end]}")
            else:
                report.unless(vertex == nodes[arc[end]]["xyz"][0], "end_is_not_its_node", f"arc {i}: {end}")
        report.unless(all(a >= b for a, b in zip(z, z[1:])), "uphill", f"arc {i}")
        report.unless(all(a != b for a, b in zip(plan, plan[1:])), "repeated_vertex", f"arc {i}")
        length = math.fsum(math.dist(a, b) for a, b in zip(plan, plan[1:]))
        metres = [(x, y, arc["unit"] * z) for x, y, z in xyz]
        length_3d = math.fsum(math.dist(a, b) for a, b in zip(metres, metres[1:]))
        report.unless(length > 0, "no_length", f"arc {i}")
        for field, value in (("length", length), ("length_3d", length_3d), ("straight", math.dist(plan[0], plan[-1])),
                             ("z_up", z[0]), ("z_down", z[-1])):
            report.unless(near(arc[field], value), field, f"arc {i}: {arc[field]}, not {value}")
        if length > 0:
            report.unless(abs(arc["slope"] - arc["unit"] * (z[0] - z[-1]) / length) <= 1e-9, "slope", f"arc {i}")
        report.unless(arc["us_area"] >= 0 and arc["ds_area"] >= 0, "area_below_zero", f"arc {i}")
        report.unless(len(plan) > 1 and LineString(plan).is_simple, "not_simple", f"arc {i}")
    for i, node in nodes.items():
        report.unless(near(node["z"], node["xyz"][0][2]), "z", f"node {i}")
        report.unless(node["area"] >= 0, "area_below_zero", f"node {i}")


def check_crossings(arcs, nodes, report):
    ids = list(arcs)
    lines = [LineString([p[:2] for p in arcs[i]["xyz"]]) for i in ids]
    number = {id(line): k for k, line in enumerate(lines)}
    tree = STRtree(lines)
    for k, line in enumerate(lines):
        for hit in tree.query(line):
            other = number[id(hit)] if isinstance(hit, LineString) else int(hit)  # shapely 1 and 2
            if other <= k or not line.intersects(lines[other]):
                continue
            pair = [arcs[ids[k]], arcs[ids[other]]]
            ends = [{arc["from_node"], arc["to_node"]} for arc in pair]
            shared = [nodes[n]["xyz"][0][:2] for n in ends[0] & ends[1] if n in nodes]
            common = line.intersection(lines[other])
            parts = list(getattr(common, "geoms", [common]))
            meets = all(p.geom_type == "Point" and any(math.dist((p.x, p.y), s) <= 1e-9 * max(1, abs(p.x), abs(p.y))
                                                       for s in shared) for p in parts)
            report.unless(meets, "crossing", f"arcs {ids[k]} and {ids[other]}: {common.wkt[:80]}")


def check_graph(arcs, nodes, report):
    """Orders, distances and degrees, found again from from_node and to_node alone."""
    graph = nx.MultiDiGraph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from((arc["from_node"], arc["to_node"], i) for i, arc in arcs.items())
    above = {n: [i for *_, i in graph.in_edges(n, keys=True)] for n in graph}
    below = {n: [i for *_, i in graph.out_edges(n, keys=True)] for n in graph}
    for n in graph:
        report.unless(len(below[n]) <= 1, "several_outflows", f"node {n}")
        report.unless(above[n] or below[n], "isolated_node", f"node {n}")
        if n in nodes:
            node = nodes[n]
            report.unless(node["deg_in"] == len(above[n]), "deg_in", f"node {n}")
            report.unless(node["deg_out"] == len(below[n]), "deg_out", f"node {n}")
            kind = "outlet" if not below[n] else {0: "source", 1: "pseudo"}.get(len(above[n]), "confluence")
            report.unless(node["kind"] == kind, "kind", f"node {n}: {node['kind']}, not {kind}")
    basins = Counter()
    for members in nx.weakly_connected_components(graph):
        part = graph.subgraph(members)
        outlets = [n for n in part if part.out_degree(n) == 0 and part.in_degree(n) > 0]
        report.unless(len(outlets) == 1, "basin_without_one_outlet", f"{len(outlets)} at node {min(members)}")
        report.unless(part.number_of_nodes() == part.number_of_edges() + 1, "no_tree", f"node {min(members)}")
        names = {nodes[n]["basin_id"] for n in members if n in nodes}
        names |= {arcs[i]["basin_id"] for *_, i in part.edges(keys=True)}
        report.unless(len(names) == 1 and min(names) >= 1, "basin_id", f"node {min(members)}: {sorted(names)[:4]}")
        basins.update(names)
    report.unless(all(count == 1 for count in basins.values()), "basin_id_twice", [b for b in basins if basins[b] > 1][:4])
    if not nx.is_directed_acyclic_graph(graph):
        report.fault("cycle", [str(edge[:2]) for edge in nx.find_cycle(graph)[:5]])
        return {}
    if report.counts["several_outflows"]:
        return {}

    down = {i: (below[arc["to_node"]] or [0])[0] for i, arc in arcs.items()}
    up = {i: above[arc["from_node"]] for i, arc in arcs.items()}
    downstream = [below[n][0] for n in nx.topological_sort(graph) if below[n]]
    strahler, shreve, path = {}, {}, {}
    for i in downstream:
        orders = sorted((strahler[k] for k in up[i]), reverse=True)
        strahler[i] = 1 if not orders else orders[0] + (1 if orders[1:2] == orders[:1] else 0)
        shreve[i] = sum(shreve[k] for k in up[i]) or 1
        path[i] = arcs[i]["length"] + max((path[k] for k in up[i]), default=0.0)
    topological, to_outlet = {0: 0}, {0: 0.0}
    for i in reversed(downstream):
        topological[i] = topological[down[i]] + 1
        to_outlet[i] = arcs[i]["length"] + to_outlet[down[i]]
    for i, arc in arcs.items():
        for field, value in (("ds_arc", down[i]), ("n_up", len(up[i])), ("strahler", strahler[i]),
                             ("shreve", shreve[i]), ("topo_ord", topological[i])):
            report.unless(arc[field] == value, field, f"arc {i}: {arc[field]}, not {value}")
        report.unless(near(arc["dist_out"], to_outlet[down[i]]), "dist_out",
                      f"arc {i}: {arc['dist_out']}, not {to_outlet[down[i]]}")
    for n in graph:
        here = arcs[below[n][0]]["hack"] if below[n] else 1
        kept = [i for i in above[n] if arcs[i]["hack"] == here]
        branches = [i for i in above[n] if arcs[i]["hack"] == here + 1]
        main = len(kept) == 1 and near(path[kept[0]], max(path[i] for i in above[n]))
        report.unless(not above[n] or (main and len(kept) + len(branches) == len(above[n])), "hack", f"node {n}")
        if n not in nodes:
            continue
        far = to_outlet[below[n][0]] if below[n] else 0.0
        report.unless(near(nodes[n]["dist_out"], far), "dist_out", f"node {n}: {nodes[n]['dist_out']}, not {far}")
        order = strahler[below[n][0]] if below[n] else max((strahler[i] for i in above[n]), default=0)
        report.unless(nodes[n]["strahler"] == order, "strahler", f"node {n}: {nodes[n]['strahler']}, not {order}")
    return {"outlets": sum(not below[n] for n in graph), "sources": sum(not above[n] for n in graph),
            "max_strahler": max(strahler.values(), default=0), "max_shreve": max(shreve.values(), default=0),
            "length_m": math.fsum(arc["length"] for arc in arcs.values())}


def has_ridges(path):
    return path.suffix.lower() != ".shp" and ogr.Open(str(path)).GetLayerByName("ridges") is not None


def check_ridges(ridges, arcs, report):
    """Ridges part two streams, lie at the heights they name and meet no river."""
    rivers = [LineString([p[:2] for p in arc["xyz"]]) for arc in arcs.values()]
    tree = STRtree(rivers)
    for i, ridge in ridges.items():
        plan = [p[:2] for p in ridge["xyz"]]
        z = [p[2] for p in ridge["xyz"]]
        report.unless(ridge["left"] != ridge["right"], "ridge_in_one_stream", f"ridge {i}: {ridge['left']}")
        report.unless(ridge["z_min"] <= ridge["z_max"], "ridge_z_order", f"ridge {i}")
        report.unless(near(ridge["z_min"], min(z)) and near(ridge["z_max"], max(z)), "ridge_z", f"ridge {i}")
        length = math.fsum(math.dist(a, b) for a, b in zip(plan, plan[1:]))
        report.unless(length > 0 and near(ridge["length"], length), "ridge_length", f"ridge {i}")
        line = LineString(plan)
        for hit in tree.query(line):
            river = hit if isinstance(hit, LineString) else rivers[int(hit)]  # shapely 1 and 2
            report.unless(not line.intersects(river), "ridge_meets_river", f"ridge {i}")


def main(path):
    report = Report()
    arcs_file, nodes_file = files_of(path)
    arc_rows = read(arcs_file, "arcs", ARC_FIELDS, ogr.wkbLineString25D, report)
    node_rows = read(nodes_file, "nodes", NODE_FIELDS, ogr.wkbPoint25D, report)
    answer = {"network": str(path), "arcs": len(arc_rows), "nodes": len(node_rows)}
    ridge_rows = []
    if has_ridges(arcs_file):
        ridge_rows = read(arcs_file, "ridges", RIDGE_FIELDS, ogr.wkbLineString25D, report)
        answer["ridges"] = len(ridge_rows)
    report.unless(arc_rows, "no_arcs", str(arcs_file))
    if not any(report.counts[kind] for kind in ("field_missing", "field_type", "null", "not_finite")):
        arcs = by_id(arc_rows, "arc_id", report)
        nodes = by_id(node_rows, "node_id", report)
        units = {row["unit"] for row in arc_rows + node_rows + ridge_rows}
        report.unless(len(units) <= 1, "several_units", sorted(units))
        check_shapes(arcs, nodes, report)
        check_crossings(arcs, nodes, report)
        answer.update(check_graph(arcs, nodes, report))
        check_ridges(by_id(ridge_rows, "ridge_id", report), arcs, report)
    return report.close(answer)


if __name__ == "__main__":
    run(main, __doc__, 1)
