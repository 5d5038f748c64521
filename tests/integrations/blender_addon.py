# Drives the add-on in Blender from its zip, as a user does, and asserts what becomes of the scene.
# blender -b --factory-startup --python blender_addon.py -- ADDON.zip SGM SCRATCH
import os
import sys

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_case import Addon, examples, main, scratch, sgm  # noqa: E402


class Models(Addon):
    def test_towers_palaces_and_clouds_are_built(self):
        tower = self.meshes(self.add("tower.sgm"))
        self.assertEqual(list(tower), ["tower"])
        self.assertEqual(len(tower["tower"].data.materials), 5)
        self.assertEqual(len(tower["tower"].data.uv_layers), 1)
        palace = self.meshes(self.add("buildings/palace.sgm"))
        self.assertGreater(len(palace["palace"].data.polygons), 1000)
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(scratch, "cloud.blend"))
        cumulus = self.add("cumulus.sgm", form="cloud")
        cloud = next(thing for thing in self.link.members(cumulus) if thing.type == "VOLUME")
        self.assertTrue(cloud.data.grids.load())
        self.assertEqual([grid.name for grid in cloud.data.grids], ["density"])
        self.assertTrue(cloud.data.filepath.startswith("//sgm"))
        self.assertGreater(cloud.data.materials[0].node_tree.nodes["Principled Volume"].inputs["Density"].default_value, 0)
        before = cloud.data.filepath
        self.slide(cumulus, "root_", 200.0)
        self.jobs.wait()
        self.assertNotEqual(cloud.data.filepath, before)
        self.assertFalse(os.path.exists(bpy.path.abspath(before)))
        self.assertTrue(os.path.exists(bpy.path.abspath(cloud.data.filepath)))
        self.assertEqual(len(cloud.data.materials), 1)

    def test_a_slider_rebuilds_in_place(self):
        root = self.add("tower.sgm")
        tower = self.meshes(root)["tower"]
        name, mesh, height = tower.name, tower.data.name, self.height(tower)
        faces = len(tower.data.polygons)
        mine = bpy.data.materials.new("mine")
        slot = next(slot for slot in tower.material_slots if slot.material.name == "glass")
        slot.material = mine
        tower.modifiers.new("bevel", "BEVEL")
        root.location = (5, 6, 7)
        tower.location.x += 2
        plain = len(bpy.data.meshes), len(bpy.data.materials)
        self.slide(root, "floors", 14)
        self.assertTrue(self.jobs.busy(root), "a change asks for a build")
        self.jobs.wait()
        again = self.meshes(root)["tower"]
        self.assertEqual((again, again.name, again.data.name), (tower, name, mesh))
        self.assertNotEqual(len(tower.data.polygons), faces)
        self.assertGreater(self.height(tower), height + 7 + 10)
        self.assertIn(mine, list(tower.data.materials))
        self.assertEqual(len(tower.data.materials), 5)
        self.assertEqual([modifier.name for modifier in tower.modifiers], ["bevel"])
        self.assertAlmostEqual(tower.location.x, 2, 5)
        self.assertEqual(tuple(root.location), (5, 6, 7))
        self.assertEqual((len(bpy.data.meshes), len(bpy.data.materials)), plain, "nothing is left behind")
        self.assertFalse(self.jobs.busy(root))

    def test_objects_by_symbol_come_and_go(self):
        root = self.add("tower.sgm", divide="symbols", symbols="Storey, Roof")
        self.assertEqual(set(self.meshes(root)), {"tower", "Roof", "Storey"} | {f"Storey_{i}" for i in range(2, 10)})
        self.assertEqual(self.meshes(root)["Roof"]["rule"], "Storey#1")
        roof = self.meshes(root)["Roof"]
        upper = self.meshes(root)["Storey_8"]
        upper.modifiers.new("mine", "SOLIDIFY")
        mine = bpy.data.materials.new("mine")
        for storey in self.meshes(root).values():
            for slot in storey.material_slots:
                if slot.material.name == "stone":
                    slot.material = mine
        top = self.height(roof)
        self.slide(root, "floors", 5)
        self.jobs.wait()
        self.assertEqual({name for name, thing in self.meshes(root).items() if not thing.hide_render},
                         {"tower", "Roof", "Storey", "Storey_2", "Storey_3", "Storey_4", "Storey_5"})
        self.assertEqual(self.meshes(root)["Roof"], roof)
        self.assertLess(self.height(roof), top - 5)
        self.assertTrue(upper.hide_render and len(upper.data.polygons) == 0, "work of the user isn't thrown away")
        self.slide(root, "floors", 11)
        self.jobs.wait()
        self.assertEqual(self.meshes(root)["Storey_8"], upper)
        self.assertFalse(upper.hide_render)
        self.assertGreater(len(upper.data.polygons), 0)
        self.assertEqual([modifier.name for modifier in upper.modifiers], ["mine"])
        self.assertIn(mine, list(self.meshes(root)["Storey_11"].data.materials), "a new storey looks like the others")

    def test_duplicates_of_a_mesh_follow_and_of_a_root_part(self):
        root = self.add("tower.sgm")
        tower = self.meshes(root)["tower"]
        linked = bpy.data.objects.new("linked", tower.data)
        bpy.context.collection.objects.link(linked)
        copy = root.copy()
        bpy.context.collection.objects.link(copy)
        child = tower.copy()
        child.parent = copy
        bpy.context.collection.objects.link(child)
        copy["sgm.floors"] = 3
        bpy.context.view_layer.objects.active = copy
        bpy.ops.sgm.build()
        self.jobs.wait()
        self.assertNotEqual(copy["sgm.root"], root["sgm.root"])
        self.assertLess(self.height(child), self.height(tower) - 10)
        self.slide(root, "floors", 20)
        self.jobs.wait()
        self.assertEqual(linked.data, tower.data)
        self.assertLess(self.height(child), self.height(tower) - 20)

    def test_own_colours_follow_the_grammar_and_the_users_stay(self):
        root = self.add("buildings/palace.sgm")
        palace = self.meshes(root)["palace"]
        wall, trim = (next(m for m in palace.data.materials if m.name == name) for name in ("wall", "trim"))
        trim.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.123
        root["sgm.wall"] = [1.0, 0.0, 0.0]
        root["sgm.trim"] = [1.0, 0.0, 0.0]
        root.update_tag()
        bpy.context.view_layer.update()
        self.jobs.wait()
        self.assertIn(wall, list(palace.data.materials))
        self.assertAlmostEqual(wall.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value[0], 1, 3)
        self.assertLess(trim.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value[0], 0.95)

    def test_levels_are_hidden_and_colliders_are_not_rendered(self):
        meshes = self.meshes(self.add("tower.sgm", levels=2, collider="mesh"))
        self.assertTrue(meshes["tower_LOD1"].hide_render and meshes["tower_LOD1"].hide_viewport)
        self.assertFalse(meshes["tower_LOD0"].hide_render)
        collider = next(thing for name, thing in meshes.items() if name.endswith("colonly"))
        self.assertTrue(collider.hide_render and collider.display_type == "WIRE")

    def test_the_link_is_in_the_file(self):
        root = self.add("tower.sgm")
        key, path = root["sgm.root"], os.path.join(scratch, "kept.blend")
        tower = self.meshes(root)["tower"].name
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        root = self.link.root_by_key(key)
        self.assertEqual(root.sgm.resolution, 64)
        faces = len(bpy.data.objects[tower].data.polygons)
        self.slide(root, "floors", 3)
        self.jobs.wait()
        self.assertNotEqual(len(bpy.data.objects[tower].data.polygons), faces)


