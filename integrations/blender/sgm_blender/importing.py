"""Brings a built `.glb` into the scene in place: objects stay, their meshes are replaced, and what the user made of them
(transforms, modifiers, materials) is kept."""
import collections
import json
import re

import bpy
from mathutils import Matrix

from . import link

NODE, MATRIX, SLOTS, ABSENT = "sgm.node", "sgm.matrix", "sgm.slots", "sgm.absent"
MATERIAL, LOOK = "sgm.material", "sgm.look"
NUMBERED = re.compile(r"\.\d{3}$")
COARSE = re.compile(r"_LOD[1-9]$")
COLLIDER = re.compile(r"-(conv)?colonly$")


def plain_name(name):
    """The name in the file: without the number that Blender gives to a second of a name."""
    return NUMBERED.sub("", name)


def read_file(path):
    """The objects and materials of a .glb, not yet in order. The scene's selection and active object stay."""
    import numpy

    numpy.__dict__.setdefault("bool", bool)  # Debian's Blender 3.4 reads glTF by a name that its numpy no longer has
    objects, materials = set(bpy.data.objects), set(bpy.data.materials)
    layer = bpy.context.view_layer
    active, selected = layer.objects.active, [thing for thing in layer.objects if thing.select_get()]
    bpy.ops.import_scene.gltf(filepath=path, merge_vertices=True)
    for thing in layer.objects:
        thing.select_set(thing in selected)
    layer.objects.active = active
    return [thing for thing in bpy.data.objects if thing not in objects], [m for m in bpy.data.materials if m not in materials]


def principled(material):
    nodes = material.node_tree.nodes if material.use_nodes and material.node_tree else []
    return next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)


def look_of(material):
    """A text for what sgm sets in a material; it differs as soon as the user changes the material."""
    node = principled(material)
    if node is None:
        return ""
    values = [[round(v, 4) for v in node.inputs["Base Color"].default_value]]
    values += [round(node.inputs[name].default_value, 4) for name in ("Roughness", "Metallic")]
    return json.dumps([values, len(material.node_tree.nodes), len(material.node_tree.links)])


def is_own(material):
    """Whether a material is one that sgm made and nobody has changed."""
    return material is not None and MATERIAL in material and material[LOOK] == look_of(material)


def refresh(material, fresh):
    node, new = principled(material), principled(fresh)
    for name in ("Base Color", "Roughness", "Metallic"):
        node.inputs[name].default_value = new.inputs[name].default_value
    material.diffuse_color = fresh.diffuse_color
    material[LOOK] = look_of(material)


def slots_of(thing):
    """[(the file's name, link, material)] of an object of a model."""
    names = json.loads(thing.get(SLOTS, "[]"))
    return [(name, slot.link, slot.material) for name, slot in zip(names, thing.material_slots)]


class Materials:
    """Which material a slot of the file gets: what stood in the object's slot of that name, else what most of the model's
    objects have there, else the file's."""

    def __init__(self, root, fresh):
        self._usual = collections.defaultdict(collections.Counter)
        for thing in link.members(root):
            for name, _, material in slots_of(thing):
                if material is not None:
                    self._usual[name][material] += 1
        for material in fresh:
            material[MATERIAL] = plain_name(material.name)
            material[LOOK] = look_of(material)
        for material in fresh:
            for own in self._usual[material[MATERIAL]]:
                if is_own(own):
                    refresh(own, material)

    def give(self, thing, before):
        """Puts materials into the slots of an object with its new mesh; `before` is slots_of it with the old one."""
        kept = {name: (kind, material) for name, kind, material in before}
        names = [slot.material[MATERIAL] if slot.material else "" for slot in thing.material_slots]
        fresh = [slot.material for slot in thing.material_slots]
        for slot, name, new in zip(thing.material_slots, names, fresh):
            kind, material = kept.get(name, ("DATA", None))
            if name not in kept:
                material = self._usual[name].most_common(1)[0][0] if self._usual[name] else new
            slot.link = kind
            slot.material = material
        thing[SLOTS] = json.dumps(names)


def _material_names(mesh):
    """The file's names of a new mesh's materials, read before any slot changes: instances share the mesh."""
    return [material[MATERIAL] if material else "" for material in mesh.materials]


def has_work(thing):
    """Whether the user put work into an object that would be lost with it."""
    mine = any(material is not None and not is_own(material) for _, _, material in slots_of(thing))
    guests = any(child.get(link.MODEL) != thing.get(link.MODEL) for child in thing.children)
    return bool(thing.modifiers) or bool(thing.constraints) or thing.animation_data is not None or mine or guests


def place(thing, basis):
    """Puts an object where the file has it; what the user moved it by stays."""
    if MATRIX in thing:
        last = Matrix([thing[MATRIX][row * 4 : row * 4 + 4] for row in range(4)])
        moved = thing.matrix_basis
        same = all(abs(a - b) < 1e-4 for x, y in zip(last, moved) for a, b in zip(x, y))
        if not same:
            thing.matrix_basis = basis @ last.inverted_safe() @ moved
        else:
            thing.matrix_basis = basis
    else:
        thing.matrix_basis = basis
    thing[MATRIX] = [number for row in basis for number in row]


