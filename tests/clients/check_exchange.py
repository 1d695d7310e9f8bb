#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_exchange.py THALWEG FOLDER STATE: does a network come back from everybody's schema and from PostGIS as it went?

FOLDER: what `thalweg make` left. STATE: of cluster.py. `thalweg convert` writes the network in each schema and format; GDAL,
QGIS and ogr2ogr into PostGIS read each file without a word; convert brings it back, and what the schema can hold is what it was:
lines to the last bit, the arc downstream of each, Strahler's order, Shreve's, and areas, which r.stream.order has none of, to a unit's rounding.
NetworkX reads the graphs as a forest in which every source has an outlet. A network in PostGIS itself is checked there by
`thalweg check`, and pgRouting finds its ways in the view. A changed copy of each kind must be told from the original.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import math
import pathlib
import subprocess
import tempfile

import cluster
import networkx as nx
import numpy as np
from check_postgis import psql
from osgeo import gdal, ogr
from report import Report, run

gdal.UseExceptions()
ogr.UseExceptions()
HERE = pathlib.Path(__file__).parent
SCHEMAS = ("native", "taudem", "nhdplus", "hydrorivers", "grass")
VECTORS = (".gpkg", ".shp", ".fgb", ".geojson")
UNIT_M2 = {"nhdplus": 1e6, "hydrorivers": 1e6}


class Thalweg:
    def __init__(self, executable, report):
        self.executable, self.report = executable, report

    def __call__(self, *words, wanted=0):
        done = subprocess.run([self.executable, *map(str, words)], capture_output=True, text=True, check=False)
        self.report.unless(done.returncode == wanted, "command", f"{' '.join(map(str, words))}: exit {done.returncode}: {done.stderr[-300:]}")
        return done.returncode == wanted


def arcs_of(path):
    """The arcs of a native file by their lines: what is left to compare when ids have changed."""
    dataset = ogr.Open(str(path))
    rows = {feature["arc_id"]: feature for feature in dataset.GetLayerByName("arcs")}
    line = {i: tuple(row.GetGeometryRef().GetPoints()) for i, row in rows.items()}
    return {line[i]: {"down": line.get(row["ds_arc"]), "strahler": row["strahler"], "shreve": row["shreve"], "ds_area": row["ds_area"]}
            for i, row in rows.items()}


def differences(before, after, schema):
    """In words, what is not as it was."""
    said = []
    if before.keys() != after.keys():
        said.append(f"{len(before.keys() - after.keys())} of {len(before)} lines are not there")
    rounding = 1e-6 * UNIT_M2.get(schema, 1.0)
    for line in before.keys() & after.keys():
        was, now = before[line], after[line]
        for field in ("down", "strahler", "shreve"):
            if was[field] != now[field]:
                said.append(f"{field} at {line[0]}")
        if schema != "grass" and abs(was["ds_area"] - now["ds_area"]) > rounding + 1e-9 * was["ds_area"]:
            said.append(f"ds_area at {line[0]}: {was['ds_area']}, now {now['ds_area']}")
    return said


def check_told_apart(arcs, report):
    """differences() would say so if an arc were lost, moved, or told otherwise."""
    first = min(arcs)
    for change in ({"down": min(arcs)}, {"strahler": -1}, {"shreve": -1}, {"ds_area": arcs[first]["ds_area"] + 10.0}):
        report.unless(differences(arcs, {**arcs, first: {**arcs[first], **change}}, "native"), "not_told_apart", change)
    moved = {tuple((x + 1e-9 * abs(x), y, z) for x, y, z in line): row for line, row in arcs.items()}
    report.unless(differences(arcs, moved, "native"), "not_told_apart", "moved lines")
    report.unless(differences(arcs, {k: v for k, v in arcs.items() if k != first}, "native"), "not_told_apart", "a lost arc")


