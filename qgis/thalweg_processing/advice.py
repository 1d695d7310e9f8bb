# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Says in the words of QGIS what the program says for the shell."""
from __future__ import annotations

import re
from collections.abc import Collection

from .keys import label_of

REPAIR = "run Check river network and take its Repaired network"
SET_CRS = "right-click the layer, Layer CRS > Set Layer CRS, and run again"

# Commands of GDAL, and where QGIS has them; the first that fits holds.
COMMANDS = (
    (r"-a_srs\b", SET_CRS),
    (r"-a_nodata\b", 'the parameter "No-data value"'),
    (r"\bgdalwarp\b.*\bogr2ogr\b|\bogr2ogr\b.*\bgdalwarp\b",
     "Vector > Data Management Tools > Reproject Layer, or Raster > Projections > Warp"),
    (r"\bgdalwarp\b", "Raster > Projections > Warp"),
    (r"-projwin\b.*-clipsrc\b", "Raster > Extraction > Clip Raster by Extent, Vector > Geoprocessing Tools > Clip"),
    (r"-clipsrc\b", "Vector > Geoprocessing Tools > Clip"),
    (r"-t_srs\b", "Vector > Data Management Tools > Reproject Layer"),
    (r"-srcwin\b|-projwin\b", "Raster > Extraction > Clip Raster by Extent"),
    (r"\bgdal_fillnodata", "Raster > Analysis > Fill Nodata"),
    (r"\bgdal_translate\b", "Raster > Conversion > Translate"),
    (r"\bogr2ogr\b", "right-click the layer, Export > Save Features As"),
)
COMMAND = r"\b(?:gdalwarp|gdal_\w+|ogr2ogr)\b|-(?:a_srs|a_nodata|t_srs|clipsrc|srcwin|projwin)\b"

# Options of the program, and the labels of their parameters.
OPTIONS = {"--network": "Rivers", "--max-upstream": "Most arcs upstream of one", "--dem": "DEM", "--cell": "Cell size of a raster",
           "--nodata": "No-data value", "--height-column": "Column of heights", "--columns": "Columns of points as text",
           "--classes": "Classes of a point cloud", "--source-crs": "CRS of points as text", "--crs": "CRS",
           "--like": "DEM to take slope and texture from", "--medial-points": "Fill in level areas of contours",
           "--breaklines": "Breaklines", "--field": "Fields of the network", "--format": "Format"}

# What the program says without advice for a shell.
KNOWN = ((r"\barcs leave the node\b", REPAIR),
         (r"\bno river of .* runs inside the grid\b", "draw the extent where the rivers are"),
         (r"\bmatch no schema \(", "take a Repaired network, for which any lines will do, or the advanced parameters Schema and "
                                  "Fields of the network"))


def in_qgis(words: str, keys: Collection[str] = ()) -> str:
    """Return the program's words with advice for QGIS in place of that for the shell.

    Parameters
    ----------
    words : str
        An error, warning or note.
    keys : collection of str
        The keys of recipes, which become labels of their parameters.
    """
    said = re.sub(r" or name it \(--source-crs [^)]*\)", "", words) if "-a_srs" in words else words
    said = re.sub(r"\brun thalweg check on the file; its --fix writes a mended copy", REPAIR, said)
    said = re.sub(r"\(([^()]*)\)", lambda found: f"({_menu(found[1])})" if re.search(COMMAND, found[1]) else found[0], said)
    said = re.sub(r"--set ((?:[a-z0-9_]+\.)+[a-z0-9_]+)=([^\s();,]*?)(?=[.;,)]?(?:\s|$)|\))", _set, said)
    said = re.sub(r"(--[a-z][a-z-]*)(?: ((?:[A-Z0-9][\w:.+-]*(?:,[\w:.+-]+)*|nan|geojson\w*|\w+=\S+?)(?<!\.)))?"
                  r"(?=[.;,:)]?(?:\s|$)|\))", _option, said)
    said = re.sub(r"(?<![\w./\"])[a-z]+(?:\.[a-z0-9_]+)+(?![\w/])",
                  lambda found: f'"{label_of(found[0])}"' if found[0] in keys else found[0], said)
    if re.search(COMMAND, said):  # in a sentence of another form
        return f"In QGIS: {_menu(said)}.\n{said}"
    for known, there in KNOWN:
        if re.search(known, said):
            return f"{said}\nIn QGIS: {there}."
    return re.sub(r"^the parameter ", "The parameter ", said)


def _menu(command: str) -> str:
    """Where QGIS has a command."""
    return next((there for known, there in COMMANDS if re.search(known, command)), command)


def _value(text: str | None) -> str:
    """A value that stands for itself; names of what is to be given have capitals alone."""
    return "" if not text or (text.isalpha() and text.isupper()) else f" = {text}"


def _set(found: re.Match[str]) -> str:
    return f'the parameter "{label_of(found[1])}"{_value(found[2])}'


def _option(found: re.Match[str]) -> str:
    name = OPTIONS.get(found[1])
    return found[0] if name is None else f'the parameter "{name}"{_value(found[2])}'
