# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg blend."""
from __future__ import annotations

import re
from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputNumber,
                       QgsProcessingParameterBoolean, QgsProcessingParameterFeatureSource, QgsProcessingParameterNumber,
                       QgsProcessingParameterPoint, QgsProcessingParameterRasterDestination, QgsProcessingParameterRasterLayer,
                       QgsProcessingParameterString)

from . import styles
from .algorithm import NODATA, Algorithm, ends_in
from .layers import File, RasterInput, VectorInput, raster_input, style_after, vector_input
from .program import Finished


class Blend(Algorithm):
    """Paste a part of one DEM into another."""

    COMMAND = "blend"
    TITLE = "Blend DEM into another"
    GROUP = "Terrain"
    TEXT = ("Paste a part of one DEM into another without a seam.\n"
            "Keeps the relief of the patch and matches the target's heights along its edge (Poisson blending), so that there "
            "is no step. Outside the patch the target's heights do not change by a single bit.")
    TAGS = ("poisson", "paste", "patch", "mosaic", "merge", "seamless")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        number = QgsProcessingParameterNumber
        self.add(QgsProcessingParameterRasterLayer("TARGET", "Target"), "The DEM to paste into.")
        self.add(QgsProcessingParameterRasterLayer("SOURCE", "Source of the patch"),
                 "The DEM to take the patch from. It is warped (bilinear) if its CRS or cells differ.")
        self.add(QgsProcessingParameterFeatureSource("MASK", "Mask: polygons", [QgsProcessing.TypeVectorPolygon],
                                                     optional=True),
                 "Replace only cells in these polygons.")
        self.add(QgsProcessingParameterRasterLayer("MASK_RASTER", "Mask: raster", optional=True),
                 "Replace only these cells: a raster on the target's grid (neither 0 nor no-data).", advanced=True)
        self.add(QgsProcessingParameterPoint("AT", "Centre of the patch", optional=True),
                 "Place the centre of the patch here. Default: at the patch's own coordinates, or in the centre of the target "
                 "if they lie outside it.")
        self.add(number("ROTATE", "Rotation [degrees]", number.Double, optional=True), "Rotate the patch counterclockwise.")
        self.add(number("SCALE", "Scale in plan", number.Double, optional=True, minValue=0),
                 "Scale the patch in plan by this factor.")
        self.add(number("GAIN", "Scale of heights", number.Double, optional=True), "Multiply heights by this factor.")
        self.add(QgsProcessingParameterString("WINDOW", "Window of the source", optional=True),
                 "Take only this part of the source: column and row of its north-western cell, number of columns and rows, "
                 "separated by commas.", advanced=True)
        self.add(number("FEATHER", "Feather [cells]", number.Double, optional=True, minValue=0),
                 "Blend the target's relief into the patch's over this many cells inside the edge.")
        self.add(QgsProcessingParameterFeatureSource("KEEP", "Keep heights: lines", [QgsProcessing.TypeVectorLine],
                                                     optional=True),
                 "Keep the heights of cells under these lines, such as rivers.")
        self.add(QgsProcessingParameterRasterLayer("KEEP_RASTER", "Keep heights: raster", optional=True),
                 "Keep the heights of these cells: a raster on the target's grid (neither 0 nor no-data).", advanced=True)
        self.add(QgsProcessingParameterBoolean("MIXED", "Use the steeper slope", defaultValue=False),
                 "Between neighbouring cells, use the steeper slope of patch and target.")
        self.add(QgsProcessingParameterBoolean("FILL_HOLES", "Fill holes of the source", defaultValue=False),
                 "Also fill holes of the source. Default: holes keep the target's heights.")
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEMs", optional=True), NODATA, advanced=True)
        self.add(QgsProcessingParameterRasterDestination("OUTPUT", "Blended DEM"), "A GeoTIFF.")
        self.give(QgsProcessingOutputNumber("CELLS", "Number of replaced cells"), "Number of replaced cells.")
        self.give(QgsProcessingOutputNumber("SEAM_RMS", "Steps along the edge, rms [m]"),
                  "Root mean square of the steps that the edge would have had.")

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        for name in ("MASK", "KEEP"):
            if self.is_set(parameters, name) and self.is_set(parameters, f"{name}_RASTER"):
                return False, f"Give {name} or {name}_RASTER, not both"
        window = self.word(parameters, "WINDOW", context)
        if window and not re.fullmatch(r"\s*\d+\s*,\s*\d+\s*,\s*\d+\s*,\s*\d+\s*", window):
            return False, f"WINDOW: write four whole numbers, COLUMN,ROW,WIDTH,HEIGHT, not '{window}'"
        if self.is_set(parameters, "OUTPUT") and not ends_in(parameters["OUTPUT"], ".tif", ".tiff"):
            return False, "OUTPUT: thalweg writes a GeoTIFF (.tif)"
        return super().checkParameterValues(parameters, context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        target = self.parameterAsRasterLayer(parameters, "TARGET", context)
        self.at = ""
        if self.is_set(parameters, "AT") and target is not None:
            point = self.parameterAsPoint(parameters, "AT", context, target.crs())
            self.at = f"--at={point.x()!r},{point.y()!r}"
        rasters = {name: raster_input(self, parameters, name, context)
                   for name in ("TARGET", "SOURCE", "MASK_RASTER", "KEEP_RASTER")}
        return {**rasters, **{name: vector_input(self, parameters, name, context) for name in ("MASK", "KEEP")}}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        output = self.parameterAsOutputLayer(parameters, "OUTPUT", context)
        self.output = self.file({**parameters, "OUTPUT": output}, "OUTPUT", context)
        options = [self.at] if self.at else []
        options += self.options(parameters, context, ROTATE="--rotate", SCALE="--scale", GAIN="--gain", FEATHER="--feather",
                                NODATA="--nodata")
        if window := self.word(parameters, "WINDOW", context):
            options.append(f"--window={re.sub(r'[ ]', '', window)}")
        for name, flag in (("MASK", "--mask"), ("MASK_RASTER", "--mask"), ("KEEP", "--keep"), ("KEEP_RASTER", "--keep")):
            options += [f"{flag}={files[name].path}"] if name in files else []
        for name, flag in (("MIXED", "--mixed"), ("FILL_HOLES", "--fill-holes")):
            options += [flag] if self.parameterAsBool(parameters, name, context) else []
        return [files["TARGET"].path, files["SOURCE"].path, f"--output={self.output}", *options, "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        style_after(context, self.output, styles.heights)
        return {"OUTPUT": self.output, "CELLS": finished.report["cells"], "SEAM_RMS": finished.report["seam_rms_m"]}
