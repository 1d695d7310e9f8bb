#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_relief.py FOLDER [--bars theta=0.45 slope=25 forms=0.08]: is the relief that `thalweg make` reports that of dem.tif, and like land?

Measured again without thalweg: geomorphons by GRASS (r.geomorphon search=15 skip=0 flat=1, 15 cells of border left out) of
dem.tif and of the two real DEMs in samples/; slopes and aspects by gdaldem; slope against area along the D8 directions of
GRASS (r.watershed -s), how straight they run, and how high main stems stand half-way; pits, peaks, perched river cells and
canals (of network.tif), the spread of slopes in windows, drops over a kilometre, the correlation and the
anisotropy of gradients by numpy. Each is held against report.json. --bars
asks that the land is like land: concavity (of slopes over uplift.tif, if there is one) within 0.05 of theta, mean slope within 10 % of slope [degrees], valley over ridge cells
0.8 to 1.25, geomorphons within forms (total variation) of the mean of the real DEMs, aspects along the grid's eight directions
within 15 % of even, no perched river cell.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from check_grass import Grass, ModuleFailed, session
from osgeo import gdal
from report import Report, run
from scipy.ndimage import distance_transform_edt, gaussian_filter, generic_filter, label, maximum_filter, minimum_filter

gdal.UseExceptions()
SAMPLES = pathlib.Path(__file__).resolve().parents[2] / "samples"
REAL = ("bigtujunga_srtm1_utm11.tif", "jacksboro_utm16.tif")
FORMS = ("flat", "peak", "ridge", "shoulder", "spur", "slope", "hollow", "footslope", "valley", "pit")
SEARCH, SUPPORT = 15, 200
STEPS = {1: (-1, 1), 2: (-1, 0), 3: (-1, -1), 4: (0, -1), 5: (1, -1), 6: (1, 0), 7: (1, 1), 8: (0, 1)}  # of GRASS: row, column


def heights(path):
    dem = gdal.Open(str(path))
    z = dem.ReadAsArray().astype(float)
    nodata = dem.GetRasterBand(1).GetNoDataValue()
    return np.where(z == nodata, np.nan, z), dem.GetGeoTransform()[1]


def forms_of(grass, path, name, folder):
    """Shares of the ten forms."""
    grass("r.in.gdal", flags="o", input=path, output=name)
    grass("g.region", raster=name)
    grass("r.geomorphon", elevation=name, forms=f"{name}_forms", search=SEARCH, skip=0, flat=1)
    form = grass.raster(f"{name}_forms", folder)[SEARCH:-SEARCH, SEARCH:-SEARCH]
    form = form[np.isfinite(form)].astype(int)
    return np.bincount(form, minlength=11)[1:11] / max(form.size, 1)


def gdaldem(verb, dem, folder):
    out = folder / f"{verb}.tif"
    subprocess.run(["gdaldem", verb, str(dem), str(out), "-q"], check=True)
    return heights(out)[0]


def along_grid(aspects, half):
    """Share of aspects within so many degrees of eight directions, over what it is where all are as frequent."""
    off = np.abs((aspects + 22.5) % 45 - 22.5)
    return float((off <= half).mean() / (half / 22.5)) if aspects.size else None


def drainage_of(grass, folder, z, cell):
    """Contributing area, drop and length of the step, and receiver (-1: none) of every cell, in one line."""
    grass("r.watershed", flags="sa", elevation="dem", accumulation="area", drainage="towards", memory=1000)
    area, towards = grass.raster("area", folder), np.abs(np.nan_to_num(grass.raster("towards", folder))).astype(int)
    drop, way, below = np.full(z.shape, np.nan), np.zeros(z.shape), np.full(z.shape, -1)
    for code, (row, column) in STEPS.items():
        at = np.argwhere(towards == code)
        there = at + (row, column)
        inside = ((there >= 0) & (there < z.shape)).all(axis=1)
        at, there = at[inside].T, there[inside].T
        drop[tuple(at)] = z[tuple(at)] - z[tuple(there)]
        way[tuple(at)] = cell * np.hypot(row, column)
        below[tuple(at)] = there[0] * z.shape[1] + there[1]
    return area.ravel(), drop.ravel(), way.ravel(), below.ravel(), towards.ravel()


