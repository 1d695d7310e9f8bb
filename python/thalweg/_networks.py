# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks for GeoPandas and NetworkX, and river files from GeoPandas."""
from __future__ import annotations

import os
import shutil
import sys
import tempfile
import weakref
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from thalweg import _core, flow, io
from thalweg import network as networks
from thalweg import report as reports
from thalweg._raster import Raster, crs_text, say, to_core
from thalweg._show import bad_input, need

if TYPE_CHECKING:
    import geopandas
    import networkx

    from thalweg._terrain import Terrain

LINES = {"LineString", "MultiLineString"}
# Columns of write_geopackage that a network without heights does not have.
OF_HEIGHTS = ["length_3d", "z_up", "z_down", "slope", "z"]


class Parts(NamedTuple):
    """A network and what is known beside it."""

    planform: _core.StreamNetwork
    elevated: _core.ElevatedNetwork | None
    orders: _core.NetworkOrders | None
    areas: flow.ContributingAreas | None
    crs: str


def parts_of(network: object) -> Parts:
    """Return the parts of a StreamNetwork, an ElevatedNetwork, ExtractedStreams or a Terrain.

    Raises
    ------
    BadInput
        When a terrain has no rivers.
    TypeError
        For anything else.
    """
    if isinstance(network, _core.StreamNetwork):
        return Parts(network, None, None, None, "")
    if isinstance(network, _core.ElevatedNetwork):
        return Parts(network.planform, network, None, None, "")
    if isinstance(network, flow.ExtractedStreams):
        return Parts(network.network.planform, network.network, None, network.areas, network.crs)
    made = getattr(network, "made", None)
    if made is None:
        raise TypeError(f"takes a StreamNetwork, an ElevatedNetwork, ExtractedStreams or a Terrain, not {type(network).__name__}")
    rivers = made.terrain.rivers
    if not rivers.network.planform.arc_count:
        raise bad_input("Terrain", "the terrain has no rivers: its recipe has no [network]")
    return Parts(rivers.network.planform, rivers.network, rivers.orders, made.terrain.water.areas, made.terrain.grid.crs)


def to_geodataframe(network: _core.StreamNetwork | _core.ElevatedNetwork | flow.ExtractedStreams | Terrain, layer: str = "arcs", *,
                    crs: object = None) -> geopandas.GeoDataFrame:
    """Return the arcs or nodes of a network as a table.

    Parameters
    ----------
    network : StreamNetwork, ElevatedNetwork, ExtractedStreams or Terrain
        A forest, as all stages return.
    layer : {"arcs", "nodes"}, default "arcs"
        Which of both.
    crs : str, int or CRS of pyproj, rasterio, geopandas or GDAL, optional
        As of a Raster. Left out: that of a terrain, or of the DEM of extracted streams, else none.

    Returns
    -------
    geopandas.GeoDataFrame
        The columns of this layer of network.gpkg, which `thalweg make` writes (docs/interchange.md), of a terrain also those
        of the user's river file. Contributing areas are known of a terrain and of extracted streams, and else -1. A
        StreamNetwork has no heights: geometries are in plan, columns of heights missing.

    Raises
    ------
    BadParameter
        For another layer.
    BadInput
        When two arcs leave a node or arcs form a cycle, or a terrain has no rivers.
    ImportError
        Without geopandas.
    """
    gpd = need("geopandas", "python3-geopandas")
    if layer not in ("arcs", "nodes"):
        raise _core.BadParameter(f"layer = {layer!r}: write arcs or nodes")
    parts = parts_of(network)
    net = parts.planform
    named = parts.crs if crs is None else crs_text(crs)
    flat_z = [np.zeros(len(line)) for line in net.lines]
    elevated = parts.elevated or _core.ElevatedNetwork(net, np.zeros(net.node_count), flat_z)
    with tempfile.TemporaryDirectory(prefix="thalweg-") as folder:
        path = os.path.join(folder, "network.gpkg")
        made = getattr(network, "made", None)
        if made is not None and crs is None:
            reports.write_rivers(made, path)
        else:
            io.write_geopackage(elevated, path, orders=parts.orders, areas=parts.areas, crs=named)
        frame = gpd.read_file(path, layer=layer)
    shapes = list(frame.geometry)
    columns = frame.drop(columns=[frame.geometry.name])
    if parts.elevated is None:
        shape = need("shapely.geometry", "python3-shapely")
        shapes = list(map(shape.LineString, net.lines) if layer == "arcs" else map(shape.Point, net.nodes))
        columns = columns.drop(columns=OF_HEIGHTS, errors="ignore")
    # GeoPackages have a CRS that stands for none.
    table: geopandas.GeoDataFrame = gpd.GeoDataFrame(columns, geometry=shapes, crs=frame.crs if named else None)
    return table


