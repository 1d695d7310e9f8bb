#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""qgis_process runs every algorithm on the samples; the results are those of the program."""
import json
import os
import pathlib

from support import BIGTUJUNGA, COAST, JACKSBORO, SMALL, Case, main, program, qgis_process, run, same_files, start

ALGORITHMS = ("make", "rebuild", "check", "convert", "measure", "tin", "blend", "draw")


class InTheProcessingExecutable(Case):
    @classmethod
    def setUpClass(cls):
        assert qgis_process("plugins", "enable", "thalweg_processing").returncode == 0
        cls.qgis = start()

    def assert_made(self, results):
        self.assertFalse(results["error"], results["error"])

    def test_lists_and_explains_every_algorithm(self):
        listed = json.loads(qgis_process("--json", "list").stdout)
        provider = listed["providers"]["thalweg"]
        self.assertTrue(provider["is_active"])
        self.assertEqual({f"thalweg:{name}" for name in ALGORITHMS}, set(provider["algorithms"]))
        said = json.loads(qgis_process("--json", "help", "thalweg:make").stdout)
        self.assertLessEqual({"OUTPUT", "DEM", "ARCS", "PROJECT", "CHECKS_OK"}, set(said["outputs"]))
        self.assertEqual(said["parameters"]["NETWORK_DLA_PARTICLES"]["description"], "Grown rivers, DLA: particles")

    def test_make_and_what_follows_on_its_files(self):
        results = run("make", RIVERS=COAST, OUTPUT=self.folder / "coast", SEED=9, CELL=150)
        self.assert_made(results)
        self.assertTrue(results["CHECKS_OK"])
        self.assertEqual(program("check", self.folder / "coast").returncode, 0)
        self.assertEqual(program("make", COAST, "-o", self.folder / "alone", "--set", "seed=9", "--set",
                                 "grid.cell=150").returncode, 0)
        same_files(self, self.folder / "coast", self.folder / "alone")
        self.assert_layers(results, ["ARCS", "NODES", "CATCHMENTS", "CONTOURS"], ["DEM"])
        dem, arcs = results["DEM"], results["ARCS"]

        results = run("measure", DEM=dem, NETWORK=arcs, OUTPUT=self.folder / "measures")
        self.assert_made(results)
        network = self.folder / "coast/network.gpkg"
        self.assertEqual(program("measure", dem, network, "--layer=arcs", "-o", self.folder / "measured").returncode, 0)
        same_files(self, self.folder / "measures", self.folder / "measured")
        self.assert_layers(results, ["CATCHMENTS", "BASINS"], ["AREA_D8", "AREA_DINF"])

        results = run("check", NETWORK=arcs, DEM=dem)
        self.assert_made(results)
        self.assertTrue(results["OK"])
        results = run("convert", NETWORK=arcs, SCHEMA="taudem", MAX_UPSTREAM=2, OUTPUT=self.folder / "streams.shp")
        self.assert_made(results)
        self.assert_layers(results, ["ARCS"])
        self.assertEqual(program("check", self.folder / "streams.shp", "--schema", "taudem").returncode, 0)

        results = run("draw", DEM=dem, NETWORK=arcs, WHAT="0,1,2,5", FORMAT="png,svg", OUTPUT=self.folder / "pictures")
        self.assert_made(results)
        page = pathlib.Path(results["PICTURES"]).read_text()
        for name in ("map.png", "map.svg", "profile.png", "hypsometry.svg"):
            self.assertIn(f'src="{name}"', page)
            self.assertTrue((self.folder / "pictures" / name).exists())
        self.assertIn("<html", pathlib.Path(results["PAGE"]).read_text())

    def test_make_from_a_dem_and_from_a_recipe_and_from_nothing(self):
        results = run("make", DEM=JACKSBORO, OUTPUT=self.folder / "dem", SURFACE_DRAIN="carve")
        self.assert_made(results)
        self.assertEqual(program("make", JACKSBORO, "-o", self.folder / "dem2", "--set", "surface.drain=carve").returncode, 0)
        same_files(self, self.folder / "dem", self.folder / "dem2")
        self.assert_layers(results, ["CONTOURS"], ["DEM"])
        results = run("make", RECIPE=JACKSBORO.parent / "lines.toml", OUTPUT=self.folder / "lines", UNITS="ft")
        self.assert_made(results)
        self.assertEqual(program("make", JACKSBORO.parent / "lines.toml", "-o", self.folder / "lines2", "--units",
                                 "ft").returncode, 0)
        same_files(self, self.folder / "lines", self.folder / "lines2")
        results = run("make", OUTPUT=self.folder / "grown", EXTENT="500010,507000,5000010,5007000[EPSG:32632]",
                      NETWORK_FOREST_OUTLET_SPACING=0)
        self.assert_made(results)
        self.assertEqual(json.loads((self.folder / "grown/report.json").read_text())["recipe"]["grid"],
                         {"cell": 30.0, "crs": "EPSG:32632", "height": 233, "origin": [500010.0, 5007000.0], "width": 233})

    def test_rebuild_and_compare(self):
        made = self.folder / "made"
        self.assertEqual(program("make", *SMALL, "-o", made).returncode, 0)
        arcs, dem = made / "network.gpkg", made / "dem.tif"
        results = run("rebuild", RIVERS=f"{arcs}|layername=arcs", AGAINST=dem, SEED=9, SURFACE_ROUGHNESS=0.3,
                      OUTPUT=self.folder / "rebuilt")
        self.assert_made(results)
        self.assertEqual(program("rebuild", arcs, "--against", dem, "--seed", "9", "--set", "surface.roughness=0.3", "--set",
                                 "network.lines.layer=arcs", "-o", self.folder / "alone").returncode, 0)
        same_files(self, self.folder / "rebuilt", self.folder / "alone")
        self.assert_layers(results, ["ARCS", "NODES", "CATCHMENTS", "CONTOURS"], ["DEM"])
        self.assertTrue(pathlib.Path(results["PICTURE"]).read_bytes().startswith(b"\x89PNG"))
        told = json.loads((self.folder / "rebuilt/report.json").read_text())["against"]["terrains"]["terrain"]
        self.assertEqual({name.removesuffix("_m").removesuffix("_deg").upper(): value for name, value in told.items()},
                         {name: value for name, value in results.items() if isinstance(value, float)})
        results = run("rebuild", RIVERS=f"{arcs}|layername=arcs", OUTPUT=self.folder / "rebuilt")
        self.assert_made(results)
        self.assertFalse({"PICTURE", "CORRELATION", "RMSE"} & set(results))

    def test_check_mends_the_coast(self):
        results = run("check", NETWORK=COAST, FIX=self.folder / "mended.gpkg", FINDINGS=self.folder / "findings.gpkg")
        self.assert_made(results)
        self.assertFalse(results["OK"])
        self.assertGreater(results["FINDINGS_COUNT"], 0)
        self.assert_layers(results, ["FIX", "FIXED_NODES", "FINDINGS"])
        self.assertEqual(program("check", self.folder / "mended.gpkg").returncode, 0)

    def test_convert_the_coast_needs_the_mended_network(self):
        results = run("convert", NETWORK=COAST, OUTPUT=self.folder / "out.gpkg")
        self.assertIn("2 arcs leave the node", results["error"])
        self.assertFalse((self.folder / "out.gpkg").exists())

    def test_tin(self):
        results = run("tin", DEM=JACKSBORO, ERROR=20, OUTPUT=self.folder / "tin.2dm")
        self.assert_made(results)
        self.assertGreater(results["TRIANGLES"], 100)
        self.assertEqual(program("tin", JACKSBORO, "--error", "20", "-o", self.folder / "alone.2dm").returncode, 0)
        self.assertEqual((self.folder / "tin.2dm").read_bytes(), (self.folder / "alone.2dm").read_bytes())
        results = run("tin", TEXT=JACKSBORO.parent / "points.csv", CRS="EPSG:32616", OUTPUT=self.folder / "points.gpkg")
        self.assert_made(results)
        self.assert_layers(results, ["TIN"])

    def test_blend(self):
        results = run("blend", TARGET=BIGTUJUNGA, SOURCE=JACKSBORO, WINDOW="10,10,100,120", ROTATE=30, FEATHER=4, MIXED="true",
                      OUTPUT=self.folder / "blended.tif")
        self.assert_made(results)
        self.assert_layers(results, [], ["OUTPUT"])
        alone = program("blend", BIGTUJUNGA, JACKSBORO, "--window", "10,10,100,120", "--rotate", "30", "--feather", "4",
                        "--mixed", "-o",
                        self.folder / "alone.tif", "--json")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertEqual((self.folder / "blended.tif").read_bytes(), (self.folder / "alone.tif").read_bytes())
        self.assertEqual(results["CELLS"], json.loads(alone.stdout)["cells"])

    def test_words_of_refusals(self):
        for algorithm, parameters, words in (
                ("make", {"RIVERS": COAST, "DEM": JACKSBORO, "OUTPUT": self.folder / "x"},
                 "Give one of RIVERS, DEM and RECIPE"),
                ("make", {"GRID_CELL": 3, "STATISTICS_MAX": "1,2", "OUTPUT": self.folder / "x"},
                 "STATISTICS_MAX: write three numbers"),
                ("make", {"RIVERS": COAST, "EXTENT": "0,1,0,1[EPSG:4326]", "OUTPUT": self.folder / "x"},
                 "draw the extent where the rivers are"),
                ("make", {"RECIPE": self.folder / "no.toml", "OUTPUT": self.folder / "x"}, "no.toml"),
                ("rebuild", {"RIVERS": COAST, "CELL": 300, "OUTPUT": self.folder / "x"}, "has lines without Z"),
                ("tin", {"DEM": JACKSBORO, "LINES": COAST, "OUTPUT": self.folder / "x.2dm"},
                 "Give exactly one of DEM, POINTS, TEXT"),
                ("measure", {"DEM": JACKSBORO, "WHAT": 10, "OUTPUT": self.folder / "x"}, "catchments need rivers"),
                ("check", {"NETWORK": COAST, "FIELDS": "arc_id", "OUTPUT": "x"}, "write QUANTITY=NAME"),
                ("blend", {"TARGET": JACKSBORO, "SOURCE": JACKSBORO, "WINDOW": "1,2", "OUTPUT": self.folder / "x.tif"},
                 "WINDOW: write")):
            results = run(algorithm, **parameters)
            self.assertIn(words, results["error"], algorithm)
        self.assertEqual(os.listdir(self.folder), [])


if __name__ == "__main__":
    main()
