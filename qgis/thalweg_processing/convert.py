# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg convert."""
from __future__ import annotations

from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputRasterLayer,
                       QgsProcessingOutputVectorLayer, QgsProcessingParameterEnum,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer,
                       QgsProcessingParameterString)

from . import styles
from .advice import in_qgis
from .algorithm import NODATA
from .layers import File, RasterInput, VectorInput, network_layers, open_after, raster_input
from .network_input import MAIN, MAIN_HELP, SCHEMAS, NetworkAlgorithm
from .program import Finished

FORMATS = ["gpkg", "shp", "fgb", "geojson", "geojson2008", "graphml", "csv", "edges", "tif"]
FILTER = ("GeoPackage (*.gpkg);;Shapefile (*.shp);;FlatGeobuf (*.fgb);;GeoJSON (*.geojson);;GraphML (*.graphml);;"
          "Tables of text (*.csv);;List of edges (*.edges);;GeoTIFF, 1 in river cells (*.tif)")


class Convert(NetworkAlgorithm):
    """Convert a network to another schema or format."""

    COMMAND = "convert"
    TITLE = "Convert river network"
    GROUP = "Networks"
    TEXT = ("Convert a river network to another schema or format.\n"
            "Networks that are not trees are rejected, but for divergences in the schema nhdplus; Check river network tells why. "
            "Arcs get new numbers; the native field feature keeps their ids of another schema. TauDEM allows two arcs upstream "
            "of one: set Most arcs upstream to 2. A shapefile, FlatGeobuf or GeoJSON in the native schema is two files, "
            "NAME_arcs and NAME_nodes. A raster has 1 in river cells and 0 elsewhere.")
    TAGS = ("taudem", "nhdplus", "hydrorivers", "grass", "graphml", "schema", "format", "rivers", "streams")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        self.add_network()
        self.add(QgsProcessingParameterEnum("SCHEMA", "New schema", SCHEMAS, defaultValue="native", usesStaticStrings=True),
                 "Field names, units and line directions of the output.")
        self.add(QgsProcessingParameterEnum("MAIN", "Main stems by", MAIN, optional=True, usesStaticStrings=True), MAIN_HELP,
                 advanced=True)
        self.add(QgsProcessingParameterNumber("MAX_UPSTREAM", "Most arcs upstream of one", optional=True, minValue=2),
                 "Split nodes where more arcs than this end: the others join a little downstream.")
        self.add(QgsProcessingParameterNumber("SPLIT_DISTANCE", "Distance of split confluences [m]",
                                              QgsProcessingParameterNumber.Double, optional=True, minValue=0),
                 "Move split confluences by this distance. Default: the median segment length.", advanced=True)
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM", optional=True),
                 "Take missing heights and contributing areas from this DEM. A raster output gets its grid.")
        self.add(QgsProcessingParameterNumber("CELL", "Cell size of a raster [m]", QgsProcessingParameterNumber.Double,
                                              optional=True, minValue=0),
                 "Cell size of a raster output without a DEM.")
        self.add(QgsProcessingParameterEnum("FORMAT", "Format", FORMATS, optional=True, usesStaticStrings=True),
                 "Format of the output. Default: by the file extension. GeoJSON is in degrees; geojson2008 keeps the network's CRS.",
                 advanced=True)
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEM", optional=True), NODATA, advanced=True)
        self.add_load(["Arcs", "Nodes", "River cells"], [0, 1, 2])
        self.add(QgsProcessingParameterFileDestination("OUTPUT", "Converted network", FILTER),
                 "The file to write; an existing one is replaced.")
        self.give(QgsProcessingOutputVectorLayer("ARCS", "Arcs", QgsProcessing.TypeVectorLine),
                  "Arcs, in formats that have layers.")
        self.give(QgsProcessingOutputVectorLayer("NODES", "Nodes", QgsProcessing.TypeVectorPoint),
                  "Nodes, in schemas that have them.")
        self.give(QgsProcessingOutputRasterLayer("RASTER", "River cells"), "River cells, of a raster output.")

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        if wrong := self.check_fields(parameters, context):
            return False, wrong
        return super().checkParameterValues(parameters, context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        return {**self.take_network(parameters, context), "DEM": raster_input(self, parameters, "DEM", context)}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        options = self.network_options(parameters, context, files)
        options += self.options(parameters, context, SCHEMA="--schema", MAIN="--main", MAX_UPSTREAM="--max-upstream",
                                SPLIT_DISTANCE="--split-distance", CELL="--cell", FORMAT="--format", NODATA="--nodata")
        options += [f"--dem={files['DEM'].path}"] if "DEM" in files else []
        return [files["NETWORK"].path, f"--output={self.output}", *options, "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        written = finished.report["written"]
        opened = self.opened(parameters, context, feedback)
        found: dict[str, Any] = {"OUTPUT": self.output}
        layers = network_layers(written)
        for number, (name, kind) in enumerate((("ARCS", "arcs"), ("NODES", "nodes"))):
            if kind in layers:
                found[name] = layers[kind]
                if number in opened:
                    open_after(context, layers[kind], name.capitalize(), name, "vector", style=styles.network)
        rasters = [path for path in written if path.lower().endswith(".tif")]
        if rasters:
            found["RASTER"] = rasters[0]
            if 2 in opened:
                open_after(context, rasters[0], "River cells", "RASTER", "raster",
                           style=styles.cells("#2171b5", "river"))
        for finding in finished.report.get("findings", []):
            if not any(finding["text"] in line for line in finished.heard):
                feedback.pushInfo(in_qgis(finding["text"]))
        return found
