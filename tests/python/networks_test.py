# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks as tables of GeoPandas and graphs of NetworkX, with the numbers and columns of network.gpkg."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import geopandas
import networkx
import numpy as np
import pandas
import shapely.geometry

import thalweg
from thalweg import BadInput, BadParameter, ElevatedNetwork, StreamNetwork
from thalweg._networks import lines_from, path_of

# Two sources that meet, and a bend below.
NODES = np.array([[0.0, 0.0], [0.0, 100.0], [100.0, 100.0], [50.0, 50.0]])
LINES = [NODES[[1, 3]], NODES[[2, 3]], np.array([[50.0, 50.0], [0.0, 50.0], [0.0, 0.0]])]
FROM, TO = [1, 2, 3], [3, 3, 0]
NODE_Z = [0.0, 30.0, 40.0, 10.0]
ARC_Z = [[30.0, 10.0], [40.0, 10.0], [10.0, 5.0, 0.0]]


def planform():
    return StreamNetwork(NODES, FROM, TO, LINES)


class Confluence(unittest.TestCase):
    def test_graph(self):
        for network in (planform(), ElevatedNetwork(planform(), NODE_Z, ARC_Z)):
            graph = network.to_networkx()
            self.assertIsInstance(graph, networkx.DiGraph)
            self.assertEqual(set(graph.edges), {(1, 3), (2, 3), (3, 0)})
            self.assertEqual([[of["x"], of["y"]] for _, of in sorted(graph.nodes.items())], NODES.tolist())
            self.assertEqual([graph.edges[edge]["strahler"] for edge in zip(FROM, TO)], [1, 1, 2])
            self.assertEqual([graph.edges[edge]["arc"] for edge in zip(FROM, TO)], [0, 1, 2])
            self.assertEqual(graph.edges[3, 0]["length_m"], 100.0)
            self.assertEqual(networkx.ancestors(graph, 0), {1, 2, 3})
            np.testing.assert_array_equal(graph.edges[3, 0]["line"][:, :2], LINES[2])
        self.assertEqual(dict(graph.nodes(data="z")), dict(enumerate(NODE_Z)))
        self.assertEqual(graph.edges[3, 0]["line"][:, 2].tolist(), ARC_Z[2])
        self.assertNotIn("z", planform().to_networkx().nodes[0])

    def test_table(self):
        table = ElevatedNetwork(planform(), NODE_Z, ARC_Z).to_geodataframe(crs="EPSG:32631")
        self.assertEqual(table.crs.to_epsg(), 32631)
        self.assertEqual(table.arc_id.tolist(), [1, 2, 3])
        self.assertEqual(table.strahler.tolist(), [1, 1, 2])
        self.assertEqual(list(table.geometry[2].coords), [(50, 50, 10), (0, 50, 5), (0, 0, 0)])
        self.assertEqual(table.us_area.tolist(), [-1, -1, -1])
        nodes = ElevatedNetwork(planform(), NODE_Z, ARC_Z).to_geodataframe("nodes")
        self.assertEqual(nodes.z.tolist(), NODE_Z)
        self.assertIsNone(nodes.crs)

    def test_a_network_in_plan_has_no_heights(self):
        arcs, nodes = planform().to_geodataframe(), planform().to_geodataframe("nodes", crs="EPSG:32631")
        self.assertFalse(arcs.has_z.any() or nodes.has_z.any())
        self.assertFalse({"z", "z_up", "z_down", "slope", "length_3d"} & {*arcs.columns, *nodes.columns})
        self.assertEqual(list(arcs.geometry[2].coords), [(50, 50), (0, 50), (0, 0)])
        self.assertEqual(nodes.crs.to_epsg(), 32631)

    def test_graphs_and_tables_come_back(self):
        def same(one, other):
            self.assertIs(type(one), type(other))
            plans = [getattr(each, "planform", each) for each in (one, other)]
            for field in ("nodes", "from_nodes", "to_nodes"):
                np.testing.assert_array_equal(getattr(plans[0], field), getattr(plans[1], field))
            for line, again in zip(plans[0].lines, plans[1].lines, strict=True):
                np.testing.assert_array_equal(line, again)
            if isinstance(one, ElevatedNetwork):
                np.testing.assert_array_equal(one.node_z, other.node_z)
                for z, again in zip(one.arc_z, other.arc_z, strict=True):
                    np.testing.assert_array_equal(z, again)

        for network in (planform(), ElevatedNetwork(planform(), NODE_Z, ARC_Z)):
            same(thalweg.from_networkx(network.to_networkx()), network)
            for crs in ("EPSG:32631", None):
                same(thalweg.from_geodataframe(network.to_geodataframe(crs=crs)), network)
        # Any graph, and any table.
        graph = networkx.DiGraph([("spring", "mouth")])
        graph.add_node("spring", x=0, y=5, z=7)
        graph.add_node("mouth", x=10, y=5, z=1)
        graph.edges["spring", "mouth"]["line"] = [(0, 5), (5, 5), (10, 5)]
        self.assertEqual(thalweg.from_networkx(graph).arc_z[0].tolist(), [7.0, 4.0, 1.0])
        table = geopandas.GeoDataFrame(geometry=[shapely.geometry.LineString(line) for line in LINES], crs=32631)
        for lines in (table, geopandas.GeoDataFrame(geometry=list(table.geometry))):
            self.assertEqual(sorted(thalweg.network.order(thalweg.from_geodataframe(lines)).strahler), [1, 1, 2])
        with self.assertRaisesRegex(TypeError, "takes a GeoDataFrame or GeoSeries, not str"):
            thalweg.from_geodataframe("rivers.gpkg")
        with self.assertRaisesRegex(BadInput, "^the network has no arcs|^network: the network has no arcs"):
            thalweg.to_geodataframe(thalweg.network.select(planform(), []))
        del graph.nodes["mouth"]["x"]
        for wrong, words in ((graph, "node 'mouth' has no x and y"), (networkx.Graph([(1, 2)]), "edges have no direction")):
            with self.assertRaisesRegex(BadInput, words):
                thalweg.from_networkx(wrong)
        bent = planform().to_networkx()
        bent.edges[1, 3]["line"] = [(0, 0), (1, 1)]
        with self.assertRaisesRegex(BadInput, "the line of the edge from 1 to 3 does not begin and end at its nodes"):
            thalweg.from_networkx(bent)
        for frame, words in ((table[:0], "the table is empty"), (table.to_crs(4326), "not in metres: reproject it first")):
            with self.assertRaisesRegex(BadInput, words):
                thalweg.from_geodataframe(frame)

    def test_what_is_no_layer_or_network_is_refused_in_words(self):
        with self.assertRaisesRegex(BadParameter, "layer = 'lakes': write arcs or nodes"):
            planform().to_geodataframe("lakes")
        with self.assertRaisesRegex(TypeError, "takes a StreamNetwork, an ElevatedNetwork, ExtractedStreams or a Terrain, not dict"):
            thalweg.to_networkx({})
        two_out = StreamNetwork(NODES, [3, 3], [0, 1], None)
        for take in (two_out.to_networkx, two_out.to_geodataframe):
            with self.assertRaises(BadInput):
                take()


