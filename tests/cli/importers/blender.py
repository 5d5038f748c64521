# Opens each file after `--` in Blender and prints a JSON line on what it became.
# blender -b --factory-startup --python blender.py -- FILE…
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
    return found


for path in sys.argv[sys.argv.index("--") + 1 :]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    open_file(path)
    for thing in bpy.data.objects:
        print("FACTS " + json.dumps({"file": os.path.basename(path), **facts(thing)}))
