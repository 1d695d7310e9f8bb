#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers of every sort become what thalweg is given, as QGIS shows them; and what it writes becomes layers."""
import json
import os
import pathlib
import tomllib
import unittest.mock
import zipfile

from support import COAST, JACKSBORO, SAMPLES, SMALL, Case, main, program, start

application, plugin = start()

import processing  # noqa: E402
from osgeo import gdal  # noqa: E402
from qgis.core import (  # noqa: E402
    QgsApplication, QgsCoordinateReferenceSystem, QgsFeature, QgsFeatureRequest, QgsGeometry, QgsProcessing,
    QgsProcessingContext, QgsProcessingException, QgsProcessingFeatureSourceDefinition, QgsProcessingFeedback,
    QgsProcessingModelAlgorithm, QgsProcessingModelChildAlgorithm, QgsProcessingModelChildParameterSource,
    QgsProcessingModelOutput, QgsProcessingMultiStepFeedback, QgsProcessingOutputLayerDefinition,
    QgsProcessingUtils, QgsProject, QgsRasterLayer, QgsRasterRange, QgsRectangle, QgsVectorLayer)
from processing.core.ProcessingConfig import ProcessingConfig  # noqa: E402
import thalweg_processing.algorithm  # noqa: E402
from processing.gui.Postprocessing import handleAlgorithmResults  # noqa: E402

GRID = {"GRID_WIDTH": 96, "GRID_HEIGHT": 96, "CELL": 30}
LINES = ["LineString (501500 5002900 300, 501500 5001500 200)", "LineString (500600 5002600 280, 501500 5001500 200)",
         "LineString (501500 5001500 200, 501400 5000200 100)"]


class Said(QgsProcessingFeedback):
    """What an algorithm said."""

    def __init__(self):
        super().__init__()
        self.commands, self.warnings, self.lines, self.errors, self.shares = [], [], [], [], []
        self.progressChanged.connect(self.shares.append)

    def pushCommandInfo(self, text):
        self.commands.append(text)

    def pushWarning(self, text):
        self.warnings.append(text)

    def reportError(self, text, fatalError=False):
        self.errors.append(text)

    def pushInfo(self, text):
        self.lines.append(text)


def lines_layer(crs="EPSG:32631", name="lines", fields="field=fid:integer&field=name:string"):
    layer = QgsVectorLayer(f"LineStringZ?crs={crs}&{fields}", name, "memory")
    for number, text in enumerate(LINES):
        feature = QgsFeature(layer.fields())
        feature.setAttribute("fid", 7)  # ids that repeat
        feature.setAttribute("name", f"river {number}")
        feature.setGeometry(QgsGeometry.fromWkt(text))
        assert layer.dataProvider().addFeature(feature)
    return layer


