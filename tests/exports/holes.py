#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""holes.py DEM FOLDER: FOLDER/dem.tif, the DEM without the cells of a disc, a corner and the last row."""
import pathlib
import sys

import numpy
from osgeo import gdal

gdal.UseExceptions()
dem = gdal.Open(sys.argv[1])
z = dem.ReadAsArray()
row, column = numpy.indices(z.shape)
z[numpy.hypot(row - 0.4 * z.shape[0], column - 0.6 * z.shape[1]) < 0.1 * min(z.shape)] = -9999
z[row + column < 20] = -9999
z[-1] = -9999
folder = pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
holed = gdal.GetDriverByName("MEM").CreateCopy("", dem)
holed.GetRasterBand(1).WriteArray(z)
holed.GetRasterBand(1).SetNoDataValue(-9999)
gdal.GetDriverByName("GTiff").CreateCopy(str(folder / "dem.tif"), holed)
