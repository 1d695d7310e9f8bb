#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_measures.py DEM THALWEG: do SAGA, GRASS and the definitions find the measures that `thalweg measure` writes?

The DEM as given: every measure of its D8 flow is computed again by its definition, from direction_d8.tif and the heights.
Then a DEM without depressions that leaves no program a choice: filled by SAGA with a slope of 0.1 degrees, plus noise lower
than what that falls in a cell, drawn again where two ways down are as steep. There the modules that the JSON names find the
measures too. Of thalweg's they are given river cells and sources, the areas for twi and the outlines of catchments; numpy
adds up areas along the D-infinity directions of ta_morphometry 0.

On the border and beside no data: ta_hydrology 13 and 27 do as thalweg does; ta_channels 4 and 5, ta_hydrology 0 and
ta_morphometry 0 need a wall around the DEM, else water leaves at each such cell; r.fill.dir is compared two cells further in.
ta_channels 4 goes another way where the steepest meets no river: compared where thalweg has a height.
Not the same quantities, and not used: r.watershed (1 % of its directions are not the steepest); D-infinity by ta_hydrology
(along the gradient of a plane, not of facets); ta_channels 6 (counts the streams that meet at another cell); ta_hydrology 23
(divides by the root of the number of cells times their side).
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import pathlib
import tempfile

import numpy as np
from check_grass import Grass, ModuleFailed, session
from osgeo import gdal, ogr
from report import Report, command, run
from scipy.ndimage import maximum_filter, minimum_filter

gdal.UseExceptions()
ogr.UseExceptions()
STEPS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))  # row, column; clockwise from the east
LEAVES, NO_CODE = 0, 255
SUPPORT, THETA, REACH_M = 100, 0.45, 500.0
FILL_DEG, APART = 0.1, 1e-3  # [m] per cell by which one way down must be steeper than all others
ROOM = 2  # cells around the DEM for the wall and no data beyond it
EVERYTHING = "d8,dinf,directions,edge,lengths,hand,twi,orders,chi,streams"


def values_of(path):
    """Values of a raster with NaN where there are none, and the side of a cell."""
    file = gdal.Open(str(path))
    band = file.GetRasterBand(1)
    values, nodata = band.ReadAsArray(), band.GetNoDataValue()
    known = np.ones(values.shape, bool) if nodata is None else values != values.dtype.type(nodata)
    return np.where(known, values.astype(float), np.nan), file.GetGeoTransform()[1]


def write(path, values, like, room=0):
    """Writes values as Float32 in the place of another raster, with so many cells more on each side."""
    file = gdal.Open(str(like))
    west, cell, _, north, _, _ = file.GetGeoTransform()
    made = gdal.GetDriverByName("GTiff").Create(str(path), *values.shape[::-1], 1, gdal.GDT_Float32)
    made.SetGeoTransform((west - room * cell, cell, 0, north + room * cell, 0, -cell))
    made.SetProjection(file.GetProjection())
    made.GetRasterBand(1).SetNoDataValue(-9999)
    made.GetRasterBand(1).WriteArray(np.where(np.isnan(values), -9999, values))
    return path


def around(values):
    """The eight neighbours of every cell, NaN beyond the grid."""
    rows, columns = values.shape
    padded = np.pad(values, 1, constant_values=np.nan)
    return np.stack([padded[1 + r:1 + r + rows, 1 + c:1 + c + columns] for r, c in STEPS])


def falls(z):
    """Fall per cell towards the eight neighbours; -inf: none there."""
    fall = (z - around(z)) / np.array([np.hypot(*step) for step in STEPS])[:, None, None]
    return np.where(np.isnan(fall), -np.inf, fall)


def undecided(z):
    """Cells with two ways down as steep, by D8 or on the two facets beside the steepest of the four straight ways."""
    fall = falls(z)
    steepest = np.sort(fall, axis=0)[-2:]
    beside = np.stack([fall[1::2], np.roll(fall[1::2], 1, axis=0)])
    with np.errstate(invalid="ignore"):  # -inf less -inf
        alike = np.abs(beside[0] - beside[1]) < APART
        level = steepest[1] - steepest[0] < APART
    on_facets = np.take_along_axis(alike, fall[::2].argmax(axis=0)[None], axis=0)[0]
    return (steepest[1] > 0) & (on_facets | level)