def concavity(flow, cell):
    """Drop over way in bins of a fifth of a decade of area; a line through the bins by the roots of their cells."""
    area, drop, way, *_ = flow
    river = (area >= SUPPORT) & (way > 0) & np.isfinite(drop)
    logs = np.log10(area[river] * cell * cell)
    number = np.floor(logs * 5).astype(int)
    line = []
    for one in np.unique(number):
        here = number == one
        slope = drop[river][here].sum() / way[river][here].sum()
        if here.sum() >= 20 and slope > 0:
            line.append((logs[here].mean(), np.log10(slope), here.sum() ** 0.25))
    if len(line) < 3:
        return None
    x, y, w = np.array(line).T
    return float(-np.polyfit(x, y, 1, w=w)[0])


def slope_area_ratio(flow, slopes):
    """Mean tangent where 3000 to 10 000 cells drain over that where 3 to 10 do."""
    area, tangent = flow[0], np.tan(np.radians(slopes)).ravel()
    means = []
    for low, high in ((3000, 10000), (3, 10)):
        here = tangent[(area >= low) & (area < high) & np.isfinite(tangent)]
        means.append(here.mean() if here.size else np.nan)
    return float(means[0] / means[1]) if np.isfinite(means[0] / means[1]) else None


def level_water(z):
    """Cells as high as their eight neighbours."""
    return maximum_filter(z, size=3) == minimum_filter(z, size=3)


def straightness(flow, z, support=2000, steps=60, tolerance=1.5):
    """Longest run of channels in one direction, and the share of reaches that keep to their chord; level water left out."""
    area, _, _, below, towards = flow
    columns, lake = z.shape[1], level_water(z).ravel()
    cells = np.flatnonzero((area >= support) & (below >= 0) & ~lake)
    run = np.ones(area.size, int)
    for at in cells[np.argsort(area[cells], kind="stable")]:
        if towards[below[at]] == towards[at] and not lake[below[at]]:
            run[below[at]] = max(run[below[at]], run[at] + 1)
    reach = [cells]
    for _ in range(steps):
        reach.append(np.where((reach[-1] >= 0) & ~lake[below[reach[-1]]], below[reach[-1]], -1))
    reach = np.stack(reach)[:, reach[-1] >= 0] if cells.size else np.zeros((steps + 1, 0), int)
    row, column = reach // columns, reach % columns
    down, across = (row[-1] - row[0]).astype(float), (column[-1] - column[0]).astype(float)
    chord = np.hypot(down, across)
    area_beside = np.abs((row - row[0]) * across - (column - column[0]) * down).max(axis=0) if reach.size else np.zeros(0)
    share = float(((area_beside <= tolerance * chord) & (chord >= 1)).mean()) if reach.shape[1] else None
    return int(run[cells].max()) if cells.size else 0, share


def units(z):
    down, across = np.gradient(z)
    length = np.hypot(across, down)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(length > 0, (across + 1j * down) / length, np.where(np.isnan(length), np.nan, 0))


def correlation(unit, lag):
    if lag < 1 or lag >= min(unit.shape):
        return None
    products = []
    for a, b in ((unit[:, lag:], unit[:, :-lag]), (unit[lag:], unit[:-lag])):
        both = (np.abs(a) > 0.5) & (np.abs(b) > 0.5)
        products.append((a * np.conj(b)).real[both].mean())
    return float(np.mean(products))


def anisotropy(unit, window):
    border = int(np.ceil(2 * window))
    if 4 * window >= min(unit.shape):
        return None
    known = np.isfinite(unit)
    unit = np.where(known, unit, 0)
    weight, xx, yy, xy = (gaussian_filter(part.astype(float), window)[border:-border, border:-border]
                          for part in (known, unit.real**2, unit.imag**2, unit.real * unit.imag))
    good = (weight > 0.98) & (xx + yy > 0)
    return float((np.sqrt((xx - yy) ** 2 + 4 * xy**2) / np.where(good, xx + yy, 1))[good].mean()) if good.any() else None


