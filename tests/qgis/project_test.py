#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""project.qgz and the styles of layers in QGIS: every layer valid and styled, the picture that of the terrain.
The pictures stay in the folder QGIS_PICTURES, if set, each beside map.png of the same terrain."""
import os
import pathlib
import shutil

from support import COAST, SAMPLES, Case, main, program, start

application, plugin = start()

import numpy  # noqa: E402
from osgeo import gdal  # noqa: E402
from qgis.core import (Qgis, QgsApplication, QgsMapRendererParallelJob, QgsMapSettings, QgsMeshLayer, QgsProject, QgsRasterLayer,  # noqa: E402
                       QgsVectorLayer)
from qgis.PyQt.QtCore import QSize  # noqa: E402
from qgis.PyQt.QtGui import QImage, QPainter  # noqa: E402
from thalweg_processing.layers import load_style  # noqa: E402

WIDE = 700  # [px] of a picture
complaints = []
QgsApplication.messageLog().messageReceived[str, str, Qgis.MessageLevel].connect(
    lambda text, tag, level: complaints.append(f"{tag}: {text}") if level in (Qgis.Warning, Qgis.Critical) else None)


def picture(project, names=None):
    """The map that the window would show; of some layers only."""
    settings = QgsMapSettings()
    nodes = [node for node in project.layerTreeRoot().findLayers() if (node.name() in names if names else node.isVisible())]
    settings.setLayers([node.layer() for node in nodes])
    settings.setBackgroundColor(project.backgroundColor())
    settings.setDestinationCrs(project.crs())
    settings.setTransformContext(project.transformContext())
    extent = project.viewSettings().defaultViewExtent()
    settings.setExtent(extent)
    settings.setOutputSize(QSize(WIDE, round(WIDE * extent.height() / extent.width())))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage().convertToFormat(QImage.Format_RGB888)


def pixels(image):
    """Rows, columns and three colours in [0, 255]."""
    data = image.constBits()
    data.setsize(image.sizeInBytes())
    rows = numpy.frombuffer(data, numpy.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, :3 * image.width()].reshape(image.height(), image.width(), 3).astype(float)


def lightness(image):
    return pixels(image) @ (0.3, 0.59, 0.11)


def shown(dem, height):
    """GDAL's hillshade of a DEM at the size of a picture; NaN without data."""
    shade = gdal.DEMProcessing("", str(dem), "hillshade", format="MEM", computeEdges=True)
    values = gdal.Translate("", shade, format="MEM", width=WIDE, height=height, resampleAlg="average").ReadAsArray().astype(float)
    return numpy.where(values > 0, values, numpy.nan)


def keep(name, image, map_png):
    """The picture beside ours, for those who look."""
    if not os.environ.get("QGIS_PICTURES"):
        return
    ours = QImage(str(map_png)).scaledToWidth(WIDE)
    both = QImage(2 * WIDE, max(image.height(), ours.height()), QImage.Format_RGB888)
    both.fill(0xffffff)
    painter = QPainter(both)
    painter.drawImage(0, 0, image)
    painter.drawImage(WIDE, 0, ours)
    painter.end()
    folder = pathlib.Path(os.environ["QGIS_PICTURES"])
    folder.mkdir(parents=True, exist_ok=True)
    both.save(str(folder / f"{name}.png"))