def drained(dem, folder):
    """The DEM without depressions, flats and ways down as steep as others."""
    out = {name: folder / f"{name}.sgrd" for name in ("filled", "directions", "basins")}
    command("saga_cmd", "-f=s", "ta_preprocessor", "4", "-ELEV", dem, "-FILLED", out["filled"], "-FDIR", out["directions"],
            "-WSHED", out["basins"], "-MINSLOPE", FILL_DEG)
    filled, cell = values_of(out["filled"].with_suffix(".sdat"))
    random = np.random.default_rng(1)
    noise = random.random(filled.shape)
    most = 0.9 * np.tan(np.radians(FILL_DEG)) * cell
    while (again := undecided(z := (filled + most * noise).astype(np.float32).astype(float))).any():
        again = maximum_filter(again, size=3)
        noise[again] = random.random(again.sum())
    return z


def border(z):
    """Cells on the grid's border or beside no data."""
    land = np.isfinite(z)
    return land & ~minimum_filter(land, size=3, mode="constant", cval=False)


class Saga:
    """Tools of SAGA on grids with room around the DEM."""

    def __init__(self, dem, folder):
        self.dem, self.folder, self.cell_m = dem, folder, values_of(dem)[1]

    def give(self, name, values, wall=None):
        """A file of values; wall: what stands around them."""
        padded = np.pad(values, ROOM, constant_values=np.nan)
        if wall is not None:
            land = np.isfinite(padded)
            padded[maximum_filter(land, size=3) & ~land] = wall
        return write(self.folder / f"{name}.tif", padded, self.dem, ROOM)

    def __call__(self, library, tool, *outputs, **options):
        """Values of the outputs."""
        paths = {key: self.folder / f"{key}.sgrd" for key in outputs}
        words = [word for key, value in {**options, **paths}.items() for word in (f"-{key}", value)]
        command("saga_cmd", "-f=s", library, tool, *words)
        found = [values_of(path.with_suffix(".sdat"))[0][ROOM:-ROOM, ROOM:-ROOM] for path in paths.values()]
        return found if len(found) > 1 else found[0]


class Flow:
    """D8 flow, cell by cell: receiver (-1: none), length of the step to it, and the cells in layers from the divides down."""

    def __init__(self, direction, cell_m):
        columns = direction.shape[1]
        code = direction.ravel()
        self.cell_m, self.known = cell_m, code != NO_CODE
        self.receiver, self.step_m = np.full(code.size, -1), np.zeros(code.size)
        for number, (row, column) in enumerate(STEPS):
            at = np.flatnonzero(code == 1 << number)
            self.receiver[at] = at + row * columns + column
            self.step_m[at] = cell_m * np.hypot(row, column)
        missing = np.bincount(self.receiver[self.receiver >= 0], minlength=code.size)
        self.layers, layer = [], np.flatnonzero(self.known & (missing == 0))
        while layer.size:
            self.layers.append(layer)
            below = self.receiver[layer]
            below = below[below >= 0]
            np.subtract.at(missing, below, 1)
            layer = np.unique(below[missing[below] == 0])

    def down(self, among=None):
        """Cells with a receiver and their receivers, layer by layer from the divides."""
        for layer in self.layers:
            cells = layer[self.receiver[layer] >= 0]
            cells = cells if among is None else cells[among[cells]]
            yield cells, self.receiver[cells]

    def up(self, among=None):
        return reversed(list(self.down(among)))

    def areas(self):
        area = self.known.astype(int)
        for cells, below in self.down():
            np.add.at(area, below, area[cells])
        return area

    def lengths(self):
        """Longest path from a divide, and path to where water leaves."""
        longest, to_outlet = np.zeros(self.known.size), np.zeros(self.known.size)
        for cells, below in self.down():
            np.maximum.at(longest, below, longest[cells] + self.step_m[cells])
        for cells, below in self.up():
            to_outlet[cells] = to_outlet[below] + self.step_m[cells]
        return longest, to_outlet

    def sources(self, rivers):
        """River cells into which none flows."""
        sources = rivers.copy()
        for _, below in self.down(rivers):
            sources[below] = False
        return sources

    def at_first(self, rivers, values):
        """Values of the first river cell on the path; NaN: it meets none."""
        found = np.where(rivers, values, np.nan)
        for cells, below in self.up(~rivers):
            found[cells] = found[below]
        return found

    def downstream_of(self, cells):
        mark = cells.copy()
        for above, below in self.down():
            mark[below[mark[above]]] = True
        return mark

    def orders(self, rivers):
        """Strahler's and Shreve's orders of river cells."""
        arriving = np.zeros((rivers.size, 20), np.int8)  # streams by order
        strahler, shreve = np.zeros(rivers.size, int), np.zeros(rivers.size, int)
        for layer in self.layers:
            layer = layer[rivers[layer]]
            streams = arriving[layer]
            highest = 19 - (streams[:, ::-1] > 0).argmax(axis=1)
            is_source = ~streams.any(axis=1)
            joined = np.take_along_axis(streams, highest[:, None], axis=1)[:, 0] > 1
            strahler[layer] = np.where(is_source, 1, highest + joined)
            shreve[layer] += is_source
            cells = layer[self.receiver[layer] >= 0]
            np.add.at(arriving, (self.receiver[cells], strahler[cells]), 1)
            np.add.at(shreve, self.receiver[cells], shreve[cells])
        return strahler, shreve