def remove(thing):
    data = thing.data
    for child in list(thing.children):
        world = child.matrix_world.copy()
        child.parent = thing.parent
        child.matrix_world = world
    bpy.data.objects.remove(thing)
    if data is not None and data.users == 0 and isinstance(data, bpy.types.Mesh):
        bpy.data.meshes.remove(data)


def relink(thing, collections):
    for collection in list(thing.users_collection):
        collection.objects.unlink(thing)
    for collection in collections:
        collection.objects.link(thing)


def _adopt(root, thing, key, parent):
    """A new object of the file becomes a member of the model."""
    thing[link.MODEL], thing[NODE] = root[link.ROOT], key
    basis = thing.matrix_basis.copy()
    thing.parent = parent
    relink(thing, root.users_collection)
    place(thing, basis)
    if COARSE.search(key):
        thing.hide_viewport = thing.hide_render = True
    if COLLIDER.search(key):
        thing.display_type, thing.hide_render = "WIRE", True
    return thing


def _replace(old, new, parent):
    """An object that was there takes the new one's mesh and facts; returns the mesh that it had."""
    before = old.data
    if old.type == "MESH":
        old.data = new.data
    for name, value in new.items():
        if not name.startswith(link.PREFIX):
            old[name] = value
    if old.parent is None or old.parent.get(link.MODEL) == old.get(link.MODEL):
        old.parent = parent
    place(old, new.matrix_basis.copy())
    if ABSENT in old:
        old.hide_viewport = old.hide_render = False
        del old[ABSENT]
    return before


def _leave(thing):
    """What the file no longer has goes; where the user put work into it, it waits hidden and empty."""
    if not has_work(thing):
        remove(thing)
        return
    if ABSENT in thing:
        return
    before = slots_of(thing)
    if thing.type == "MESH":
        empty = bpy.data.meshes.new(thing.data.name)
        for _, _, material in before:
            empty.materials.append(material)
        thing.data = empty
    thing[ABSENT] = True
    thing.hide_viewport = thing.hide_render = True


def _top_first(things):
    """Parents before their children."""

    def depth(thing):
        return 0 if thing.parent is None else 1 + depth(thing.parent)

    return sorted(things, key=lambda thing: (depth(thing), thing.name))


def update(root, path):
    """Brings the model below `root` to what the file holds. Returns the names of the objects that are new."""
    new, fresh = read_file(path)
    materials = Materials(root, fresh)
    old = {thing[NODE]: thing for thing in link.members(root) if NODE in thing}
    befores = {thing.name: slots_of(thing) for thing in old.values()}
    names = {thing.data.name: _material_names(thing.data) for thing in new if thing.type == "MESH"}
    parents = {thing.name: thing.parent.name if thing.parent else "" for thing in new}
    at, gone, made, placed, spent = {}, {}, [], [], []
    for thing in _top_first(new):
        key, parent = plain_name(thing.name), at.get(parents[thing.name], root)
        mesh, was = (thing.data if thing.type == "MESH" else None), old.pop(key, None)
        if was is not None and (was.type == "MESH") != (mesh is not None):
            _leave(was)
            was = None
        if was is None:
            at[thing.name] = _adopt(root, thing, key, parent)
            made.append(thing.name)
        else:
            at[thing.name] = was
            before = _replace(was, thing, parent)
            if mesh is not None and before is not mesh:
                gone.setdefault(before.name, (before, mesh))
            spent.append(thing)
        if mesh is not None:
            placed.append((at[thing.name], mesh))
    for thing in spent:
        bpy.data.objects.remove(thing)
    for thing in old.values():
        _leave(thing)
    _give_materials(materials, placed, names, befores)
    _drop_meshes(gone)
    for material in fresh:
        if material.users == 0:
            bpy.data.materials.remove(material)
    return made


def clear(root):
    """Takes away the meshes of a model that has none any more."""
    for thing in link.members(root):
        if NODE in thing:
            _leave(thing)


def _give_materials(materials, placed, names, befores):
    """Instances share a mesh and its slots: what the first of them has counts for the mesh, an object's own link for it."""
    done = set()
    for thing, mesh in placed:
        before = befores.get(thing.name, [])
        if mesh.name in done:
            thing[SLOTS] = json.dumps(names[mesh.name])
            for slot, kept in zip(thing.material_slots, _object_links(before, names[mesh.name])):
                if kept is not None:
                    slot.link, slot.material = "OBJECT", kept
            continue
        done.add(mesh.name)
        materials.give(thing, before)


def _object_links(before, names):
    own = {name: material for name, kind, material in before if kind == "OBJECT"}
    return [own.get(name) for name in names]


def _drop_meshes(gone):
    """The user's own duplicates that showed an old mesh show the new one."""
    for before, after in gone.values():
        name = before.name
        if before.users > 0:
            before.user_remap(after)
        bpy.data.meshes.remove(before)
        after.name = name