class Panel(Addon):
    def test_parameters_have_ranges_labels_and_kinds(self):
        root = self.add("tower.sgm")
        floors = root.id_properties_ui("sgm.floors").as_dict()
        self.assertEqual((floors["min"], floors["max"], floors["default"], floors["description"]), (2, 40, 9, "Storeys"))
        self.assertEqual(root["sgm.bulge"], "both")
        root["sgm.floors"] = 12
        bpy.ops.sgm.choose(parameter="bulge", value="flat")
        self.jobs.wait()
        self.assertIn("bulge=flat", self.link.settings_arguments(root))
        bpy.ops.sgm.reset()
        self.assertEqual((root["sgm.floors"], root["sgm.bulge"]), (9, "both"))

    def test_every_example_is_a_panel_whose_values_build(self):
        for folder, _, files in os.walk(examples):
            for file in sorted(files):
                if not file.endswith(".sgm"):
                    continue
                with self.subTest(file):
                    root = self.link.make_root(os.path.join(folder, file), bpy.context.collection)
                    self.link.read_panel(root, sgm)
                    panel = self.link.panel_of(root)
                    for parameter in panel["parameters"]:
                        value = self.link.value_of(root, parameter)
                        if parameter["kind"] in ("integer", "boolean", "choice", "color", "text"):
                            self.assertEqual(value, parameter["default"], parameter["name"])
                    # The defaults, said again one by one, are what the program takes them for.
                    run = self.jobs.program.subprocess.run(
                        [sgm, "tree", self.link.grammar_path(root), "--max-shapes", "20000", *self.link.settings_arguments(root)],
                        capture_output=True)
                    self.assertIn(run.returncode, (0, 3), run.stderr.decode())

    def test_styles_starts_and_seeds(self):
        path = os.path.join(scratch, "two.sgm")
        with open(path, "w") as file:
            file.write("grammar 1\nparam n = 2 in 1..9\nparam wide = true\nparam part = 30% in 10%..90%\nparam v = (1, 2, 3) in 0..9\n"
                       "param name = \"it\"\nstart A -> cube size (n, 1 + v[0], 1)\n"
                       "start B -> sphere size (n * part)\nstyle default for B { n = 5 }\nstyle Tall for A { n = 7 part = 60% }\n")
        root = self.add(path)
        self.assertEqual((root["sgm.n"], root["sgm.wide"], root["sgm.part"], list(root["sgm.v"])), (2, 1, 30.0, [1, 2, 3]))
        self.assertEqual([type(part) for part in root["sgm.v"]], [int] * 3)
        bpy.ops.sgm.style(style="Tall")
        self.assertEqual((root["sgm.n"], root["sgm.part"]), (7, 60.0))
        self.assertIn("part=60%", self.link.settings_arguments(root))
        self.assertIn('name="it"', self.link.settings_arguments(root))
        bpy.ops.sgm.toggle(parameter="wide")
        self.assertIn("wide=false", self.link.settings_arguments(root))
        bpy.ops.sgm.start(start="B")
        self.jobs.wait()
        self.assertEqual(root["sgm.n"], 5)
        self.assertEqual(self.messages(root), [])
        seed = root.sgm.seed
        bpy.ops.sgm.random_seed()
        self.assertNotEqual(root.sgm.seed, seed)
        self.assertTrue(self.jobs.busy(root))

    def test_a_value_beyond_its_range_is_the_end_of_it(self):
        root = self.add("tower.sgm")
        root["sgm.peak"] = 1.0000001
        root["sgm.floors"] = 99
        self.assertIn("peak=1", self.link.settings_arguments(root))
        self.assertIn("floors=40", self.link.settings_arguments(root))


