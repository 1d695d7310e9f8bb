#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_gdal.py FILE|FOLDER|PG:...: does GDAL read every file to its end without a word?

Every feature of every layer and every cell of every band is read, and the file closed; any warning or error is a fault, and so is
a layer that gives fewer features than it says. Of a folder, what lies in it by itself, not the copies in inputs/.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import pathlib

from osgeo import gdal
from report import Report, run

gdal.DontUseExceptions()  # a warning must reach the handler as one
ENDINGS = {".gpkg", ".shp", ".dbf", ".fgb", ".geojson", ".json", ".tif", ".csv"}
NOT_FOR_GDAL = {"report.json"}


def read(source, report):
    figures = {}
    opened = gdal.OpenEx(source)
    if opened is None:
        report.fault("not_opened", source)
        return figures
    for k in range(opened.GetLayerCount()):
        layer = opened.GetLayer(k)
        given = sum(feature.ExportToJson() is not None for feature in layer)
        report.unless(given == layer.GetFeatureCount(), "features", f"{source} {layer.GetName()}: {given}, not {layer.GetFeatureCount()}")
        figures[layer.GetName()] = given
    for k in range(opened.RasterCount):
        band = opened.GetRasterBand(k + 1)
        values = band.ReadRaster()
        report.unless(values is not None, "unread_band", f"{source} band {k + 1}")
        figures[f"band {k + 1}"] = band.XSize * band.YSize
    return figures


def main(*sources):
    report = Report()
    files = []
    for source in sources:
        path = pathlib.Path(source)
        inside = path.is_dir() and not source.startswith("PG:")
        files += [str(p) for p in sorted(path.iterdir()) if p.suffix in ENDINGS and p.name not in NOT_FOR_GDAL] if inside else [source]
    if not files:
        raise RuntimeError(f"nothing for GDAL in {' '.join(sources)}")
    figures = {}
    for source in files:
        gdal.PushErrorHandler(lambda level, number, text, source=source: report.unless(
            level < gdal.CE_Warning, "warning", f"{source}: {text}"))
        figures[source] = read(source, report)
        gdal.PopErrorHandler()
    return report.close({"read": figures})


if __name__ == "__main__":
    run(main, __doc__)