def level_patch(z, slope):
    """Share of the largest patch below 3 degrees, in percent; level water left out."""
    land = np.isfinite(slope) & ~level_water(z)
    land[0] = land[-1] = land[:, 0] = land[:, -1] = False
    with np.errstate(invalid="ignore"):
        patches, count = label(land & (slope < 3), structure=np.ones((3, 3)))
    return float(100 * np.bincount(patches.ravel())[1:].max() / land.sum()) if count else 0.0


def perched(z, mask, rise):
    ring = np.ones((5, 5), bool)
    ring[1:4, 1:4] = False
    lowest = minimum_filter(np.where(np.isnan(z), np.inf, z), footprint=ring, mode="constant", cval=np.inf)
    return int((mask & (z - lowest > rise)).sum())


def windows_of(slopes, cell, side_m=3000):
    """Standard deviation of the mean slopes of square windows that are at least half full."""
    side = max(round(side_m / cell), 1)
    means = []
    for row in range(0, slopes.shape[0], side):
        for column in range(0, slopes.shape[1], side):
            window = slopes[row : row + side, column : column + side]
            here = window[np.isfinite(window)]
            if 2 * here.size >= side * side:
                means.append(here.mean())
    return float(np.std(means)) if len(means) >= 4 else None


def half_way_height(flow, z, cell, stream_m2=1e6, least=50, most=20):
    """Median over main stems: height half-way above the mouth, over that of the source."""
    area, _, way, below, towards = flow
    support, heights = np.ceil(stream_m2 / cell**2), z.ravel()
    donors = {}
    for at in np.flatnonzero((area >= support) & (below >= 0)):
        if below[at] not in donors or area[at] > area[donors[below[at]]]:
            donors[below[at]] = at
    shares = []
    ends = (below < 0) | np.isnan(heights[below])  # off the grid or in the sea
    for mouth in sorted(np.flatnonzero((area >= support) & ends & ~np.isnan(heights)), key=lambda at: -area[at]):
        stem, length = [mouth], [0.0]
        while stem[-1] in donors:
            stem.append(donors[stem[-1]])
            length.append(length[-1] + way[stem[-1]])
        up = heights[stem]
        if len(stem) >= least and up[-1] > up[0] and len(shares) < most:
            shares.append((np.interp(length[-1] / 2, length, up) - up[0]) / (up[-1] - up[0]))
    return float(np.median(shares)) if shares else None


def canals(z, mask, cell):
    """Share of river cells whose lowest neighbour that is no river cell stands more than a cell's size above them, in percent."""
    bank = minimum_filter(np.where(mask | np.isnan(z), np.inf, z), size=3, mode="constant", cval=np.inf)
    river = mask & np.isfinite(z)
    return float(100 * (river & np.isfinite(bank) & (bank - z > cell)).sum() / river.sum()) if river.any() else None


def steepest_drop(z, cell, over_m=1000):
    """Drop to the lowest of 16 places a kilometre away, 99.9th over 90th percentile."""
    radius, step = over_m / cell, max(int(over_m / cell / 10), 1)
    if min(z.shape) * cell < 2 * over_m:
        return None
    reach = int(np.ceil(radius)) + 1
    wide = np.pad(z, reach, constant_values=np.nan)
    lowest = z.copy()
    for k in range(16):
        down, right = (int(np.floor(abs(x) + 0.5) * np.sign(x)) for x in (radius * np.sin(k * np.pi / 8), radius * np.cos(k * np.pi / 8)))
        lowest = np.fmin(lowest, wide[reach + down : reach + down + z.shape[0], reach + right : reach + right + z.shape[1]])
    drop = (z - lowest)[::step, ::step]
    drop = drop[np.isfinite(drop)]
    high, usual = np.percentile(drop, (99.9, 90))
    return float(high / usual) if usual > 0 else None


