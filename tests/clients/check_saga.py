#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_saga.py DEM: does a DEM drain, with no depression left for SAGA to fill?

SAGA's Fill Sinks (Wang & Liu 2006) with no slope forced on what it fills raises just the cells of depressions. None may be
raised, not by the last bit of a Float32. Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import pathlib
import tempfile

import numpy as np
from osgeo import gdal
from report import Report, command, run
from scipy.ndimage import label, maximum, minimum_position, sum_labels

gdal.UseExceptions()
EIGHT = np.ones((3, 3))


def main(path):
    report = Report()
    dem = gdal.Open(path)
    place, nodata = dem.GetGeoTransform(), dem.GetRasterBand(1).GetNoDataValue()
    z = dem.ReadAsArray().astype(float)
    with tempfile.TemporaryDirectory(prefix="thalweg-saga-") as folder:
        out = {name: pathlib.Path(folder) / f"{name}.sgrd" for name in ("filled", "directions", "basins")}
        command("saga_cmd", "-f=s", "ta_preprocessor", "4", "-ELEV", path, "-FILLED", out["filled"], "-FDIR", out["directions"],
                "-WSHED", out["basins"], "-MINSLOPE", "0")
        filled = gdal.Open(str(out["filled"].with_suffix(".sdat"))).ReadAsArray().astype(float)
    report.equal("shape", filled.shape, z.shape)
    raised = np.where(z == nodata, 0.0, filled - z)
    report.unless((raised >= 0).all(), "lowered_by_saga", int((raised < 0).sum()))
    pits, count = label(raised > 0, EIGHT)
    numbers = np.arange(1, count + 1)
    lowest, deep, cells = minimum_position(z, pits, numbers), maximum(raised, pits, numbers), sum_labels(raised > 0, pits, numbers)
    for (row, column), depth, size in zip(lowest, deep, cells):
        report.fault("depression", f"{int(size)} cells, {depth:.6g} m deep, lowest at column {column}, row {row}")
    volume = float(raised.sum()) * abs(place[1] * place[5])
    return report.close({"dem": path, "depressions": count, "cells": int((raised > 0).sum()),
                         "max_depth_m": float(raised.max()), "volume_m3": volume})


if __name__ == "__main__":
    run(main, __doc__, 1)
