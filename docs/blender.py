# Draws a picture with Blender's path tracer: the palace from its .glb, a cumulus from its fog in a .vdb.
# blender -b --factory-startup --python docs/blender.py -- PALACE.glb CUMULUS.vdb PICTURE.png
import math
import os
import sys

import numpy

numpy.__dict__.setdefault("bool", bool)  # Debian's Blender 3.4 reads glTF by a name that its numpy no longer has

import bpy
from mathutils import Vector

palace, cloud, picture = (os.path.abspath(name) for name in sys.argv[sys.argv.index("--") + 1 :])


def material(name, shader, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(shader)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    socket = "Volume" if "Volume" in shader else "Surface"
    tree.links.new(node.outputs[0], output.inputs[socket])
    return made


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene

bpy.ops.import_scene.gltf(filepath=palace, merge_vertices=True)
house = next(thing for thing in bpy.data.objects if thing.type == "MESH")
corners = [house.matrix_world @ Vector(corner) for corner in house.bound_box]
low, high = (Vector(pick(c[axis] for c in corners) for axis in range(3)) for pick in (min, max))
middle, reach = (low + high) / 2, max(high - low)

bpy.ops.object.volume_import(filepath=cloud, align="WORLD", location=(0, 0, 0))
fog = next(thing for thing in bpy.data.objects if thing.type == "VOLUME")
fog.rotation_euler = (math.pi / 2, 0, 0)  # the file's y is up
fog.scale = (0.13, 0.13, 0.13)  # a small cloud, near
fog.location = (205, 215, 72)
fog.data.materials.append(
    material("cloud", "ShaderNodeVolumePrincipled", Density=0.3, Color=(0.98, 0.98, 0.98, 1), Anisotropy=0.5))

bpy.ops.mesh.primitive_plane_add(size=4000, location=(0, 0, low.z + 0.02))
bpy.context.object.data.materials.append(
    material("grass", "ShaderNodeBsdfDiffuse", Color=(0.15, 0.17, 0.11, 1)))

scene.world = bpy.data.worlds.new("day")
scene.world.use_nodes = True
nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
sky = nodes.new("ShaderNodeTexSky")
sky.sky_type, sky.sun_elevation, sky.sun_rotation, sky.sun_intensity = "NISHITA", math.radians(32), math.radians(150), 0.5
links.new(sky.outputs[0], nodes["Background"].inputs[0])
nodes["Background"].inputs[1].default_value = 0.12

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.location = middle + reach * Vector((-1, -1.75, -0.02))
towards = middle + reach * Vector((0.08, 0, 0.14))
camera.rotation_euler = (towards - camera.location).to_track_quat("-Z", "Y").to_euler()
camera.data.lens, camera.data.clip_end = 34, 10000

scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = 160, False
scene.cycles.max_bounces, scene.cycles.volume_bounces, scene.cycles.volume_step_rate = 6, 10, 2
scene.view_settings.look = "Medium High Contrast"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 960, 540, 100
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