def to_networkx(network: _core.StreamNetwork | _core.ElevatedNetwork | flow.ExtractedStreams | Terrain) -> networkx.DiGraph[Any]:
    """Return a network as a graph, directed downstream.

    Parameters
    ----------
    network : StreamNetwork, ElevatedNetwork, ExtractedStreams or Terrain
        A forest, as all stages return.

    Returns
    -------
    networkx.DiGraph
        Nodes 0, 1, ... in the network's order, with x, y and, where the network has heights, z [m]. Edges with arc (the
        number of the arc), length_m [m], strahler, and line [m]: its vertices downstream, ndarray, shape (k, 2) or (k, 3).

    Raises
    ------
    BadInput
        When two arcs leave a node or arcs form a cycle, or a terrain has no rivers.
    ImportError
        Without networkx.
    """
    nx = need("networkx", "python3-networkx")
    parts = parts_of(network)
    net = parts.planform
    orders = parts.orders or networks.order(net)
    graph: networkx.DiGraph[Any] = nx.DiGraph()
    # Lists of numbers, which later numpy types as anything.
    nodes: Any = net.nodes.tolist()
    for node, (x, y) in enumerate(nodes):
        graph.add_node(node, x=x, y=y)
    lines = list(net.lines)
    if parts.elevated is not None:
        nx.set_node_attributes(graph, dict(enumerate(map(float, parts.elevated.node_z))), "z")
        lines = [np.column_stack([line, z]) for line, z in zip(lines, parts.elevated.arc_z)]
    ends = zip(map(int, net.from_nodes), map(int, net.to_nodes))
    for arc, ((up, down), length, order) in enumerate(zip(ends, map(float, net.length_m), map(int, orders.strahler))):
        graph.add_edge(up, down, arc=arc, length_m=length, strahler=order, line=lines[arc])
    return graph


def _has_place(known: Any) -> bool:
    return all(isinstance(known.get(axis), (int, float, np.number)) and np.isfinite(known[axis]) for axis in "xy")


def from_networkx(graph: networkx.Graph[Any]) -> _core.StreamNetwork | _core.ElevatedNetwork:
    """Return the network of a graph, as to_networkx writes it or of any graph of rivers.

    Parameters
    ----------
    graph : networkx.DiGraph
        Edges lead downstream. Nodes have x and y [m], and z [m] where the network has heights. Edges may have line: their
        vertices downstream [m], shape (k, 2), or (k, 3) with heights; without it they are straight. Edges with arc keep that
        order, others come as the graph has them; nodes are numbered as the graph has them.

    Returns
    -------
    StreamNetwork, or ElevatedNetwork where every node has z

    Raises
    ------
    BadInput
        When edges have no direction, a node has no x or y, or a line does not begin and end at its nodes.
    """
    if not hasattr(graph, "is_directed"):
        raise TypeError(f"from_networkx: takes a DiGraph of networkx, not {type(graph).__name__}")
    if not graph.is_directed():
        raise bad_input("from_networkx", "from_networkx: edges have no direction: give a DiGraph, whose edges lead downstream")
    numbers = {node: number for number, node in enumerate(graph)}
    for node, known in graph.nodes(data=True):
        if not _has_place(known):
            raise bad_input("from_networkx", f"from_networkx: node {node!r} has no x and y: set them, in metres")
    nodes = np.array([(known["x"], known["y"]) for _, known in graph.nodes(data=True)], float).reshape(-1, 2)
    has_heights = len(numbers) > 0 and all("z" in known for _, known in graph.nodes(data=True))
    edges = sorted(graph.edges(data=True), key=lambda edge: int(edge[2].get("arc") or 0))
    lines = []
    for up, down, known in edges:
        ends = nodes[[numbers[up], numbers[down]]]
        line = np.asarray(known.get("line", ends), float)
        if line.ndim != 2 or line.shape[0] < 2 or line.shape[1] not in (2, 3) or not np.array_equal(line[[0, -1], :2], ends):
            raise bad_input("from_networkx", f"from_networkx: the line of the edge from {up!r} to {down!r} does not begin and end "
                                             "at its nodes: it has the shape (k, 2) or (k, 3), downstream")
        lines.append(line)
    network = _core.StreamNetwork(nodes, [numbers[up] for up, _, _ in edges], [numbers[down] for _, down, _ in edges],
                                  [line[:, :2] for line in lines])
    if not has_heights:
        return network
    node_z = np.array([known["z"] for _, known in graph.nodes(data=True)], float)
    heights = []
    for (up, down, _), line in zip(edges, lines):
        ends_z = node_z[[numbers[up], numbers[down]]]
        if line.shape[1] == 3:
            heights.append(np.concatenate([ends_z[:1], line[1:-1, 2], ends_z[1:]]))
        else:  # along the line
            steps = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
            heights.append(np.interp(steps, [0.0, steps[-1]], ends_z))
    return _core.ElevatedNetwork(network, node_z, heights)


