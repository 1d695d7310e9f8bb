# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg measure."""
from __future__ import annotations

import os
from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputRasterLayer,
                       QgsProcessingOutputVectorLayer, QgsProcessingParameterEnum,
                       QgsProcessingParameterFolderDestination, QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer,
                       QgsProcessingParameterString)

from . import styles
from .algorithm import NODATA
from .layers import File, RasterInput, VectorInput, open_after, raster_input
from .network_input import NetworkAlgorithm
from .program import Finished

WHAT = {"d8": "Contributing area, D8", "dinf": "Contributing area, D-infinity", "directions": "Flow directions of both",
        "edge": "Cells whose area the edge of the data cuts", "lengths": "Flow lengths, upstream and to the outlet",
        "hand": "Height above nearest drainage (HAND)", "twi": "Topographic wetness index",
        "orders": "Stream orders, Strahler and Shreve", "chi": "Chi and channel steepness (ksn)",
        "streams": "Streams with Pfafstetter codes, ksn and knickpoints",
        "catchments": "Catchments and basins of the rivers, with their relief"}
RASTERS = {"AREA_D8": ("area_d8.tif", "Contributing area (D8)"),
           "AREA_DINF": ("area_dinf.tif", "Contributing area (D-infinity)"),
           "DIRECTION_D8": ("direction_d8.tif", "Flow direction (D8)"),
           "DIRECTION_DINF": ("direction_dinf.tif", "Flow direction (D-infinity)"),
           "EDGE": ("edge.tif", "Cut by the edge"),
           "LENGTH_UP": ("length_up.tif", "Flow length from the divide"),
           "LENGTH_DOWN": ("length_down.tif", "Flow length to the outlet"),
           "HAND": ("hand.tif", "Height above nearest drainage"),
           "TWI": ("twi.tif", "Topographic wetness index"),
           "STRAHLER": ("strahler.tif", "Stream order (Strahler)"),
           "SHREVE": ("shreve.tif", "Stream order (Shreve)"),
           "CHI": ("chi.tif", "Chi"),
           "KSN": ("ksn.tif", "Channel steepness (ksn)")}
STYLES = {"DIRECTION_D8": styles.directions, "DIRECTION_DINF": styles.angles, "STRAHLER": styles.orders,
          "EDGE": styles.cells("#d7642c", "cut by the edge")}  # of those that are no amounts
LAYERS = {"CATCHMENTS": ("catchments", "Catchments", QgsProcessing.TypeVectorPolygon, "One polygon per arc, with rivers."),
          "BASINS": ("catchments", "Basins", QgsProcessing.TypeVectorPolygon, "One polygon per outlet, with rivers."),
          "ARCS": ("streams", "Arcs", QgsProcessing.TypeVectorLine, "Rivers, or streams of the DEM, if wanted."),
          "KNICKPOINTS": ("streams", "Knickpoints", QgsProcessing.TypeVectorPoint, "Knickpoints of these, if wanted.")}


class Measure(NetworkAlgorithm):
    """Measure what drains where on a DEM."""

    COMMAND = "measure"
    TITLE = "Measure drainage of DEM"
    GROUP = "Terrain"
    TEXT = ("Write contributing areas, flow directions and catchments of a DEM.\n"
            "Contributing areas are in m2. D8 directions are 1 to 128 clockwise from east, 0 at outlets; D-infinity "
            "directions are radians counterclockwise from east, -1 at outlets. Flow is routed through depressions and flats; "
            "the DEM is not changed, but one in degrees is warped to UTM first. HAND, chi and streams are of the rivers, or of "
            "the cells that enough others drain through. A catchment holds the cells whose flow reaches a river first at its "
            "arc; the catchments tile all cells that drain to a river.")
    TAGS = ("hand", "twi", "wetness", "stream order", "strahler", "pfafstetter", "chi", "ksn", "steepness", "knickpoint",
            "flow length", "melton", "hypsometry", "flow accumulation", "flow direction", "d8", "d-infinity", "catchment",
            "watershed", "basin", "hydrology")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM"), "Heights.")
        self.add_network(optional=True)
        self.add(QgsProcessingParameterEnum("WHAT", "What to measure", list(WHAT.values()), allowMultiple=True, optional=True),
                 "Default: contributing areas and, with rivers, catchments.")
        self.add(QgsProcessingParameterNumber("SUPPORT", "Cells that drain through the head of a stream", defaultValue=200,
                                              minValue=1), "Streams of the DEM begin there.")
        self.add(QgsProcessingParameterString("THETA", "Concavity index of chi and ksn", defaultValue="0.45"),
                 "A number from 0 to 2; fit: that for which rivers and tributaries fall best on one line.", advanced=True)
        real = QgsProcessingParameterNumber.Double
        self.add(QgsProcessingParameterNumber("WINDOW", "Length of river for ksn by cell [m]", real, 1000, minValue=0.001),
                 "Half of it upstream, half downstream.", advanced=True)
        self.add(QgsProcessingParameterNumber("KNICK_DROP", "Least height of a knickpoint [m]", real, 30, minValue=0.001),
                 "Above the concave profile.", advanced=True)
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEM", optional=True), NODATA, advanced=True)
        titles = [title for _, title in RASTERS.values()] + [title for _, title, _, _ in LAYERS.values()]
        self.add_load(titles, list(range(len(titles))))
        self.add(QgsProcessingParameterFolderDestination("OUTPUT", "Folder"),
                 "Files of the same names in it are replaced; other files are kept.")
        for name, (_, title) in RASTERS.items():
            self.give(QgsProcessingOutputRasterLayer(name, title), f"{title}, if wanted.")
        for name, (_, title, kind, text) in LAYERS.items():
            self.give(QgsProcessingOutputVectorLayer(name, title, kind), text)

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        if wrong := self.check_fields(parameters, context):
            return False, wrong
        if "catchments" in self.what(parameters, context) and not self.is_set(parameters, "NETWORK"):
            return False, "NETWORK: catchments need rivers"
        return super().checkParameterValues(parameters, context)

    def what(self, parameters: dict[str, Any], context: QgsProcessingContext) -> list[str]:
        """Return the words of WHAT for the program."""
        chosen = self.parameterAsEnums(parameters, "WHAT", context) if self.is_set(parameters, "WHAT") else []
        return [list(WHAT)[number] for number in chosen]

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        return {"DEM": raster_input(self, parameters, "DEM", context), **self.take_network(parameters, context)}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        what = self.what(parameters, context)
        paths = [files[name].path for name in ("DEM", "NETWORK") if name in files]
        options = self.network_options(parameters, context, files) + self.options(
            parameters, context, SUPPORT="--support", THETA="--theta", WINDOW="--window", KNICK_DROP="--knick-drop",
            NODATA="--nodata")
        return [*paths, f"--output={self.output}", *options, *([f"--what={','.join(what)}"] if what else []), "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        files = {os.path.basename(path): path for path in finished.report["files"]}
        opened = self.opened(parameters, context, feedback)
        found: dict[str, Any] = {"OUTPUT": self.output}
        for number, (name, (file, title)) in enumerate(RASTERS.items()):
            if file in files:
                found[name] = files[file]
                if number in opened:
                    open_after(context, files[file], title, name, "raster", style=STYLES.get(name, styles.amounts))
        for number, (name, (file, title, _, _)) in enumerate(LAYERS.items(), len(RASTERS)):
            if f"{file}.gpkg" in files:
                found[name] = f"{files[f'{file}.gpkg']}|layername={name.lower()}"
                if number in opened:
                    open_after(context, found[name], title, name, "vector")
        return found
