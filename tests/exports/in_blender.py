# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""blender -b --factory-startup --python in_blender.py -- FILE ...: what Blender reads of each, as one line of JSON.

Meshes: vertices, edges, edges and vertices without a face, faces, the corners of the box around them in Blender's frame (Z
up), and the pictures of their materials. Pictures: size, and the lowest and highest value of the first channel."""
import json
import sys

import bpy
import numpy

numpy.bool = bool  # the glTF importer of Blender 3.4 wants it, numpy 1.24 has it no more


def pictures_of(thing):
    nodes = [node for slot in thing.material_slots if slot.material and slot.material.use_nodes
             for node in slot.material.node_tree.nodes if node.type == "TEX_IMAGE" and node.image]
    return [{"size": list(node.image.size), "read": node.image.size[0] > 0,
             "to": [link.to_socket.name for link in node.outputs["Color"].links]} for node in nodes]


def mesh(thing):
    data = thing.data
    places = numpy.empty(3 * len(data.vertices), numpy.float32)
    data.vertices.foreach_get("co", places)
    turned = numpy.array(thing.matrix_world)
    places = places.reshape(-1, 3) @ turned[:3, :3].T + turned[:3, 3]
    in_faces = {key for face in data.polygons for key in face.edge_keys}
    return {"name": thing.name, "vertices": len(data.vertices), "edges": len(data.edges), "faces": len(data.polygons),
            "loose_edges": len(data.edges) - len(in_faces), "low": places.min(axis=0).tolist(),
            "high": places.max(axis=0).tolist(), "uv": bool(data.uv_layers), "pictures": pictures_of(thing)}


def picture(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    first = values[::image.channels]
    return {"size": list(image.size), "low": float(first.min()), "high": float(first.max()),
            "north_west": float(first.reshape(image.size[1], -1)[-1, 0])}  # rows begin at the bottom


READERS = {"glb": lambda path: bpy.ops.import_scene.gltf(filepath=path),
           "obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
           "stl": lambda path: bpy.ops.import_mesh.stl(filepath=path)}
read = {}
for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ending = path.rsplit(".", 1)[1]
    if ending in READERS:
        READERS[ending](path)
        read[path] = [mesh(thing) for thing in bpy.data.objects if thing.type == "MESH"]
    else:
        read[path] = picture(path)
print("\nread " + json.dumps(read))
