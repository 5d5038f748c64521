# Opens each file after `--` in Blender and prints a JSON line on what it became.
# blender -b --factory-startup --python blender.py -- FILE…
import collections
import json
import os
import sys

import numpy

numpy.__dict__.setdefault("bool", bool)  # Debian's Blender 3.4 reads glTF by a name that its numpy no longer has

import bmesh
import bpy
import mathutils


def open_file(path):
    kind = os.path.splitext(path)[1]
    if kind in (".glb", ".gltf"):
        bpy.ops.import_scene.gltf(filepath=path, merge_vertices=True)
    elif kind == ".ply":
        bpy.ops.import_mesh.ply(filepath=path)
    elif kind == ".stl":
        bpy.ops.import_mesh.stl(filepath=path)
    elif kind == ".obj":
        bpy.ops.wm.obj_import(filepath=path)
    elif kind == ".vdb":
        bpy.ops.object.volume_import(filepath=path)


def facts(thing):
    corners = [thing.matrix_world @ mathutils.Vector(corner) for corner in thing.bound_box]
    found = {"size": [max(c[axis] for c in corners) - min(c[axis] for c in corners) for axis in range(3)]}
    if thing.type == "VOLUME":
        thing.data.grids.load()
        found["grids"] = [grid.name for grid in thing.data.grids]
    elif thing.type == "MESH":
        mesh = bmesh.new()
        mesh.from_mesh(thing.data)
        found["triangles"] = len(mesh.faces)
        found["open"] = sum(1 for edge in mesh.edges if len(edge.link_faces) != 2)
        found["sharp"] = sum(1 for edge in mesh.edges if not edge.smooth)
        found["volume"] = mesh.calc_volume(signed=True)
        found["materials"] = sorted(material.name for material in thing.data.materials)
        found["charts"] = len(thing.data.uv_layers)
        # glTF has a vertex once for each normal: what is closed is closed by position.
        sides = collections.Counter()
        for face in mesh.faces:
            corners = [tuple(vert.co) for vert in face.verts]
            for a, b in zip(corners, corners[1:] + corners[:1]):
                sides[min(a, b), max(a, b)] += 1 if a < b else -1
        found["open_welded"] = sum(1 for balance in sides.values() if balance != 0)
    return found


def tree(thing):
    """The object's name, what it knows of its shape, and what hangs on it."""
    known = {key: value for key, value in thing.items() if isinstance(value, (str, int, float))}
    return {"name": thing.name, "known": known, "below": [tree(child) for child in thing.children]}


arguments = sys.argv[sys.argv.index("--") + 1 :]
as_tree = arguments[0] == "--tree"
for path in arguments[as_tree:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    open_file(path)
    if as_tree:
        roots = [tree(thing) for thing in bpy.data.objects if thing.parent is None]
        triangles = sum(len(thing.data.polygons) for thing in bpy.data.objects if thing.type == "MESH")
        found = {"roots": roots, "triangles": triangles}
        print("FACTS " + json.dumps({"file": os.path.basename(path), **found}))
        continue
    for thing in bpy.data.objects:
        print("FACTS " + json.dumps({"file": os.path.basename(path), **facts(thing)}))
