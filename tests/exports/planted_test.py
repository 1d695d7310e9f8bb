#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""planted_test.py CHECK FOLDER EXPORTS: does check_CHECK.py find each fault planted in a copy of EXPORTS?

CHECK: export, programs or print. FOLDER: what the exports show. EXPORTS: what check_export.py left; for print the folder of
print3d. Exits with 1 when a fault goes unseen or EXPORTS itself is not good."""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO
import PIL.Image

HERE = pathlib.Path(__file__).resolve().parent


def png(change):
    def plant(place):
        samples = numpy.array(PIL.Image.open(place / "a.png")).astype(numpy.int64)
        changed = numpy.clip(change(samples), 0, 65535).astype(numpy.uint16)
        PIL.Image.fromarray(changed).save(place / "a.png")
    return plant


def raw(name, kind, change):
    def plant(place):
        change(numpy.fromfile(place / name, kind)).astype(kind).tofile(place / name)
    return plant


def exr(change, kind="float", channel="Y"):
    def plant(place):
        image = OpenImageIO.ImageInput.open(str(place / "a.exr"))
        heights = change(image.read_image("float"))
        image.close()
        form = OpenImageIO.ImageSpec(heights.shape[1], heights.shape[0], 1, kind)
        form.channelnames = (channel,)
        out = OpenImageIO.ImageOutput.create(str(place / "a.exr"))
        out.open(str(place / "a.exr"), form)
        out.write_image(heights)
        out.close()
    return plant


FACET = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])


def stl(change, name="a.stl"):
    def plant(place):
        data = (place / name).read_bytes()
        facets = change(numpy.frombuffer(data[84:], FACET).copy())
        (place / name).write_bytes(data[:80] + struct.pack("<I", len(facets)) + facets.tobytes())
    return plant


def corners(change):
    def turn(facets):
        facets["corners"] = change(facets["corners"])
        return facets
    return turn


def lifted(facets):
    """One facet, so that it hangs beside its neighbours."""
    facets["corners"][len(facets) // 2] += numpy.float32(0.25)
    return facets


def one_ulp(heights):
    middle = tuple(length // 2 for length in heights.shape)
    heights[middle] = numpy.nextafter(heights[middle], numpy.float32(1e9))
    return heights


def glb(change):
    """Changes the bytes of a GLB."""
    def plant(place):
        (place / "a.glb").write_bytes(change(bytearray((place / "a.glb").read_bytes())))
    return plant


def longer(data):
    data[8:12] = struct.pack("<I", len(data) + 4)
    return data


def scene(change):
    """Changes the JSON of a GLB, which must not become longer."""
    def turn(data):
        length, = struct.unpack_from("<I", data, 12)
        text = json.loads(data[20:20 + length])
        change(text)
        data[20:20 + length] = json.dumps(text, separators=(",", ":")).encode().ljust(length)
        return data
    return glb(turn)


def view_too_long(text):
    text["bufferViews"][0]["byteLength"] = text["buffers"][0]["byteLength"] + 4


def index_beyond(data):
    """The first index of the first triangle."""
    length, = struct.unpack_from("<I", data, 12)
    text = json.loads(data[20:20 + length])
    accessor = text["accessors"][text["meshes"][0]["primitives"][0]["indices"]]
    at = 28 + length + text["bufferViews"][accessor["bufferView"]]["byteOffset"]
    data[at:at + 4] = struct.pack("<I", 2**31)
    return data


def no_rivers(text):
    del text["nodes"][1]["mesh"]


def no_texture(text):
    del text["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]


def lines(name, change):
    def plant(place):
        text = (place / name).read_text().splitlines(keepends=True)
        (place / name).write_text("".join(change(text)))
    return plant


def raised(text):
    """The vertices of an OBJ, by more than heights may differ."""
    return [f"v {x} {float(y) + 0.03} {z}\n" if kind == "v" else line
            for line in text for kind, x, y, z in [(line.split() + [""] * 4)[:4]]]


def told(name, **other):
    def plant(place):
        path = place / f"{name}.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), **other}))
    return plant


def without(name):
    return lambda place: (place / name).unlink()


OF_A_SOLID = [
    ("edges of one triangle", lambda facets: facets[1:]),
    ("edges of one triangle", lifted),
    ("edges run through twice the same way", lambda facets: numpy.append(facets, facets[:1])),
    ("volume", corners(lambda places: places[:, ::-1])),
]
PLANTED = {
    "export": [
        ("more than half a step", png(lambda samples: samples + 1)),
        ("more than half a step", png(numpy.flipud)),
        ("raw is not the PNG", raw("a.raw", "<u2", lambda samples: numpy.where(samples > 40000, samples - 1, samples))),
        ("size", png(lambda samples: samples[1:])),
        ("other heights", raw("a.r32", "<f4", one_ulp)),
        ("other heights", exr(one_ulp)),
        ("other heights", exr(numpy.fliplr)),
        ("exr", exr(lambda heights: heights, kind="half")),
        ("exr", exr(lambda heights: heights, channel="R")),
        ("cells are not kept", raw("b.r32", "<f4", lambda heights: heights + numpy.float32(0.01))),
        ("heights of the OBJ", lines("a.obj", raised)),
        ("no texture", without("a_texture.png")),
        ("glb header", glb(longer)),
        ("glb header", glb(lambda data: data[:-4])),
        ("view beyond the buffer", scene(view_too_long)),
        *[(fault, stl(plant)) for fault, plant in OF_A_SOLID],
    ],
    "programs": [
        ("gltf", glb(index_beyond)),
        ("rivers", scene(no_rivers)),
        ("texture", scene(no_texture)),
        ("texture", without("a_texture.png")),
        ("vertices", told("a.glb", vertices=5)),
        ("triangles", told("a.obj", triangles=5)),
        ("river_lines", told("a.glb", river_lines=2)),
        ("triangles", stl(lambda facets: facets[1:])),
        ("box", stl(corners(lambda places: 1000 * places))),
        ("box", stl(corners(lambda places: places[:, :, [0, 2, 1]]))),
        ("box", lines("a.obj", raised)),
        ("heights", exr(lambda heights: heights + numpy.float32(0.01))),
        ("size", exr(lambda heights: heights[1:])),
        ("heights", png(lambda samples: numpy.minimum(samples, 65534))),
    ],
    "print": [
        *[(fault, stl(plant, "terrain.stl")) for fault, plant in OF_A_SOLID],
        ("admesh", stl(lambda facets: facets[1:], "terrain.stl")),
        ("admesh", stl(corners(lambda places: places[:, ::-1]), "terrain.stl")),
        ("corner", stl(corners(lambda places: places + numpy.float32(1)), "terrain.stl")),
        ("longest", stl(corners(lambda places: places * numpy.float32(0.001)), "terrain.stl")),
        ("base", stl(corners(lambda places: places * numpy.float32([1, 1, 1.1])), "terrain.stl")),
    ],
}
COMMANDS = {
    "export": lambda folder, place: [HERE.parent / "clients/check_export.py", "false", folder, place],
    "programs": lambda folder, place: [HERE / "check_programs.py", place],
    "print": lambda folder, place: [HERE / "check_print.py", place / "terrain.stl", "150", "3"],
}


def faults_in(check, folder, place):
    done = subprocess.run(list(map(str, COMMANDS[check](folder, place))), capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        return {f"exit {done.returncode}: {done.stderr.strip()[-300:]}"}
    return set(json.loads(done.stdout)["violations"])


def main(check, folder, exports):
    exports = pathlib.Path(exports)
    unseen = [f"{exports} itself has {fault}" for fault in sorted(faults_in(check, folder, exports))]
    for fault, plant in PLANTED[check]:
        with tempfile.TemporaryDirectory(prefix="thalweg-planted-") as place:
            copy = pathlib.Path(place) / "exports"
            shutil.copytree(exports, copy)
            plant(copy)
            seen = faults_in(check, folder, copy)
        if fault not in seen:
            unseen.append(f"{fault} planted, {sorted(seen)} found")
    print(json.dumps({"planted": len(PLANTED[check]), "unseen": unseen}))
    return 1 if unseen else 0


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in PLANTED:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