def check_schemas(thalweg, source, place, report):
    """source: a file in which at most two arcs meet, which every schema can hold."""
    before = arcs_of(source)
    check_told_apart(before, report)
    for schema in SCHEMAS:
        folder = place / schema
        folder.mkdir()
        for ending in VECTORS:
            out = folder / f"net{ending}"
            exact = ["--format", "geojson2008"] if ending == ".geojson" else []
            if not thalweg("convert", source, "-o", out, "--schema", schema, *exact):
                continue
            if schema == "native" and ending != ".gpkg":
                out = folder / f"net_arcs{ending}"
            back = place / f"back_{schema}{ending}.gpkg"
            if thalweg("convert", out, "-o", back, "--from", schema):
                for words in differences(before, arcs_of(back), schema):
                    report.fault("not_as_it_was", f"{schema}{ending}: {words}")


def check_degrees(thalweg, source, place, report):
    """GeoJSON as RFC 7946 has it: in degrees, and back within a millimetre, in the order of the arcs."""
    out, back = place / "hydrorivers" / "degrees.geojson", place / "back_degrees.gpkg"
    if not (thalweg("convert", source, "-o", out, "--schema", "hydrorivers") and thalweg("convert", out, "-o", back)):
        return
    written, *files = [ogr.Open(str(path)) for path in (out, source, back)]
    report.unless(written.GetLayer().GetSpatialRef().IsGeographic(), "not_degrees", out)
    rows = [list(file.GetLayerByName("arcs")) for file in files]
    report.equal("degrees_arcs", *map(len, rows))
    for before, after in zip(*rows):
        lines = [row.GetGeometryRef().GetPoints() for row in (before, after)]
        report.equal("degrees_vertices", *map(len, lines))
        far = max(map(math.dist, *lines))
        report.unless(far < 1e-3, "not_where_it_was", f"arc {before['arc_id']}: {far} m")
        report.unless(before["strahler"] == after["strahler"], "not_as_it_was", f"strahler of arc {before['arc_id']}")


def check_readers(place, state, report):
    files = sorted(path for schema in SCHEMAS for path in (place / schema).iterdir() if path.suffix in VECTORS)
    report.unless(len(files) >= len(SCHEMAS) * len(VECTORS), "files_missing", len(files))
    for reader in ("check_gdal.py", "check_qgis.py"):
        done = subprocess.run([HERE / reader, *files], capture_output=True, text=True, check=False)
        report.unless(done.returncode == 0, reader, done.stderr[-800:])
    schema = f"exchanged_{place.name.split('-')[-1].lower()}"
    psql(state, f"create schema {schema}")
    for k, file in enumerate(files):
        words = ["ogr2ogr", "-f", "PostgreSQL", f"PG:{cluster.words(state)} active_schema={schema}", file, "-nlt", "GEOMETRY",
                 "-lco", "PRECISION=NO"]
        for layer in ogr.Open(str(file)):
            name = layer.GetName()
            if layer.GetGeomType() != ogr.wkbNone:
                done = subprocess.run([*map(str, words), name, "-nln", f"t{k}_{name}"], capture_output=True, text=True, check=False)
                report.unless(done.returncode == 0 and not done.stderr, "ogr2ogr", f"{file} {name}: {done.stderr[-300:]}")
    psql(state, f"set client_min_messages = error; drop schema {schema} cascade")
    return len(files)


def check_graphs(thalweg, source, place, arcs, report):
    graphs = {}
    if thalweg("convert", source, "-o", place / "net.graphml"):
        graphs["graphml"] = nx.read_graphml(place / "net.graphml", node_type=int)
    if thalweg("convert", source, "-o", place / "net.edges"):
        graphs["edges"] = nx.read_edgelist(place / "net.edges", nodetype=int, create_using=nx.DiGraph)
    for name, graph in graphs.items():
        outlets = [n for n in graph if graph.out_degree(n) == 0]
        report.equal(f"{name}_arcs", graph.number_of_edges(), arcs)
        report.unless(nx.is_directed_acyclic_graph(graph), f"{name}_cycle", source)
        report.unless(nx.is_forest(graph.to_undirected()), f"{name}_no_forest", source)
        report.equal(f"{name}_components", nx.number_weakly_connected_components(graph), len(outlets))
        report.unless(all(graph.out_degree(n) <= 1 for n in graph), f"{name}_several_outflows", source)
        orders = nx.get_edge_attributes(graph, "strahler")
        report.equal(f"{name}_orders", len(orders), arcs)
    return {name: [graph.number_of_nodes(), graph.number_of_edges()] for name, graph in graphs.items()}


