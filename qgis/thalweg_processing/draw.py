# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg draw."""
from __future__ import annotations

import html
import os
from typing import Any
from urllib.parse import quote

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputHtml,
                       QgsProcessingParameterEnum, QgsProcessingParameterFeatureSource, QgsProcessingParameterFolderDestination,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer, QgsProcessingParameterString)

from .algorithm import NODATA, Algorithm
from .layers import File, RasterInput, VectorInput, raster_input, vector_input
from .program import Finished

WHAT = {"map": "Map", "profile": "Long profiles of the rivers", "hypsometry": "Hypsometric curve", "sections": "Sections",
        "wireframe": "Wireframe", "page": "Report page for a browser"}
FORMATS = ["png", "svg", "pdf"]


class Draw(Algorithm):
    """Draw pictures of a DEM and its rivers."""

    COMMAND = "draw"
    TITLE = "Draw pictures of terrain"
    GROUP = "Pictures"
    TEXT = ("Draw a map, hypsometric curve, sections and a wireframe of a DEM and, with rivers, their long profiles.\n"
            "A raster larger than 4000 cells a side is averaged; a geographic one is reprojected to its UTM zone. The log "
            "reports such changes. The results viewer shows the pictures.")
    TAGS = ("map", "profile", "hypsometry", "wireframe", "section", "picture", "report")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        number = QgsProcessingParameterNumber
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM"), "Heights.")
        self.add(QgsProcessingParameterFeatureSource("NETWORK", "Rivers", [QgsProcessing.TypeVectorLine], optional=True),
                 "Lines of rivers to draw.")
        self.add(QgsProcessingParameterEnum("WHAT", "What to draw", list(WHAT.values()), allowMultiple=True, optional=True),
                 "Default: every picture that the input allows.")
        self.add(QgsProcessingParameterEnum("FORMAT", "Formats", FORMATS, allowMultiple=True, defaultValue=["png"],
                                            usesStaticStrings=True), "Formats of the pictures.")
        self.add(QgsProcessingParameterString("TITLE", "Title", optional=True), "Title of the pictures.")
        self.add(number("WIDTH", "Width [pixels]", optional=True, minValue=1), "Width of the pictures.")
        self.add(number("AZIMUTH", "Viewing direction of the wireframe [degrees]", number.Double, optional=True),
                 "Clockwise from north. Default: up the valley.", advanced=True)
        self.add(number("ELEVATION", "Height of the eye [degrees]", number.Double, optional=True),
                 "Above the wireframe's horizon.", advanced=True)
        self.add(number("EXAGGERATION", "Exaggeration of the wireframe's heights", number.Double, optional=True, minValue=0),
                 "Default: a suitable round number.", advanced=True)
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEM", optional=True), NODATA, advanced=True)
        self.add(QgsProcessingParameterFolderDestination("OUTPUT", "Folder"),
                 "Pictures of the same names in it are replaced; other files are kept.")
        self.give(QgsProcessingOutputHtml("PICTURES", "Pictures"), "A page with the pictures, pictures.html.")
        self.give(QgsProcessingOutputHtml("PAGE", "Report page"), "The report page, if wanted.")

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        return {"DEM": raster_input(self, parameters, "DEM", context),
                "NETWORK": vector_input(self, parameters, "NETWORK", context)}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        chosen = self.parameterAsEnums(parameters, "WHAT", context) if self.is_set(parameters, "WHAT") else []
        formats = self.parameterAsEnumStrings(parameters, "FORMAT", context)
        options = [f"--what={','.join(list(WHAT)[number] for number in chosen)}"] if chosen else []
        options += [f"--format={','.join(formats)}"] if formats else []
        options += self.options(parameters, context, TITLE="--title", WIDTH="--width", AZIMUTH="--azimuth",
                                ELEVATION="--elevation",
                                EXAGGERATION="--exaggeration", NODATA="--nodata")
        options += [f"--network={files['NETWORK'].path}"] if "NETWORK" in files else []
        return [files["DEM"].path, f"--output={self.output}", *options, "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        names = [os.path.basename(path) for path in finished.report["files"]]
        found: dict[str, Any] = {"OUTPUT": self.output}
        pictures = [name for name in names if name.endswith((".png", ".svg", ".pdf"))]
        if pictures:
            found["PICTURES"] = os.path.join(self.output, "pictures.html")
            with open(found["PICTURES"], "w", encoding="utf-8") as page:
                page.write(_page(self.word(parameters, "TITLE", context), pictures))
        if "page.html" in names:
            found["PAGE"] = os.path.join(self.output, "page.html")
        return found


def _page(title: str, pictures: list[str]) -> str:
    """A page that shows pictures, those that a browser can show as such."""
    shown = [f'<p><a href="{quote(name)}">{html.escape(name)}</a></p>' if name.endswith(".pdf") else
             f'<p><img src="{quote(name)}" alt="{html.escape(name)}" style="max-width: 100%"></p>' for name in pictures]
    head = html.escape(title or "thalweg")
    return f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{head}</title>\n' + "\n".join(shown) + "\n</html>\n"
