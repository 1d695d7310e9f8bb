#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_foreign_files.py THALWEG: do files that other programs write keep their rivers?

A tree of 13 rivers with heights (45 km), made by formula, is written by ogr2ogr, GRASS and QGIS in their formats and after their
operations. `thalweg check --fix` reads each file, `thalweg make` some of them; of the arcs that come back the length, the direction by the nearest
line of the tree, the outlets and the heights at its vertices are compared with it. A tree that is changed must be told from it.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import math
import os
import pathlib
import subprocess
import tempfile

from osgeo import gdal, ogr, osr
from report import Report, command, run

gdal.UseExceptions()
ogr.UseExceptions()
UTM = 32632
WEST, SOUTH = 500000.0, 5200000.0
LOWEST = 112.5
NODES = {"o": (6000, 0), "a": (6200, 3500), "b": (4500, 6500), "c": (8300, 6600), "d": (3000, 9300), "e": (7500, 9800), "h1": (800, 5200),
         "h2": (1200, 11500), "h3": (3600, 12600), "h4": (6100, 12300), "h5": (8600, 12900), "h6": (11500, 9400), "h7": (10600, 3000), "h8": (5600, 8900)}
REACHES = "h7a h1b h2d h3d db h8b ba h4e h5e ec h6c ca ao"
# What each program keeps of the heights at vertices: to some millimetres, or not at all.
EXACT, NONE = 0.011, None
FORMATS = {  # ending: words of ogr2ogr, heights
    "dxf": (("-f", "DXF"), EXACT),
    "dgn": (("-f", "DGN"), EXACT),
    "gml": (("-f", "GML", "-dsco", "FORMAT=GML2"), EXACT),
    "kml": (("-f", "KML"), EXACT),
    "gpx": (("-f", "GPX", "-nlt", "MULTILINESTRING25D", "-lco", "FORCE_GPX_TRACK=YES", "-dsco", "GPX_USE_EXTENSIONS=YES", "-t_srs", "EPSG:4326"), EXACT),
    "gmt": (("-f", "OGR_GMT"), EXACT),
    "csv": (("-f", "CSV", "-lco", "GEOMETRY=AS_WKT"), EXACT),
    "tab": (("-f", "MapInfo File"), NONE),
    "shp": (("-f", "ESRI Shapefile", "-dim", "XYZM", "-lco", "SHPT=ARCZ"), EXACT),
    "fgb": (("-f", "FlatGeobuf"), EXACT),
    "geojson": (("-f", "GeoJSON", "-dialect", "SQLite", "-sql", "select st_union(geom) from rivers"), EXACT),
}
AS_METRES = {"dxf", "dgn", "csv"}  # these hold no CRS
PARTS = {"union.geojson"}  # one feature: check, which numbers arcs by features, finds ids twice (exit 3)
AGAINST = {"reversed.gpkg"}  # drawn upstream: check finds them so (exit 3)
QGIS = """
import sys
sys.path.append('/usr/share/qgis/python/plugins')
from qgis.core import QgsApplication
app = QgsApplication([], False)
app.initQgis()
import processing
from processing.core.Processing import Processing
Processing.initialize()
rivers, place = sys.argv[1:]
processing.run('native:dissolve', {'INPUT': rivers, 'OUTPUT': place + '/dissolved.gpkg'})
processing.run('native:multiparttosingleparts', {'INPUT': place + '/dissolved.gpkg', 'OUTPUT': place + '/parts.shp'})
processing.run('native:splitlinesbylength', {'INPUT': rivers, 'LENGTH': 777.0, 'OUTPUT': place + '/pieces.fgb'})
processing.run('native:reverselinedirection', {'INPUT': rivers, 'OUTPUT': place + '/reversed.gpkg'})
app.exitQgis()
"""
GRASS = """
v.in.ogr input={rivers} output=rivers --quiet
v.clean input=rivers output=cleaned tool=break,snap,rmdupl threshold=0,1,0 --quiet
v.out.ogr input=cleaned output={place}/cleaned.shp format=ESRI_Shapefile type=line lco=SHPT=ARCZ --quiet
"""


