# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg make."""
from __future__ import annotations

import html
import math
import os
import re
from typing import Any

from qgis.core import (QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsProcessing,
                       QgsProcessingContext, QgsProcessingException,
                       QgsProcessingFeedback, QgsProcessingOutputBoolean, QgsProcessingOutputFile, QgsProcessingOutputHtml,
                       QgsProcessingOutputMapLayer, QgsProcessingOutputRasterLayer, QgsProcessingOutputVectorLayer,
                       QgsProcessingParameterCrs, QgsProcessingParameterDefinition, QgsProcessingParameterEnum,
                       QgsProcessingParameterExtent, QgsProcessingParameterFeatureSource, QgsProcessingParameterField,
                       QgsProcessingParameterFile, QgsProcessingParameterFolderDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer, QgsProcessingParameterString,
                       QgsRectangle, QgsUnitTypes)

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
FEWEST_CELLS = 250  # along the longer side of an extent without CELL
ROUND = (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5, 9)  # cell sizes that the program chooses, times a power of ten

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
                 "The grid covers this extent, in whole cells, and rivers are cut there. It may be drawn in any CRS. CRS and cell "
                 "size, where they are empty, are those for all of the rivers; where fewer than 250 cells would lie along "
                 "its longer side, they are finer. Default: the rivers and a margin of 5 %.")
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
            crs = self.parameterAsCrs(parameters, "CRS", context)
            if crs.isValid() and not is_metric(crs):
                return False, "CRS: give a projected CRS in metres, or leave it empty"
            if not given and not crs.isValid() and not self.parameterAsExtentCrs(parameters, "EXTENT", context).isValid():
                return False, "CRS: give the CRS of this extent"
        for key in self.keys:
            name = parameter_name(key["key"])
            if key["type"] in COUNTS and self.is_set(parameters, name):
                try:
                    numbers_of(self.parameterAsString(parameters, name, context), COUNTS[key["type"]])
                except ValueError:
                    return False, f"{name}: write {key['type']} separated by commas, {key['range']}"
        return super().checkParameterValues(parameters, context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        wanted = self.crs(parameters, "CRS", context)
        self.grid: dict[str, str] = {"grid.crs": wanted} if wanted else {}
        self.extent: tuple[QgsRectangle, QgsCoordinateReferenceSystem] | None = None
        if self.is_set(parameters, "EXTENT"):
            crs = self.parameterAsExtentCrs(parameters, "EXTENT", context)
            if not crs.isValid() and self.is_set(parameters, "RIVERS"):
                crs = self.parameterAsSource(parameters, "RIVERS", context).sourceCrs()
            self.extent = self.parameterAsExtent(parameters, "EXTENT", context), crs
        inputs: dict[str, VectorInput | RasterInput | None] = {
            "RIVERS": vector_input(self, parameters, "RIVERS", context, takes_layer_name=True, takes_source_crs=True),
            "DEM": raster_input(self, parameters, "DEM", context)}
        for key in self.keys:
            name = parameter_name(key["key"])
            if self.parameterDefinition(name).type() == "layer":
                inputs[name] = map_layer_input(self, parameters, name, context)
        return inputs

    def settle(self, folder: str, found: program.Program, parameters: dict[str, Any], context: QgsProcessingContext,
               files: dict[str, File], feedback: QgsProcessingFeedback) -> None:
        """Lay the grid over EXTENT; the program says which CRS and cells it takes for the rivers."""
        if self.extent is None:
            return
        extent, its_crs = self.extent
        crs = self.parameterAsCrs(parameters, "CRS", context)
        cell = float(self.word(parameters, "CELL", context) or 0)
        corner = (0.0, 0.0)
        if self.is_set(parameters, "RIVERS") or self.is_set(parameters, "RECIPE"):
            asked = [self.COMMAND, *self.asked(parameters, context, files), "--dry-run"]
            planned = program.answer(found, asked, folder, feedback)
            if not planned:
                return
            grid = planned["grid"]
            if "adopt" in planned["stages"] and not self.is_set(parameters, "GRID_CLIP"):
                self.grid["grid.clip"] = "true"
            crs = QgsCoordinateReferenceSystem()
            crs.createFromUserInput(grid["crs"])
            corner = (grid["west"], grid["north"])
            cell = grid["cell"]
        else:
            crs = crs if crs.isValid() else its_crs if is_metric(its_crs) else utm_of(extent, its_crs, context)
            cell = cell if self.is_set(parameters, "CELL") else WITHOUT_INPUT_CELL
        try:
            across = QgsCoordinateTransform(its_crs if its_crs.isValid() else crs, crs, context.transformContext())
            extent = across.transformBoundingBox(extent)
        except QgsCsException as why:
            raise QgsProcessingException(f"EXTENT: it cannot be brought into {crs.authid()}, the CRS of the terrain: draw a "
                                         f"smaller one ({why})") from why
        sides = (extent.xMinimum(), extent.yMinimum(), extent.xMaximum(), extent.yMaximum())
        if cell <= 0 or not all(math.isfinite(side) for side in sides):
            raise QgsProcessingException(f"EXTENT: {extent.toString()} in {crs.authid()} has no cells of {cell:g} m")
        if self.is_set(parameters, "RIVERS") and not self.is_set(parameters, "CELL"):
            cell = min(cell, round_below(max(extent.width(), extent.height()) / FEWEST_CELLS))
        self.grid.update(grid_of(*sides, cell, corner))
        self.grid.update({"grid.crs": crs_text(crs), "grid.cell": repr(cell)})
        feedback.pushInfo(f"extent: {self.grid['grid.width']}x{self.grid['grid.height']} cells of {cell:g} m in "
                          f"{crs.authid() or 'the CRS of the recipe'}")

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

    def asked(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        """Return the inputs and what is set, without the output."""
        paths = [files[name].path for name in ("RIVERS", "DEM") if name in files]
        if self.is_set(parameters, "RECIPE"):
            paths = [os.path.abspath(self.parameterAsFile(parameters, "RECIPE", context))]
        settings = self.settings(parameters, context, files)
        return [*paths, *(f"--set={key}={value}" for key, value in settings.items())]

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.output = self.file(parameters, "OUTPUT", context)
        return [*self.asked(parameters, context, files), f"--output={self.output}", "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        warn_of_failed(finished.report, feedback)
        if self.extent is not None and (rivers := finished.report.get("given")):
            feedback.pushInfo(f"extent: it holds {rivers['given_m'] / 1000:.1f} km of the rivers; "
                              f"{rivers['left_out_m']['grid'] / 1000:.1f} km beyond it were cut off")
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


def is_metric(crs: QgsCoordinateReferenceSystem) -> bool:
    """Return whether a CRS is projected, in metres."""
    return crs.isValid() and not crs.isGeographic() and crs.mapUnits() == QgsUnitTypes.DistanceMeters


def utm_of(extent: QgsRectangle, crs: QgsCoordinateReferenceSystem,
           context: QgsProcessingContext) -> QgsCoordinateReferenceSystem:
    """Return the UTM zone of the middle of an extent."""
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    middle = QgsCoordinateTransform(crs, degrees, context.transformContext()).transform(extent.center())
    zone = min(max(math.floor((middle.x() + 180) / 6) + 1, 1), 60)
    return QgsCoordinateReferenceSystem(f"EPSG:{(32600 if middle.y() >= 0 else 32700) + zone}")


def round_below(size: float) -> float:
    """Return the greatest cell size that the program chooses, and that is no greater; size > 0."""
    power = 10.0 ** math.floor(math.log10(size))
    return max(step * power for step in ROUND if step * power <= size * (1 + 1e-9))


def grid_of(west: float, south: float, east: float, north: float, cell: float,
            corner: tuple[float, float] = (0.0, 0.0)) -> dict[str, str]:
    """Return the keys of the smallest grid of cells that covers a box; a corner of cells lies at that position."""
    x, y = corner
    column, row = math.floor((west - x) / cell), math.ceil((north - y) / cell)
    width, height = math.ceil((east - x) / cell) - column, row - math.floor((south - y) / cell)
    return {"grid.width": str(max(width, 1)), "grid.height": str(max(height, 1)),
            "grid.origin": f"[{x + column * cell!r}, {y + row * cell!r}]"}
