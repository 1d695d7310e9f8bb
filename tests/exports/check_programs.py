#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_programs.py EXPORTS: what 3D programs say of the exports in a folder, which check_export.py left there.

Khronos' validator finds no error in a GLB. Blender imports GLB, OBJ and STL with as many vertices and triangles as FILE.json
says, in metres, each with its texture, a GLB with its rivers; pictures have their heights."""
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "clients"))
import report  # noqa: E402

PLACE_M = 0.01  # 32-bit floats of 50 km


def validator_on(paths):
    return json.loads(report.command("node", HERE / "validate.mjs", *paths).stdout)


def blender_on(paths):
    done = report.command("blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python", HERE / "in_blender.py",
                          "--", *paths)
    return json.loads(next(line for line in done.stdout.splitlines() if line.startswith("read ")).removeprefix("read "))


def check_box(found, told, things):
    """The terrain in Blender's frame, which is that of an STL: x east, y north, z up."""
    half = [0.5 * length for length in told["size_m"]]
    top = (told["max_m"] - told["min_m"]) * told["exaggeration"]
    floor = -told.get("base_m", 0.0) * told["exaggeration"]
    for corner, wanted in (("low", [-half[0], -half[1], floor]), ("high", [half[0], half[1], top])):
        off = max(abs(a - b) for a, b in zip(things[0][corner], wanted))
        found.unless(off <= PLACE_M, "box", f"{told['format']}: {things[0][corner]}, not {wanted}")


def check_mesh(found, told, things):
    kind = told["format"]
    terrain = [thing for thing in things if thing["faces"] > 0]
    if len(terrain) != 1:
        found.fault("terrain", f"{kind}: {len(terrain)} meshes with faces")
        return
    found.equal("vertices", (kind, terrain[0]["vertices"]), (kind, told["vertices"]))
    found.equal("triangles", (kind, terrain[0]["faces"]), (kind, told["triangles"]))
    found.equal("loose_edges", (kind, terrain[0]["loose_edges"]), (kind, 0))
    if kind == "stl" or told["cells_without_data"] == 0 or "without_data_m" in told:  # holes may reach the rim
        check_box(found, told, terrain)
    if kind != "stl":
        shown = [picture for picture in terrain[0]["pictures"] if picture["read"] and "Base Color" in picture["to"]]
        found.equal("texture", (kind, len(shown)), (kind, 1))
        found.unless(terrain[0]["uv"], "uv", kind)
    rivers = [thing for thing in things if thing["faces"] == 0]
    found.equal("rivers", (kind, len(rivers) > 0), (kind, told.get("river_lines", 0) > 0))
    for thing in rivers:
        found.equal("river_lines", thing["vertices"] - thing["loose_edges"], told["river_lines"])  # of n vertices, n - 1 edges


def check_picture(found, told, picture):
    kind = told["format"]
    found.equal("size", (kind, picture["size"]), (kind, [told["width"], told["height"]]))
    scale = 1.0 if kind == "exr" else told["max_m"] - told["min_m"]
    base = 0.0 if kind == "exr" else told["min_m"]
    for end in ("low", "high"):
        height = base + scale * picture[end]
        wanted = told["min_m" if end == "low" else "max_m"]
        found.unless(abs(height - wanted) <= 1e-6 * scale + 1e-6 * abs(wanted), "heights", f"{kind}: {height}, not {wanted}")


def main(folder):
    found = report.Report()
    paths = [path for path in sorted(pathlib.Path(folder).iterdir()) if path.suffix in (".glb", ".obj", ".stl", ".exr", ".png")
             and path.with_name(path.name + ".json").exists()]
    glbs = [path for path in paths if path.suffix == ".glb"]
    found.at_least("glb", len(glbs), 1)
    warnings = {}
    for path, issues in validator_on(glbs).items():
        for issue in issues["messages"]:
            if issue["severity"] == 0:
                found.fault("gltf", f"{path}: {issue['code']} {issue['message']}")
        warnings[pathlib.Path(path).name] = issues["numWarnings"]
    if found.counts:
        return found.close({})
    read = blender_on(paths)
    for path in paths:
        told = json.loads(path.with_name(path.name + ".json").read_text())
        (check_picture if path.suffix in (".exr", ".png") else check_mesh)(found, told, read[str(path)])
    return found.close({"read": [path.name for path in paths], "warnings_of_gltf": warnings})


if __name__ == "__main__":
    report.run(main, __doc__, 1)
