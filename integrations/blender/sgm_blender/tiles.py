"""A baked city: each object of its library once, as a collection; a collection a cell, which holds the cell's ground and an
instance of a library's collection at every place. Cells and objects whose files are the same are left as they are."""
import json
import os
import shutil
import struct
import tempfile
import time

import bpy
from bpy.app.handlers import persistent
from mathutils import Matrix, Quaternion, Vector

from . import importing, jobs, program

ROOT, FOLDER = "sgm.tiles", "sgm.folder"
CELL, DIGEST, OBJECT = "sgm.cell", "sgm.digest", "sgm.object"
SLICE_S = 0.1  # how long a step of the interface may bring cells in
imports = {}  # root's name → Import
messages = {}  # root's name → what the last import told


def root_of(thing):
    """The root of the city that an object belongs to, or None."""
    while thing is not None and ROOT not in thing:
        thing = thing.parent
    return thing


def read_header(path):
    """The JSON of a .glb, and the bytes behind it."""
    with open(path, "rb") as file:
        data = file.read()
    magic, _, _, length, _ = struct.unpack_from("<4sIIII", data)
    if magic != b"glTF":
        raise ValueError(f"{path} is no .glb")
    return json.loads(data[20 : 20 + length]), data[20 + length :]


def upright(node):
    """Where a node of glTF stands in Blender: z up."""
    x, y, z = node.get("translation", (0, 0, 0))
    rx, ry, rz, rw = node.get("rotation", (0, 0, 0, 1))
    return Matrix.Translation((x, -z, y)) @ Quaternion((rw, rx, -rz, ry)).to_matrix().to_4x4()


def object_file(gltf, mesh):
    """The library's file that holds a mesh, relative to the cell's; "" for the cell's own."""
    accessor = gltf["accessors"][gltf["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"]]
    return gltf["buffers"][gltf["bufferViews"][accessor["bufferView"]]["buffer"]].get("uri", "")


def nodes_of(gltf):
    """[(node, object_file of its mesh)] of a cell."""
    return [(node, object_file(gltf, node["mesh"])) for node in gltf["nodes"][1:]]


class Materials:
    """The materials of a city, each once, by name and look."""

    def __init__(self, city):
        self._known = {}
        for collection in city.children_recursive:
            for thing in collection.objects:
                for slot in thing.material_slots:
                    if slot.material is not None and importing.MATERIAL in slot.material:
                        self._known.setdefault(self._key(slot.material), slot.material)

    @staticmethod
    def _key(material):
        return material[importing.MATERIAL], material[importing.LOOK]

    def share(self, things, fresh):
        """Replaces new materials by those that are there already."""
        for material in fresh:
            material[importing.MATERIAL] = importing.plain_name(material.name)
            material[importing.LOOK] = importing.look_of(material)
        for thing in things:
            names = [slot.material[importing.MATERIAL] if slot.material else "" for slot in thing.material_slots]
            for slot in thing.material_slots:
                if slot.material is not None:
                    slot.material = self._known.setdefault(self._key(slot.material), slot.material)
            thing[importing.SLOTS] = json.dumps(names)
        for material in fresh:
            if material.users == 0:
                bpy.data.materials.remove(material)


def read_objects(path, materials):
    """The objects of a .glb, in no collection, with the city's materials."""
    things, fresh = importing.read_file(path)
    materials.share(things, fresh)
    for thing in things:
        importing.relink(thing, ())
    return things


def child(parent, name, key):
    """The collection below another one that is known by a key, made where there is none."""
    for collection in parent.children:
        if collection.get(CELL) == key:
            return collection
    made = bpy.data.collections.new(name)
    made[CELL] = key
    parent.children.link(made)
    return made


def exclude(collection):
    """Keeps a collection out of the view: what is an instance of what it holds stays visible."""

    def visit(layer):
        if layer.collection == collection:
            layer.exclude = True
        for below in layer.children:
            visit(below)

    for scene in bpy.data.scenes:
        for view_layer in scene.view_layers:
            visit(view_layer.layer_collection)


def empty_out(collection):
    for thing in list(collection.objects):
        mesh = thing.data
        bpy.data.objects.remove(thing)
        if mesh is not None and mesh.users == 0:
            bpy.data.meshes.remove(mesh)


