# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg tin."""
from __future__ import annotations

import os
from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputMapLayer,
                       QgsProcessingOutputNumber, QgsProcessingParameterBoolean, QgsProcessingParameterCrs,
                       QgsProcessingParameterEnum, QgsProcessingParameterFeatureSource, QgsProcessingParameterFile,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer,
                       QgsProcessingParameterString)

from .algorithm import NODATA, Algorithm
from .layers import File, RasterInput, VectorInput, open_after, raster_input, vector_input
from .program import Finished

FORMATS = ["2dm", "ply", "gpkg", "obj", "off", "landxml", "las", "xyz", "ply-points"]
FILTER = ("2DM mesh (*.2dm);;PLY mesh (*.ply);;GeoPackage, a polygon per triangle (*.gpkg);;Wavefront OBJ (*.obj);;OFF "
          "(*.off);;LandXML (*.xml);;Points: LAS (*.las);;Points: text (*.xyz)")
SOURCES = ("DEM", "POINTS", "TEXT", "LINES")
KINDS = {".2dm": "mesh", ".ply": "mesh", ".gpkg": "vector"}


class Tin(Algorithm):
    """Triangulate heights."""

    COMMAND = "tin"
    TITLE = "TIN of DEM, points or lines"
    GROUP = "Terrain"
    TEXT = ("Write a TIN (a triangulated surface) of a DEM within a vertical error, of points, or of lines with heights.\n"
            "Give exactly one of DEM, points, points as text and lines.")
    TAGS = ("mesh", "triangulation", "delaunay", "triangles", "2dm", "landxml", "breaklines")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM", optional=True), "Heights of a grid.")
        self.add(QgsProcessingParameterFeatureSource("POINTS", "Points with heights", [QgsProcessing.TypeVectorPoint],
                                                     optional=True),
                 "Points with Z.")
        self.add(QgsProcessingParameterFile("TEXT", "Points as text, or a point cloud", optional=True,
                                            fileFilter="Text and point clouds (*.csv *.xyz *.txt *.las *.laz);;All files (*)"),
                 "A file of lines with x, y and z (CSV or XYZ), or a point cloud (LAS, LAZ).")
        self.add(QgsProcessingParameterFeatureSource("LINES", "Lines with heights", [QgsProcessing.TypeVectorLine],
                                                     optional=True),
                 "Lines with Z, as edges: rivers, ridges, contours.")
        self.add(QgsProcessingParameterFeatureSource("BREAKLINES", "Breaklines", [QgsProcessing.TypeVectorLine], optional=True),
                 "Use these lines with Z as edges, in addition to points.")
        self.add(QgsProcessingParameterNumber("ERROR", "Largest vertical error of a DEM's TIN [m]",
                                              QgsProcessingParameterNumber.Double,
                                              optional=True, minValue=0),
                 "Default: 1.")
        self.add(QgsProcessingParameterCrs("CRS", "CRS of the TIN", optional=True),
                 "Set the CRS of points as text, or reproject points and lines to this CRS.")
        self.add(QgsProcessingParameterCrs("SOURCE_CRS", "CRS of points as text", optional=True),
                 "Read points as text in this CRS; the TIN is then in the CRS above.", advanced=True)
        self.add(QgsProcessingParameterString("COLUMNS", "Columns of points as text", optional=True),
                 "Names of the first line or numbers from 1, such as 3,2,4; or pnezd (number, northing, easting, height, "
                 "description).",
                 advanced=True)
        self.add(QgsProcessingParameterString("HEIGHT_COLUMN", "Column of heights", optional=True),
                 "Take the heights of points and lines from this column, in place of Z.", advanced=True)
        self.add(QgsProcessingParameterString("CLASSES", "Classes of a point cloud", optional=True),
                 "Take points of these classes: ground (2 and 8), water (9), all (but noise), or numbers, separated by commas. "
                 "Default: ground, or all of a cloud that is not classified.",
                 advanced=True)
        self.add(QgsProcessingParameterNumber("THIN", "Cells of a point cloud [m]", QgsProcessingParameterNumber.Double,
                                              optional=True, minValue=0),
                 "Keep the point nearest to the centre of each cell of this side; 0: all points. Default: the side that leaves "
                 "about a million points, if there are more.",
                 advanced=True)
        self.add(QgsProcessingParameterBoolean("MEDIAL_POINTS", "Fill in level areas of contours", defaultValue=False),
                 "Add points with heights between the contours where the TIN of contours would be flat.", advanced=True)
        self.add(QgsProcessingParameterEnum("DUPLICATES", "Points at one place but unequal heights", ["mean", "error"],
                                            optional=True,
                                            usesStaticStrings=True),
                 "Merge them into their mean (the default), or refuse the file.", advanced=True)
        self.add(QgsProcessingParameterEnum("FORMAT", "Format", FORMATS, optional=True, usesStaticStrings=True),
                 "Format of the output. Default: by the file extension.", advanced=True)
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEM", optional=True), NODATA, advanced=True)
        self.add_load(["TIN"], [0], "A 2DM or PLY is a mesh layer, a GeoPackage has polygons. A 2DM names no CRS: the layer "
                                    "gets it. ")
        self.add(QgsProcessingParameterFileDestination("OUTPUT", "TIN", FILTER),
                 "The file to write; an existing one is replaced.")
        self.give(QgsProcessingOutputMapLayer("TIN", "TIN"), "The TIN as a layer, in formats that QGIS reads.")
        self.give(QgsProcessingOutputNumber("VERTICES", "Number of vertices"), "Number of vertices.")
        self.give(QgsProcessingOutputNumber("TRIANGLES", "Number of triangles"), "Number of triangles.")

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        given = [name for name in SOURCES if self.is_set(parameters, name)]
        if len(given) != 1:
            return False, f"Give exactly one of DEM, POINTS, TEXT and LINES, not {' and '.join(given) or 'none'}"
        if self.is_set(parameters, "BREAKLINES") and given == ["DEM"]:
            return False, "BREAKLINES: a TIN of a DEM takes no breaklines"
        if self.is_set(parameters, "ERROR") and given != ["DEM"]:
            return False, "ERROR: only a DEM has a vertical error"
        if given == ["TEXT"] and os.path.isdir(text := self.parameterAsFile(parameters, "TEXT", context)):
            return False, f"TEXT: {text} is a folder"
        return super().checkParameterValues(parameters, context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        vectors = {name: vector_input(self, parameters, name, context) for name in ("POINTS", "LINES", "BREAKLINES")}
        return {"DEM": raster_input(self, parameters, "DEM", context), **vectors}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        source = next((files[name].path for name in SOURCES if name in files), None) or self.parameterAsFile(parameters, "TEXT",
                                                                                                             context)
        options = self.options(parameters, context, ERROR="--error", COLUMNS="--columns", DUPLICATES="--duplicates",
                               HEIGHT_COLUMN="--height-column", CLASSES="--classes", THIN="--thin", FORMAT="--format",
                               NODATA="--nodata")
        for name, flag in (("CRS", "--crs"), ("SOURCE_CRS", "--source-crs")):
            crs = self.crs(parameters, name, context)
            options += [f"{flag}={crs}"] if crs else []
        options += ["--medial-points"] if self.parameterAsBool(parameters, "MEDIAL_POINTS", context) else []
        options += [f"--breaklines={files['BREAKLINES'].path}"] if "BREAKLINES" in files else []
        return [source, f"--output={self.output}", *options, "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        report = finished.report
        found: dict[str, Any] = {"OUTPUT": self.output, "VERTICES": report["vertices"], "TRIANGLES": report["triangles"]}
        kind = KINDS.get(self.output[self.output.rfind("."):].lower(), "")
        if kind and self.word(parameters, "FORMAT", context) != "ply-points":
            found["TIN"] = self.output
            if self.opened(parameters, context, feedback):
                open_after(context, self.output, "TIN", "TIN", kind, report["crs"])
        return found
