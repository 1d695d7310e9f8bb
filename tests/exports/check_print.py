#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_print.py STL LONGEST_MM BASE_MM: is it a solid that a slicer takes as it is? Read by meshio and ADMesh."""
import pathlib
import re
import sys

import meshio

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "clients"))
import check_export  # noqa: E402
import report  # noqa: E402

WELL = {"Total disconnected facets": 0, "Number of parts": 1, "Degenerate facets": 0, "Edges fixed": 0, "Facets removed": 0,
        "Facets added": 0, "Facets reversed": 0, "Backwards edges": 0, "Normals fixed": 0}


def main(path, longest_mm, base_mm):
    found = report.Report()
    mesh = meshio.read(path)
    figures = check_export.check_solid(found, mesh)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    found.unless((low == 0).all(), "corner", f"{low}, not the origin")
    found.unless(abs(max(high[:2]) - float(longest_mm)) < 1e-3, "longest", f"{high} mm, not {longest_mm}")
    base = mesh.points[mesh.points[:, 2] > 0, 2].min()
    found.unless(abs(base - float(base_mm)) < 1e-3, "base", f"{base} mm, not {base_mm}")
    said = report.command("admesh", path, errors="replace").stdout  # it prints memory beyond the header
    for name, wanted in WELL.items():
        number = re.search(rf"{name} *: *(\d+)", said)
        found.equal("admesh", (name, number and int(number[1])), (name, wanted))
    return found.close({**figures, "size_mm": [round(float(length), 3) for length in high]})


if __name__ == "__main__":
    report.run(main, __doc__, 3)