def extremes(z):
    around = np.ones((3, 3), bool)
    around[1, 1] = False
    whole = generic_filter(np.isnan(z).astype(float), np.max, size=3, mode="constant", cval=1.0) == 0
    with np.errstate(invalid="ignore"):
        pits = (z < minimum_filter(z, footprint=around)) & whole
        peaks = (z > maximum_filter(z, footprint=around)) & whole
    return int(pits.sum()), int(peaks.sum())


def measured(folder, dem, report):
    z, cell = heights(dem)
    mask = folder / "network.tif"
    found = {}
    with tempfile.TemporaryDirectory(prefix="thalweg-relief-") as place, session(str(dem), pathlib.Path(place)):
        place = pathlib.Path(place)
        grass = Grass(report)
        real = [forms_of(grass, SAMPLES / name, f"real{k}", place) for k, name in enumerate(REAL)]
        found["forms"] = forms_of(grass, dem, "dem", place)
        found["form_distance"] = float(np.abs(found["forms"] - np.mean(real, axis=0)).sum() / 2)
        found["valleys_over_ridges"] = float(found["forms"][8] / found["forms"][2]) if found["forms"][2] > 0 else None
        flow = drainage_of(grass, place, z, cell)
        slopes, aspects = gdaldem("slope", dem, place), gdaldem("aspect", dem, place)
    found["theta"], found["slope_area_ratio"] = concavity(flow, cell), slope_area_ratio(flow, slopes)
    found["theta_of_uplift"] = found["theta"]  # what the slopes have in common where uplift differs
    if (folder / "uplift.tif").exists():
        area, drop, *rest = flow
        found["theta_of_uplift"] = concavity((area, drop / heights(folder / "uplift.tif")[0].ravel(), *rest), cell)
    found["half_way_height"] = half_way_height(flow, z, cell)
    found["straight_run"], found["straight_share"] = straightness(flow, z)
    unit = units(z)
    for lag in (360, 720, 1440):
        found[f"gradient_correlation_{lag}"] = correlation(unit, round(lag / cell))
    found["gradient_anisotropy"] = anisotropy(unit, 960 / cell)
    found["level_patch"] = level_patch(z, slopes)
    slope, aspect = slopes[np.isfinite(slopes)], aspects[np.isfinite(aspects)]
    found["slope_mean"] = float(slope.mean())
    found["slope_spread"], found["steepest_drop"] = windows_of(slopes, cell), steepest_drop(z, cell)
    low, middle, high = np.percentile(slope, (25, 50, 75))
    found["slope_iqr"] = float((high - low) / middle) if middle > 0 else None
    for percent in (5, 50, 95):
        found[f"slope_p{percent}"] = float(np.percentile(slope, percent))
    tangent = np.tan(np.radians(slope))
    found["slope_cv"] = float(tangent.std() / tangent.mean()) if tangent.mean() > 0 else None
    found["aspects_along_grid"], found["aspects_on_grid"] = along_grid(aspect, 11.25), along_grid(aspect, 2.5)
    found["pits"], found["peaks"] = extremes(z)
    found["rivers"] = gdal.Open(str(mask)).ReadAsArray() == 1 if mask.exists() else None
    if found["rivers"] is not None and found["rivers"].any():
        to_river = distance_transform_edt(~found["rivers"]) * cell
        found["river_distance"] = float(np.median(to_river[np.isfinite(z)]))
        found["canals"] = canals(z, found["rivers"], cell)
        with np.errstate(invalid="ignore"):
            found["gentle_away"] = float(100 * ((slopes < 4) & (to_river > 240)).sum() / slope.size)
    return found, z, cell


# How far a figure of ours may be from that of others, who round and break ties their way.
WITHIN = {"slope_mean": 0.01, "slope_p5": 0.03, "slope_p50": 0.03, "slope_p95": 0.03, "slope_cv": 0.002, "form_distance": 0.005,
          "valleys_over_ridges": 0.02, "aspects_along_grid": 0.01, "aspects_on_grid": 0.03, "theta": 0.03,
          "slope_area_ratio": 0.02, "gradient_correlation_360": 1e-4, "gradient_correlation_720": 1e-4,
          "gradient_correlation_1440": 1e-4, "gradient_anisotropy": 2e-3, "level_patch": 0.05, "straight_run": 6, "straight_share": 0.02,
          "slope_spread": 0.02, "slope_iqr": 0.005, "half_way_height": 0.03, "steepest_drop": 0.05}
