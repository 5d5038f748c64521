"""Volumes: a fog `.vdb` as an object below the root. The file stays on the disk, beside the .blend."""
import hashlib
import math
import os
import re
import shutil

import bpy
from mathutils import Matrix

from . import importing, link

CLOUD = "sgm.cloud"
UPRIGHT = Matrix.Rotation(math.pi / 2, 4, "X")  # the file's y is up


def folder():
    """Where volumes are kept: `sgm` beside the .blend, or Blender's own for this session while it isn't saved."""
    beside = os.path.dirname(bpy.data.filepath) if bpy.data.filepath else bpy.app.tempdir
    return os.path.join(beside, "sgm")


def arguments(root):
    given = {"grids": "fog", "wisps": root.sgm.wisps, "edge": root.sgm.edge}
    return [part for name, value in given.items() for part in ("--format-option", f"{name}={value}")]


def keep_file(root, path, label=""):
    """Moves a volume to where it stays, under a name that changes with what it holds, for Blender remembers files by name."""
    os.makedirs(folder(), exist_ok=True)
    with open(path, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()[:12]
    stem = re.sub(r"\W+", "_", os.path.splitext(root.name)[0]) + "_" + root[link.ROOT][:6]
    kept = os.path.join(folder(), f"{stem}_{label or digest}.vdb")
    shutil.move(path, kept)
    return kept


def blend_path(path):
    return bpy.path.relpath(path) if bpy.data.filepath else path


def cloud_of(root):
    return next((thing for thing in link.members(root) if CLOUD in thing), None)


def update(root, path):
    """Shows the volume of a file in place of the one before: the object, its transform, modifiers and materials stay."""
    kept = keep_file(root, path)
    data = bpy.data.volumes.new(os.path.splitext(root.name)[0] + " fog")
    data.filepath = blend_path(kept)
    thing = cloud_of(root)
    if thing is None:
        thing = add(root, data)
        data.materials.append(fog_material(root, data))
    else:
        before = thing.data
        for material in before.materials:
            data.materials.append(material)
        for setting in ("display", "render"):
            _copy_settings(getattr(before, setting), getattr(data, setting))
        thing.data = data
        _drop(before, kept)
    importing.place(thing, UPRIGHT)
    return thing


def add(root, data):
    thing = bpy.data.objects.new(data.name, data)
    thing[link.MODEL] = root[link.ROOT]
    thing[CLOUD] = True
    thing.parent = root
    for collection in root.users_collection:
        collection.objects.link(thing)
    return thing


def _copy_settings(given, taken):
    for name in given.bl_rna.properties.keys():
        if not given.is_property_readonly(name):
            setattr(taken, name, getattr(given, name))


def _drop(data, kept):
    """Removes a volume and its file, unless something else shows it."""
    path = os.path.realpath(bpy.path.abspath(data.filepath))
    if data.users == 0:
        bpy.data.volumes.remove(data)
    shown = {os.path.realpath(bpy.path.abspath(other.filepath)) for other in bpy.data.volumes}
    ours = os.path.dirname(path) == os.path.realpath(folder())
    if ours and path not in shown and path != os.path.realpath(kept) and os.path.exists(path):
        os.remove(path)


def remove(root):
    thing = cloud_of(root)
    if thing is not None and not importing.has_work(thing):
        data = thing.data
        bpy.data.objects.remove(thing)
        _drop(data, "")


def fog_material(root, data):
    """A Principled Volume whose density lets light through the height of the cloud a few times over."""
    made = bpy.data.materials.new("fog")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeVolumePrincipled")
    shader.inputs["Color"].default_value = (0.98, 0.98, 0.98, 1)
    shader.inputs["Anisotropy"].default_value = 0.5
    shader.inputs["Density"].default_value = 30 / max(longest_side(data), 1e-3)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Volume"])
    return made


def longest_side(data):
    """Metres of the volume's longest side, by a trial object: a volume alone knows no box."""
    trial = bpy.data.objects.new("trial", data)
    bpy.context.scene.collection.objects.link(trial)
    bpy.context.view_layer.update()
    corners = [tuple(corner) for corner in trial.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box]
    bpy.data.objects.remove(trial)
    return max(max(c[axis] for c in corners) - min(c[axis] for c in corners) for axis in range(3))
