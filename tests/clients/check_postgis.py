#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_postgis.py STATE NETWORK...: is a network a forest to PostGIS and pgRouting?

STATE: of cluster.py. NETWORK: a GeoPackage with arcs and nodes, or the shapefile of the arcs of a pair. ogr2ogr loads it without a
word. PostGIS: valid, simple lines in three dimensions, none twice, ends that are their nodes in x, y and z, no
meeting but at ends. PostGIS topology, which nodes lines as it loads them: as many edges as arcs, no face, as many nodes as
nodes. pgRouting: no cycle, one component for each outlet, a way from every source to an outlet.
Prints one JSON line for each network and exits with 1 on any violation, 2 when there is nothing to check."""
import contextlib
import json
import os
import pathlib

import cluster
from report import Report, command, run

# pgRouting takes its edges as text; a negative reverse_cost is a way that does not exist.
EDGES = "'select arc_id as id, from_node as source, to_node as target, length as cost, {reverse} as reverse_cost from {schema}.arcs'"
FIGURES = {
    "nodes": "select count(*) from nodes",
    "outlets": "select count(*) from nodes where kind = 'outlet'",
    "sources": "select count(*) from nodes where kind = 'source'",
    "components": "select count(distinct component) from pgr_connectedComponents({both_ways})",
    "reach_outlet": """select count(distinct start_vid) from pgr_dijkstraCost({downstream},
        (select array_agg(node_id) from nodes where kind = 'source'), (select array_agg(node_id) from nodes where kind = 'outlet'))""",
}
SHAPES = {
    "not_a_line_in_3d": "select count(*) from arcs where GeometryType(geom) <> 'LINESTRING' or ST_NDims(geom) <> 3",
    "invalid": "select count(*) from arcs where not ST_IsValid(geom)",
}
NONE = {
    "not_simple": "select count(*) from arcs where not ST_IsSimple(geom)",
    "twice": "select count(*) from arcs a join arcs b on a.ctid < b.ctid and a.geom && b.geom and ST_Equals(a.geom, b.geom)",
    "end_is_not_its_node": """select count(*) from arcs left join nodes f on f.node_id = from_node left join nodes t on t.node_id = to_node
        where f.geom is null or t.geom is null
        or ST_AsEWKB(ST_StartPoint(arcs.geom)) <> ST_AsEWKB(f.geom) or ST_AsEWKB(ST_EndPoint(arcs.geom)) <> ST_AsEWKB(t.geom)""",
    "crossing": "select count(*) from arcs a join arcs b on a.ctid < b.ctid and a.geom && b.geom and ST_Relate(a.geom, b.geom, 'T********')",
    "node_inside_an_arc": """select count(*) from arcs join nodes n on arcs.geom && n.geom and ST_Intersects(arcs.geom, n.geom)
        and n.node_id not in (from_node, to_node)""",
    "cycle": "select count(*) from (select from pgr_strongComponents({downstream}) group by component having count(*) > 1) cycles",
}
# Every arc joins one node that is new: the order saves the walk around a tree's one face for each.
TOPOLOGY = """
select topology.CreateTopology('{schema}_topology', (select ST_SRID(geom) from arcs limit 1), 0, true) \\g /dev/null
select topology.TopoGeo_AddLineString('{schema}_topology', geom, 0) from
    (select geom from arcs order by topo_ord, arc_id offset 0) upstream \\g /dev/null
select json_build_array((select count(*) from {schema}_topology.edge_data) - (select count(*) from arcs),
    (select count(*) - 1 from {schema}_topology.face), (select count(*) from {schema}_topology.node) - (select count(*) from nodes));
"""


def psql(state, script):
    words = ["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-d", cluster.words(state), "-f", "-"]
    return command(*words, input=script).stdout


@contextlib.contextmanager
def own_schema(state):
    name = f"checked_{os.getpid()}"
    psql(state, f"create schema {name}")
    try:
        yield name
    finally:
        psql(state, f"""set client_min_messages = error; drop schema {name} cascade;
            select topology.DropTopology(name) from topology.topology where name = '{name}_topology' \\g /dev/null""")


def load(state, network, schema, report):
    path = pathlib.Path(network)
    tables = {"arcs": path, "nodes": path}
    if path.suffix == ".shp":
        tables["nodes"] = path.with_name(path.name.replace("arcs", "nodes"))
    for table, file in tables.items():
        layer = [table] if file.suffix != ".shp" else []
        words = ["ogr2ogr", "-f", "PostgreSQL", f"PG:{cluster.words(state)} active_schema={schema}", str(file), *layer,
                 "-nln", table, "-lco", "GEOMETRY_NAME=geom", "-lco", "SPATIAL_INDEX=GIST", "-lco", "PRECISION=NO"]  # dBase integers stay integers
        done = command(*words)
        report.unless(not done.stderr and not done.stdout, "warning", f"{file.name}: {(done.stdout + done.stderr).strip()[:300]}")


def ask(state, schema, queries):
    edges = {"downstream": EDGES.format(schema=schema, reverse="-1"), "both_ways": EDGES.format(schema=schema, reverse="length")}
    pairs = ", ".join(f"'{name}', ({query.format(**edges)})" for name, query in queries.items())
    return json.loads(psql(state, f"set client_min_messages = error; set search_path = {schema}, public; select json_build_object({pairs})"))


def none_of(state, schema, queries, report):
    for kind, count in ask(state, schema, queries).items():
        report.equal(kind, count, 0)


def check(state, network, schema):
    report = Report()
    load(state, network, schema, report)
    figures = {"network": network, **ask(state, schema, {"arcs": "select count(*) from arcs"})}
    report.unless(figures["arcs"] > 0, "no_arcs", network)
    none_of(state, schema, SHAPES, report)
    if report.counts:  # GEOS and the topology break off at such shapes
        return report.close(figures)
    figures.update(ask(state, schema, FIGURES))
    none_of(state, schema, NONE, report)
    report.equal("components", figures["components"], figures["outlets"])
    report.equal("source_without_outlet", figures["reach_outlet"], figures["sources"])
    prefix = f"set client_min_messages = error; set search_path = {schema}, topology, public;"
    figures["edges_faces_nodes"] = json.loads(psql(state, prefix + TOPOLOGY.format(schema=schema)))
    report.equal("edges_faces_nodes", figures["edges_faces_nodes"], [0, 0, 0])
    return report.close(figures)


def main(state, *networks):
    worst = 0
    for network in networks:
        with own_schema(pathlib.Path(state)) as schema:
            worst = max(worst, check(pathlib.Path(state), network, schema))
    return worst


if __name__ == "__main__":
    run(main, __doc__)
