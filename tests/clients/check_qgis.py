#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_qgis.py FOLDER|FILE...: does QGIS open every file without a word of complaint?

All layers of GeoPackages, shapefiles, FlatGeobuf and GeoJSON, rasters and meshes. Each opens valid and in a CRS; a vector layer gives as
many features as it says, and QGIS's check of validity, by its own rules and by GEOS's, finds nothing; a raster gives
every block; a mesh has vertices and faces. GDAL, which reads for QGIS, warns of nothing.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import os
import pathlib
import shutil
import sys
import tempfile

# Debian's qgis_process is a broken wrapper, and there is no screen.
os.environ["QT_QPA_PLATFORM"] = "offscreen"
os.environ["XDG_RUNTIME_DIR"] = tempfile.mkdtemp(prefix="thalweg-qgis-")
os.environ["QGIS_CUSTOM_CONFIG_PATH"] = os.environ["XDG_RUNTIME_DIR"]
sys.path.append("/usr/share/qgis/python/plugins")

from osgeo import gdal  # noqa: E402
from qgis.core import Qgis, QgsApplication, QgsMesh, QgsMeshLayer, QgsRasterLayer, QgsVectorLayer, QgsWkbTypes  # noqa: E402
from report import Report  # noqa: E402

VECTORS = (".gpkg", ".shp", ".fgb", ".geojson")
RASTERS = (".tif",)
MESHES = (".2dm",)
QGIS_RULES, GEOS_RULES = 1, 2


def place(point):
    return round(point.x(), 3), round(point.y(), 3)


def closing_points(shapes):
    """QGIS's own rules see the first and the last segment of a closed line cross where they close it."""
    points = set()
    for shape in shapes:
        if QgsWkbTypes.geometryType(shape.wkbType()) == QgsWkbTypes.LineGeometry:
            for line in shape.constParts():
                if line.isClosed():
                    points.add(place(line.startPoint()))
    return points


def check_vector(layer, source, report):
    import processing

    features = list(layer.getFeatures())
    report.equal("features", len(features), layer.featureCount())
    if not layer.isSpatial():
        return len(features)
    report.unless(layer.crs().isValid(), "no_crs", source)
    report.unless(not any(feature.geometry().isEmpty() for feature in features), "no_geometry", source)
    closed = closing_points(feature.geometry() for feature in features)
    for rules in (QGIS_RULES, GEOS_RULES):
        out = {key: "memory:" for key in ("VALID_OUTPUT", "INVALID_OUTPUT", "ERROR_OUTPUT")}
        found = processing.run("qgis:checkvalidity", {"INPUT_LAYER": layer, "METHOD": rules, **out})
        for error in found["ERROR_OUTPUT"].getFeatures():
            at = error.geometry().asPoint() if error.hasGeometry() else None
            report.unless(at and place(at) in closed, "invalid_geometry", f"{source}: {error['message']}")
    return len(features)


def check_raster(layer, source, report):
    provider = layer.dataProvider()
    report.unless(layer.crs().isValid(), "no_crs", source)
    block = provider.block(1, layer.extent(), layer.width(), layer.height())
    report.unless(block.isValid() and not block.isEmpty(), "unread_raster", source)
    report.equal("raster_size", (block.width(), block.height()), (layer.width(), layer.height()))
    return layer.width() * layer.height()


def check_mesh(layer, source, report):
    mesh = QgsMesh()
    layer.dataProvider().populateMesh(mesh)
    report.unless(mesh.vertexCount() > 0 and mesh.faceCount() > 0, "empty_mesh", source)
    return mesh.faceCount()


def layers_of(path):
    if path.suffix in VECTORS:
        opened = gdal.OpenEx(str(path), gdal.OF_VECTOR)
        names = [opened.GetLayer(k).GetName() for k in range(opened.GetLayerCount())] if opened else []
        for name in names:
            yield name, QgsVectorLayer(f"{path}|layername={name}", name, "ogr"), check_vector
        if not names:
            yield path.name, QgsVectorLayer(str(path), path.stem, "ogr"), check_vector
    elif path.suffix in RASTERS:
        yield path.name, QgsRasterLayer(str(path), path.stem, "gdal"), check_raster
    elif path.suffix in MESHES:
        yield path.name, QgsMeshLayer(str(path), path.stem, "mdal"), check_mesh


def main(paths):
    report = Report()
    gdal.SetConfigOption("CPL_DEBUG", "OFF")
    gdal.PushErrorHandler(lambda level, number, text: report.unless(level < gdal.CE_Warning, "gdal", text))
    application = QgsApplication([], False)
    application.initQgis()
    from processing.core.Processing import Processing

    Processing.initialize()
    QgsApplication.messageLog().messageReceived[str, str, Qgis.MessageLevel].connect(
        lambda text, tag, level: report.unless(level == Qgis.Info or level == Qgis.Success, "qgis", f"{tag}: {text}"))
    files = [file for path in paths for file in (sorted(path.glob("*")) if path.is_dir() else [path])]
    figures = {}
    for file in files:
        if not file.exists():
            raise FileNotFoundError(f"{file} is not there")
        for name, layer, check in layers_of(file):
            source = f"{file.name} {name}"
            report.unless(layer.isValid(), "not_opened", source)
            if layer.isValid():
                figures[source] = check(layer, source, report)
    if not figures and not report.counts:
        raise FileNotFoundError(f"nothing for QGIS in {', '.join(map(str, paths))}")
    return report.close({"opened": figures})


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    try:
        code = main([pathlib.Path(path) for path in sys.argv[1:]])
    except (OSError, RuntimeError) as error:
        print(f"check_qgis.py: {error}", file=sys.stderr)
        code = 2
    shutil.rmtree(os.environ["XDG_RUNTIME_DIR"], ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # QGIS 3.22 may crash while Python takes its objects apart