class Rivers:
    """River cells as profiles, and as links between confluences, named by their first cells: the last cell of each, and the
    links that flow into it (None: that end where water leaves)."""

    def __init__(self, flow, area, z):
        self.flow, self.area = flow, area
        rivers = area >= SUPPORT
        self.cells = rivers & ~(flow.sources(rivers) & (flow.receiver < 0))  # a river of one cell is none
        self.donors = {}
        for cells, below in flow.down(self.cells):
            for cell, receiver in zip(cells.tolist(), below.tolist()):
                self.donors.setdefault(receiver, []).append(cell)
        self.z, self.chi = z.copy(), np.zeros(z.size)
        for cells, below in flow.down(self.cells):
            np.minimum.at(self.z, below, self.z[cells])
        for cells, below in flow.up(self.cells):
            self.chi[cells] = self.chi[below] + flow.step_m[cells] * (area[cells] * flow.cell_m**2.0) ** -THETA
        self.last, self.above = {}, {}
        for first in np.flatnonzero(self.cells).tolist():
            if len(self.donors.get(first, ())) == 1 or flow.receiver[first] < 0:
                continue
            cell = first
            while (after := int(flow.receiver[cell])) >= 0 and len(self.donors[after]) == 1:
                cell = after
            self.last[first] = cell
            self.above.setdefault(after if after >= 0 and flow.receiver[after] >= 0 else None, []).append(first)

    def window(self, cell):
        """Cells of the main stem within reach upstream and downstream."""
        yield cell
        at, way = cell, 0.0
        while (after := self.flow.receiver[at]) >= 0 and (way := way + self.flow.step_m[at]) <= REACH_M:
            at = after
            yield at
        at, way = cell, 0.0
        while at in self.donors:
            at = max(self.donors[at], key=lambda donor: self.area[donor])
            if (way := way + self.flow.step_m[at]) > REACH_M:
                return
            yield at

    def steepness(self):
        ksn = np.full(self.z.size, np.nan)
        for cell in np.flatnonzero(self.cells):
            cells = list(self.window(cell))
            chi, z = (values[cells] - values[cells].mean() for values in (self.chi, self.z))
            ksn[cell] = (chi @ z) / (chi @ chi)
        return ksn

    def size(self, link):
        return self.area[self.last[link]]

    def divide(self, stem, sides, prefix, codes):
        """Codes a part of a basin: its main stem from the mouth up, and where on it which tributaries join."""
        if not sides:
            codes.update(dict.fromkeys(stem, prefix))
            return
        largest = sorted(sorted(sides, key=lambda side: -self.size(side[1]))[:4])
        bounds = [0, *(place + 1 for place, _ in largest), len(stem)]
        for number, (start, end) in enumerate(zip(bounds, bounds[1:])):
            lesser = [(place - start, link) for place, link in sides if start <= place < end and (place, link) not in largest]
            self.divide(stem[start:end], lesser, f"{prefix}{2 * number + 1}", codes)
        for number, (_, link) in enumerate(largest):
            self.code(link, f"{prefix}{2 * number + 2}", codes)

    def stem(self, mouth):
        """The main stem above the mouth of a link, and its tributaries."""
        stem, sides = [mouth], []
        while links := self.above.get(stem[-1]):
            main = max(links, key=self.size)
            sides += [(len(stem) - 1, link) for link in links if link != main]
            stem.append(main)
        return stem, sides

    def code(self, mouth, prefix, codes):
        """Codes all that drains to the mouth of a link."""
        self.divide(*self.stem(mouth), prefix, codes)

    def outlet(self, link):
        """The last cell of what a link flows into where water leaves."""
        last = self.last[link]
        return last if self.flow.receiver[last] < 0 else int(self.flow.receiver[last])

    def pfafstetter(self):
        """Codes of all links: rivers that end in one cell form one basin, as if they met a link without length there."""
        basins, codes = {}, {}
        for mouth in self.above.get(None, ()):
            basins.setdefault(self.outlet(mouth), []).append(mouth)
        for mouths in basins.values():
            main = max(mouths, key=self.size)
            stem, sides = self.stem(main)
            if len(mouths) > 1:
                sides = [*((0, link) for link in mouths if link != main), *((place + 1, link) for place, link in sides)]
                stem = [None, *stem]
            self.divide(stem, sides, "", codes)
        return codes

    def areas(self, links):
        """Areas of links, of which the first to end in a cell has also what reaches the outlet beside them."""
        areas = {link: self.area[self.last[link]] for link in links}
        seen = set()
        for link in links:
            outlet = self.outlet(link)
            if self.flow.receiver[outlet] < 0 and outlet not in seen:
                seen.add(outlet)
                others = sum(self.area[self.last[other]] for other in self.above.get(None, ()) if other != link
                             and self.outlet(other) == outlet)
                areas[link] = self.area[outlet] - others
        return np.array([areas[link] for link in links])