def check_mask(thalweg, folder, place, report):
    if not thalweg("convert", folder, "-o", place / "mask.tif", "--dem", folder / "dem.tif"):
        return
    mask, wanted = gdal.Open(str(place / "mask.tif")), gdal.Open(str(folder / "network.tif"))
    report.equal("mask_place", mask.GetGeoTransform(), wanted.GetGeoTransform())
    report.unless(mask.GetSpatialRef().IsSame(wanted.GetSpatialRef()), "mask_crs", "")
    report.equal("mask_type", gdal.GetDataTypeName(mask.GetRasterBand(1).DataType), "Byte")
    report.unless(np.array_equal(mask.ReadAsArray(), wanted.ReadAsArray()), "mask_cells", "not those of network.tif")


def check_database(thalweg, source, state, arcs, report):
    schema = f"direct_{pathlib.Path(source).parent.name.split('-')[-1].lower()}"
    psql(state, f"create schema {schema}")
    database, table = f"PG:{cluster.words(state)}", f"{schema}.network"
    figures = {}
    layers = ("--layer", f"{table}_arcs", "--nodes-layer", f"{table}_nodes")
    if thalweg("convert", source, "-o", database, "--table", table):
        thalweg("convert", source, "-o", database, "--table", table, wanted=2)  # it is there already
        thalweg("convert", source, "-o", database, "--table", table, "--overwrite")
        thalweg("check", database, *layers)
        back = pathlib.Path(source).with_name("back_postgis.gpkg")
        if thalweg("convert", database, *layers, "-o", back):
            for words in differences(arcs_of(source), arcs_of(back), "native"):
                report.fault("not_as_it_was", f"PostGIS: {words}")
        edges = f"'select id, source, target, cost, reverse_cost from {table}_edges'"
        found = psql(state, f"""select count(distinct start_vid) from pgr_dijkstraCost({edges},
            (select array_agg(node_id) from {table}_nodes where kind = 'source'),
            (select array_agg(node_id) from {table}_nodes where kind = 'outlet'))""")
        sources = psql(state, f"select count(*) from {table}_nodes where kind = 'source'")
        report.equal("source_without_outlet", int(found), int(sources))
        report.equal("edges", int(psql(state, f"select count(*) from {table}_edges")), arcs)
        # Against the water nothing is reached: reverse_cost is a way that does not exist.
        upstream = psql(state, f"""select count(*) from pgr_dijkstraCost({edges},
            (select array_agg(node_id) from {table}_nodes where kind = 'outlet'),
            (select array_agg(node_id) from {table}_nodes where kind = 'source'))""")
        report.equal("ways_upstream", int(upstream), 0)
        psql(state, f"update {table}_arcs set strahler = strahler + 1 where arc_id = 1")
        thalweg("check", database, *layers, wanted=3)
        figures["sources_routed"] = int(found)
    psql(state, f"set client_min_messages = error; drop schema {schema} cascade")
    return figures


def main(executable, folder, state):
    folder, state = pathlib.Path(folder), pathlib.Path(state)
    report = Report()
    thalweg = Thalweg(executable, report)
    with tempfile.TemporaryDirectory(prefix="thalweg-exchange-") as name:
        place = pathlib.Path(name)
        source = place / "split.gpkg"
        figures = {"folder": str(folder)}
        if thalweg("convert", folder, "-o", source, "--max-upstream", "2"):
            figures["arcs"] = len(arcs_of(source))
            check_schemas(thalweg, source, place, report)
            check_degrees(thalweg, source, place, report)
            figures["files_read"] = check_readers(place, state, report)
            figures["graphs"] = check_graphs(thalweg, source, place, figures["arcs"], report)
            check_mask(thalweg, folder, place, report)
            figures.update(check_database(thalweg, source, state, figures["arcs"], report))
    return report.close(figures)


if __name__ == "__main__":
    run(main, __doc__, 3)