BY_DRAINAGE = ("theta", "slope_area_ratio", "straight_run", "straight_share", "half_way_height")


def held_against_report(found, relief, recipe, z, cell, drained, report):
    for key, tolerance in WITHIN.items():
        ours, theirs = relief["figures"][key]["value"], found[key]
        if (key in BY_DRAINAGE and not drained) or (key == "half_way_height" and level_water(z).any()):
            continue  # through depressions and across lakes every program leads water its own way
        if ours is None or theirs is None:
            report.unless(ours is None and theirs is None, key, f"{ours}, not {theirs}")
        else:
            report.unless(abs(ours - theirs) <= tolerance, key, f"{ours}, not {theirs}")
    distance = sum(abs(relief["forms"][name] - share) for name, share in zip(FORMS, found["forms"])) / 2
    report.unless(distance <= 0.003, "forms", f"{distance} apart")
    report.equal("pits", relief["extremes"]["pits"], found["pits"])
    report.equal("peaks", relief["extremes"]["peaks"], found["peaks"])
    for key, tolerance in (("canals", 0.01), ("gentle_away", 0.02)):
        if key in found and not recipe.get("network", {}).get("fill_space"):  # network.tif has the side valleys, too
            ours = relief["figures"][key]["value"]
            report.unless(abs(ours - found[key]) <= tolerance, key, f"{ours}, not {found[key]}")
    if found["rivers"] is not None:
        asked = recipe.get("surface", {}).get("mean_slope") or found["slope_mean"]
        found["perched"] = perched(z, found["rivers"], np.tan(np.radians(asked)) * cell)
        ours = relief["figures"]["perched"]["value"]
        # The mean that others find may differ in its last digits: who stands just so high counts for one and not for another.
        report.unless(abs(ours - found["perched"]) <= 2 + 0.01 * found["perched"], "perched", f"{ours}, not {found['perched']}")


def meets(bars, found, report):
    theta, slope = float(bars["theta"]), float(bars["slope"])
    ratio = found["valleys_over_ridges"]
    of_uplift = found["theta_of_uplift"]
    report.unless(of_uplift is not None and abs(of_uplift - theta) <= 0.05, "bar_theta", f"{of_uplift}, not {theta}")
    report.unless(abs(found["slope_mean"] / slope - 1) <= 0.1, "bar_slope", f"{found['slope_mean']}, not {slope}")
    report.unless(ratio is not None and 0.8 <= ratio <= 1.25, "bar_valleys_over_ridges", ratio)
    report.unless(found["form_distance"] <= float(bars["forms"]), "bar_form_distance", found["form_distance"])
    along = found["aspects_along_grid"]
    report.unless(along is not None and abs(along - 1) <= 0.15, "bar_aspects", along)
    report.unless(found.get("perched", 0) == 0, "bar_perched", found.get("perched"))


def main(folder, *words):
    folder = pathlib.Path(folder)
    told = json.loads((folder / "report.json").read_text())
    report = Report()
    try:
        found, z, cell = measured(folder, folder / "dem.tif", report)
    except ModuleFailed as failure:
        report.fault("module_failed", failure)
        return report.close({"folder": folder})
    drained = any(check["name"] == "depressions" and check["ok"] for check in told["checks"])
    held_against_report(found, told["dem"]["relief"], told["recipe"], z, cell, drained, report)
    if words:
        meets(dict(word.split("=") for word in words[1:]), found, report)
    found["forms"] = dict(zip(FORMS, found["forms"].round(4)))
    del found["rivers"]
    return report.close({"folder": folder, **found})


if __name__ == "__main__":
    run(main, __doc__, 1, 5)
