#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_dem.py DEM MASK NETWORK: is a DEM what it says, and does it fall along its rivers?

DEM: a tiled Float32 COG (DEFLATE, no-data, CRS). MASK: the Byte raster of its network cells, on the same grid.
NETWORK: a GeoPackage with a layer arcs, or a shapefile of arcs. Each arc's cells (Bresenham between vertices) must be
in the mask and the DEM must not rise from one to the next. Nothing of thalweg is used, only GDAL and numpy.
Prints one JSON object and exits with 1 on any violation, 2 when there is nothing to check.
"""
import contextlib
import io

import numpy as np
from osgeo import gdal, ogr
from osgeo_utils.samples import validate_cloud_optimized_geotiff
from report import Report, run

gdal.UseExceptions()
ogr.UseExceptions()


def bresenham(a, b):
    """The cells of a segment, ends included (Bresenham 1965)."""
    (col, row), (last_col, last_row) = a, b
    dx, dy = abs(last_col - col), abs(last_row - row)
    step_x, step_y = (1 if col < last_col else -1), (1 if row < last_row else -1)
    error = dx - dy
    yield col, row
    while (col, row) != b:
        twice = 2 * error
        if twice > -dy:
            error -= dy
            col += step_x
        if twice < dx:
            error += dx
            row += step_y
        yield col, row


def check_format(path, dataset, compression, data_type, report):
    band = dataset.GetRasterBand(1)
    report.unless(dataset.RasterCount == 1, "bands", path)
    report.unless(band.DataType == data_type, "data_type", gdal.GetDataTypeName(band.DataType))
    report.unless(dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") == compression, "compression", path)
    width, height = band.GetBlockSize()
    report.unless(width == height and width % 16 == 0, "not_tiled", [width, height])
    report.unless(dataset.GetSpatialRef() is not None, "no_crs", path)


def check_cog(path, report):
    """A dataset that must be a COG of heights."""
    dem = gdal.Open(path)
    check_format(path, dem, "DEFLATE", gdal.GDT_Float32, report)
    with contextlib.redirect_stdout(io.StringIO()):
        _, errors, _ = validate_cloud_optimized_geotiff.validate(path, full_check=True)
    report.unless(not errors and dem.GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE") == "COG", "not_a_cog", errors)
    report.unless(dem.GetRasterBand(1).GetNoDataValue() is not None, "no_nodata", path)
    return dem


def main(dem_path, mask_path, network_path):
    report = Report()
    dem, mask = check_cog(dem_path, report), gdal.Open(mask_path)
    check_format(mask_path, mask, "DEFLATE", gdal.GDT_Byte, report)
    nodata = dem.GetRasterBand(1).GetNoDataValue()
    place = dem.GetGeoTransform()
    same = mask.GetGeoTransform() == place and (mask.RasterXSize, mask.RasterYSize) == (dem.RasterXSize, dem.RasterYSize)
    report.unless(same, "mask_on_another_grid", mask_path)
    answer = {"dem": dem_path, "cells": dem.RasterXSize * dem.RasterYSize}
    if same:
        z, inside = dem.ReadAsArray(), mask.ReadAsArray()
        report.unless(np.isin(inside, (0, 1)).all(), "mask_values", mask_path)
        report.unless(np.isfinite(z).all() and (np.abs(z) < 1e30).all(), "implausible_height", dem_path)
        network = ogr.Open(network_path)
        layer = network.GetLayerByName("arcs") or network.GetLayer(0)
        drawn = np.zeros(z.shape, dtype=bool)
        steps = 0
        for feature in layer:
            name = f"arc {feature['arc_id']}"
            points = feature.GetGeometryRef().GetPoints()
            # The outer edge belongs to the outermost cells.
            cells = [(min(int(np.floor((x - place[0]) / place[1])), dem.RasterXSize - 1),
                      min(int(np.floor((place[3] - y) / -place[5])), dem.RasterYSize - 1)) for x, y, *_ in points]
            if not all(0 <= c < dem.RasterXSize and 0 <= r < dem.RasterYSize for c, r in cells):
                report.unless(False, "arc_outside_dem", name)
                continue
            before = None
            for a, b in zip(cells, cells[1:]):
                for col, row in bresenham(a, b):
                    height = z[row, col]
                    drawn[row, col] = True
                    report.unless(inside[row, col] == 1, "river_cell_not_in_mask", f"{name} at {[col, row]}")
                    report.unless(height != nodata, "river_cell_without_height", f"{name} at {[col, row]}")
                    if before is not None:
                        steps += 1
                        report.unless(height <= before, "uphill", f"{name} at {[col, row]}: {before} to {height}")
                    before = height
        stray = np.argwhere((inside == 1) & ~drawn)
        report.unless(len(stray) == 0, "mask_cell_without_river", [[int(c), int(r)] for r, c in stray[:5]])
        answer.update(network_cells=int(drawn.sum()), steps=steps)
    return report.close(answer)


if __name__ == "__main__":
    run(main, __doc__, 3)