def length(line):
    return sum(math.dist(a[:2], b[:2]) for a, b in zip(line, line[1:]))


def source():
    """The rivers, downstream, with falling heights: [(x, y, z), ...] of each."""
    shapes = {}
    for k, word in enumerate(REACHES.split()):
        up, down = word[:-1], word[-1]
        (x0, y0), (x1, y1) = NODES[up], NODES[down]
        across = math.dist((x0, y0), (x1, y1))
        count = max(12, int(across / 100))
        aside = [(60 + 10 * (k % 4)) * math.sin(math.pi * (3 + k % 3) * i / count) * math.sin(math.pi * i / count) / across for i in range(count + 1)]
        shapes[up] = down, [(WEST + x0 + (x1 - x0) * i / count - (y1 - y0) * w, SOUTH + y0 + (y1 - y0) * i / count + (x1 - x0) * w)
                            for i, w in enumerate(aside)]

    def to_outlet(node):
        return length(shapes[node][1]) + to_outlet(shapes[node][0]) if node in shapes else 0.0

    rivers = []
    for up, (_, line) in shapes.items():
        left = to_outlet(up)
        rivers.append([(x, y, round(LOWEST + 0.012 * d + 1e-6 * d * d, 3)) for i, (x, y) in enumerate(line) for d in [max(0.0, left - length(line[:i + 1]))]])
    return rivers


def write(rivers, path):
    place = osr.SpatialReference()
    place.ImportFromEPSG(UTM)
    dataset = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = dataset.CreateLayer("rivers", place, ogr.wkbLineString25D)
    layer.CreateField(ogr.FieldDefn("name", ogr.OFTString))
    for k, line in enumerate(rivers):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature["name"] = f"River {k + 1}"
        shape = ogr.Geometry(ogr.wkbLineString25D)
        for point in line:
            shape.AddPoint(*point)
        feature.SetGeometry(shape)
        layer.CreateFeature(feature)


def arcs_of(path):
    dataset = ogr.Open(str(path))
    return [(feature["ds_arc"], feature.GetGeometryRef().GetPoints()) for feature in dataset.GetLayerByName("arcs")]