def from_geodataframe(frame: geopandas.GeoDataFrame | geopandas.GeoSeries) -> _core.StreamNetwork | _core.ElevatedNetwork:
    """Return the network of a table of lines, as to_geodataframe writes it or of any river file.

    Parameters
    ----------
    frame : GeoDataFrame or GeoSeries
        Lines in a projected CRS in metres, or without CRS: metres. Columns of a schema that thalweg knows, or that link the
        lines (docs/river_files.md), tell how they join; else lines join where they meet, and are directed as by
        network.import_lines.

    Returns
    -------
    StreamNetwork, or ElevatedNetwork where the lines have heights
        A forest: where a river divides, it follows the main arm.

    Raises
    ------
    BadInput
        When there are no lines, the CRS is not in metres, or what the columns tell is no network.
    """
    if not is_table(frame):
        raise TypeError(f"from_geodataframe: takes a GeoDataFrame or GeoSeries, not {type(frame).__name__}")
    if len(frame) == 0:
        raise bad_input("from_geodataframe", "from_geodataframe: the table is empty")
    crs = "" if frame.crs is None else crs_text(frame.crs)
    if crs and io.ground_cell(_core.Grid(1, 1, 1e-3, 0.0, 1e-3, crs)).unit in ("degrees", "other"):
        raise bad_input("from_geodataframe", "from_geodataframe: the table's CRS is not in metres: reproject it first, as "
                                             ".to_crs(frame.estimate_utm_crs()) does")
    path = table_file(frame, "rivers")
    file = io.read_network(str(path), any_lines=True, crs=crs)
    if file.says.downstream or file.says.ends:
        elevated = networks.from_file(networks.divide(file)[0]).network
    else:
        lines = io.read_rivers(path=str(path)) if crs else _plain_lines(frame)
        imported = networks.import_lines(lines)
        if imported.repairs:
            say(f"rivers: joined as lines, with {len(imported.repairs)} repairs; network.import_lines lists them")
        if not lines.has_z:
            return imported.network
        elevated = networks.take_file_heights(imported, lines)
    return elevated if np.isfinite(elevated.node_z).all() else elevated.planform


def _plain_lines(frame: Any) -> _core.RiverLines:
    """Lines in metres of no CRS."""
    lines: list[dict[str, Any]] = []
    for number, shape in enumerate(frame.geometry, 1):
        for part in getattr(shape, "geoms", [shape]):
            if part is not None and part.geom_type == "LineString":
                vertices = np.full((len(part.coords), 3), np.nan)
                vertices[:, :3 if part.has_z else 2] = np.asarray(part.coords)[:, :3 if part.has_z else 2]
                lines.append({"vertices": vertices, "feature": number})
    if not lines:
        raise bad_input("from_geodataframe", "from_geodataframe: no lines in the table")
    return _core.RiverLines(lines=lines, has_z=all(np.isfinite(line["vertices"]).all() for line in lines))


class TemporaryPath(str):
    """The name of a file that is deleted with it; others get str() of it, as some keep what they were given."""


def is_table(thing: object) -> bool:
    """Return whether a value is a GeoDataFrame or GeoSeries."""
    gpd = sys.modules.get("geopandas")
    return gpd is not None and isinstance(thing, (gpd.GeoDataFrame, gpd.GeoSeries))


