# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg make."""
from __future__ import annotations

import html
import math
import os
import re
from typing import Any

from qgis.core import (QgsCoordinateReferenceSystem, QgsProcessing, QgsProcessingContext, QgsProcessingException,
                       QgsProcessingFeedback, QgsProcessingOutputBoolean, QgsProcessingOutputFile, QgsProcessingOutputHtml,
                       QgsProcessingOutputMapLayer, QgsProcessingOutputRasterLayer, QgsProcessingOutputVectorLayer,
                       QgsProcessingParameterCrs, QgsProcessingParameterDefinition, QgsProcessingParameterEnum,
                       QgsProcessingParameterExtent, QgsProcessingParameterFeatureSource, QgsProcessingParameterField,
                       QgsProcessingParameterFile, QgsProcessingParameterFolderDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer, QgsProcessingParameterString,
                       QgsUnitTypes)

from . import program
from .algorithm import Algorithm, warn_of_failed
from .keys import GROUPS, group_of, label_of
from .layers import File, RasterInput, VectorInput, crs_text, map_layer_input, open_after, raster_input, vector_input
from .program import Finished

Key = dict[str, Any]  # of `thalweg recipe --json`

# Keys that have a parameter of their own, or none.
PLAIN = {"seed": "SEED", "grid.cell": "CELL", "grid.crs": "CRS", "output.units": "UNITS", "output.title": "TITLE"}
LEFT_OUT = {"network.lines.path": "the layer RIVERS is that file", "network.lines.layer": "the layer RIVERS is that layer",
            "network.lines.source_crs": "the layer RIVERS has a CRS in QGIS"}
FIELDS = ("network.lines.type_field", "network.lines.rank_field", "network.lines.id_field", "network.lines.down_field",
          "network.lines.from_field", "network.lines.to_field", "network.lines.direction_field")
TEXT_FILES = ("skeleton.points",)  # that QGIS does not open as a layer without being told how
LARGEST = 2**31 - 1  # whole number of QGIS
HEIGHTS_TEXT = "The heights of the terrain."
COUNTS = {"two numbers": 2, "three numbers": 3, "four numbers": 4}
SOURCES = ("RIVERS", "DEM", "RECIPE")
WITHOUT_INPUT_CELL = 30.0  # [m] of a recipe without CELL

# Outputs that are layers: file, layer in it, title, kind.
LAYERS = {"DEM": ("dem.tif", "", "DEM", "raster"), "ARCS": ("network.gpkg", "arcs", "Rivers", "vector"),
          "NODES": ("network.gpkg", "nodes", "Nodes of the rivers", "vector"),
          "CATCHMENTS": ("catchments.gpkg", "catchments", "Catchments", "vector"),
          "CONTOURS": ("contours.gpkg", "contours", "Contours", "vector"), "TIN": ("tin.2dm", "", "TIN", "mesh")}
SHAPES = {"ARCS": QgsProcessing.TypeVectorLine, "NODES": QgsProcessing.TypeVectorPoint,
          "CATCHMENTS": QgsProcessing.TypeVectorPolygon, "CONTOURS": QgsProcessing.TypeVectorLine}


def parameter_name(key: str) -> str:
    """Return the name of the parameter of a key."""
    return PLAIN.get(key, key.upper().replace(".", "_"))


def bounds(key: Key) -> tuple[float | None, float | None]:
    """Return the least and the greatest value of a number; None where there is none."""
    found = re.fullmatch(r"[\[(]\s*([-+.\de]+)\s*,\s*([-+.\de]+)\s*[\])]", key["range"])
    if found:
        return float(found[1]), float(found[2])
    found = re.fullmatch(r">=?\s*([-+.\de]+)", key["range"])
    return (float(found[1]), None) if found else (None, None)


def help_of(key: Key) -> str:
    """Return what a key means, with its unit, range, default and use."""
    meaning = key["meaning"]
    parts = [meaning[:1].upper() + meaning[1:] + "."]
    parts += [f"Unit: {key['unit']}."] if key["unit"] else []
    parts += [f"Range: {key['range']}."] if key["range"] and not key["choices"] else []
    parts += [f"Default: {key['default']}."] if key["default"] not in ("", "''") else []
    parts += [f"Used by: {key['used_by']}."] if key["used_by"] else []
    parts.append(f"Key: {key['key']}.")
    return html.escape(" ".join(parts), quote=False)


