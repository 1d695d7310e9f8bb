#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_grass.py DEM MASK NETWORK.gpkg [recall=SHARE]: is the network a clean forest to GRASS, and does its water keep to the rivers?

One GRASS session in the DEM's CRS. Topology: read without snapping, v.clean's tools find nothing to touch, every node is
an arc's end, every arc is a bridge. Water: r.watershed -s gives D8 directions; r.path follows them from the
sources. The trace against the arcs by v.to.rast: precision >= 0.99, recall >= 0.95 within one cell; against MASK: F >= 0.98 in
the very cells; only where the topology is in order. Streams by area threshold are scored without a bar: a DEM may have more valleys than its rivers.
recall: of land drawn around its rivers more is asked: F >= 0.995 within one cell, and that share of the arcs' cells within
one cell of those through which 100 cells or more drain.
Prints one JSON line and exits with 1 on any violation, 2 when there is nothing to check."""
import contextlib
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal
from report import Report, command, run
from scipy.ndimage import distance_transform_edt

gdal.UseExceptions()
TOLERANCE = {0: 0.5, 1: 1.5, 2: 2.9}  # [cells] between centres
THRESHOLDS = (100, 200, 600, 1500)  # [cells]


def score(truth, found):
    """Precision, recall and F of `found` within 0, 1 and 2 cells of `truth`."""
    far = np.full(truth.shape, np.inf)
    to_truth = distance_transform_edt(~truth) if truth.any() else far
    to_found = distance_transform_edt(~found) if found.any() else far
    scores = {}
    for cells, reach in TOLERANCE.items():
        precision = float((to_truth[found] <= reach).mean()) if found.any() else 0.0
        recall = float((to_found[truth] <= reach).mean()) if truth.any() else 0.0
        both = precision + recall
        scores[cells] = {"P": round(precision, 4), "R": round(recall, 4), "F": round(2 * precision * recall / both, 4) if both else 0.0}
    return scores


@contextlib.contextmanager
def session(dem, folder):
    """A location in the DEM's CRS, for as long as the block runs."""
    place = folder / "location"
    command("grass", "-c", dem, "-e", place)
    sys.path.insert(0, command("grass", "--config", "python_path").stdout.strip())
    from grass.script import setup  # GRASS says only when asked where its modules are

    with setup.init(str(folder), "location", "PERMANENT"):
        yield


class ModuleFailed(RuntimeError):
    pass


class Grass:
    """Modules of the session."""

    def __init__(self, report):
        self.report = report

    def __call__(self, module, **options):
        flags = options.pop("flags", "")
        words = [module, *[f"-{flag}" for flag in flags], *[f"{key.rstrip('_')}={value}" for key, value in options.items()]]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise ModuleFailed(f"{' '.join(words)}: {done.stderr.strip()[-300:]}")
        if module in ("v.in.ogr", "r.in.gdal"):
            warned = [line for line in done.stderr.splitlines() if "WARNING" in line or "ERROR" in line]
            self.report.unless(not warned, "warning", f"{module}: {' '.join(warned)[:300]}")
        return done.stdout

    def counts(self, vector):
        lines = self("v.info", flags="t", map=vector).split()
        return {key: int(value) for key, value in (line.split("=") for line in lines)}

    def raster(self, name, folder):
        path = folder / f"{name}.tif"
        self("r.out.gdal", flags="cf", input=name, output=path, type="Float64", nodata=-1e300)
        values = gdal.Open(str(path)).ReadAsArray()
        return np.where(values == -1e300, np.nan, values)


def check_topology(grass, network, report):
    grass("v.in.ogr", input=network, layer="arcs", output="arcs", snap=-1)
    grass("v.in.ogr", input=network, layer="nodes", output="nodes", snap=-1)
    arcs, nodes = grass.counts("arcs"), grass.counts("nodes")
    report.unless(arcs["lines"] > 0, "no_arcs", network)
    report.equal("nodes_at_arc_ends", arcs["nodes"], nodes["points"])
    for tool in ("rmline", "rmdupl", "break", "snap"):  # break gives up where a line has no length
        threshold = 0.001 if tool == "snap" else 0
        grass("v.clean", input="arcs", output=f"clean_{tool}", error=f"error_{tool}", tool=tool, threshold=threshold, type="line")
        left, errors = grass.counts(f"clean_{tool}")["lines"], grass.counts(f"error_{tool}")
        touched = errors["points"] + errors["lines"]
        report.unless(left == arcs["lines"] and touched == 0, f"clean_{tool}", f"{arcs['lines']} lines to {left}, {touched} touched")
    grass("v.net", input="arcs", output="net", operation="nodes", flags="c")
    grass("v.net.bridge", input="net", output="bridges", method="bridge")
    bridges = grass.counts("bridges")["lines"]
    report.equal("bridges", bridges, arcs["lines"])
    distances = grass("v.distance", flags="p", from_="nodes", to="net", from_type="point", to_type="point", upload="dist")
    off = sum(float(line.split("|")[1]) > 0 for line in distances.splitlines()[1:])
    report.equal("nodes_off_arc_ends", off, 0)
    return {"arcs": arcs["lines"], "nodes": nodes["points"], "bridges": bridges}


def check_water(grass, dem, mask, network, recall, folder, report):
    grass("r.in.gdal", input=dem, output="dem")
    grass("g.region", raster="dem")
    grass("v.in.ogr", input=network, layer="nodes", where="kind='source'", output="sources", snap=-1)
    grass("v.to.rast", input="arcs", output="drawn", use="val", value=1, type="line")
    grass("r.watershed", flags="sa", elevation="dem", accumulation="area", drainage="towards", memory=1000)
    grass("r.mapcalc", expression="direction = if(abs(towards) > 0, abs(towards), null())")
    grass("r.path", input="direction", format="auto", start_points="sources", raster_path="trace")
    drawn, trace = (np.isfinite(grass.raster(name, folder)) for name in ("drawn", "trace"))
    area = grass.raster("area", folder)
    honoured = gdal.Open(mask).ReadAsArray() == 1
    against_arcs, against_mask = score(drawn, trace), score(honoured, trace)
    report.at_least("precision_at_one_cell", against_arcs[1]["P"], 0.99)
    report.at_least("recall_at_one_cell", against_arcs[1]["R"], 0.95)
    report.at_least("f_in_network_cells", against_mask[0]["F"], 0.98)
    by_area = {cells: score(drawn, area >= cells)[1] for cells in THRESHOLDS}
    if recall is not None:
        report.at_least("f_at_one_cell", against_arcs[1]["F"], 0.995)
        report.at_least("recall_by_area", by_area[THRESHOLDS[0]]["R"], recall)
    return {"trace_against_arcs": against_arcs, "trace_against_mask": against_mask[0], "threshold_against_arcs": by_area}


def main(dem, mask, network, recall=None):
    report = Report()
    grass = Grass(report)
    figures = {"network": network}
    with tempfile.TemporaryDirectory(prefix="thalweg-grass-") as folder, session(dem, pathlib.Path(folder)):
        try:
            figures.update(check_topology(grass, network, report))
            if not report.counts.total():
                figures.update(check_water(grass, dem, mask, network, recall and float(recall.removeprefix("recall=")), pathlib.Path(folder), report))
        except ModuleFailed as failure:
            report.fault("module_failed", failure)
    return report.close(figures)


if __name__ == "__main__":
    run(main, __doc__, 3, 4)