class Compared:
    """Measures held against those of peers."""

    def __init__(self, report):
        self.report, self.rows = report, []

    def __call__(self, measure, peer, ours, theirs, within=0.0, relative=False):
        """Both must have values in the same places, no further apart than this."""
        ours, theirs = np.ravel(ours), np.ravel(theirs)
        both = np.isfinite(ours) & np.isfinite(theirs)
        apart = np.abs(ours - theirs)[both] / (np.maximum(np.abs(theirs[both]), 1e-300) if relative else 1.0)
        alone = int((np.isfinite(ours) != np.isfinite(theirs)).sum())
        greatest = float(apart.max(initial=0.0))
        self.rows.append({"measure": measure, "peer": peer, "mean": float(ours[both].mean()) if both.any() else None,
                          "compared": int(both.sum()), "difference": greatest, "relative": relative, "within": within})
        self.report.at_least(f"{measure} compared", int(both.sum()), 1)
        self.report.unless(alone == 0, f"{measure} in other places", f"{peer}: {alone}")
        off = int((apart > within).sum())
        self.report.unless(off == 0, f"{measure} differs", f"{peer}: at {off} places, by up to {greatest}")

    def texts(self, measure, peer, ours, theirs):
        unlike = [f"{one}, not {other}" for one, other in zip(ours, theirs) if one != other]
        self.rows.append({"measure": measure, "peer": peer, "compared": len(ours), "different": len(unlike)})
        for words in unlike:
            self.report.fault(f"{measure} differs", f"{peer}: {words}")


def rows_of(path, name):
    """Rows of a layer; of lines also the first and the last point."""
    file = ogr.Open(str(path))  # kept alive: its layers die with it
    rows = []
    for feature in file.GetLayer(name):
        row, shape = feature.items(), feature.GetGeometryRef()
        if ogr.GT_Flatten(shape.GetGeometryType()) == ogr.wkbLineString:
            row["first"], row["last"] = shape.GetPoint_2D(0), shape.GetPoint_2D(shape.GetPointCount() - 1)
        rows.append(row)
    return rows


def column(rows, name):
    return np.array([np.nan if row[name] is None else row[name] for row in rows], float)


