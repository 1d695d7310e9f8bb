#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_export.py THALWEG FOLDER [EXPORTS]: what `thalweg export` writes of a folder, read by programs that are not ours.

PNG and raw files by Pillow and numpy, EXR by OpenImageIO: heights of GDAL's dem.tif within half a step, or bit for bit.
STL by meshio: closed, with a volume. OBJ by meshio: the heights of the DEM, and a texture beside it. The chunks of a GLB
are those of the standard. EXPORTS: a folder in which the exports stay; those that are there already are checked as they
are."""
import contextlib
import json
import pathlib
import struct
import sys
import tempfile

import meshio
import numpy
import OpenImageIO
import PIL.Image
from osgeo import gdal

import report

gdal.UseExceptions()


def heights_of(folder):
    data = gdal.Open(str(pathlib.Path(folder) / "dem.tif"))
    band = data.GetRasterBand(1)
    return numpy.where(band.GetMaskBand().ReadAsArray() > 0, band.ReadAsArray(), numpy.nan)


def first_cell(folder, says):
    west, cell, _, north, _, _ = gdal.Open(str(pathlib.Path(folder) / "dem.tif")).GetGeoTransform()
    return (round((says["north_west"][0] - west) / cell - 0.5), round((north - says["north_west"][1]) / cell - 0.5))


def check_solid(found, mesh):
    points, corners = numpy.unique(mesh.points, axis=0, return_inverse=True)
    triangles = corners[mesh.cells_dict["triangle"]]
    edges = numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    once, count = numpy.unique(edges, axis=0, return_counts=True)
    found.equal("edges run through twice the same way", int((count > 1).sum()), 0)
    back = numpy.unique(edges[:, ::-1], axis=0)
    found.unless(numpy.array_equal(once, back), "edges of one triangle", len(once))
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    volume = float((a * numpy.cross(b, c)).sum() / 6)
    found.unless(volume > 0, "volume", volume)
    return {"solid": [len(points), len(triangles), round(volume)]}


def check_glb(found, path):
    data = path.read_bytes()
    magic, version, size, length, kind = struct.unpack_from("<4sIII4s", data)
    found.equal("glb header", (magic, version, size, kind), (b"glTF", 2, len(data), b"JSON"))
    scene = json.loads(data[20:20 + length])
    room, kind = struct.unpack_from("<I4s", data, 20 + length)
    found.equal("glb chunk", (room, kind), (len(data) - 28 - length, b"BIN\0"))
    for view in scene["bufferViews"]:
        found.unless(view["byteOffset"] + view["byteLength"] <= room, "view beyond the buffer", view)
    image = scene["bufferViews"][scene["images"][0]["bufferView"]]
    begin = 28 + length + image["byteOffset"]
    with tempfile.TemporaryFile() as file:
        file.write(data[begin:begin + image["byteLength"]])
        file.seek(0)
        texture = PIL.Image.open(file)
        texture.load()
    return {"texture": texture.size, "meshes": [mesh["name"] for mesh in scene["meshes"]]}


def main(thalweg, folder, exports=None):
    found = report.Report()
    dem = heights_of(folder)
    rows, columns = dem.shape
    kept = contextlib.nullcontext(exports) if exports else tempfile.TemporaryDirectory(prefix="thalweg-export-")
    with kept as place:
        def export(name, *words):
            path = pathlib.Path(place) / name
            if not path.exists():
                report.command(thalweg, "export", folder, "-o", path, *words)
            return path, json.loads(path.with_name(name + ".json").read_text())

        path, says = export("a.png")
        image = PIL.Image.open(path)
        col, row = first_cell(folder, says)  # of the largest rectangle without a rim that has no data
        is_whole = (says["height"], says["width"]) == dem.shape
        dem = dem[row:row + says["height"], col:col + says["width"]]
        found.unless(is_whole or says["rim"]["closed_by"] == "cut", "cut", says.get("rim"))
        rows, columns = dem.shape
        found.equal("size", image.size, (columns, rows))
        if found.counts:
            return found.close({})
        found.unless(image.mode in ("I;16", "I"), "mode", image.mode)  # by the version of Pillow
        samples = numpy.array(image).astype(float)
        known = numpy.isfinite(dem)
        error = numpy.abs(says["min_m"] + samples * says["metres_per_step"] - dem)[known]
        found.unless(error.max() <= 0.5 * says["metres_per_step"] * (1 + 1e-6), "more than half a step", error.max())

        path, _ = export("a.raw")
        found.unless((numpy.fromfile(path, "<u2").reshape(rows, columns) == samples).all(), "raw is not the PNG", path.name)
        path, _ = export("a.r32")
        found.unless((numpy.fromfile(path, "<f4").reshape(rows, columns)[known] == dem[known]).all(), "other heights", "r32")
        path, _ = export("a.exr")
        image = OpenImageIO.ImageInput.open(str(path))
        form = image.spec()
        found.equal("exr", (form.width, form.height, form.channelnames, str(form.format)), (columns, rows, ("Y",), "float"))
        found.unless((image.read_image("float")[:, :, 0][known] == dem[known]).all(), "other heights", "exr")

        longer = 1 + 2 * (max(rows, columns) - 1)
        size = f"{1 + 2 * (columns - 1)}x{1 + 2 * (rows - 1)}"
        path, _ = export("b.r32", "--size", size)
        fine = numpy.fromfile(path, "<f4").reshape(1 + 2 * (rows - 1), -1)
        found.unless((fine[::2, ::2][known] == dem[known]).all(), "cells are not kept", size)
        found.equal("longer side", max(fine.shape), longer)

        path, says = export("a.obj")
        points = meshio.read(path).points
        if columns <= 1025 and rows <= 1025 and is_whole and known.all():
            error = numpy.abs(points[:, 1] + says["origin"][2] - dem.ravel()).max()
            found.unless(error < 1e-3, "heights of the OBJ", error)
        found.unless((path.parent / "a_texture.png").exists(), "no texture", "obj")

        path, _ = export("a.glb")
        figures = check_glb(found, path)
        path, _ = export("a.stl", "--size", f"{1 + (columns - 1) // 4}x{1 + (rows - 1) // 4}")
        figures.update(check_solid(found, meshio.read(path)))
    return found.close({"size": [columns, rows], **figures})


if __name__ == "__main__":
    report.run(main, __doc__, 2, 3)