class Projects(Case):
    def opened(self, folder):
        """The project of a folder, every layer of which QGIS can open."""
        complaints.clear()
        project = QgsProject()
        self.assertTrue(project.read(str(folder / "project.qgz")), project.error())
        layers = [node.layer() for node in project.layerTreeRoot().findLayers()]
        self.assertEqual(len(layers), len(project.mapLayers()))
        for layer in layers:
            self.assertTrue(layer.isValid(), layer.name())
            self.assertTrue(layer.crs().isValid() and layer.crs() == project.crs(), layer.name())
            source = pathlib.Path(layer.source().split("|")[0])
            self.assertEqual(source.parent.resolve(), folder.resolve(), f"{layer.name()} lies elsewhere")
            if isinstance(layer, QgsMeshLayer):
                ramp = layer.rendererSettings().scalarSettings(0).colorRampShader().colorRampItemList()
                self.assertEqual(ramp[0].color.name(), "#7ea688", "our tints, and not those of QGIS")
        self.assertEqual(complaints, [])
        return project

    def made(self, name, *arguments):
        folder = self.folder / name
        done = program("make", *arguments, "-o", folder, "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        return folder

    def hold_picture(self, name, folder, least):
        """The picture shows the terrain's light, its heights and its rivers."""
        project = self.opened(folder)
        image = picture(project)
        keep(name, image, folder / "map.png")
        ground = lightness(picture(project, ("Heights", "Hillshade")))
        shade = shown(folder / "dem.tif", image.height())
        land = numpy.isfinite(shade)
        light = numpy.corrcoef(lightness(picture(project, ("Hillshade",)))[land], shade[land])[0, 1]
        both = numpy.corrcoef(ground[land], shade[land])[0, 1]
        print(f"{name}: light of the picture and GDAL's hillshade, r {light:.3f}; under tints {both:.3f}")
        self.assertGreater(light, 0.9)
        self.assertGreater(both, least)
        rivers = pixels(picture(project, ("Rivers",)))
        blue = (rivers[:, :, 2] - rivers[:, :, 0] > 40) & (rivers[:, :, 0] < 160)
        self.assertGreater(blue.mean(), 0.002, "rivers are blue lines")
        self.assertGreater((pixels(image)[blue] @ (-1, 0, 1)).mean(), 40, "and stand on top")
        return project

    def test_every_sample_opens(self):
        self.assertTrue(list(SAMPLES.glob("*.toml")))
        for recipe in sorted(SAMPLES.glob("*.toml")):
            with self.subTest(recipe.stem):
                folder = self.made(recipe.stem, recipe)
                project = self.opened(folder)
                names = [node.name() for node in project.layerTreeRoot().findLayers()]
                self.assertEqual("Heights" in names, (folder / "dem.tif").exists())
                self.assertEqual("Rivers" in names, (folder / "network.gpkg").exists())
                self.assertEqual("TIN" in names, (folder / "tin.2dm").exists())
                self.assertEqual("Contours" in names, (folder / "contours.gpkg").exists())

    def test_the_picture_is_that_of_the_terrain(self):
        self.hold_picture("relief", self.made("relief", SAMPLES / "relief.toml"), 0.75)

    def test_rivers_of_a_file_and_the_sea(self):
        project = self.hold_picture("coast", self.made("coast", COAST), 0.75)
        names = [node.name() for node in project.layerTreeRoot().findLayers()]
        self.assertIn("Lines not in the network", names)
        sea = project.backgroundColor()
        self.assertGreater(sea.blue(), sea.red() + 30)

    def test_in_feet_the_light_is_the_same(self):
        small = ("--set", "grid.width=128", "--set", "grid.height=128")
        metres, feet = self.made("m", *small), self.made("ft", *small, "--units", "ft")
        projects = [self.opened(folder) for folder in (metres, feet)]
        light = [lightness(picture(project, ("Hillshade",))) for project in projects]
        self.assertLess(numpy.abs(light[0] - light[1]).mean(), 2.0)

    def test_a_crs_without_a_code(self):
        folder = self.made("laea", "--set", "grid.width=128", "--set", "grid.height=128", "--crs",
                           "+proj=laea +lat_0=47 +lon_0=9 +datum=WGS84 +units=m")
        project = self.opened(folder)
        self.assertIn("Lambert", project.crs().toWkt())

    def test_a_folder_may_be_moved(self):
        folder = self.made("here", SAMPLES / "tin.toml")
        (self.folder / "elsewhere").mkdir()
        moved = shutil.move(folder, self.folder / "elsewhere" / "moved & renamed")
        self.opened(pathlib.Path(moved))

    def test_saved_by_qgis_it_stays_itself(self):
        folder = self.made("saved", SAMPLES / "tin.toml")
        project = self.opened(folder)
        before = picture(project)
        self.assertTrue(project.write())
        replayed = program("replay", folder, "--verify")
        self.assertEqual(replayed.returncode, 3)
        differing = [line for line in replayed.stdout.splitlines() if not line.startswith("same ")]
        self.assertEqual([line.split()[-1] for line in differing], ["project.qgz"], "QGIS leaves the data as they are")
        project = self.opened(folder)
        again = picture(project)
        self.assertLess(numpy.abs(pixels(before) - pixels(again)).mean(), 0.5)


class Layers(Case):
    def test_each_layer_opens_styled_alone(self):
        folder = self.folder / "tin"
        self.assertEqual(program("make", SAMPLES / "tin.toml", "--set", "skeleton.ridges=voronoi", "-o", folder, "-q").returncode, 0)
        styled = {}
        for file in ("network.gpkg", "contours.gpkg", "catchments.gpkg"):
            data = gdal.OpenEx(str(folder / file), gdal.OF_VECTOR)
            for name in (data.GetLayer(k).GetName() for k in range(data.GetLayerCount())):
                layer = QgsVectorLayer(f"{folder / file}|layername={name}", name, "ogr")
                if layer.isSpatial():
                    styled[name] = layer.renderer().dump()
                    text, _ = layer.getStyleFromDatabase("1")[:2]
                    self.assertIn("<qgis", text)
        self.assertLessEqual({"arcs", "nodes", "ridges", "contours", "catchments", "basins"}, set(styled))
        arcs = QgsVectorLayer(f"{folder / 'network.gpkg'}|layername=arcs", "arcs", "ogr")
        self.assertEqual(arcs.renderer().classAttribute(), "strahler")
        self.assertEqual([category.label() for category in arcs.renderer().categories()][:2], ["Order 1", "Order 2"])
        nodes = QgsVectorLayer(f"{folder / 'network.gpkg'}|layername=nodes", "nodes", "ogr")
        rules = {rule.label(): rule.symbol().size() for rule in nodes.renderer().rootRule().children()}
        self.assertEqual(rules.keys(), {"Source", "Confluence", "Outlet", "Sink", "Pseudo-node"})
        dem = QgsRasterLayer(str(folder / "dem.tif"), "dem")
        self.assertEqual(dem.renderer().type(), "singlebandpseudocolor")
        heights = sorted(float(line.split()[4]) for line in (folder / "tin.2dm").read_text().splitlines() if line.startswith("ND"))
        sources = [str(folder / "tin.2dm")]
        if Qgis.QGIS_VERSION_INT >= 34000:  # as its browser names a mesh, beside whose path it looks for no .qml
            sources.append(f'2DM:"{folder / "tin.2dm"}"')
        for source in sources:
            mesh = QgsMeshLayer(source, "tin", "mdal")
            self.assertTrue(load_style(mesh))
            shader = mesh.rendererSettings().scalarSettings(0).colorRampShader()
            self.assertEqual((shader.minimumValue(), shader.maximumValue()), (heights[0], heights[-1]))
            self.assertEqual(shader.colorRampItemList()[0].color.name(), "#7ea688", "our tints, and not those of QGIS")

    def test_other_commands_style_too(self):
        check, schema = self.folder / "findings.gpkg", self.folder / "nhd.gpkg"
        program("check", COAST, "--findings", check)
        found = QgsVectorLayer(f"{check}|layername=findings", "f", "ogr")
        self.assertEqual(found.renderer().classAttribute(), "kind")
        self.assertEqual(program("convert", SAMPLES / "walker_nhdplus.gpkg", "--schema", "hydrorivers", "-o", schema).returncode, 0)
        data = gdal.OpenEx(str(schema))
        name = data.GetLayer(0).GetName()
        rivers = QgsVectorLayer(f"{schema}|layername={name}", "r", "ogr")
        self.assertEqual(rivers.renderer().classAttribute(), "ORD_STRA")
        measures = self.folder / "measures"
        self.assertEqual(program("measure", SAMPLES / "jacksboro_utm16.tif", "-o", measures).returncode, 0)
        for name in ("area_d8", "area_dinf"):
            areas = QgsRasterLayer(str(measures / f"{name}.tif"), name)
            self.assertEqual(areas.renderer().type(), "singlebandpseudocolor")


if __name__ == "__main__":
    main()