class City:
    """The collections of a city in the scene, and what it takes to bring a cell in."""

    def __init__(self, root):
        self.root, self.folder = root, bpy.path.abspath(root[FOLDER])
        self.collection = root.users_collection[0]
        with open(os.path.join(self.folder, "manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)
        self.library = child(self.collection, self.collection.name + " library", "library")
        exclude(self.library)
        self.objects = {each[OBJECT]: each for each in self.library.children if OBJECT in each}
        self.materials = Materials(self.collection)

    def cells(self):
        """[(X_Z, digest)] of the finest cells."""
        return [(key[2:], facts["digest"]) for key, facts in sorted(self.manifest["cells"].items()) if key.startswith("0/")]

    def object(self, file):
        """The library's collection for a file; read with its first use."""
        key = os.path.splitext(os.path.basename(file))[0]
        if key not in self.objects:
            things = read_objects(os.path.join(self.folder, "blender", "cells", file), self.materials)
            made = bpy.data.collections.new(f"{importing.plain_name(things[0].name)} {key[:6]}")
            made[OBJECT] = key
            for thing in things:
                made.objects.link(thing)
            self.library.children.link(made)
            self.objects[key] = made
        return self.objects[key]

    def bring(self):
        """Brings the scene to what the folder holds; yields what it does, step by step. All that is read by the importer comes
        before the places, for it takes longer the more objects there are."""
        changed = [(name, digest) for name, digest in self.cells() if self._collection(name).get(DIGEST) != digest]
        cells = {}
        for at, (name, _) in enumerate(changed):
            yield f"reads cell {at + 1} of {len(changed)}"
            cells[name] = read_header(os.path.join(self.folder, "blender", "cells", name + ".glb"))[0]
        files = list(dict.fromkeys(file for gltf in cells.values() for _, file in nodes_of(gltf) if file))
        for at, file in enumerate(files):
            yield f"object {at + 1} of {len(files)}"
            self.object(file)
        for at, (name, _) in enumerate(changed):
            yield f"ground {at + 1} of {len(changed)}"
            self._ground(name, cells[name])
        for at, (name, digest) in enumerate(changed):
            yield f"cell {at + 1} of {len(changed)}"
            self._places(name, cells[name])
            self._collection(name)[DIGEST] = digest
        self.forget()

    def _collection(self, name):
        return child(self.collection, f"{self.collection.name} {name}", name)

    def _places(self, name, gltf):
        collection, cell = self._collection(name), upright(gltf["nodes"][0])
        for at, (node, file) in enumerate(nodes_of(gltf)):
            if not file:
                continue
            source = self.object(file)
            kind = source.name.rsplit(" ", 1)[0]
            thing = bpy.data.objects.new(f"{kind} {name} {at}", None)
            thing.instance_type, thing.instance_collection = "COLLECTION", source
            thing.empty_display_size = 0.5
            for key, value in node.get("extras", {}).items():
                thing[key] = value
            thing.parent, thing.matrix_basis = self.root, cell @ upright(node)
            collection.objects.link(thing)

    def _ground(self, name, gltf):
        """The importer reads the ground alone: places are no meshes of their own here. The user's materials stay."""
        collection = self._collection(name)
        kept = [slot for thing in collection.objects for slot in importing.slots_of(thing)]
        empty_out(collection)
        node = next((node for node, file in nodes_of(gltf) if not file), None)
        if node is None:
            return
        _, rest = read_header(os.path.join(self.folder, "blender", "cells", name + ".glb"))
        alone = {**gltf, "nodes": [{**gltf["nodes"][0], "children": [1]}, node]}
        header = json.dumps(alone).encode()
        header += b" " * (-len(header) % 4)
        with tempfile.TemporaryDirectory(prefix="sgm-") as folder:
            path = os.path.join(folder, "ground.glb")
            with open(path, "wb") as file:
                file.write(struct.pack("<4sIIII", b"glTF", 2, 20 + len(header) + len(rest), len(header), 0x4E4F534A))
                file.write(header + rest)
            things = read_objects(path, self.materials)
        bpy.context.view_layer.update()
        for thing in sorted(things, key=lambda each: each.type):  # the empty above the mesh comes first and goes
            if thing.type != "MESH":
                above = thing.matrix_basis.copy()
                bpy.data.objects.remove(thing)
                continue
            thing.parent, thing.matrix_basis = self.root, above @ thing.matrix_basis
            thing.name = f"ground {collection[CELL]}"
            own = {name: material for name, _, material in kept if material is not None and not importing.is_own(material)}
            for slot, name in zip(thing.material_slots, json.loads(thing[importing.SLOTS])):
                slot.material = own.get(name, slot.material)
            collection.objects.link(thing)

    def forget(self):
        """Takes away cells that the folder no longer has, and objects that no place shows."""
        known = {name for name, _ in self.cells()} | {"library"}
        for collection in list(self.collection.children):
            if CELL in collection and collection[CELL] not in known:
                empty_out(collection)
                bpy.data.collections.remove(collection)
        used = {thing.instance_collection for thing in bpy.data.objects if thing.instance_type == "COLLECTION"}
        for collection in list(self.library.children):
            if OBJECT in collection and collection not in used:
                empty_out(collection)
                bpy.data.collections.remove(collection)


def is_delivered(folder):
    """Whether `sgm merge --for blender` ran since the cells were made."""
    made, cells = os.path.join(folder, "blender", "cells"), os.path.join(folder, "cells", "0")
    if not os.path.isdir(made) or not os.path.isdir(cells):
        return os.path.isdir(made)
    done = {name: os.path.getmtime(os.path.join(made, name)) for name in os.listdir(made)}
    wanted = [name for name in os.listdir(cells) if name.endswith(".glb")]
    return all(done.get(name, 0) >= os.path.getmtime(os.path.join(cells, name)) for name in wanted)


class Import:
    """Lets sgm write what Blender reads where that is missing, and brings in cell after cell."""

    def __init__(self, root):
        self.name, self._doing, self._work = root.name, "reads", None
        self.cancelled, self.job = False, None
        folder = bpy.path.abspath(root[FOLDER])
        if not is_delivered(folder):
            self.job = self._deliver(folder)

    def _deliver(self, folder):
        sgm = jobs.find_program()
        if not sgm:
            raise program.Failed([program.Message("error", "the program sgm isn't found", fix="name it in the add-on's preferences")])
        # The tileset says where on Earth the city lies, which merging for Blender isn't told: it stays.
        self._tileset, self._kept = os.path.join(folder, "tileset.json"), tempfile.mkdtemp(prefix="sgm-")
        if os.path.exists(self._tileset):
            shutil.copy(self._tileset, self._kept)
        return program.Job([sgm, "merge", folder, "--for", "blender", "--quiet", "--progress"], self._kept)

    @property
    def stage(self):
        return f"writes cells {self.job.fraction:.0%}" if self.job else self._doing

    def cancel(self):
        self.cancelled = True
        if self.job is not None:
            self.job.cancel()

    def end(self):
        if self.job is None:
            return
        self.job.end()
        kept = os.path.join(self._kept, "tileset.json")
        if os.path.exists(kept):
            shutil.copy(kept, self._tileset)
        shutil.rmtree(self._kept, ignore_errors=True)
        self.job = None

    def _delivered(self):
        """Whether sgm has ended well; None while it runs."""
        code = self.job.poll()
        if code is None:
            return None
        told = self.job.messages() if not self.cancelled else []
        self.end()
        messages[self.name] = told
        return code == 0

    def step(self):
        """True while there is more to do."""
        root = bpy.data.objects.get(self.name)
        if root is None or bpy.context.mode != "OBJECT":
            return root is not None
        if self.job is not None:
            went = self._delivered()
            if went is not True:
                return went is None
        if self.cancelled:
            return False
        if self._work is None:
            self._work = City(root).bring()
        until = time.monotonic() + SLICE_S
        while time.monotonic() < until:
            self._doing = next(self._work, None)
            if self._doing is None:
                return False
        return True


def make_root(folder):
    """An empty that stands for the city, in a collection of its own."""
    name = os.path.basename(os.path.normpath(folder)) or "city"
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    root = bpy.data.objects.new(name, None)
    root[ROOT], root[FOLDER] = True, folder
    collection.objects.link(root)
    return root


def start(root):
    """Begins to bring a city to what its folder holds. Raises program.Failed."""
    if root.name in imports:
        imports[root.name].cancel()
        imports.pop(root.name).end()
    messages.pop(root.name, None)
    imports[root.name] = Import(root)
    if not bpy.app.background and not bpy.app.timers.is_registered(step):
        bpy.app.timers.register(step)


def _advance(each):
    override = jobs._window()
    try:
        if override is None:
            return each.step()
        with override:
            return each.step()
    except (OSError, ValueError, KeyError, IndexError, RuntimeError, struct.error) as problem:
        each.end()
        messages[each.name] = [program.Message("error", f"the folder can't be read: {problem}", fix="run sgm merge --verify")]
        return False


def step():
    for name, each in list(imports.items()):
        if not _advance(each):
            del imports[name]
    jobs.redraw()
    return jobs.POLL_S if imports else None


def wait(timeout_s=600):
    """Steps until all is there: for scripts, where no timer runs."""
    end = time.monotonic() + timeout_s
    while step() is not None and time.monotonic() < end:
        time.sleep(0.02)


def stop_all():
    for each in imports.values():
        each.cancel()
        each.end()
    imports.clear()
    messages.clear()


@persistent
def on_load(_file):
    stop_all()