def compare_with_definitions(dem, z, measures, flow, compared, peer):
    """What follows from directions and heights on any DEM."""
    area, (up, down) = flow.areas(), flow.lengths()
    rivers, heights = area >= SUPPORT, z.ravel()
    profiles = Rivers(flow, area, heights)
    orders = flow.orders(rivers)
    compared("places of directions", peer, np.where(flow.known, 1, np.nan), np.where(np.isfinite(heights), 1, np.nan))
    for name, values, known, within in (
            ("area_d8", area * flow.cell_m**2, flow.known, 0), ("edge", flow.downstream_of(border(z).ravel()), flow.known, 0),
            ("length_up", up, flow.known, 0.5), ("length_down", down, flow.known, 1e-6),
            ("hand", heights - flow.at_first(rivers, heights), flow.known, 1e-3), ("strahler", orders[0], rivers, 0),
            ("shreve", orders[1], rivers, 0), ("chi", profiles.chi, profiles.cells, 1e-6),
            ("ksn", profiles.steepness(), profiles.cells, 1e-3)):
        compared(name, peer, values_of(measures / f"{name}.tif")[0], np.where(known, values, np.nan), within)
    compare_arcs(dem, measures, profiles, down, orders, compared, peer)


def compare_arcs(dem, measures, profiles, down, orders, compared, peer):
    west, cell, _, north, _, _ = gdal.Open(str(dem)).GetGeoTransform()
    columns = gdal.Open(str(dem)).RasterXSize
    arcs = rows_of(measures / "streams.gpkg", "arcs")
    links = [int((north - y) / cell) * columns + int((x - west) / cell) for x, y in (arc["first"] for arc in arcs)]
    compared.report.equal("first cells of arcs", sorted(links), sorted(profiles.last))
    if sorted(links) != sorted(profiles.last):
        return
    last = np.array([profiles.last[link] for link in links])
    mouth = np.where(profiles.flow.receiver[last] < 0, last, profiles.flow.receiver[last])
    length = down[links] - down[mouth]
    codes = profiles.pfafstetter()
    for name, values in (
            ("strahler", orders[0][last]), ("shreve", orders[1][last]), ("ds_area", profiles.areas(links) * cell**2),
            ("length", length), ("sinuosity", length / [np.hypot(*np.subtract(arc["first"], arc["last"])) for arc in arcs]),
            ("chi_up", profiles.chi[links]), ("chi_down", profiles.chi[mouth])):
        compared(f"arcs {name}", peer, column(arcs, name), values, 1e-6)
    compared.texts("arcs pfafstetter", peer, [arc["pfafstetter"] for arc in arcs], [codes[link] for link in links])