class Layers(Case):
    def checked(self, network, **parameters):
        """The report of check on a layer."""
        said = Said()
        results = processing.run("thalweg:check", {"NETWORK": network, "FIX": str(self.folder / "fixed.gpkg"), **parameters},
                                 feedback=said)
        self.assertEqual(self.leftovers(), [])
        return results, said

    def leftovers(self):
        folder = QgsProcessingUtils.tempFolder()
        return [name for name in os.listdir(folder) if name.startswith("thalweg-")]

    def fixed_lines(self):
        layer = QgsVectorLayer(f"{self.folder / 'fixed.gpkg'}|layername=arcs", "arcs", "ogr")
        return layer.featureCount(), layer.crs().authid()

    def test_memory_layer_with_its_fields(self):
        self.checked(lines_layer())
        self.assertEqual(self.fixed_lines(), (3, "EPSG:32631"))

    def test_selected_features_only(self):
        layer = lines_layer()
        layer.selectByIds([feature.id() for feature in layer.getFeatures()][1:])
        self.checked(QgsProcessingFeatureSourceDefinition(layer.id(), selectedFeaturesOnly=True)
                     if QgsProject.instance().addMapLayer(layer) else None)
        count, _ = self.fixed_lines()
        QgsProject.instance().clear()
        self.assertLess(count, 3)

    def saved(self, layer, name="rivers 'of Ü'.gpkg", layer_name='lines "a" é'):
        path = self.folder / name
        from qgis.core import QgsVectorFileWriter
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName, options.layerName = "GPKG", layer_name
        options.layerOptions = ["FID=own_id"]
        assert QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), QgsProject.instance().transformContext(),
                                                         options)[0] == 0
        return path

    def test_an_empty_selection_is_named_so(self):
        layer = QgsProject.instance().addMapLayer(lines_layer(name="my rivers"))
        selected = QgsProcessingFeatureSourceDefinition(layer.id(), selectedFeaturesOnly=True)
        self.refused("^the selection of layer my rivers holds no features: select some, or untick Selected features only$",
                     "check", NETWORK=selected)
        self.refused("^the selection of layer my rivers holds no features", "make", RIVERS=selected,
                     OUTPUT=str(self.folder / "out"))
        QgsProject.instance().clear()
        path = self.saved(lines_layer())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        layer.setSubsetString("\"name\" = 'none'")
        self.refused("^the layer lines shows no features: look at its filter$", "check", NETWORK=layer)

    def test_layer_of_a_geopackage_with_quotes_in_its_names(self):
        path = self.saved(lines_layer())
        options = gdal.VectorTranslateOptions(options=["-update", "-nln", "other"])
        gdal.VectorTranslate(str(path), str(COAST), options=options)
        _, said = self.checked(f'{path}|layername=lines "a" é')
        self.assertIn("--layer", said.commands[0])
        self.assertIn(path.name.split("'")[0], said.commands[0])  # no copy
        self.assertEqual(self.fixed_lines()[0], 3)

    def test_subset_filter(self):
        path = self.saved(lines_layer())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        self.assertTrue(layer.setSubsetString("\"name\" <> 'river 0'"))
        self.checked(layer)
        self.assertLess(self.fixed_lines()[0], 3)

    def test_edits_that_are_not_saved(self):
        path = self.saved(lines_layer())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        layer.startEditing()
        layer.deleteFeature(next(layer.getFeatures(QgsFeatureRequest().setFilterExpression("\"name\" = 'river 0'"))).id())
        self.checked(layer)
        self.assertLess(self.fixed_lines()[0], 3)
        layer.rollBack()
        self.assertEqual(layer.featureCount(), 3)

    def test_crs_that_only_qgis_knows(self):
        path = self.folder / "no crs.shp"
        gdal.VectorTranslate(str(path), str(self.saved(lines_layer())))
        path.with_suffix(".prj").unlink()
        layer = QgsVectorLayer(str(path), "lines", "ogr")
        self.assertFalse(layer.dataProvider().crs().isValid())
        layer.setCrs(QgsCoordinateReferenceSystem("EPSG:32632"))
        _, said = self.checked(layer)
        self.assertIn("--source-crs=EPSG:32632", said.commands[0])
        self.assertEqual(self.fixed_lines(), (3, "EPSG:32632"))
        said = Said()
        processing.run("thalweg:make", {"RIVERS": layer, "OUTPUT": str(self.folder / "out"), **GRID}, feedback=said)
        self.assertIn("network.lines.source_crs=EPSG:32632", said.commands[0])
        self.assertEqual(QgsRasterLayer(str(self.folder / "out/dem.tif")).crs().authid(), "EPSG:32632")

    def test_crs_that_the_user_corrected(self):
        path = self.saved(lines_layer())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        layer.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
        self.checked(layer)
        self.assertEqual(self.fixed_lines(), (3, "EPSG:32633"))

    def test_raster_whose_crs_and_no_data_only_qgis_knows(self):
        path = self.folder / "höhen.tif"
        gdal.Translate(str(path), str(JACKSBORO), noData="none", creationOptions=["PROFILE=BASELINE", "TFW=YES"])
        for beside in self.folder.glob("*.aux.xml"):
            beside.unlink()
        layer = QgsRasterLayer(str(path))
        self.assertFalse(layer.dataProvider().crs().isValid())
        layer.setCrs(QgsCoordinateReferenceSystem("EPSG:32616"))
        layer.dataProvider().setUserNoDataValue(1, [QgsRasterRange(-9999, -9999)])
        results = processing.run("thalweg:measure", {"DEM": layer, "WHAT": [0], "OUTPUT": str(self.folder / "out")})
        self.assertEqual(QgsRasterLayer(results["AREA_D8"]).crs().authid(), "EPSG:32616")
        self.assertEqual(self.leftovers(), [])

    def test_raster_that_comes_from_no_file_is_refused(self):
        layer = QgsRasterLayer("type=xyz&url=file:///nowhere/{x}/{y}/{z}.png&zmax=1&zmin=0", "tiles", "wms")
        self.assertTrue(layer.isValid())
        said = Said()
        with self.assertRaises(QgsProcessingException):
            processing.run("thalweg:measure", {"DEM": layer, "OUTPUT": str(self.folder / "out")}, feedback=said)
        self.assertRegex(said.errors[0], "tiles does not come from a file: save it as a GeoTIFF")

    def test_rasters_that_are_no_file_of_their_own(self):
        table, zipped, memory = self.folder / "two.gpkg", self.folder / "z.zip", "/vsimem/höhen.tif"
        for name, more in (("a", []), ("b", ["APPEND_SUBDATASET=YES"])):
            gdal.Translate(str(table), str(JACKSBORO), format="GPKG", outputType=gdal.GDT_Float32,
                           creationOptions=[f"RASTER_TABLE={name}", *more])
        with zipfile.ZipFile(zipped, "w") as file:
            file.write(JACKSBORO, "in.tif")
        gdal.Translate(memory, str(JACKSBORO))
        for number, source in enumerate((f"GPKG:{table}:b", f"/vsizip/{zipped}/in.tif", memory)):
            layer = QgsRasterLayer(source, "dem")
            self.assertTrue(layer.isValid())
            results = processing.run("thalweg:measure", {"DEM": layer, "WHAT": [0], "OUTPUT": str(self.folder / str(number))})
            self.assertEqual(QgsRasterLayer(results["AREA_D8"]).width(), layer.width())
        gdal.Unlink(memory)
        self.assertEqual(self.leftovers(), [])

    def refused(self, words, algorithm, **parameters):
        instance = QgsApplication.processingRegistry().createAlgorithmById(f"thalweg:{algorithm}")
        context, said = QgsProcessingContext(), Said()
        context.setProject(QgsProject.instance())
        right, why = instance.checkParameterValues(parameters, context)
        if right:
            try:
                self.assertFalse(instance.run(parameters, context, said, {}, False)[1])
                why = said.errors[0]
            except QgsProcessingException as error:
                why = str(error)
        self.assertRegex(why, words)
        self.assertNotIn("Traceback", why)

    def test_no_output_replaces_the_file_of_an_input(self):
        path, dem = self.saved(lines_layer()), self.folder / "dem.tif"
        dem.write_bytes(JACKSBORO.read_bytes())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        layer.setSubsetString("\"name\" <> 'river 0'")  # so that the program gets another file
        for name in ("FIX", "FINDINGS"):
            self.refused(f"{name}: .* would replace the file of the layer lines", "check", NETWORK=layer, **{name: str(path)})
        self.refused("would replace the file of the layer dem", "blend", TARGET=str(dem), SOURCE=str(JACKSBORO), GAIN=2,
                     OUTPUT=str(dem))
        self.refused("name two files", "check", NETWORK=layer, **dict.fromkeys(("FIX", "FINDINGS"), str(self.folder / "x.gpkg")))
        shapes = self.folder / "r_arcs.shp"
        gdal.VectorTranslate(str(shapes), str(path))
        self.refused("would replace", "check", NETWORK=str(shapes), FIX=str(self.folder / "r.shp"))
        layer.setSubsetString("")
        self.assertEqual(layer.featureCount(), 3)
        self.assertEqual(dem.read_bytes(), JACKSBORO.read_bytes())

    def test_nonsense_is_refused_in_words(self):
        dem, out = str(JACKSBORO), str(self.folder / "out")
        for gain in ("1,5", "much", float("nan"), "inf"):
            self.refused("GAIN: '.*' is not a", "blend", TARGET=dem, SOURCE=dem, GAIN=gain, OUTPUT=f"{out}.tif")
        self.refused("SEED: '2.5' is not a whole number", "make", SEED="2.5", OUTPUT=out)
        self.refused("TITLE: a text with a null character", "make", TITLE="a\0b", OUTPUT=out)
        self.refused("EXTENT: 'a,b,c' is not an extent", "make", EXTENT="a,b,c", OUTPUT=out)
        for extent, cell in (("0,inf,0,1 [EPSG:32631]", 1), ("0,1,0,1 [EPSG:32631]", 0)):
            self.refused("EXTENT: .* has no cells of", "make", EXTENT=extent, CELL=cell, OUTPUT=out)
        self.refused("OUTPUT: cannot make the folder of /proc/none/out", "make", OUTPUT="/proc/none/out")
        self.refused("CRS: 'EPSG:0' is not a CRS", "tin", TEXT=str(SAMPLES / "points.csv"), CRS="EPSG:0", OUTPUT=f"{out}.2dm")
        self.refused("is a folder", "tin", TEXT=str(self.folder), OUTPUT=f"{out}.2dm")
        self.refused("writes a GeoTIFF", "blend", TARGET=dem, SOURCE=dem, OUTPUT=f"{out}.png")
        for name in ("FIX", "FINDINGS"):  # an ending in capitals is one
            results = processing.run("thalweg:check", {"NETWORK": str(COAST), name: str(self.folder / "X.GPKG")})
            self.assertTrue(QgsVectorLayer(results[name], "layer", "ogr").isValid())
            (self.folder / "X.GPKG").unlink()
        self.refused("FIX: thalweg writes", "check", NETWORK=str(COAST), FIX=f"{out}.geojson")
        self.refused("match no schema(.|\n)*In QGIS: ", "check", NETWORK=lines_layer())
        self.refused("2 arcs leave(.|\n)*In QGIS: ", "convert", NETWORK=str(COAST), OUTPUT=f"{out}/new/x.gpkg")
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_dem_in_the_utm_zone_of_rivers_in_degrees(self):
        """As the help of Check says."""
        warped = str(self.folder / "dem.tif")
        gdal.Warp(warped, str(JACKSBORO), dstSRS="EPSG:4326")
        rivers = str(SAMPLES / "jacksboro_rivers.fgb")
        degrees = str(self.folder / "degrees.gpkg")
        gdal.VectorTranslate(degrees, rivers, dstSRS="EPSG:4326", reproject=True)
        said = Said()
        processing.run("thalweg:check", {"NETWORK": degrees, "DEM": str(JACKSBORO), "FIX": str(self.folder / "f.gpkg")},
                       feedback=said)
        self.assertIn("EPSG:32616", " ".join(said.lines))
        self.refused(r"reproject one of them \(.*Raster > Projections > Warp\)", "check", NETWORK=degrees, DEM=warped,
                     FIX=str(self.folder / "f.gpkg"))
        instance = QgsApplication.processingRegistry().createAlgorithmById("thalweg:check")
        self.assertIn("in degrees, be in its UTM zone", instance.parameterDefinition("DEM").help())

    def test_no_folder_for_temporary_files(self):
        none = unittest.mock.Mock(tempFolder=lambda: "/proc/none")
        with unittest.mock.patch.object(thalweg_processing.algorithm, "QgsProcessingUtils", none):
            self.refused("cannot write to the folder for temporary files, /proc/none: ", "check", NETWORK=str(COAST))

    def test_names_that_a_geopackage_does_not_take(self):
        fields = "&".join(f"field={name}:string" for name in ("ID", "id", "geom", "thalweg_fid", "thalweg_shape"))
        for name in ("", "(rivers)", "-o", "./a", "gpkg_contents", "sqlite_a", "x" * 300):
            self.checked(lines_layer(name=name, fields=f"{fields}&field=fid:integer&field=name:string"))
            self.assertEqual(self.fixed_lines()[0], 3)

    def test_a_layer_that_qgis_cannot_read_is_not_empty(self):
        layer = QgsProject.instance().addMapLayer(QgsVectorLayer("/none.csv", "no rivers", "delimitedtext"))
        self.refused("no rivers: QGIS cannot read|Could not load source", "check", NETWORK=layer)
        QgsProject.instance().clear()

    def test_a_file_that_has_gone_is_not_an_empty_layer(self):
        path = self.saved(lines_layer())
        layer = QgsVectorLayer(f'{path}|layername=lines "a" é', "lines", "ogr")
        path.rename(self.folder / "elsewhere.gpkg")
        self.refused("lines: its file .* does not exist any more", "check", NETWORK=layer)

    def test_nodes_of_another_layer(self):
        self.assertEqual(program("make", "-o", self.folder / "made", "--set", "grid.width=128", "--set", "grid.height=128",
                                 "--set",
                                 "network.forest.outlet_spacing=0").returncode, 0)
        source = self.folder / "made/network.gpkg"
        arcs, nodes = (QgsVectorLayer(f"{source}|layername={name}", name, "ogr") for name in ("arcs", "nodes"))
        results = processing.run("thalweg:check", {"NETWORK": arcs, "NETWORK_NODES": nodes})
        self.assertTrue(results["OK"])
        nodes.selectAll()
        copy = nodes.materialize(QgsFeatureRequest())
        results = processing.run("thalweg:check", {"NETWORK": arcs, "NETWORK_NODES": copy})
        self.assertTrue(results["OK"])
        fewer = nodes.materialize(QgsFeatureRequest().setLimit(3))
        said = Said()
        results = processing.run("thalweg:check", {"NETWORK": arcs, "NETWORK_NODES": fewer}, feedback=said)
        self.assertFalse(results["OK"])
        self.assertRegex(said.warnings[0], "These checks failed: .*missing_node")

    def test_make_takes_layers_for_keys(self):
        region = QgsVectorLayer("Polygon?crs=EPSG:32631", "region", "memory")
        feature = QgsFeature()
        feature.setGeometry(QgsGeometry.fromRect(QgsRectangle(500300, 4997400, 502500, 4999700)))
        region.dataProvider().addFeature(feature)
        said = Said()
        results = processing.run("thalweg:make", {
            "NETWORK_SOURCE": "forest", "NETWORK_FOREST_REGION": region, "CRS": QgsCoordinateReferenceSystem("EPSG:32631"),
            "OUTPUT": str(self.folder / "out"), "GRID_ORIGIN": "500000, 5000000", "NETWORK_MEANDER": 0.25,
                                                  "OUTPUT_CATCHMENTS": "false",
            "NETWORK_FOREST_OUTLET_SPACING": 0, "TITLE": 'a "title" é', **GRID}, feedback=said)
        recipe = tomllib.loads((self.folder / "out/recipe.toml").read_text())


        self.assertEqual(recipe["network"]["forest"]["region"].split("/")[0], "inputs")
        self.assertEqual(recipe["grid"]["origin"], [500000.0, 5000000.0])
        self.assertEqual((recipe["network"]["meander"], recipe["output"]["catchments"], recipe["output"]["title"]),
                         (0.25, False, 'a "title" é'))
        self.assertNotIn("CATCHMENTS", results)
        self.assertEqual(said.shares, sorted(said.shares))
        self.assertGreater(len(said.shares), 5)

    def test_rebuild_takes_layers_as_qgis_shows_them(self):
        self.assertEqual(program("make", *SMALL, "-o", self.folder / "made").returncode, 0)
        arcs = QgsVectorLayer(f"{self.folder / 'made/network.gpkg'}|layername=arcs", "rivers", "ogr")
        arcs.setSubsetString("strahler > 1")
        dem = QgsRasterLayer(str(self.folder / "made/dem.tif"), "höhen")
        dem.dataProvider().setUserNoDataValue(1, [QgsRasterRange(-9999, -9999)])
        said = Said()
        results = processing.run("thalweg:rebuild", {"RIVERS": arcs, "LIKE": dem, "AGAINST": dem,
                                                     "OUTPUT": str(self.folder / "out")}, feedback=said)
        self.assertGreater(results["CORRELATION"], 0.5)
        self.assertLess(QgsVectorLayer(results["ARCS"], "arcs", "ogr").featureCount(),
                        QgsVectorLayer(str(self.folder / "made/network.gpkg|layername=arcs"), "arcs", "ogr").featureCount())
        self.assertEqual((QgsRasterLayer(results["DEM"]).width(), QgsRasterLayer(results["DEM"]).extent()),
                         (dem.width(), dem.extent()))
        self.assertEqual({path.name for path in (self.folder / "out/inputs").rglob("*.tif")}, {"höhen.tif", "höhen_2.tif"})
        self.assertEqual(said.shares, sorted(said.shares))
        self.assertEqual(self.leftovers(), [])

    def test_extent_in_another_crs(self):
        said = Said()
        processing.run("thalweg:make", {"EXTENT": "3.00,3.05,45.00,45.04 [EPSG:4326]", "CRS": "EPSG:32631", "CELL": 40,
                                        "NETWORK_FOREST_OUTLET_SPACING": 0, "OUTPUT": str(self.folder / "out")}, feedback=said)
        grid = json.loads((self.folder / "out/report.json").read_text())["recipe"]["grid"]
        self.assertEqual([x % 40 for x in grid["origin"]], [0, 0])
        self.assertLessEqual(grid["origin"][0], 500000)
        self.assertTrue(99 <= grid["width"] <= 101 and 111 <= grid["height"] <= 114, grid)

    def of_extent(self, rivers, extent, **parameters):
        """The grid that make lays over an extent; its checks pass, and the log tells what was cut."""
        said = Said()
        results = processing.run("thalweg:make", {"RIVERS": rivers, "EXTENT": extent, "OUTPUT": str(self.folder / "out"),
                                                  **parameters}, feedback=said)
        self.assertTrue(results["CHECKS_OK"], f"{rivers} {extent}: {said.warnings}")
        self.assertRegex("\n".join(said.lines), r"extent: \d+x\d+ cells of [\d.]+ m in EPSG:\d+\n(.|\n)*"
                                                r"extent: it holds [\d.]+ km of the rivers; [\d.]+ km beyond it were cut off")
        return json.loads((self.folder / "out/report.json").read_text())["recipe"]["grid"]

    def test_extent_with_rivers_and_nothing_else(self):
        """The CRS and the cells are those for all of the rivers; the extent may be in any CRS."""
        coast = str(COAST)
        whole = json.loads(program("make", coast, "--dry-run", "--json").stdout)["grid"]
        for extent in ("-124.30,-124.10,40.10,40.28 [EPSG:4326]", "-13820000,-13790000,4880000,4905000 [EPSG:3857]",
                       "390000,410000,4440000,4460000 [EPSG:32610]"):
            grid = self.of_extent(coast, extent)
            self.assertEqual((grid["crs"], grid["clip"], grid["cell"]), (whole["crs"], True, whole["cell"]))
            for here, there in zip(grid["origin"], (whole["west"], whole["north"])):
                self.assertEqual((here - there) % whole["cell"], 0)
        grid = self.of_extent(coast, "-124.10,-124.06,40.10,40.14 [EPSG:4326]")
        self.assertTrue(250 <= max(grid["width"], grid["height"]) <= 400, grid)  # finer cells
        self.assertEqual(self.of_extent(coast, "-124.20,-124.05,40.10,40.22 [EPSG:4326]", CELL=60)["cell"], 60)
        self.assertEqual(self.of_extent(coast, "-124.20,-124.05,40.10,40.22 [EPSG:4326]", CRS="EPSG:26910")["crs"],
                         "EPSG:26910")
        metric = self.folder / "metric.gpkg"
        gdal.VectorTranslate(str(metric), coast, dstSRS="EPSG:3310", reproject=True, layerName="rivers")
        self.assertEqual(self.of_extent(str(metric), "-124.20,-124.05,40.10,40.22 [EPSG:4326]")["crs"], "EPSG:3310")
        layer = QgsProject.instance().addMapLayer(QgsVectorLayer(coast, "rivers", "ogr"))
        layer.selectByExpression("FTYPE <> 'Coastline'")
        self.of_extent(QgsProcessingFeatureSourceDefinition(layer.id(), selectedFeaturesOnly=True),
                       "-124.20,-124.05,40.10,40.22 [EPSG:4326]")
        QgsProject.instance().clear()

    def test_extent_with_a_recipe_and_with_nothing(self):
        said = Said()
        results = processing.run("thalweg:make", {
            "RECIPE": str(SAMPLES / "relief_lines.toml"), "OUTPUT": str(self.folder / "out"),
            "EXTENT": "-122.85,-122.75,38.13,38.20 [EPSG:4326]"}, feedback=said)
        self.assertTrue(results["CHECKS_OK"], said.warnings)
        grid = json.loads((self.folder / "out/report.json").read_text())["recipe"]["grid"]
        self.assertEqual((grid["cell"], grid["clip"]), (30.0, True))
        processing.run("thalweg:make", {
            "EXTENT": "3.00,3.05,-45.04,-45.00 [EPSG:4326]", "CELL": 40, "OUTPUT": str(self.folder / "out"),
            "NETWORK_FOREST_OUTLET_SPACING": 0})
        grid = json.loads((self.folder / "out/report.json").read_text())["recipe"]["grid"]
        self.assertEqual(grid["crs"], "EPSG:32731")

    def test_runs_in_a_model(self):
        model = QgsProcessingModelAlgorithm("terrain and its TIN")
        make = QgsProcessingModelChildAlgorithm("thalweg:make")
        make.setChildId("make")
        static = QgsProcessingModelChildParameterSource.fromStaticValue
        for name, value in {"NETWORK_FOREST_OUTLET_SPACING": 0, "LOAD": [], **GRID}.items():
            make.addParameterSources(name, [static(value)])
        tin = QgsProcessingModelChildAlgorithm("thalweg:tin")
        tin.setChildId("tin")
        tin.addParameterSources("DEM", [QgsProcessingModelChildParameterSource.fromChildOutput("make", "DEM")])
        tin.addParameterSources("ERROR", [static(5)])
        output = QgsProcessingModelOutput("mesh")
        output.setChildOutputName("OUTPUT")
        tin.setModelOutputs({"mesh": output})
        model.addChildAlgorithm(make)
        model.addChildAlgorithm(tin)
        results, done = model.run({"tin:mesh": str(self.folder / "mesh.2dm")}, QgsProcessingContext(), QgsProcessingFeedback())
        self.assertTrue(done)
        self.assertTrue(pathlib.Path(results["tin:mesh"]).read_text().startswith("MESH2D"))