def lines_from(frame: geopandas.GeoDataFrame | geopandas.GeoSeries) -> TemporaryPath:
    """Write lines as a river file.

    Parameters
    ----------
    frame : GeoDataFrame or GeoSeries
        Lines with a CRS; rows of other geometries are the reader's to refuse or leave out.

    Returns
    -------
    TemporaryPath
        A GeoPackage with the columns of the table, which is deleted with its name.

    Raises
    ------
    BadInput
        When there are no rows, no lines, or no CRS.
    """
    if len(frame) == 0:
        raise bad_input("rivers", "rivers: the table is empty")
    kinds = set(frame.geometry.geom_type.dropna())
    if not kinds & LINES:
        raise bad_input("rivers", f"rivers: no lines in the table, but {', '.join(sorted(kinds)) or 'no geometry'}")
    if frame.crs is None:
        raise bad_input("rivers", "rivers: the table has no CRS: set it, as .set_crs(\"EPSG:32610\") does")
    return table_file(frame, "rivers")


def table_file(frame: geopandas.GeoDataFrame | geopandas.GeoSeries, name: str) -> TemporaryPath:
    """Write a table as a GeoPackage of this name, which is deleted with its path."""
    path = temporary_path(f"{name.replace('.', '_')}.gpkg")
    table: Any = frame.to_frame("geometry") if not hasattr(frame, "columns") else frame
    # Names for what GeoPackage adds that no table has: one with columns fid and geom keeps them.
    _plain(table, name).to_file(str(path), driver="GPKG", layer=name.replace(".", "_"), index=False, FID="thalweg_fid",
                                GEOMETRY_NAME="thalweg_geometry")
    return path


def _plain(table: Any, what: str) -> Any:
    """The table as a file can hold it: one geometry, names that differ in more than their case, numbers, times and texts."""
    shape = table.geometry.name
    columns: dict[str, Any] = {}
    taken: set[str] = set()
    for column, values in table.drop(columns=shape).items():
        if hasattr(values, "geom_type"):
            say(f"{what}: the second geometry {column} is left out")
            continue
        name = str(column)
        while name.lower() in taken:
            name += "_2"
        if name != str(column):
            say(f"{what}: column {column!r} is read as {name}")
        taken.add(name.lower())
        columns[name] = _plain_column(values)
    plain = table[[shape]].copy()
    for name, values in columns.items():
        plain[name] = values
    return plain


def _plain_column(values: Any) -> Any:
    kind = values.dtype.kind if isinstance(values.dtype, np.dtype) else "V"
    if kind == "m":
        return values.dt.total_seconds()
    if kind in "biufM" or str(values.dtype).startswith(("Int", "UInt", "Float", "boolean", "string", "datetime64")):
        return values
    values = values.astype(object)
    known = values[values.notna()]
    kinds = {type(one) for one in known}
    if kinds <= {int} or kinds <= {int, float}:
        return values.astype(float) if values.isna().any() or float in kinds else values.astype(int)
    return values.where(values.isna(), values.map(str)) if kinds - {str} else values


def is_raster(thing: object) -> bool:
    """Return whether a value is a Raster or an array of numpy or xarray."""
    xr = sys.modules.get("xarray")
    return isinstance(thing, (Raster, np.ndarray)) or (xr is not None and isinstance(thing, (xr.DataArray, xr.Dataset)))


def raster_file(thing: object, what: str) -> TemporaryPath:
    """Write heights as a GeoTIFF, which is deleted with its path; what: its name, also in messages."""
    path = temporary_path(f"{what.replace('.', '_')}.tif")
    io.write_dem(to_core(thing, np.float32, what), str(path))
    return path


def path_of(thing: object, what: str) -> str:
    """Return the path of a file: as given, or of one that holds a table of lines or a raster.

    Parameters
    ----------
    thing : str, path, GeoDataFrame, GeoSeries, Raster, DataArray or ndarray
        Tables as for lines_from, rasters as for to_core.
    what : str
        Its name in messages.

    Returns
    -------
    str
        Of a table or raster a TemporaryPath: the file lives as long as this object.

    Raises
    ------
    BadInput
        As lines_from and to_core.
    TypeError
        For anything else.
    """
    if isinstance(thing, (str, os.PathLike)):
        return os.fspath(thing)
    if is_table(thing):
        return lines_from(thing)
    if is_raster(thing):
        return raster_file(thing, what)
    raise TypeError(f"{what}: takes a path, a GeoDataFrame of lines or a raster, not {type(thing).__name__}")


def temporary_path(name: str) -> TemporaryPath:
    """Return a file name in a new folder, which is deleted with it."""
    folder = tempfile.mkdtemp(prefix="thalweg-")
    path = TemporaryPath(os.path.join(folder, name))
    weakref.finalize(path, shutil.rmtree, folder, ignore_errors=True)
    return path
