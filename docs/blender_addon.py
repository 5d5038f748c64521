# Draws the picture of docs/blender.md: models built by the add-on, one with a material of the user's, traced by Cycles.
# blender -b --factory-startup --python docs/blender_addon.py -- ADDON.zip SGM FOLDER      writes FOLDER/a.png
import math
import os
import shutil
import sys

import addon_utils
import bpy
from mathutils import Vector

archive, sgm, folder = (os.path.abspath(name) for name in sys.argv[sys.argv.index("--") + 1 :])
shutil.unpack_archive(archive, folder)
sys.path.insert(0, folder)
bpy.ops.wm.read_factory_settings(use_empty=True)
addon = addon_utils.enable("sgm_blender", default_set=True)
bpy.context.preferences.addons["sgm_blender"].preferences.program = sgm
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "scene.blend"))
scene = bpy.context.scene


def add(grammar, location, settings=None, **values):
    bpy.ops.sgm.add(filepath=os.path.abspath(f"examples/{grammar}"))
    root = bpy.context.object
    root.location = location
    for name, value in (settings or {}).items():
        setattr(root.sgm, name, value)
    for name, value in values.items():
        root[addon.link.property_name(name)] = value
    addon.jobs.request(root, 0)
    addon.jobs.wait()
    assert not any(m.severity == "error" for m in addon.jobs.messages[root["sgm.root"]])
    return root


def principled(name, color, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    node = made.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return made


fine = {"resolution": 256}
add("tower.sgm", (-32, 14, 0), fine, floors=5, bulge="convex", peak=0.0)
middle = add("tower.sgm", (0, 0, 0), {**fine, "divide": "symbols", "symbols": "Storey,Roof"})
add("tower.sgm", (34, 16, 0), fine, floors=15, bulge="concave", bays=4)
copper = principled("copper", (0.12, 0.42, 0.36), Metallic=0.6, Roughness=0.35)
for thing in addon.link.members(middle):
    for slot in thing.material_slots:
        if slot.material and slot.material["sgm.material"] == "color_a4503a":
            slot.material = copper
middle["sgm.floors"] = 10  # built again: the copper stays
addon.jobs.request(middle, 0)
addon.jobs.wait()

cloud = add("cumulus.sgm", (60, 330, 110), {"form": "cloud", "resolution": 160, "edge": 60})
cloud.scale = (0.16, 0.16, 0.16)
fog = addon.clouds.cloud_of(cloud).data.materials[0].node_tree.nodes["Principled Volume"]
fog.inputs["Density"].default_value = 0.35

ground = bpy.data.meshes.new("ground")
ground.from_pydata([(-3000, -3000, 0), (3000, -3000, 0), (3000, 3000, 0), (-3000, 3000, 0)], [], [(0, 1, 2, 3)])
ground.materials.append(principled("grass", (0.13, 0.16, 0.09), Roughness=1))
scene.collection.objects.link(bpy.data.objects.new("ground", ground))
bpy.data.objects["ground"].location.z = -2.79

scene.world = bpy.data.worlds.new("day")
scene.world.use_nodes = True
nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
sky = nodes.new("ShaderNodeTexSky")
sky.sky_type, sky.sun_elevation, sky.sun_rotation, sky.sun_intensity = "NISHITA", math.radians(30), math.radians(140), 0.5
links.new(sky.outputs[0], nodes["Background"].inputs[0])
nodes["Background"].inputs[1].default_value = 0.085

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.location = (-22, -88, 9)
camera.rotation_euler = (Vector((4, 0, 22)) - camera.location).to_track_quat("-Z", "Y").to_euler()
camera.data.lens, camera.data.clip_end = 30, 10000

scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = int(os.environ.get("SAMPLES", "128")), False
scene.cycles.max_bounces, scene.cycles.volume_bounces, scene.cycles.volume_step_rate = 6, 8, 2
scene.view_settings.look = "Medium High Contrast"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 960, 600, 100
scene.render.filepath = os.path.join(folder, "a.png")
bpy.ops.render.render(write_still=True)