class OfTerrain(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.terrain = thalweg.make({"grid": {"width": 96, "height": 80}})

    def test_tables_are_the_layers_of_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            self.terrain.write(folder + "/out")
            for layer in ("arcs", "nodes"):
                written = geopandas.read_file(folder + "/out/network.gpkg", layer=layer)
                table = self.terrain.to_geodataframe(layer)
                self.assertLessEqual(set(written.columns), set(table.columns))
                for name in ("arc_id", "node_id", "strahler", "length", "us_area", "ds_area", "z", "z_up", "dist_out", "area"):
                    if name in written.columns:
                        np.testing.assert_array_equal(table[name], written[name], name)
                self.assertTrue((table.geometry == written.geometry).all())
                self.assertEqual(table.crs, written.crs)

    def test_graph_and_table_have_the_same_arcs(self):
        graph, table = self.terrain.to_networkx(), self.terrain.to_geodataframe()
        self.assertTrue(networkx.is_directed_acyclic_graph(graph))
        self.assertEqual([(up + 1, down + 1) for up, down in sorted(graph.edges, key=lambda ends: graph.edges[ends]["arc"])],
                         list(zip(table.from_node, table.to_node)))
        for (up, down), edge in graph.edges.items():
            self.assertEqual(tuple(edge["line"][0]), tuple(graph.nodes[up][name] for name in "xyz"))
            self.assertEqual(tuple(edge["line"][-1]), tuple(graph.nodes[down][name] for name in "xyz"))


class Files(unittest.TestCase):
    def test_a_river_file_lives_as_long_as_its_name(self):
        table = geopandas.read_file(pathlib.Path(__file__).parents[2] / "samples/walker_nhdplus.gpkg")
        path = lines_from(table)
        name = str(path)
        written = geopandas.read_file(name)
        self.assertEqual((len(written), list(written.columns)), (len(table), list(table.columns)))
        del path
        self.assertFalse(os.path.exists(name))

    def test_ordinary_tables_are_river_files(self):
        table = geopandas.GeoDataFrame(geometry=[shapely.geometry.LineString(line) for line in LINES], crs=32631)
        for columns, read, said in [
                ({"COMID": [1, 2, 3], "comid": [4, 5, 6]}, {"COMID": [1, 2, 3], "comid_2": [4, 5, 6]}, "'comid' is read as comid_2"),
                ({"fid": [1, 1, 1]}, {"fid": [1, 1, 1]}, None),
                ({"fid": ["a", "b", "c"], "geom": ["x", "y", "z"]}, {"fid": ["a", "b", "c"], "geom": ["x", "y", "z"]}, None),
                ({"kind": pandas.Categorical(["a", "b", "a"]), "order": pandas.Categorical([1, 2, 1])},
                 {"kind": ["a", "b", "a"], "order": [1, 2, 1]}, None),
                ({"middle": table.centroid}, {}, "the second geometry middle is left out"),
                ({"ids": [[1, 2], [3], []]}, {"ids": ["[1, 2]", "[3]", "[]"]}, None),
                ({"mixed": [1, "a", None]}, {"mixed": ["1", "a", None]}, None),
                ({"age": pandas.to_timedelta([1, 2, 3], unit="h")}, {"age": [3600.0, 7200.0, 10800.0]}, None),
                ({"order": pandas.array([1, None, 3], dtype="Int64")}, {"order": [1, None, 3]}, None),
                ({5: [1, 2, 3]}, {"5": [1, 2, 3]}, None)]:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                path = lines_from(table.assign(**columns) if 5 not in columns else table.join(pandas.DataFrame(columns)))
            self.assertEqual([str(one.message) for one in caught if issubclass(one.category, thalweg.ConversionWarning)],
                             [f"rivers: {'column ' if 'read as' in said else ''}{said}"] if said else [])
            rivers = thalweg.io.read_rivers(path=path)
            self.assertEqual(len(rivers.lines), 3)
            self.assertEqual([column.name for column in rivers.attributes.columns], list(read))
            for number, name in enumerate(read):
                self.assertEqual([row[number] for row in rivers.attributes.rows], read[name])

    def test_extracted_streams_keep_their_areas_and_crs(self):
        dem = thalweg.io.read_dem(pathlib.Path(__file__).parents[2] / "samples/jacksboro_utm16.tif")
        streams = thalweg.flow.extract_streams(thalweg.flow.route(dem), dem)
        table = thalweg.to_geodataframe(streams)
        self.assertEqual((streams.crs, table.crs.to_epsg()), (dem.crs, 32616))
        self.assertEqual(table.ds_area.tolist(), streams.areas.ds_area_m2.tolist())
        self.assertEqual(len(thalweg.to_networkx(streams).edges), len(table))

    def test_values_stand_for_files(self):
        table = geopandas.GeoDataFrame(geometry=[shapely.geometry.LineString(line) for line in LINES], crs=32631)
        dem = thalweg.Raster(np.eye(3, dtype=np.float32), cell_m=30, crs="EPSG:32631")
        self.assertEqual(path_of("rivers.gpkg", "rivers"), "rivers.gpkg")
        self.assertEqual(path_of(pathlib.Path("rivers.gpkg"), "rivers"), "rivers.gpkg")
        lines, heights = path_of(table, "rivers"), path_of(dem, "dem")
        self.assertEqual(len(geopandas.read_file(str(lines))), 3)
        np.testing.assert_array_equal(thalweg.io.read_dem(str(heights)), dem)
        with self.assertRaisesRegex(TypeError, "rivers: takes a path, a GeoDataFrame of lines or a raster, not int"):
            path_of(3, "rivers")


class WithoutPackages(unittest.TestCase):
    def test_what_is_missing_is_named(self):
        for module, package, call in [("xarray", "python3-xarray", "dem.to_xarray()"),
                                      ("matplotlib.pyplot", "python3-matplotlib", "dem.plot()"),
                                      ("networkx", "python3-networkx", "net.to_networkx()"),
                                      ("geopandas", "python3-geopandas", "net.to_geodataframe()")]:
            code = (f"import sys; sys.modules[{module!r}] = None\nimport numpy, thalweg\n"
                    "dem = thalweg.Raster(numpy.zeros((2, 2), numpy.float32))\n"
                    f"net = thalweg.StreamNetwork([[0, 0], [1, 1]], [0], [1])\ntry: {call}\n"
                    "except ImportError as missing: print(missing)")
            with self.subTest(module):
                said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
                self.assertEqual(said, f"this needs the Python module {module}: install the package {package}\n")

    def test_nothing_is_imported_before_it_is_used(self):
        code = ("import sys, thalweg\n"
                "print(sorted({'xarray', 'geopandas', 'networkx', 'matplotlib', 'tqdm', 'pyproj'} & set(sys.modules)))")
        said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said, "[]\n")

    def test_modules_are_there_under_their_names(self):
        code = "import thalweg.flow, thalweg.io as io; from thalweg.network import order; print(io is thalweg.io)"
        said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said, "True\n")


if __name__ == "__main__":
    unittest.main()