class Trouble(Addon):
    def test_an_error_has_its_line_and_its_fix(self):
        path = os.path.join(scratch, "broken.sgm")
        with open(path, "w") as file:
            file.write("grammar 1\nstart A -> cube size 2\n")
        root = self.add(path)
        before = self.meshes(root)["broken"].data.name
        with open(path, "w") as file:
            file.write("grammar 1\n\nstart A -> spere size 2\n")
        bpy.ops.sgm.build()
        self.jobs.wait()
        message = self.jobs.messages[root["sgm.root"]][0]
        self.assertEqual((message.severity, message.line, message.text), ("error", 3, "unknown solid 'spere'"))
        self.assertEqual(message.fix, "did you mean 'sphere'?")
        self.assertEqual(self.meshes(root)["broken"].data.name, before, "the last good model stays")
        bpy.ops.sgm.open_line(filepath=message.file, line=message.line)
        self.assertEqual(bpy.data.texts["broken.sgm"].current_line_index, 2)
        with open(path, "w") as file:  # what only the derivation finds
            file.write("grammar 1\nparam n = 1 in 0..1.0\nstart A -> cube size 1 : B\nrule B -> cube size n : B\n")
        bpy.ops.sgm.build()
        self.jobs.wait()
        self.assertTrue(self.messages(root))
        with open(path, "w") as file:
            file.write("grammar 1\nstart A -> sphere size 2\n")
        bpy.ops.sgm.build()
        self.jobs.wait()
        self.assertEqual(self.messages(root), [])
        self.assertGreater(len(self.meshes(root)["broken"].data.polygons), 12)

    def test_a_missing_program_is_told(self):
        root = self.add("tower.sgm")
        bpy.context.preferences.addons["sgm_blender"].preferences.program = "/nowhere/sgm"
        bpy.ops.sgm.build()
        self.jobs.wait()
        self.assertEqual(self.messages(root), ["the program sgm isn't found"])

    def test_cancel_leaves_the_model(self):
        root = self.add("buildings/palace.sgm")
        faces = len(self.meshes(root)["palace"].data.polygons)
        root.sgm.resolution = 700
        self.assertTrue(self.jobs.busy(root))
        while self.jobs.progress(root) is None or not self.jobs.progress(root)[0]:
            self.jobs.step()
        folder = next(iter(self.jobs.running.values()))[0].folder
        bpy.ops.sgm.cancel()
        self.jobs.wait(20)
        self.assertFalse(self.jobs.busy(root))
        self.assertEqual(len(self.meshes(root)["palace"].data.polygons), faces)
        self.assertFalse(os.path.exists(folder))

    def test_a_later_change_takes_the_place_of_a_running_build(self):
        root = self.add("tower.sgm")
        root.sgm.resolution = 500
        while self.jobs.progress(root) is None:
            self.jobs.step()
        first = next(iter(self.jobs.running.values()))[0]
        root.sgm.resolution = 32
        self.jobs.wait()
        self.assertTrue(first.cancelled)
        self.assertLess(len(self.meshes(root)["tower"].data.polygons), 9000)

    def test_it_unregisters_without_a_trace(self):
        self.add("tower.sgm")
        addon_utils.disable("sgm_blender", default_set=True)
        self.assertFalse(hasattr(bpy.types.Object, "sgm"))
        self.assertFalse(hasattr(bpy.types, "SGM_PT_model"))
        self.assertNotIn("on_change", [handler.__name__ for handler in bpy.app.handlers.depsgraph_update_post])


