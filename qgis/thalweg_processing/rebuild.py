# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg rebuild."""
from __future__ import annotations

import re
from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputFile,
                       QgsProcessingOutputNumber, QgsProcessingParameterFeatureSource, QgsProcessingParameterRasterLayer)

from .layers import File, RasterInput, VectorInput, raster_input
from .make import Key, Make
from .program import Finished

# Keys that make has and rebuild has not, beside those of other rivers and other ways to make terrain.
LEFT_OUT = {"network.source": "the rivers are those of RIVERS", "surface.method": "the terrain is in equilibrium",
            "surface.like": "the layer LIKE is that file", "output.against": "the layer AGAINST is that file"}
# What the use of a key names, where the key is of use in equilibrium around rivers of a file.
USED_BY = r'^$|^\[network\]($| or )|"lines"|"equilibrium"|\[surface\]|network\.heights = "rosgen"'

# Outputs that are numbers: their keys in report.json, titles.
FIGURES = {"CORRELATION": ("correlation", "Correlation of heights"),
           "CORRELATION_ABOVE_RIVER": ("correlation_above_river", "Correlation of heights above the nearest river"),
           "RMSE": ("rmse_m", "Difference of heights, rms [m]"),
           "BIAS": ("bias_m", "Mean of the terrain minus the DEM [m]"),
           "SAME_REACH": ("same_reach", "Share of cells that drain to the same reach"),
           "DIVIDES_FOUND": ("divides_found", "Share of the DEM's divides that are found within three cells"),
           "DIVIDES_RIGHT": ("divides_right", "Share of the terrain's divides that are right within three cells"),
           "SLOPES_DIFFERENCE": ("slopes_difference", "Difference of slopes (Kolmogorov-Smirnov)"),
           "MEAN_SLOPE": ("mean_slope_deg", "Mean slope of the terrain [degrees]"),
           "HYPSOMETRIC_INTEGRAL": ("hypsometric_integral", "Hypsometric integral of the terrain")}


class Rebuild(Make):
    """Make the terrain between rivers whose heights are known."""

    COMMAND = "rebuild"
    TITLE = "Rebuild terrain from rivers with heights"
    TEXT = ("Make the terrain between rivers whose heights are known, and compare it with a DEM.\n"
            "The rivers keep their heights. The terrain between them follows from where they run and how steep they are, or "
            "has the mean slope and the texture of another DEM. A comparison puts numbers on how close it comes, and on how "
            "close a cone, a TIN and a dilation around the same rivers come.\n"
            "Each advanced parameter is a key of the recipe; one that is left empty keeps its value.")
    TAGS = ("terrain", "dem", "rivers", "heights", "3d lines", "reconstruction", "landscape evolution", "compare")
    FILES = {**Make.FILES, "PICTURE": "against.png"}

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        super().initAlgorithm(configuration)
        self.give(QgsProcessingOutputFile("PICTURE", "Picture of the comparison"),
                  "The terrain, the DEM to compare with and their difference, if there is one: against.png.")
        for name, (_, title) in FIGURES.items():
            self.give(QgsProcessingOutputNumber(name, title), f"{title}, if there is a DEM to compare with.")

    def takes(self, key: Key) -> bool:
        return super().takes(key) and key["key"] not in LEFT_OUT and re.search(USED_BY, key["used_by"]) is not None

    def add_sources(self) -> None:
        self.add(QgsProcessingParameterFeatureSource("RIVERS", "Rivers", [QgsProcessing.TypeVectorLine]),
                 "Lines of rivers with heights (Z).")
        self.add(QgsProcessingParameterRasterLayer("LIKE", "DEM to take slope and texture from", optional=True),
                 "Take the mean slope and the texture of this DEM, which may be of another place. Default: they follow from "
                 "the rivers.")
        self.add(QgsProcessingParameterRasterLayer("AGAINST", "DEM to compare with", optional=True),
                 "Make the terrain on the cells of this DEM and compare the two. Its heights decide nothing of the terrain.")

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        return {**super().take(parameters, context),
                **{name: raster_input(self, parameters, name, context) for name in ("LIKE", "AGAINST")}}

    def asked(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        options = [f"--like={files['LIKE'].path}"] if "LIKE" in files else []
        options += [f"--against={files['AGAINST'].path}"] if "AGAINST" in files else []
        return [*super().asked(parameters, context, files), *options]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        against = finished.report.get("against")
        figures = against["terrains"]["terrain"] if against else {}
        return {**super().results(finished, parameters, context, feedback),
                **{name: figures[key] for name, (key, _) in FIGURES.items() if figures.get(key) is not None}}