class Opened(Case):
    """What QGIS opens when an algorithm has ended."""

    kept = []  # QGIS 3.22 crashes where a second project goes before the end

    def opened(self, algorithm, parameters):
        return self.opened_by(QgsApplication.processingRegistry().createAlgorithmById(f"thalweg:{algorithm}"), parameters)

    def opened_by(self, instance, parameters):
        project = QgsProject()
        self.kept.append(project)
        parameters = {name: QgsProcessingOutputLayerDefinition(value[1:], project) if str(value)[:1] == ">" else value
                      for name, value in parameters.items()}  # ">": to be opened
        context = QgsProcessingContext()
        context.setProject(project)
        self.assertTrue(instance.checkParameterValues(parameters, context)[0])
        results, done = instance.run(parameters, context, QgsProcessingFeedback())
        self.assertTrue(done)
        self.assertTrue(handleAlgorithmResults(instance, context, QgsProcessingFeedback(), parameters=parameters))
        layers = {layer.name(): layer for layer in project.mapLayers().values()}
        self.assertTrue(all(layer.isValid() and layer.crs().isValid() for layer in layers.values()))
        self.kept.append(layers)
        return results, layers

    def from_the_top(self):
        return [node.name() for node in self.kept[-2].layerTreeRoot().findLayers()]

    def test_layers_that_hide_others_lie_below(self):
        for group in ("", "Results"):  # new layers lie at the top of the project, or at the bottom of a group
            ProcessingConfig.setSettingValue(ProcessingConfig.RESULTS_GROUP_NAME, group)
            self.addCleanup(ProcessingConfig.setSettingValue, ProcessingConfig.RESULTS_GROUP_NAME, "")
            self.opened("make", {"OUTPUT": str(self.folder / "out"), "LOAD": [0, 1, 2, 3], "NETWORK_FOREST_OUTLET_SPACING": 0,
                                 **GRID})
            self.assertEqual(self.from_the_top(), ["Nodes of the rivers", "Rivers", "Catchments", "DEM"])

    def test_a_check_without_findings_opens_nothing(self):
        source, wanted = str(self.folder / "out"), ">" + QgsProcessing.TEMPORARY_OUTPUT
        self.assertEqual(program("make", "-o", source, "--set=grid.width=96", "--set=grid.height=96",
                                 "--set=network.forest.outlet_spacing=0").returncode, 0)
        results, layers = self.opened("check", {"NETWORK": f"{source}/network.gpkg|layername=arcs", "FINDINGS": wanted})
        self.assertEqual((results["FINDINGS_COUNT"], layers), (0, {}))
        self.assertTrue(QgsVectorLayer(results["FINDINGS"], "empty", "ogr").isValid())

    def test_make_opens_what_is_wanted_with_its_styles(self):
        results, layers = self.opened("make", {
            "OUTPUT": str(self.folder / "out"), "LOAD": [0, 1, 3, 5], "NETWORK_FOREST_OUTLET_SPACING": 0,
                                               "SURFACE_METHOD": "tin",
            "SKELETON_TIN": "true", **GRID})
        self.assertEqual(set(layers), {"DEM", "Rivers", "Catchments", "TIN"})
        self.assertEqual(layers["TIN"].crs().authid(), "EPSG:32631")
        self.assertNotEqual(layers["DEM"].renderer().type(), "singlebandgray")
        bare = QgsVectorLayer(results["ARCS"], "bare", "ogr", QgsVectorLayer.LayerOptions(loadDefaultStyle=False))
        self.assertNotEqual(layers["Rivers"].renderer().dump(), bare.renderer().dump())
        read = QgsProject()
        self.assertTrue(read.read(results["PROJECT"]))
        self.assertTrue(read.mapLayers() and all(layer.isValid() for layer in read.mapLayers().values()))

    def test_a_model_opens_its_own_outputs_alone(self):
        """The TIN and the catchments of its children are none; the blended DEM, as an output of the model, is opened."""
        static = QgsProcessingModelChildParameterSource.fromStaticValue
        model = QgsProcessingModelAlgorithm("drainage and its TIN")
        for name, values in (("measure", {"DEM": str(JACKSBORO), "LOAD": [0, 1]}),
                             ("tin", {"DEM": str(JACKSBORO), "ERROR": 30, "LOAD": [0]}),
                             ("blend", {"TARGET": str(JACKSBORO), "SOURCE": str(JACKSBORO), "WINDOW": "5,5,50,50", "GAIN": 2})):
            child = QgsProcessingModelChildAlgorithm(f"thalweg:{name}")
            child.setChildId(name)
            for parameter, value in values.items():
                child.addParameterSources(parameter, [static(value)])
            if name == "blend":
                output = QgsProcessingModelOutput("pasted")
                output.setChildOutputName("OUTPUT")
                child.setModelOutputs({"pasted": output})
            model.addChildAlgorithm(child)
        _, layers = self.opened_by(model, {"blend:pasted": f">{self.folder / 'b.tif'}"})
        self.assertEqual(len(layers), 1)
        part, batch = QgsProcessingMultiStepFeedback(1, Said()), type("Batch", (QgsProcessingMultiStepFeedback,), {})(1, Said())
        self.assertEqual([thalweg_processing.algorithm.is_part_of_another(one) for one in (part, batch)], [True, False])
        _, layers = self.opened("tin", {"DEM": str(JACKSBORO), "ERROR": 30, "LOAD": [], "OUTPUT": str(self.folder / "t.2dm")})
        self.assertEqual(layers, {})
        _, layers = self.opened("measure", {"DEM": str(JACKSBORO), "LOAD": [1], "OUTPUT": str(self.folder / "m")})
        self.assertEqual(set(layers), {"Contributing area (D-infinity)"})

    def test_tin_has_the_crs_that_2dm_has_no_place_for(self):
        _, layers = self.opened("tin", {"DEM": str(JACKSBORO), "ERROR": 30, "OUTPUT": str(self.folder / "t.2dm")})
        self.assertEqual(layers["TIN"].crs().authid(), QgsRasterLayer(str(JACKSBORO)).crs().authid())

    def test_check_measure_convert_and_blend(self):
        wanted = ">" + QgsProcessing.TEMPORARY_OUTPUT
        results, layers = self.opened("check", {"NETWORK": str(COAST), "FIX": wanted, "FINDINGS": wanted})
        self.assertEqual(set(layers), {"Repaired arcs", "Repaired nodes", "Findings"})
        self.assertEqual(self.from_the_top(), ["Findings", "Repaired nodes", "Repaired arcs"])
        fixed = results["FIX"]
        _, layers = self.opened("convert", {"NETWORK": fixed, "SCHEMA": "native", "OUTPUT": str(self.folder / "n.geojson")})
        self.assertEqual(set(layers), {"Arcs", "Nodes"})
        _, layers = self.opened("measure", {"DEM": str(JACKSBORO), "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT})
        self.assertEqual(set(layers), {"Contributing area (D8)", "Contributing area (D-infinity)"})
        _, layers = self.opened("blend", {
            "TARGET": str(JACKSBORO), "SOURCE": str(JACKSBORO), "WINDOW": "5,5,50,50", "GAIN": 2,
            "OUTPUT": f">{self.folder / 'b.tif'}"})
        layer, = layers.values()
        blended = layer.renderer().shader().rasterShaderFunction()
        self.assertEqual(len(blended.colorRampItemList()), 17)
        self.assertGreater(blended.maximumValue(), 900)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("b.")], ["b.tif"])

    def test_no_output_is_grey(self):
        self.assertEqual(program("make", *SMALL, "-o", self.folder / "made").returncode, 0)
        dem, arcs = str(self.folder / "made/dem.tif"), f"{self.folder / 'made/network.gpkg'}|layername=arcs"
        _, layers = self.opened("measure", {"DEM": dem, "NETWORK": arcs, "WHAT": list(range(11)),
                                            "OUTPUT": str(self.folder / "m")})
        self.assertEqual(len(layers), 17)
        kinds = {name: layer.renderer().type() for name, layer in layers.items()}
        self.assertEqual({name for name, kind in kinds.items() if kind == "paletted"},
                         {"Flow direction (D8)", "Stream order (Strahler)", "Cut by the edge"})
        self.assertNotIn("singlebandgray", kinds.values())
        _, layers = self.opened("convert", {"NETWORK": arcs, "OUTPUT": str(self.folder / "n.tif"), "DEM": dem})
        self.assertEqual(layers["River cells"].renderer().type(), "paletted")
        _, layers = self.opened("convert", {"NETWORK": arcs, "OUTPUT": str(self.folder / "n.geojson")})
        self.assertEqual(layers["Arcs"].renderer().symbol().color().name(), "#2171b5")


if __name__ == "__main__":
    main()