def parameter_of(key: Key, label: str | None = None) -> QgsProcessingParameterDefinition:
    """Return the parameter of a key of the recipe; left empty, the key is not set."""
    name, kind = parameter_name(key["key"]), key["type"]
    label = label or label_of(key["key"]) + (f" [{key['unit']}]" if key["unit"] else "")
    if kind in ("integer", "number"):
        least, greatest = bounds(key)
        whole = kind == "integer"
        limits: dict[str, float] = {} if least is None else {"minValue": least}
        if whole:
            limits["maxValue"] = LARGEST if greatest is None else min(greatest, LARGEST)
        elif greatest is not None:
            limits["maxValue"] = greatest
        number = QgsProcessingParameterNumber(name, label, QgsProcessingParameterNumber.Integer if whole else
                                              QgsProcessingParameterNumber.Double, optional=True, **limits)
        if not whole:
            number.setMetadata({"widget_wrapper": {"decimals": 12}})
        return number
    if key["choices"] and key["range"] == " | ".join(key["choices"]):  # else it may be an expression, too
        return QgsProcessingParameterEnum(name, label, list(key["choices"]), optional=True, usesStaticStrings=True)
    if key["key"] in FIELDS:
        return QgsProcessingParameterField(name, label, parentLayerParameterName="RIVERS", optional=True)
    if key["is_file"]:
        if key["key"] in TEXT_FILES:
            return QgsProcessingParameterFile(name, label, optional=True)
        return QgsProcessingParameterMapLayer(name, label, optional=True)
    return QgsProcessingParameterString(name, label, optional=True)


