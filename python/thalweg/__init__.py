# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Terrain from river networks, and river networks for terrain.

make() makes terrain from a recipe, from rivers or from a DEM, as the program `thalweg make` does. Every stage of the library
has its own name in the modules growth, network, skeleton, surface, fractal, blend, flow, measure, geometry, draw and io; what
the program does with them is in recipe, terrain, report, export, members and commands.

Rasters are numpy arrays with a grid (Raster), rows from the north, float32 for heights, NaN for no data. A raster that a stage
returns shows the library's memory, and one that a stage takes is read in place: what must be converted first is said by a
ConversionWarning. Lengths are metres, areas square metres. Errors are thalweg.Error and its kinds.

Examples
--------
>>> import thalweg
>>> terrain = thalweg.make({"grid": {"width": 256, "height": 256}})
>>> terrain.dem.shape
(256, 256)
>>> routed = thalweg.flow.route(terrain.dem)
"""
from __future__ import annotations

import sys as _sys
from typing import TYPE_CHECKING

from thalweg import _core

if TYPE_CHECKING:
    from thalweg import (blend, commands, draw, export, flow, fractal, geometry, growth, io, measure, members, network, recipe,
                         report, skeleton, solver, surface, terrain)
    from thalweg._core import *
    from thalweg._core import BadInput, BadParameter, Cancelled, Error, IoError, NotConverged

# The modules come first: the package itself imports them.
for _name in _core.MODULES:
    globals()[_name] = _sys.modules[f"{__name__}.{_name}"] = getattr(_core, _name)
for _name in _core.VALUES:
    globals()[_name] = getattr(_core, _name)

from thalweg._ensemble import Member, ensemble
from thalweg._networks import from_geodataframe, from_networkx, to_geodataframe, to_networkx
from thalweg._raster import ConversionWarning, Raster, UnitWarning
from thalweg._terrain import Terrain, TerrainWarning, forecast, make, rebuild

for _kind in (_core.StreamNetwork, _core.ElevatedNetwork):
    setattr(_kind, "to_geodataframe", to_geodataframe)
    setattr(_kind, "to_networkx", to_networkx)
del _kind, _name

__version__ = _core.version()
__all__ = ["BadInput", "BadParameter", "Cancelled", "ConversionWarning", "Error", "IoError", "Member", "NotConverged", "Raster",
           "Terrain", "TerrainWarning", "UnitWarning", "__version__", "blend", "commands", "draw", "ensemble", "export", "flow",
           "forecast", "fractal", "from_geodataframe", "from_networkx", "geometry", "growth", "io", "make", "measure", "members",
           "network", "rebuild", "recipe", "report", "skeleton", "solver", "surface", "terrain", "to_geodataframe",
           "to_networkx"]
__all__ += [name for name in _core.VALUES if name not in __all__]
