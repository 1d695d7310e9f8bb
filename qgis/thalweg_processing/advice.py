# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Says where in QGIS to do what the program advises for the shell."""
from __future__ import annotations

import re

REPROJECT = "Raster > Projections > Warp, or Vector > Data Management Tools > Reproject Layer"
REPAIR = "run Check river network and take its Repaired network"

# What the program says, and what to do in QGIS; the first that fits holds.
KNOWN = (
    (r"\bhas no CRS\b|-a_srs\b", "right-click the layer, Layer CRS > Set Layer CRS, and run again"),
    (r"-t_srs\b|\bare geographic\b", REPROJECT),
    (r"\bgdalwarp\b", "Raster > Projections > Warp"),
    (r"--nodata\b|-a_nodata\b", "the advanced parameter No-data value"),
    (r"\bgdal_fillnodata", "Raster > Analysis > Fill Nodata"),
    (r"-srcwin\b|-projwin\b", "Raster > Extraction > Clip Raster by Extent"),
    (r"-clipsrc\b", "Vector > Geoprocessing Tools > Clip"),
    (r"\bmatch no schema\b", "take a Repaired network, for which any lines will do, or the advanced parameters Schema and "
                              "Fields of the network"),
    (r"\bits --fix\b|\barcs leave the node\b", REPAIR),
    (r"--network\b", "the parameter Rivers"),
    (r"--max-upstream\b", "the parameter Most arcs upstream of one"),
    (r"\bgive --dem or --cell\b", "the parameter DEM, or Cell size of a raster"),
)
LABELS = {"grid.cell": "Cell size", "grid.crs": "CRS of the terrain"}


def in_qgis(words: str) -> str:
    """Return the program's words, with a sentence about QGIS after advice for the shell."""
    if key := re.search(r"--set ((?:[a-z0-9_]+\.)+[a-z0-9_]+)=", words):
        section, _, last = key[1].rpartition(".")
        there = LABELS.get(key[1]) or f"{section}: {last.replace('_', ' ')}"
        return f"{words}\nIn QGIS: the parameter {there}."
    for known, there in KNOWN:
        if re.search(known, words):
            return f"{words}\nIn QGIS: {there}."
    return words