class Make(Algorithm):
    """Make terrain around rivers."""

    COMMAND = "make"
    TITLE = "Make terrain from rivers"
    GROUP = "Terrain"
    TEXT = ("Make terrain and a river network: around rivers of a layer, from a DEM, from a recipe, or with rivers that "
            "thalweg grows.\n"
            "Rivers get heights, and the terrain is shaped around them. thalweg chooses the grid and its cell size from the "
            "rivers. A DEM is taken as the terrain, cell by cell. The recipe in the folder holds everything that decides the "
            "result: the same recipe gives the same bytes on any machine. The folder is written completely or not at all.\n"
            "Each advanced parameter is a key of the recipe; one that is left empty keeps its value.")
    TAGS: tuple[str, ...] = ("terrain", "dem", "rivers", "synthetic", "landscape evolution", "catchments", "contours", "recipe",
                             "dla", "tokunaga")
    FILES = {"PROJECT": "project.qgz", "REPORT": "report.html"}  # outputs that are no layers

    def __init__(self) -> None:
        super().__init__()
        self.keys: tuple[Key, ...] = ()

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        try:
            self.keys = tuple(key for key in program.find().keys if self.takes(key))
        except program.ProgramError:  # canExecute() tells
            self.keys = ()
        by_name = {key["key"]: key for key in self.keys}
        self.add_sources()
        for name, label in (("seed", "Random seed"), ("grid.cell", "Cell size [m]")):
            if name in by_name:
                self.add(parameter_of(by_name[name], label), help_of(by_name[name]))
        self.add(QgsProcessingParameterExtent("EXTENT", "Extent of the grid", optional=True),
                 "The grid covers this extent, in whole cells. Its CRS is that of the terrain, else that of the rivers or the "
                 "DEM, else the extent's own. Default: that of the DEM, or of the rivers and a margin of 5 %.")
        self.add(QgsProcessingParameterCrs("CRS", "CRS of the terrain", optional=True),
                 "A projected CRS in metres. Default: that of the rivers or the DEM, or its UTM zone.")
        for name, label in (("output.units", "Unit of heights"), ("output.title", "Title")):
            if name in by_name:
                self.add(parameter_of(by_name[name], label), help_of(by_name[name]))
        for key in sorted(self.keys, key=lambda key: group_of(key["key"])):
            if key["key"] not in PLAIN:
                self.add(parameter_of(key), help_of(key), advanced=True)
        titles = [title for _, _, title, _ in LAYERS.values()]
        self.add_load(titles, [0, 1], "project.qgz in the folder is a project with all of them. ")
        self.add(QgsProcessingParameterFolderDestination("OUTPUT", "Folder"),
                 "Files that an earlier run wrote to it are replaced; other files are kept.")
        for name, (_, _, title, kind) in LAYERS.items():
            if kind == "vector":
                self.give(QgsProcessingOutputVectorLayer(name, title, SHAPES[name]), f"{title}, where the terrain has them.")
            else:
                self.give((QgsProcessingOutputRasterLayer if kind == "raster" else QgsProcessingOutputMapLayer)(name, title),
                          self.said.get(name, HEIGHTS_TEXT) if kind == "raster" else "The TIN, where the recipe makes one.")
        self.give(QgsProcessingOutputFile("PROJECT", "QGIS project"), "A QGIS project with every layer.")
        self.give(QgsProcessingOutputHtml("REPORT", "Report"), "The report, for a browser.")
        self.give(QgsProcessingOutputBoolean("CHECKS_OK", "Every check passed"), "Whether every check of the terrain passed.")

    def shortHelpString(self) -> str:
        """Return the help, with a title over each group of keys."""
        text, shown = super().shortHelpString(), set()
        for key in sorted(self.keys, key=lambda key: group_of(key["key"])):
            group, name = group_of(key["key"]), parameter_name(key["key"])
            if key["key"] not in PLAIN and group not in shown and group < len(GROUPS):
                shown.add(group)
                first = f"<h3>{self.parameterDefinition(name).description()}</h3>"
                text = text.replace(first, f"<h2>{GROUPS[group][0]}</h2>\n{first}", 1)
        return text

    def takes(self, key: Key) -> bool:
        """Return whether a key can be set here."""
        return key["key"] not in LEFT_OUT

    def add_sources(self) -> None:
        """Declare what the terrain is made from."""
        self.add(QgsProcessingParameterFeatureSource("RIVERS", "Rivers", [QgsProcessing.TypeVectorLine], optional=True),
                 "Lines of rivers. Without rivers, DEM or recipe, thalweg grows a valley on 1024x1024 cells.")
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM", optional=True),  # QGIS keeps one help a name
                 f"As an input: take this DEM as the terrain, cell by cell. As an output: {HEIGHTS_TEXT.lower()}")
        self.add(QgsProcessingParameterFile("RECIPE", "Recipe", extension="toml", optional=True), "A recipe of thalweg (TOML).")

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        given = [name for name in SOURCES if self.is_set(parameters, name)]
        if len(given) > 1:
            return False, f"Give one of RIVERS, DEM and RECIPE, not {' and '.join(given)}"
        if self.is_set(parameters, "DEM") and self.is_set(parameters, "SURFACE_SOURCE"):
            return False, "SURFACE_SOURCE: the terrain is that of DEM already"
        if self.is_set(parameters, "EXTENT"):
            if self.parameterAsExtent(parameters, "EXTENT", context).isNull():
                return False, f"EXTENT: '{parameters['EXTENT']}' is not an extent; write XMIN,XMAX,YMIN,YMAX [EPSG:N]"
            clash = [name for name in ("GRID_WIDTH", "GRID_HEIGHT", "GRID_ORIGIN") if self.is_set(parameters, name)]
            if clash:
                return False, f"Give EXTENT or {clash[0]}, not both"
            if given == ["DEM"]:
                return False, "EXTENT: the grid is that of DEM"
            if given and not self.is_set(parameters, "CELL"):
                return False, "CELL: an extent with rivers or a recipe needs the cell size"
            crs = self.grid_crs(parameters, context)
            if not crs.isValid() or crs.isGeographic() or crs.mapUnits() != QgsUnitTypes.DistanceMeters:
                return False, "CRS: give a projected CRS in metres with this extent"
        for key in self.keys:
            name = parameter_name(key["key"])
            if key["type"] in COUNTS and self.is_set(parameters, name):
                try:
                    numbers_of(self.parameterAsString(parameters, name, context), COUNTS[key["type"]])
                except ValueError:
                    return False, f"{name}: write {key['type']} separated by commas, {key['range']}"
        return super().checkParameterValues(parameters, context)

    def grid_crs(self, parameters: dict[str, Any], context: QgsProcessingContext) -> QgsCoordinateReferenceSystem:
        """Return the CRS of a grid with EXTENT."""
        given = self.parameterAsCrs(parameters, "CRS", context)
        if given.isValid():
            return given
        source = self.parameterAsVectorLayer(parameters, "RIVERS", context) if self.is_set(parameters, "RIVERS") else None
        if source is not None and source.crs().isValid():
            return source.crs()
        return self.parameterAsExtentCrs(parameters, "EXTENT", context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        self.grid: dict[str, str] = {}
        if self.is_set(parameters, "EXTENT"):
            crs = self.grid_crs(parameters, context)
            extent = self.parameterAsExtent(parameters, "EXTENT", context, crs)
            cell = float(self.word(parameters, "CELL", context) or WITHOUT_INPUT_CELL)
            sides = (extent.xMinimum(), extent.yMinimum(), extent.xMaximum(), extent.yMaximum())
            if cell <= 0 or not all(math.isfinite(side) for side in sides):
                raise QgsProcessingException(f"EXTENT: {extent.toString()} in {crs.authid()} has no cells of {cell:g} m")
            self.grid = grid_of(*sides, cell)
            self.grid["grid.crs"] = crs_text(crs)
        elif wanted := self.crs(parameters, "CRS", context):
            self.grid = {"grid.crs": wanted}
        inputs: dict[str, VectorInput | RasterInput | None] = {
            "RIVERS": vector_input(self, parameters, "RIVERS", context, takes_layer_name=True, takes_source_crs=True),
            "DEM": raster_input(self, parameters, "DEM", context)}
        for key in self.keys:
            name = parameter_name(key["key"])
            if self.parameterDefinition(name).type() == "layer":
                inputs[name] = map_layer_input(self, parameters, name, context)
        return inputs

    def settings(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> dict[str, str]:
        """Return the keys of the recipe that are set, with their values as --set takes them."""
        found = {}
        for key in self.keys:
            name = parameter_name(key["key"])
            if key["key"] in self.grid:
                found[key["key"]] = self.grid[key["key"]]
            elif name in files and key["is_file"]:
                found[key["key"]] = files[name].path
            elif self.is_set(parameters, name):
                if key["key"] in FIELDS:
                    word = (self.parameterAsFields(parameters, name, context) or [""])[0]
                elif key["is_file"]:
                    word = os.path.abspath(self.parameterAsFile(parameters, name, context))
                elif key["type"] in COUNTS:
                    word = numbers_of(self.parameterAsString(parameters, name, context), COUNTS[key["type"]])
                else:
                    word = self.word(parameters, name, context)
                found[key["key"]] = word
        rivers = files.get("RIVERS")
        if rivers is not None and rivers.layer:
            found["network.lines.layer"] = rivers.layer
        if rivers is not None and rivers.source_crs:
            found["network.lines.source_crs"] = rivers.source_crs
        return found

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        paths = [files[name].path for name in ("RIVERS", "DEM") if name in files]
        if self.is_set(parameters, "RECIPE"):
            paths = [os.path.abspath(self.parameterAsFile(parameters, "RECIPE", context))]
        settings = self.settings(parameters, context, files)
        return [*paths, f"--output={self.output}", *(f"--set={key}={value}" for key, value in settings.items()), "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        warn_of_failed(finished.report, feedback)
        found: dict[str, Any] = {"OUTPUT": self.output, "CHECKS_OK": finished.passed}
        opened = self.opened(parameters, context, feedback)
        written = set(finished.report["files"])
        crs = str(finished.report["recipe"].get("grid", {}).get("crs", ""))
        for number, (name, (file, layer, title, kind)) in enumerate(LAYERS.items()):
            if file not in written:
                continue
            found[name] = os.path.join(self.output, file) + (f"|layername={layer}" if layer else "")
            if number in opened:
                open_after(context, found[name], title, name, kind, crs)
        for name, file in self.FILES.items():
            if os.path.exists(os.path.join(self.output, file)):
                found[name] = os.path.join(self.output, file)
        return found


def numbers_of(text: str, count: int) -> str:
    """Return numbers separated by commas as an array of TOML.

    Raises
    ------
    ValueError
        When there are not as many, or something is not a number.
    """
    words = text.strip().strip("[]").replace(",", " ").split()
    if len(words) != count or not all(math.isfinite(float(word)) for word in words):
        raise ValueError(text)
    return f"[{', '.join(words)}]"


def grid_of(west: float, south: float, east: float, north: float, cell: float) -> dict[str, str]:
    """Return the keys of the smallest grid of cells that covers a box; its corners are multiples of the cell size."""
    column, row = math.floor(west / cell), math.ceil(north / cell)
    width, height = math.ceil(east / cell) - column, row - math.floor(south / cell)
    return {"grid.width": str(max(width, 1)), "grid.height": str(max(height, 1)),
            "grid.origin": f"[{column * cell!r}, {row * cell!r}]"}