class Tree:
    """The rivers as segments and vertices, to find the nearest."""

    def __init__(self, rivers):
        self.length = sum(map(length, rivers))
        self.segments = [pair for line in rivers for pair in zip(line, line[1:])]
        self.vertices = [point for line in rivers for point in line]

    def nearest(self, x, y):
        def away(pair):
            (ax, ay, _), (bx, by, _) = pair
            share = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
            share = min(1.0, max(0.0, share))
            return math.dist((x, y), (ax + share * (bx - ax), ay + share * (by - ay)))

        best = min(self.segments, key=away)
        return best, away(best)

    def differences(self, arcs, heights, reach=60.0):
        """In words, how arcs differ from the rivers; what lies more than `reach` away is an outlet that was carried on."""
        along = against = 0.0
        off = 0.0
        seen = 0
        for _, line in arcs:
            for a, b in zip(line, line[1:]):
                (u, v), away = self.nearest((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
                if away <= reach:
                    along += math.dist(a[:2], b[:2])
                    against += math.dist(a[:2], b[:2]) * ((b[0] - a[0]) * (v[0] - u[0]) + (b[1] - a[1]) * (v[1] - u[1]) < 0)
            if heights is not None:
                for point in line:
                    wanted = min(self.vertices, key=lambda vertex: math.dist(vertex[:2], point[:2]))
                    if math.dist(wanted[:2], point[:2]) < 0.02:
                        seen += 1
                        off = max(off, abs(point[2] - wanted[2]))
        outlets = sum(down in (0, -1, None) for down, _ in arcs)
        said = []
        if abs(along - self.length) > 0.003 * self.length:
            said.append(f"length {along:.0f} m, not {self.length:.0f}")
        if against > 0.001 * self.length:
            said.append(f"{against:.0f} m run against the rivers")
        if outlets != 1:
            said.append(f"{outlets} outlets, not 1")
        if heights is not None and (off > heights or seen < 0.9 * len(self.vertices)):
            said.append(f"heights of {seen} of {len(self.vertices)} vertices, off by up to {off:.3f} m")
        return said


def check_told_apart(rivers, tree, report):
    arcs = [(0 if k + 1 == len(rivers) else 1, line) for k, line in enumerate(rivers)]
    report.unless(not tree.differences(arcs, EXACT), "unlike_itself", tree.differences(arcs, EXACT))
    changed = {"lost": arcs[1:], "turned": [(0 if i == 0 else d, line[::-1] if i == 3 else line) for i, (d, line) in enumerate(arcs)],
               "outlets": [(0, line) for _, line in arcs], "raised": [(d, [(x, y, z + 0.1) for x, y, z in line]) for d, line in arcs]}
    for kind, found in changed.items():
        report.unless(tree.differences(found, EXACT), "not_told_apart", kind)


def write_files(rivers, place):
    """Path of each file: what it keeps of heights."""
    files = {}
    for ending, (words, heights) in FORMATS.items():
        path = place / f"{'union' if ending == 'geojson' else 'net'}.{ending}"
        command("ogr2ogr", *words, path, rivers)
        files[path] = heights
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": str(place), "QGIS_CUSTOM_CONFIG_PATH": str(place)}
    (place / "operations.py").write_text(QGIS)
    command("/usr/bin/python3", place / "operations.py", rivers, place, env=environment)
    (place / "operations.sh").write_text(GRASS.format(rivers=rivers, place=place))
    command("grass", "-e", "-c", f"EPSG:{UTM}", place / "location")
    command("grass", place / "location/PERMANENT", "--exec", "sh", place / "operations.sh")
    return files | {place / name: EXACT for name in ("parts.shp", "pieces.fgb", "reversed.gpkg", "cleaned.shp")}


def main(thalweg):
    report = Report()
    rivers = source()
    tree = Tree(rivers)
    check_told_apart(rivers, tree, report)
    with tempfile.TemporaryDirectory(prefix="thalweg-foreign-") as folder:
        place = pathlib.Path(folder)
        write(rivers, place / "rivers.gpkg")
        files = write_files(place / "rivers.gpkg", place)
        for path, heights in files.items():
            given = ("--source-crs", f"EPSG:{UTM}") if path.suffix[1:] in AS_METRES else ()
            jobs = {"make": ((0,), ("make", path, "-o", place / f"made_{path.name}", "--only", "network", "--set", "grid.cell=50", *given))}
            if path.name not in AGAINST:  # check --fix goes by the drawn direction
                jobs["check"] = ((3,) if path.name in PARTS else (0,), ("check", path, "--fix", place / f"fixed_{path.name}.gpkg", *given))
            for kind, (exits, words) in jobs.items():
                done = subprocess.run([thalweg, *map(str, words)], capture_output=True, text=True, check=False)
                if done.returncode not in exits:
                    report.fault(f"{kind}_exit", f"{path.name}: {done.returncode}: {done.stderr[-300:]}")
                    continue
                made = place / f"made_{path.name}/network.gpkg" if kind == "make" else place / f"fixed_{path.name}.gpkg"
                kept = heights if kind == "check" or heights is None else 2.0  # two vertices of a cell of 50 m have one height
                for difference in tree.differences(arcs_of(made), kept):
                    report.fault("not_as_it_was", f"{kind} {path.name}: {difference}")
    return report.close({"files": len(files), "length_m": round(tree.length, 3)})


if __name__ == "__main__":
    run(main, __doc__, 1)
