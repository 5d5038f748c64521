# Brings baked cities into Blender by the add-on, and compares the scene with the manifest.
# blender -b --factory-startup --python blender_city.py -- ADDON.zip SGM SCRATCH
import glob
import json
import os
import shutil
import struct
import subprocess
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_case import Addon, main, scratch, sgm  # noqa: E402

TOWN = """grammar 1
param height = 4m in 4m..9m
terminal lawn color #86a35f
terminal stone color #c8b090
start Town -> size (300, 4, 300) (lawn - sphere size (90, 20, 90) move (30, 8, -10), split x { { ~30m: Row }* })
rule Row -> split z { { ~30m: Plot }* }
rule Plot -> move (0, 6m, 0) size 8 turn (0deg..90deg) place House variety 5
start House -> stone size (8, height..9m, 6) - cube size (1, 2, 9) at -y to centre
"""


def run(*words):
    subprocess.run([sgm, *words], check=True, capture_output=True)


class City(Addon):
    def baked(self, name, *words):
        folder, grammar = os.path.join(scratch, name), os.path.join(scratch, "town.sgm")
        with open(grammar, "w", encoding="utf-8") as file:
            file.write(TOWN)
        shutil.rmtree(folder, ignore_errors=True)
        run("bake", grammar, "-o", folder, "--side", "128", "-q", *words)
        run("merge", folder, "-q", "--at", "52.52,13.405")
        return folder

    def read(self, folder):
        self.assertEqual(bpy.ops.sgm.tiles(filepath=os.path.join(folder, "manifest.json")), {"FINISHED"})
        root = bpy.context.object
        self.tiles.wait()
        self.assertEqual([told.text for told in self.tiles.messages.get(root.name, [])], [])
        return root

    def text(self, folder, name):
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            return file.read()

    def manifest(self, folder):
        return json.loads(self.text(folder, "manifest.json"))

    def skirts(self, folder):
        """Triangles that close gaps between levels: they belong to no surface, and don't come to Blender."""
        count = 0
        for path in glob.glob(os.path.join(folder, "**", "*.glb"), recursive=True):
            with open(path, "rb") as file:
                data = file.read()
            tree = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
            finest = os.path.relpath(path, folder).split(os.sep)[1:2] == ["0"]
            for mesh in tree.get("meshes", []) if finest else []:
                count += sum(primitive.get("extras", {}).get("skirtTriangles", 0) for primitive in mesh["primitives"])
        return count

    def places(self):
        return [thing for thing in bpy.data.objects if thing.instance_type == "COLLECTION"]

    def drawn(self):
        """[(mesh object, matrix)] of what is seen, instances included."""
        graph = bpy.context.evaluated_depsgraph_get()
        return [(each.object.original, each.matrix_world.copy()) for each in graph.object_instances if each.object.type == "MESH"]

    def test_instances_triangles_and_places_are_the_manifests(self):
        folder = self.baked("city")
        tileset = self.text(folder, "tileset.json")
        self.read(folder)
        manifest, places, drawn = self.manifest(folder), self.places(), self.drawn()
        self.assertGreater(manifest["instances"], 50)
        self.assertEqual(len(places), manifest["instances"])
        cells = [collection for collection in bpy.data.collections if "sgm.digest" in collection]
        finest = {key: cell for key, cell in manifest["cells"].items() if key.startswith("0/")}
        self.assertEqual({"0/" + collection["sgm.cell"] for collection in cells}, set(finest))
        for collection in cells:
            inside = [thing for thing in collection.objects if thing.instance_type == "COLLECTION"]
            self.assertEqual(len(inside), finest["0/" + collection["sgm.cell"]]["instances"])
        kinds = {thing.instance_collection for thing in places}
        self.assertEqual(len(kinds), manifest["objects"])
        self.assertEqual(len(drawn), manifest["instances"] + len(cells))
        self.assertEqual(sum(len(thing.data.polygons) for thing, _ in drawn), manifest["triangles"] - self.skirts(folder))
        self.assertEqual({m.name for m in bpy.data.materials}, {"lawn", "stone"}, "each once")
        for place in places:
            self.assertEqual((place["rule"], place["line"]), ("Plot#1", 7))
            self.assertTrue(place["path"].startswith("Town/"))
        self.assertEqual(self.text(folder, "tileset.json"), tileset, "where it lies on Earth stays")

    def test_things_stand_where_the_importer_puts_them(self):
        folder = self.baked("same")
        self.read(folder)
        bpy.context.view_layer.update()
        ours = sorted(tuple(round(number, 2) for number in matrix.translation) for _, matrix in self.drawn())
        bpy.ops.wm.read_factory_settings(use_empty=True)
        import numpy

        numpy.__dict__.setdefault("bool", bool)
        cells = os.path.join(folder, "blender", "cells")
        for name in os.listdir(cells):
            bpy.ops.import_scene.gltf(filepath=os.path.join(cells, name))
        bpy.context.view_layer.update()
        theirs = sorted(tuple(round(number, 2) for number in matrix.translation) for _, matrix in self.drawn())
        self.assertEqual(ours, theirs)

    def test_what_is_the_same_stays(self):
        folder = self.baked("again")
        root = self.read(folder)
        root.location = (5, 6, 7)
        stayed = next(thing for thing in bpy.data.objects if thing.name.startswith("ground"))
        mine = bpy.data.materials.new("mine")
        stayed.material_slots[0].material = mine
        house = self.places()[0].instance_collection.objects[0]
        house.material_slots[0].material = mine
        names, name = {thing.name for thing in bpy.data.objects}, stayed.name
        bpy.ops.sgm.tiles_again()
        self.tiles.wait()
        self.assertEqual({thing.name for thing in bpy.data.objects}, names)
        self.assertEqual(house.material_slots[0].material, mine)
        self.baked("again", "--set", "height=8m")
        bpy.ops.sgm.tiles_again()
        self.tiles.wait()
        self.assertEqual(len(self.places()), self.manifest(folder)["instances"])
        self.assertEqual(len({place.instance_collection for place in self.places()}), self.manifest(folder)["objects"])
        library = next(collection for collection in bpy.data.collections if collection.get("sgm.cell") == "library")
        self.assertEqual(len(library.children), self.manifest(folder)["objects"], "what no place shows has gone")
        self.assertEqual(tuple(root.location), (5, 6, 7))
        ground = bpy.data.objects[name]
        self.assertEqual(ground.material_slots[0].material, mine)

    def test_it_is_cancelled(self):
        folder = self.baked("cancelled")
        bpy.ops.sgm.tiles(filepath=os.path.join(folder, "manifest.json"))
        self.tiles.step()
        bpy.ops.sgm.tiles_cancel()
        self.tiles.wait(20)
        self.assertEqual(self.tiles.imports, {})
        self.assertLess(len(self.places()), self.manifest(folder)["instances"])
        bpy.ops.sgm.tiles_again()
        self.tiles.wait()
        self.assertEqual(len(self.places()), self.manifest(folder)["instances"])

    def test_a_damaged_folder_is_told(self):
        folder = self.baked("damaged")
        cells = os.path.join(folder, "cells", "0")
        victim = os.path.join(cells, sorted(name for name in os.listdir(cells) if name.endswith(".glb"))[0])
        with open(victim, "r+b") as file:
            file.truncate(100)
        bpy.ops.sgm.tiles(filepath=os.path.join(folder, "manifest.json"))
        self.tiles.wait()
        told = self.tiles.messages[bpy.context.object.name]
        self.assertTrue(told and told[0].severity == "error", told)
        self.assertIn(os.path.basename(victim), told[0].text)
        with self.assertRaisesRegex(RuntimeError, "no folder that sgm bake wrote"):
            bpy.ops.sgm.tiles(filepath=os.path.join(scratch, "town.sgm"))


if __name__ == "__main__":
    main()
