# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mypy --strict sees of the package in a user's program."""
from typing import Any, assert_type

import numpy as np
import numpy.typing as npt

import thalweg
from thalweg import ElevatedNetwork, Grid, Raster, StreamNetwork, Terrain, flow, make


def report(share: float, stage: str) -> None:
    print(f"{stage} {share:.0%}")


terrain = make({"grid": {"width": 96, "height": 80}}, seed=7, progress=report, log=print)
assert_type(terrain, Terrain)
assert_type(terrain.dem, Raster)
assert_type(terrain.network, ElevatedNetwork)
assert_type(terrain.grid, Grid)
assert_type(terrain.checks, list[dict[str, Any]])
assert_type(terrain.dem.array(), npt.NDArray[Any])
assert_type(terrain.dem.shape, tuple[int, int])
assert_type(thalweg.io.hillshade(terrain.dem.array(copy=True)), Raster)
assert_type(flow.route(terrain.dem.to_xarray("dem"), threads=2), flow.FlowField)
assert_type(Raster.open("dem.tif").sample([1.0], [2.0]), npt.NDArray[Any])
assert_type(terrain.network.planform, StreamNetwork)
assert_type(terrain.network.node_z, npt.NDArray[np.float64])
thalweg.network.order(terrain.network.planform)
terrain.network.to_networkx()
terrain.network.planform.to_geodataframe("nodes", crs=terrain.crs)
try:
    thalweg.io.read_dem("dem.tif")
except thalweg.BadInput as refused:
    assert_type(refused.where, str)
