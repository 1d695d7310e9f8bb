#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds docs/qgis.md to what QGIS does: its Python prints what it says, its commands (blocks marked console) run, the ten
minutes give its numbers, and its tables name the algorithms, their parameters and outputs, and the words of errors.
THALWEG_RENEW=1 writes what is printed and the numbers into the page."""
import contextlib
import inspect
import io
import json
import os
import re
import shutil
import subprocess
import sys

from support import COAST, ENVIRONMENT, QGIS_PROCESS, ROOT, SAMPLES, Case, main, start

sys.path.insert(0, str(ROOT / "tests/clients"))
import figures  # noqa: E402

PAGE = ROOT / "docs/qgis.md"
TEXT = PAGE.read_text(encoding="utf-8")
WORDS = " ".join(TEXT.split())

application, plugin = start()

import processing  # noqa: E402
from qgis.core import (QgsApplication, QgsCoordinateReferenceSystem, QgsProcessing, QgsProcessingException,  # noqa: E402
                       QgsProcessingFeedback, QgsProcessingModelAlgorithm, QgsProcessingModelChildAlgorithm, QgsProject,
                       QgsVectorLayer)
import thalweg_processing.program  # noqa: E402


class Said(QgsProcessingFeedback):
    """The log of an algorithm."""

    def __init__(self):
        super().__init__()
        self.lines = []

    def pushInfo(self, text):
        self.lines.append(text)

    def pushWarning(self, text):
        self.lines.append(text)


def count(source, wanted=""):
    """Features of a layer that an expression selects; without one, all."""
    layer = QgsVectorLayer(source, "layer", "ogr")
    layer.setSubsetString(wanted)
    return layer.featureCount()


class Page(Case):
    def setUp(self):
        super().setUp()
        shutil.copytree(SAMPLES, self.folder / "samples")
        self.enterContext(contextlib.chdir(self.folder))

    def assert_says(self, *phrases):
        for phrase in phrases:
            self.assertIn(phrase, WORDS)

    def assert_right(self, mended):
        """The page is as a function of its text makes it."""
        text = PAGE.read_text(encoding="utf-8")
        right = mended(text)
        if os.environ.get("THALWEG_RENEW") == "1":
            PAGE.write_text(right, encoding="utf-8")
        else:
            self.assertEqual(figures.differences(PAGE.name, text, right), [])

    def assert_numbers(self, phrase, *values):
        """The page has a phrase with these values for each {}."""
        self.assert_right(lambda text: figures.with_numbers(text, phrase, values))

    def test_python_prints_what_it_says(self):
        space, blocks = {"__name__": "page"}, list(re.finditer(r"^```python\n(.*?)^```", TEXT, re.S | re.M))
        self.assertGreater(len(blocks), 1)
        for block in blocks:
            said, lines = io.StringIO(), "\n" * TEXT.count("\n", 0, block.start(1))  # tracebacks name lines of the page
            with contextlib.redirect_stdout(said):
                exec(compile(lines + block[1], str(PAGE), "exec"), space)
            right = figures.with_prints(block[1], said.getvalue().splitlines())
            self.assert_right(lambda text, old=block[1], new=right: text.replace(old, new))
        space.clear()
        QgsProject.instance().clear()

    def test_commands_run(self):
        tools = self.folder / "bin"
        tools.mkdir()
        (tools / "qgis_process").symlink_to(QGIS_PROCESS)
        environment = {**ENVIRONMENT, "PATH": f"{tools}:{ENVIRONMENT['PATH']}"}
        blocks = re.findall(r"^```console\n(.*?)^```", TEXT, re.S | re.M)
        commands = [line[2:] for block in blocks for line in block.splitlines()]
        self.assertGreater(len(commands), 1)
        for command in commands:
            done = subprocess.run(["bash", "-c", command], env=environment, capture_output=True, text=True,
                                  stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")

    def test_ten_minutes(self):
        def run(name, **parameters):
            said = Said()
            results = processing.run(f"thalweg:{name}", parameters, feedback=said)
            return results, "\n".join(said.lines)

        lines = QgsVectorLayer("samples/coastal_nhdplus.gpkg", "rivers", "ogr")
        self.assert_numbers("into the window: {} lines", lines.featureCount())
        checked, log = run("check", NETWORK=lines, FIX="repaired.gpkg", FINDINGS="findings.gpkg")
        self.assertFalse(checked["OK"])
        failed, = re.findall("These checks failed: (.*)", log)
        self.assertEqual(failed.count("allowed"), 3)
        kinds = {kind: count(checked["FINDINGS"], f"kind = '{kind}'") for kind in
                 ("several_outflows", "duplicate_geometry", "ds_arc_mismatch")}
        self.assertEqual(sum(kinds.values()), checked["FINDINGS_COUNT"])
        repairs, = re.findall(r"(\d+) repairs: .*\d+ secondary", log)
        self.assert_says("three checks that failed", *kinds)
        self.assert_numbers("{} findings and counts {} repairs", checked["FINDINGS_COUNT"], int(repairs))
        self.assert_numbers("{} findings are nodes", kinds["several_outflows"])
        self.assert_numbers("{} is a line drawn twice", kinds["duplicate_geometry"])
        self.assert_numbers("{} names the wrong river", kinds["ds_arc_mismatch"])
        secondary = count("repaired.gpkg|layername=secondary")
        self.assert_numbers("repaired network has {} arcs. Minor channels, {} lines", count(checked["FIX"]), secondary)

        made, log = run("make", RIVERS=lines, OUTPUT="coast")
        self.assertTrue(made["CHECKS_OK"])
        with open("coast/report.json", encoding="utf-8") as file:
            grid = json.load(file)["recipe"]["grid"]
        checks, outlets = map(int, re.search(r"check: (\d+) checks, (\d+) outlets", log).groups())
        sea = int(re.search(r"sea: (\d+) % of the grid", log)[1])
        self.assert_numbers("{} × {} cells of {} m in EPSG:{}.", grid["width"], grid["height"], grid["cell"],
                            int(grid["crs"].removeprefix("EPSG:")))
        self.assert_numbers("All {} checks pass", checks)
        self.assert_numbers("{} arcs reach {} outlets, and {} % of the grid is sea", count(made["ARCS"]), outlets, sea)
        project = QgsProject.instance()
        self.assertTrue(project.read(made["PROJECT"]))
        self.assertLessEqual({"Rivers", "Heights", "Hillshade"}, {layer.name() for layer in project.mapLayers().values()})
        rivers, heights = (project.mapLayersByName(name)[0] for name in ("Rivers", "Heights"))

        checked, log = run("check", NETWORK=rivers, DEM=heights)
        self.assertIn("All checks passed. They allow findings within limits: ", log)
        self.assertTrue(checked["OK"])
        self.assert_numbers("The {} findings are places", checked["FINDINGS_COUNT"])
        measured, log = run("measure", DEM=heights, NETWORK=rivers, OUTPUT="measures")
        self.assert_numbers("{} catchments and {} basins", count(measured["CATCHMENTS"]), count(measured["BASINS"]))
        self.assert_numbers("{} cells drain", int(re.search("water of ([0-9]+) cells", log)[1]))
        tin, _ = run("tin", DEM=heights, ERROR=20, OUTPUT="coast.2dm")
        self.assert_numbers("{} vertices and {} triangles", tin["VERTICES"], tin["TRIANGLES"])
        drawn, _ = run("draw", DEM=heights, NETWORK=rivers, OUTPUT="pictures")
        self.assertEqual(sorted(name for name in os.listdir("pictures") if name.endswith(".png")),
                         ["hypsometry.png", "map.png", "profile.png", "sections.png", "wireframe.png"])
        blended, _ = run("blend", TARGET=heights, SOURCE="samples/bigtujunga_srtm1_utm11.tif", KEEP=rivers, FEATHER=8, OUTPUT="pasted.tif")
        self.assert_numbers("replaces {} cells", blended["CELLS"])
        made, _ = run("make", RIVERS=lines, CELL=150, SKELETON_TIN="true", OUTPUT="with_tin")
        self.assertTrue(os.path.exists(made["TIN"]))
        project.clear()

    def test_the_model(self):
        model = QgsProcessingModelAlgorithm("terrain and its catchments")
        for name in ("make", "measure"):
            child = QgsProcessingModelChildAlgorithm(f"thalweg:{name}")
            child.setChildId(name)
            model.addChildAlgorithm(child)
        for kind, shapes, output in (("outputRaster", [], "DEM"), ("outputVector", [QgsProcessing.TypeVectorLine], "ARCS")):
            sources = model.availableSourcesForChild("measure", [], [kind], shapes)
            self.assertIn(("make", output), {(source.outputChildId(), source.outputName()) for source in sources})

    def test_algorithms_are_those_of_the_table(self):
        rows = re.findall(r"^\| ([^|]+) \| `thalweg:(\w+)` \| (.*) \| (.*) \|$", TEXT, re.M)
        registry = QgsApplication.processingRegistry()
        algorithms = registry.providerById("thalweg").algorithms()
        self.assertEqual({name for _, name, _, _ in rows}, {one.name() for one in algorithms})
        for title, name, given, gives in rows:
            algorithm = registry.algorithmById(f"thalweg:{name}")
            self.assertEqual(algorithm.displayName(), title)
            parameters = {one.name() for one in algorithm.parameterDefinitions()}
            outputs = {one.name() for one in algorithm.outputDefinitions()}
            self.assertLessEqual(set(re.findall("`([A-Z_0-9]+)`", given)), parameters, name)
            self.assertLessEqual(set(re.findall("`([A-Z_0-9]+)`", gives)), outputs, name)
            if name != "convert":  # no step of the ten minutes
                self.assert_says(f"{algorithm.group()} > {title}")

    def test_what_is_wrong_is_said_so(self):
        layer = QgsVectorLayer(str(COAST), "rivers", "ogr")
        layer.setCrs(QgsCoordinateReferenceSystem())
        for words, name, parameters in (
                ("has no CRS", "make", {"RIVERS": layer, "OUTPUT": "x"}),
                ("has lines without Z", "rebuild", {"RIVERS": str(COAST), "CELL": 300, "OUTPUT": "x"}),
                ("2 arcs leave the node", "convert", {"NETWORK": str(COAST), "OUTPUT": "x.gpkg"}),
                ("draw the extent where the rivers are", "make",
                 {"RIVERS": str(COAST), "EXTENT": "0,1,0,1 [EPSG:4326]", "OUTPUT": "x"})):
            with self.assertRaises(QgsProcessingException) as refused:
                processing.run(f"thalweg:{name}", parameters)
            self.assertIn(words, str(refused.exception))
            self.assert_says(words)
        for words in ("the program thalweg is not in PATH", "is older than this plugin needs"):  # program_test.py hears them
            self.assertIn(words, inspect.getsource(thalweg_processing.program))
            self.assert_says(words)


if __name__ == "__main__":
    main()