def compare_with_saga(z, measures, all_cells, flow, saga, compared):
    """Flow on a DEM that leaves SAGA no choice. Returns the lengths to the outlet that SAGA finds."""
    ours = {path.stem: values_of(path)[0] for path in measures.glob("*.tif")}
    land, leaves = np.isfinite(z), ~(falls(z) > 0).any(axis=0)
    bare, walled = saga.give("bare", z), saga.give("walled", z, np.nanmax(z) + 1e5)
    rivers = ours["area_d8"] >= SUPPORT * saga.cell_m**2
    segments, basins = saga.folder / "segments.shp", saga.folder / "basins.shp"
    ways, strahler = saga("ta_channels", 5, "DIRECTION", "ORDER", DEM=walled, THRESHOLD=1, SEGMENTS=segments, BASINS=basins)
    towards = np.where(land, np.where(leaves, LEAVES, 2.0 ** ((ways - 2) % 8)), np.nan)  # SAGA counts from the north
    compared("direction_d8", "SAGA ta_channels 5", ours["direction_d8"], towards)
    everywhere = values_of(all_cells / "strahler.tif")[0]
    compared("strahler of all cells", "SAGA ta_channels 5", everywhere, np.where(land, strahler, np.nan))
    area = saga("ta_hydrology", 0, "FLOW", ELEVATION=walled, METHOD=0, FLOW_UNIT=0)
    compared("area_d8", "SAGA ta_hydrology 0", ours["area_d8"], np.where(land, area * saga.cell_m**2, np.nan))
    sources = saga.give("sources", np.where(land, flow.sources(rivers.ravel()).reshape(z.shape), np.nan))
    shreve = saga("ta_hydrology", 0, "FLOW", ELEVATION=walled, WEIGHTS=sources, METHOD=0, FLOW_UNIT=0)
    compared("shreve", "SAGA ta_hydrology 0 of sources", ours["shreve"], np.where(rivers, shreve, np.nan))
    channels = saga.give("channels", np.where(rivers, 1.0, np.nan))
    hand = saga("ta_channels", 4, "DISTVERT", "DISTANCE", "DISTHORZ", ELEVATION=walled, CHANNELS=channels, METHOD=0)[0]
    compared("hand", "SAGA ta_channels 4", ours["hand"], np.where(np.isfinite(ours["hand"]), hand, np.nan), 1e-3)
    down = saga("ta_hydrology", 27, "DISTANCE", ELEVATION=bare, DIRECTION=0)
    compared("length_down", "SAGA ta_hydrology 27", ours["length_down"], down, 1)
    up = saga("ta_hydrology", 27, "DISTANCE", ELEVATION=bare, DIRECTION=1)
    compared("length_up", "SAGA ta_hydrology 27", ours["length_up"], up, 1)
    edge = saga("ta_hydrology", 13, "CONTAMINATION", ELEVATION=bare, METHOD=0)
    compared("edge", "SAGA ta_hydrology 13", ours["edge"], np.where(land, edge > 0, np.nan))
    aspect = saga("ta_morphometry", 0, "ASPECT", "SLOPE", ELEVATION=walled, METHOD=1)[0]
    bearing = np.where(land, np.where(leaves, -1, (np.pi / 2 - aspect) % (2 * np.pi)), np.nan)
    turn = np.pi - np.abs(np.pi - np.abs(ours["direction_dinf"] - bearing))
    compared("direction_dinf", "SAGA ta_morphometry 0", turn, np.where(land, 0, np.nan), 1e-5)
    parted = areas_along(bearing, z) * saga.cell_m**2
    compared("area_dinf", "SAGA ta_morphometry 0", ours["area_dinf"], parted, 1e-6 * np.nanmax(parted))
    return down


def areas_along(bearing, z):
    """Cells that drain through each, parted between the two neighbours that enclose its bearing."""
    rows, columns = z.shape
    steps = [row * columns + column for row, column in STEPS]
    way = (-bearing % (2 * np.pi) / (np.pi / 4)).ravel()
    way = np.where(np.abs(way - np.round(way)) < 1e-6, np.round(way), way)
    area = np.where(np.isfinite(z), 1.0, np.nan).ravel()
    order = np.argsort(-z, axis=None, kind="stable")
    for cell in order[np.isfinite(way[order]) & (bearing.ravel()[order] >= 0)]:
        number, share = divmod(way[cell], 1.0)
        area[cell + steps[int(number) % 8]] += (1 - share) * area[cell]
        if share > 0:
            area[cell + steps[int(number + 1) % 8]] += share * area[cell]
    return area.reshape(z.shape)


def compare_with_grass(dem, z, measures, down, saga, grass, compared):
    """Directions, slopes and the statistics of catchments."""
    grass("r.in.gdal", input=dem, output="dem")
    grass("g.region", raster="dem")
    grass("r.fill.dir", input="dem", output="filled", direction="ways", format="grass")
    ways = grass.raster("ways", saga.folder)  # [degrees] counterclockwise from the east
    inside = np.isfinite(z) & ~maximum_filter(border(z), size=3)
    compared("direction_d8", "GRASS r.fill.dir", np.where(inside, values_of(measures / "direction_d8.tif")[0], np.nan),
             np.where(inside, 2.0 ** (-ways / 45 % 8), np.nan))
    grass("r.slope.aspect", elevation="dem", slope="slope")
    slope = np.arctan(np.maximum(np.tan(np.radians(grass.raster("slope", saga.folder))), 0.001))
    area = saga.give("area", values_of(measures / "area_dinf.tif")[0])
    twi = saga("ta_hydrology", 20, "TWI", SLOPE=saga.give("slope", slope), AREA=area, CONV=1)
    compared("twi", "SAGA ta_hydrology 20 with GRASS r.slope.aspect", values_of(measures / "twi.tif")[0], twi, 1e-4)
    grass("r.in.gdal", input=write(saga.folder / "down.tif", down, dem), output="down")
    for layer, key in (("basins", "basin_id"), ("catchments", "arc_id")):
        compare_zones(dem, measures, layer, key, saga, grass, compared)


