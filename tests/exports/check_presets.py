#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_presets.py THALWEG FOLDER: what `thalweg export --for` writes of a folder whose DEM has 513 x 513 cells, read by
programs that are not ours.

Heights by numpy and Pillow: tiles put together are GDAL's dem.tif within half a step, edges are equal, and numbers at "import"
give true heights by the engines' own formulas. Slope is gdaldem's. Weights of land cover make one. Rivers lie in their cells."""
import json
import pathlib
import sys
import tempfile

import numpy
import PIL.Image
from osgeo import gdal

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "clients"))
import report  # noqa: E402

gdal.UseExceptions()
SIDE = 513


def picture(path):
    return numpy.array(PIL.Image.open(path)).astype(float)


def tiles(folder, says, files, read):
    """Tiles as one array, from the north-west, and how many pairs of neighbours differ along their edge."""
    across, down = says["tiles"]["across"], says["tiles"]["down"]
    width, height = says["tiles"]["width"], says["tiles"]["height"]
    whole = numpy.full((down * (height - 1) + 1, across * (width - 1) + 1), numpy.nan)
    unequal = 0
    for number, name in enumerate(files):
        y, x = divmod(number, across)
        tile = read(folder / name).reshape(height, width)
        place = whole[y * (height - 1):y * (height - 1) + height, x * (width - 1):x * (width - 1) + width]
        known = numpy.isfinite(place)
        unequal += int((place[known] != tile[known]).sum())
        place[:] = tile
    return whole, unequal


def check_heights(found, folder, says, dem):
    flip = says["for"] == "unity"

    def read(path):
        if path.suffix == ".png":
            return picture(path)
        side = says["tiles"]["width"]
        numbers = numpy.fromfile(path, "<u2").astype(float).reshape(-1, side)
        return numbers[::-1] if flip else numbers

    numbers, unequal = tiles(folder, says, says["heights"]["files"], read)
    found.equal("samples of tiles' edges that differ", (says["for"], unequal), (says["for"], 0))
    if says["width"] != SIDE:
        return
    error = numpy.abs(says["min_m"] + numbers * says["metres_per_step"] - dem).max()
    found.unless(error <= 0.5 * says["metres_per_step"] * (1 + 1e-6), "more than half a step", (says["for"], error))
    told = says["import"]
    if says["for"] == "unity":
        heights = told["position_of_south_west_tile"][1] + numbers / 65535 * told["terrain_height"]
        found.unless(numpy.abs(heights - dem).max() < says["metres_per_step"], "heights in Unity", "terrain_height")


def check_unreal(found, says, numbers):
    told = says["import"]
    z = (told["location_cm"][2] + (numbers - 32768) / 128 * told["scale"][2]) / 100
    wanted = says["min_m"] + numbers * says["metres_per_step"]
    found.unless(numpy.abs(z - wanted).max() < 1e-3, "heights in Unreal", float(numpy.abs(z - wanted).max()))


def check_masks(found, folder, says, dem_path):
    masks = {mask["name"]: mask for mask in says["masks"]}
    found.equal("masks", sorted(masks), sorted(["slope", "flow", "wetness", "curvature", "water", "river_distance", "river_width",
                                                "ridge", "land_cover"]))
    most = 2 ** masks["slope"]["bits"] - 1
    slope, unequal = tiles(folder, says, masks["slope"]["files"], picture)
    found.equal("edges of masks that differ", unequal, 0)
    theirs = gdal.DEMProcessing("", str(dem_path), "slope", format="MEM", computeEdges=False).ReadAsArray()
    off = numpy.abs(slope / most * masks["slope"]["white"] - theirs)[1:-1, 1:-1].max()
    found.unless(off <= 0.51 * masks["slope"]["white"] / most + 1e-3, "slope beside gdaldem's", off)
    total = 0
    for kind in masks["land_cover"]["kinds"]:
        weight, _ = tiles(folder, says, kind["weights"], picture)
        total = total + weight
    found.unless(numpy.abs(total - 255).max() <= 3, "weights of land cover", float(numpy.abs(total - 255).max()))
    for name, mask in masks.items():
        seen, _ = tiles(folder, says, mask["files"], picture)
        found.unless(name == "land_cover" or seen.std() > 0.5, "an empty mask", name)


def check_rivers(found, folder, says, dem):
    """Heights of rivers beside those of the nearest cells."""
    rivers = json.loads((folder / "rivers.json").read_text())["rivers"]
    found.at_least("rivers", len(rivers), 5)
    cells = (SIDE - 1) / (says["width"] - 1)
    scale = says["import"]["scale"]
    heights = picture(folder / says["heights"]["files"][0])
    off = []
    for river in rivers:
        for x, y, z, width, discharge, ground in river["points"]:
            col, row = cells * x / scale[0], cells * y / scale[1]
            if 0 <= col <= SIDE - 1 and 0 <= row <= SIDE - 1:
                off.append(abs(z / 100 - dem[round(row), round(col)]))
                place = round(y / scale[1]), round(x / scale[0])
                on_map = says["min_m"] + heights[place] * says["metres_per_step"]
                around = heights[max(place[0] - 1, 0):place[0] + 2, max(place[1] - 1, 0):place[1] + 2]
                found.unless(abs(ground / 100 - on_map) <= numpy.ptp(around) * says["metres_per_step"] + 0.01, "ground", river["id"])
            found.unless(width > 0 and discharge > 0, "a river without water", river["id"])
    off_m = float(numpy.median(off))
    found.unless(off_m < 0.01 * (says["max_m"] - says["min_m"]), "rivers off the ground [m]", off_m)
    return {"rivers": len(rivers), "median_off_m": round(off_m, 2)}


def main(thalweg, folder):
    found = report.Report()
    dem_path = pathlib.Path(folder) / "dem.tif"
    dem = gdal.Open(str(dem_path)).ReadAsArray().astype(float)
    found.equal("cells", dem.shape, (SIDE, SIDE))
    figures = {}
    with tempfile.TemporaryDirectory(prefix="thalweg-presets-") as place:
        def export(preset, name, *words):
            target = pathlib.Path(place) / name
            report.command(thalweg, "export", folder, "--for", preset, "-o", target, *words)
            says = json.loads((target / "export.json").read_text())
            there = sorted(str(path.relative_to(target)) for path in target.rglob("*") if path.is_file())
            found.equal("files", there, sorted(says["files"]))
            return target, says

        target, says = export("unity", "whole", "--size", SIDE, "--masks", "none")
        check_heights(found, target, says, dem)
        target, says = export("unity", "quarters", "--size", 257, "--tiles", 2, "--mask-bits", 16)
        check_heights(found, target, says, dem)
        check_masks(found, target, says, dem_path)
        target, says = export("godot", "godot", "--masks", "none")
        check_heights(found, target, says, dem)
        target, says = export("blender", "blender")
        check_heights(found, target, says, dem)
        target, says = export("unreal", "unreal", "--size", 253, "--tiles", "3x2", "--masks", "slope")
        check_heights(found, target, says, dem)
        check_unreal(found, says, picture(target / says["heights"]["files"][0]))
        target, says = export("unreal", "same", "--size", 505)
        figures.update(check_rivers(found, target, says, dem))
        colour = PIL.Image.open(target / "colour.png")
        found.equal("colour", (colour.size, colour.mode), ((505, 505), "RGB"))
        found.unless(numpy.array(colour).std() > 5, "a texture of one colour", "colour.png")
    return found.close(figures)


if __name__ == "__main__":
    report.run(main, __doc__, 2)