class Baking(Addon):
    def test_keyframes_become_a_sequence(self):
        root = self.add("tower.sgm")
        scene = bpy.context.scene
        for frame, floors in ((1, 3), (4, 6)):
            root["sgm.floors"] = floors
            root.keyframe_insert('["sgm.floors"]', frame=frame)
        scene.frame_start, scene.frame_end = 1, 6
        self.assertEqual(bpy.ops.sgm.bake(), {"FINISHED"})
        self.bake.wait()
        frames = [thing for thing in self.bake.frames_of(root) if thing.type == "MESH"]
        self.assertEqual(len(frames), 4, "3, 4, 5 and 6 storeys")
        heights = []
        for frame in range(1, 7):
            scene.frame_set(frame)
            shown = [thing for thing in frames if not thing.hide_render and not thing.hide_viewport]
            self.assertEqual(len(shown), 1, frame)
            heights.append(self.height(shown[0]))
        self.assertTrue(heights[0] < heights[1] < heights[2] < heights[3] == heights[4] == heights[5])
        self.assertTrue(self.meshes(root)["tower"].hide_render)
        self.assertEqual({m.name for thing in frames for m in thing.data.materials},
                         {m.name for m in self.meshes(root)["tower"].data.materials})
        self.assertEqual(bpy.ops.sgm.unbake(), {"FINISHED"})
        self.assertEqual(self.bake.frames_of(root), [])
        self.assertFalse(self.meshes(root)["tower"].hide_render)

    def test_fog_becomes_a_sequence_of_volumes(self):
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(scratch, "fog.blend"))
        root = self.add("cumulus.sgm", form="cloud")
        for frame, radius in ((1, 100.0), (3, 160.0)):
            root["sgm.root_"] = radius
            root.keyframe_insert('["sgm.root_"]', frame=frame)
        bpy.ops.sgm.bake(first=1, last=3)
        self.bake.wait()
        volume = next(thing for thing in self.bake.frames_of(root) if thing.type == "VOLUME").data
        self.assertTrue(volume.is_sequence)
        self.assertEqual((volume.frame_start, volume.frame_duration), (1, 3))
        self.assertEqual(len([name for name in os.listdir(os.path.join(scratch, "sgm")) if "_000" in name]), 3)


if __name__ == "__main__":
    main()