def compare_zones(dem, measures, layer, key, saga, grass, compared):
    zones = saga.folder / f"{layer}.tif"
    write(zones, np.full(values_of(dem)[0].shape, np.nan), dem)
    outlines = ogr.Open(str(measures / "catchments.gpkg"))
    raster = gdal.Open(str(zones), gdal.GA_Update)
    gdal.RasterizeLayer(raster, [1], outlines.GetLayer(layer), options=[f"ATTRIBUTE={key}"])
    del raster
    grass("r.in.gdal", input=zones, output=f"{layer}_read")
    grass("r.mapcalc", expression=f"{layer} = int({layer}_read)")
    found = {}
    for name in ("dem", "slope", "down"):
        head, *lines = grass("r.univar", flags="t", map=name, zones=layer).splitlines()
        for line in lines:
            words = dict(zip(head.split("|"), line.split("|")))
            found.setdefault(int(words["zone"]), {})[name] = words
    rows = rows_of(measures / "catchments.gpkg", layer)
    if layer == "catchments":
        codes = {arc["arc_id"]: arc["pfafstetter"] for arc in rows_of(measures / "streams.gpkg", "arcs")}
        compared.texts("catchments pfafstetter", "streams.gpkg", [row["pfafstetter"] for row in rows],
                       [codes[row["arc_id"]] for row in rows])

    def statistic(name, of):
        return np.array([float(found[row[key]].get(name, {}).get(of, "nan")) for row in rows])

    area, length = statistic("dem", "non_null_cells") * saga.cell_m**2, statistic("down", "range")
    low, mean, high = (statistic("dem", of) for of in ("min", "mean", "max"))
    with np.errstate(divide="ignore", invalid="ignore"):
        for name, values, within in (
                ("area", area, 0), ("z_min", low, 1e-4), ("z_mean", mean, 1e-4), ("z_max", high, 1e-4),
                ("hypsometric", (mean - low) / (high - low), 1e-6), ("melton", (high - low) / np.sqrt(area), 1e-6),
                ("slope_deg", statistic("slope", "mean"), 1e-3), ("flow_length", length, 1)):
            compared(f"{layer} {name}", "GRASS r.univar", column(rows, name), values, within)
        compared(f"{layer} form_factor", "GRASS r.univar", column(rows, "form_factor"), area / length**2, 1e-3, relative=True)


def main(dem, thalweg):
    report = Report()
    compared = Compared(report)
    with tempfile.TemporaryDirectory(prefix="thalweg-measures-") as folder:
        folder = pathlib.Path(folder)

        def measure(heights, name, what, support):
            command(thalweg, "measure", heights, "-o", folder / name, "--what", what, "--support", support, "-q")
            return folder / name

        def flow_of(measures):
            return Flow(gdal.Open(str(measures / "direction_d8.tif")).ReadAsArray(), values_of(dem)[1])

        given = measure(dem, "given", EVERYTHING, SUPPORT)
        compare_with_definitions(dem, values_of(dem)[0], given, flow_of(given), compared, "definition, with depressions")
        z = drained(dem, folder)
        dry = write(folder / "drained.tif", z, dem)
        report.equal("pits", int(((falls(z) <= 0).all(axis=0) & np.isfinite(z) & ~border(z)).sum()), 0)
        made, all_cells = measure(dry, "made", EVERYTHING, SUPPORT), measure(dry, "all_cells", "orders", 1)
        command(thalweg, "measure", dry, made / "streams.gpkg", "--what", "catchments", "-o", made, "-q")
        flow, saga = flow_of(made), Saga(dry, folder)
        compare_with_definitions(dry, z, made, flow, compared, "definition")
        down = compare_with_saga(z, made, all_cells, flow, saga, compared)
        with session(dry, folder):
            try:
                compare_with_grass(dry, z, made, down, saga, Grass(report), compared)
            except ModuleFailed as failure:
                report.fault("module_failed", failure)
    return report.close({"dem": dem, "compared": compared.rows})


if __name__ == "__main__":
    run(main, __doc__, 2)
