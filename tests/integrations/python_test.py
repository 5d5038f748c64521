"""Tests of the installed Python module; integrations.python runs it in a fresh virtual environment.
python_test.py EXAMPLES_FOLDER"""
import json
import os
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import sgm

EXAMPLES = sys.argv.pop(1)
BOX = "grammar 1\nparam height = 2m in 1m..9m \"Height\" group Form\nparam wide = true\nparam wall = #a4503a\nstart A -> cube size (4, height, 3) color wall\n"


def example(name):
    return sgm.load(os.path.join(EXAMPLES, name))


class Grammars(unittest.TestCase):
    def test_tells_parameters(self):
        grammar = sgm.parse(BOX, "box.sgm")
        height = grammar.parameters["height"]
        self.assertEqual((height.kind, height.default, height.minimum, height.maximum, height.unit), ("real", 2, 1, 9, "m"))
        self.assertEqual((height.label, height.group, height.line), ("Height", "Form", 2))
        self.assertEqual(grammar.parameters["wall"].default, "#a4503a")
        self.assertEqual(grammar.starts, ["A"])
        self.assertEqual([w.line for w in grammar.warnings], [3], "`wide` isn't used")

    def test_takes_values_of_every_kind(self):
        grammar = sgm.parse(BOX)
        for given, told in ((3, "3m"), (3.5, "3.5m"), ("350cm", "3.5m"), (np.float32(4), "4m")):
            self.assertEqual(grammar.model(height=given).parameters["height"], told)
        self.assertEqual(grammar.model({"height": 5, "wide": False}, wall="#ffffff").parameters,
                         {"height": "5m", "wide": "false", "wall": "#ffffff"})

    def test_errors_have_places(self):
        with self.assertRaises(sgm.GrammarError) as caught:
            sgm.parse("grammar 1\nstart A -> spere size 2\n", "a.sgm")
        problem = caught.exception.diagnostics[0]
        self.assertEqual((problem.file, problem.line, problem.column, problem.end_column), ("a.sgm", 2, 12, 17))
        self.assertIn("sphere", problem.hint)
        self.assertIn("spere", str(caught.exception))

    def test_errors_of_the_derivation_have_places(self):
        with self.assertRaises(sgm.BudgetError) as caught:
            sgm.parse("grammar 1\nstart A -> cube : B\nrule B repeat 1000 -> + cube at +y : B\n").model(max_shapes=100)
        self.assertGreater(caught.exception.diagnostics[0].line, 0)

    def test_wrong_values_are_refused(self):
        grammar = sgm.parse(BOX)
        for error, values in ((sgm.GrammarError, {"height": 99}), (sgm.UsageError, {"heigth": 3}), (sgm.GrammarError, {"wall": "red"})):
            with self.assertRaises(error):
                grammar.model(values)
        self.assertTrue(issubclass(sgm.UsageError, ValueError))
        with self.assertRaises(sgm.UsageError):
            grammar.model(start="B")
        with self.assertRaises(sgm.GrammarError):
            sgm.load("nowhere.sgm")

    def test_finds_the_standard_library(self):
        self.assertGreater(len(example("tower.sgm").model().mesh(32).triangles), 100)


class Fields(unittest.TestCase):
    def test_a_ball(self):
        model = sgm.parse("grammar 1\nstart A -> sphere size 2\n").model()
        points = np.random.default_rng(1).uniform(-2, 2, (7, 1001, 3))
        values = model.values(points)
        self.assertEqual((values.shape, values.dtype), ((7, 1001), np.float32))
        np.testing.assert_allclose(values, np.linalg.norm(points, axis=-1) - 1, atol=1e-5)
        again, slopes = model.gradients(points)
        np.testing.assert_array_equal(again, values)
        np.testing.assert_allclose(slopes, points / np.linalg.norm(points, axis=-1, keepdims=True), atol=1e-4)

    def test_odd_numbers_of_points(self):
        model = example("tower.sgm").model()
        points = np.random.default_rng(2).uniform(-9, 9, (5000, 3)).astype(np.float32)
        whole = model.values(points)
        for n in (0, 1, 15, 16, 17, 1023, 1024, 1025, 4999):
            np.testing.assert_array_equal(model.values(points[:n]), whole[:n])
        np.testing.assert_array_equal(model.values(points[::-1]), whole[::-1])
        with self.assertRaises(ValueError):
            model.values(np.zeros((3, 2)))

    def test_names_the_parts(self):
        model = sgm.parse("grammar 1\nterminal ball = sphere\nstart A -> cube size 1 + ball size 1 at +y\n").model()
        mesh = model.mesh(32)
        low, high = model.origins([[0, -.5, 0], [0, 1.5, 0]])
        self.assertEqual((mesh.parts[low].symbol, mesh.parts[high].symbol), ("cube", "ball"))


class Meshes(unittest.TestCase):
    def test_a_box_is_closed_and_exact(self):
        model = sgm.parse(BOX).model(height=3)
        mesh = model.mesh(64)
        self.assertEqual(len(mesh.triangles), 12)
        np.testing.assert_allclose([mesh.positions.min(0), mesh.positions.max(0)], [[-2, -1.5, -1.5], [2, 1.5, 1.5]], atol=1e-4)
        corners = mesh.positions[mesh.triangles]
        volume = np.einsum("ti,ti->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        self.assertAlmostEqual(volume, 36, places=3)
        self.assertAlmostEqual(mesh.report()["mesh"]["volume_m3"], 36, places=3)
        self.assertEqual(mesh.report()["mesh"]["boundary_edges"], 0)
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
        np.testing.assert_allclose(mesh.corner_normals, np.repeat(flat[:, None], 3, 1), atol=1e-3)

    def test_many_blocks_are_one_mesh(self):
        mesh = example("grotto.sgm").model().mesh(128, surface="cubes", tolerance=0)
        edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        counts = np.unique(edges, axis=0, return_counts=True)[1]
        self.assertTrue((counts == 2).all(), "closed")
        self.assertEqual(mesh.triangles.max() + 1, len(mesh.positions))
        self.assertEqual(mesh.report()["mesh"]["triangles"], len(mesh.triangles))
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-3)

    def test_arrays_show_the_meshs_memory(self):
        mesh = sgm.parse(BOX).model().mesh(32)
        first, second = mesh.positions, mesh.positions
        self.assertTrue(np.shares_memory(first, second))
        self.assertFalse(first.flags.writeable or first.flags.owndata)
        kept = mesh.triangles.copy()
        triangles = mesh.triangles
        del mesh, first, second
        np.testing.assert_array_equal(triangles, kept)

    def test_parts_and_materials(self):
        mesh = example("tower.sgm").model().mesh(48)
        names = {mesh.materials[m].name for m in np.unique(mesh.triangle_materials)}
        self.assertIn("stone", names)
        part = mesh.parts[mesh.origins[0]]
        self.assertTrue(part.path.startswith("House") and part.line > 0, part)

    def test_writes_files(self):
        mesh = example("tower.sgm").model().mesh(48)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.glb", "a.ply", "a.html", "a.obj"):
                mesh.save(os.path.join(folder, name))
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 1000)
            mesh.save(os.path.join(folder, "b.glb"), objects="Storey,Roof", collider="convex", levels=2, options={"pack": "meshopt"})
            for path, arguments in (("a.xyz", {}), ("a.vdb", {}), ("b.glb", {"options": {"pack": "zip"}}), ("b.glb", {"objects": "Nothing"})):
                with self.assertRaises(sgm.UsageError):
                    mesh.save(os.path.join(folder, path), **arguments)
            with self.assertRaises(sgm.Error):
                mesh.save(os.path.join(folder, "missing", "a.glb"))

    def test_same_bytes_at_any_number_of_threads(self):
        one, all_ = (example("tower.sgm").model(threads=n).mesh(64) for n in (1, 0))
        for name in ("positions", "normals", "triangles", "origins"):
            np.testing.assert_array_equal(getattr(one, name), getattr(all_, name))


class LevelSets(unittest.TestCase):
    def test_a_ball(self):
        level_set = sgm.parse("grammar 1\nstart A -> sphere size 2\n").model().level_set(64)
        nx, ny, nz = level_set.values.shape
        places = np.stack(np.meshgrid(np.arange(nx), np.arange(ny), np.arange(nz), indexing="ij"), -1) * level_set.voxel + level_set.origin
        distance = np.linalg.norm(places, axis=-1) - 1
        near = abs(distance) < 2 * level_set.voxel
        np.testing.assert_allclose(level_set.values[near], distance[near], atol=1e-4)
        self.assertTrue((level_set.values[distance < -4 * level_set.voxel] < 0).all())
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.vdb")
            level_set.save(path)
            self.assertGreater(os.path.getsize(path), 1000)
            with self.assertRaises(sgm.UsageError):
                level_set.save(os.path.join(folder, "ball.glb"))


class LiveModels(unittest.TestCase):
    def test_follows(self):
        live = example("tower.sgm").live(resolution=64)
        live.mesh(peak=.2)
        live.mesh(peak=.5)
        self.assertTrue(live.followed)
        self.assertGreater(live.blocks_kept, 0)

    def test_is_exact_after_a_change(self):
        live = sgm.parse(BOX).live(resolution=32)
        for height in (2, 2.1, 6, 1.5):
            figures = live.mesh(height=height).report()["mesh"]
            self.assertAlmostEqual(figures["volume_m3"], 12 * height, places=3)

    def test_earlier_meshes_stay(self):
        live = sgm.parse(BOX).live(resolution=32)
        first = live.mesh(height=2)
        before = first.positions.copy()
        live.mesh(height=4)
        np.testing.assert_array_equal(first.positions, before)

    def test_goes_on_after_an_error(self):
        live = sgm.parse(BOX).live(resolution=32)
        with self.assertRaises(sgm.GrammarError):
            live.mesh(height=99)
        self.assertGreater(len(live.mesh(height=3).triangles), 0)


class Notebook(unittest.TestCase):
    def test_its_cells_run(self):
        with open(os.path.join(EXAMPLES, os.pardir, "integrations", "python", "example.ipynb"), encoding="utf-8") as file:
            cells = json.load(file)["cells"]
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        self.assertGreater(len(code), 5)
        names, before = {}, os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for cell in code:
                    exec(compile(cell, "cell", "exec"), names)
            finally:
                os.chdir(before)


class Work(unittest.TestCase):
    def test_progress_and_cancelling(self):
        class Enough(Exception):
            pass

        told = []

        def tell(stage, share):
            told.append((stage, share))
            if len(told) > 2:
                raise Enough

        with self.assertRaises(Enough):
            example("cumulus.sgm").model().mesh(1024, progress=tell)
        self.assertTrue(all(stage and 0 <= share <= 1 for stage, share in told), told)

    def test_other_threads_run_meanwhile(self):
        counted = []
        done = threading.Event()

        def count():
            while not done.is_set():
                counted.append(1)
                time.sleep(.001)

        thread = threading.Thread(target=count)
        thread.start()
        example("cumulus.sgm").model().mesh(256)
        done.set()
        thread.join()
        self.assertGreater(len(counted), 5)


class Scenes(unittest.TestCase):
    TOWN = "grammar 2\nterminal lawn\nterminal stone color #c8b090\nstart Town -> size (60, 2, 60) (lawn, split x { { ~20m: Row }* })\n" \
           "rule Row -> split z { { ~20m: Plot }* }\nrule Plot -> move (0, 5m, 0) size 5 turn (0deg..90deg) place House variety 3\n" \
           "start House -> stone size (5, 3m..5m, 4)\n"

    def test_objects_are_made_once_and_stand_at_many_places(self):
        model = sgm.parse(self.TOWN, "town.sgm").model(apart=True)
        scene = model.scene(32)
        self.assertEqual(len(scene.objects), 3)
        self.assertEqual(scene.object_of.shape, (9,))
        self.assertEqual(set(scene.object_of), {0, 1, 2})
        self.assertEqual([place.line for place in scene.places], [6] * 9)
        self.assertTrue(all(place.path.startswith("Town/") for place in scene.places))
        for thing in scene.objects:
            self.assertEqual(thing.values["start"], "House")
            self.assertEqual(thing.mesh.report()["mesh"]["boundary_edges"], 0)
            self.assertEqual({thing.mesh.materials[m].name for m in set(thing.mesh.triangle_materials)}, {"stone"})
        matrices = scene.matrices
        np.testing.assert_allclose(np.linalg.det(matrices[:, :3, :3]), 1, atol=1e-9)
        self.assertFalse(matrices.flags.writeable)
        # Where an object's vertices stand, the field of the model that has them inside is zero.
        grafted = sgm.parse(self.TOWN, "town.sgm").model()
        for number, matrix in zip(scene.object_of, matrices):
            mesh = scene.objects[number].mesh
            there = mesh.positions @ matrix[:3, :3].T + matrix[:3, 3]
            self.assertLess(np.abs(grafted.values(there)).max(), 0.02)
        self.assertGreater(model.values([matrices[0][:3, 3]])[0], 0, "apart, the field is without them")

    def test_scenes_are_written_as_the_program_writes_them(self):
        model = sgm.parse(self.TOWN, "town.sgm").model(apart=True)
        scene, ground = model.scene(32), model.mesh(32)
        with tempfile.TemporaryDirectory() as folder:
            scene.save(os.path.join(folder, "town.gltf"), ground)
            with open(os.path.join(folder, "town.gltf"), encoding="utf-8") as file:
                gltf = json.load(file)
            self.assertEqual(len(gltf["meshes"]), 4)
            self.assertGreaterEqual(sum("mesh" in node for node in gltf["nodes"]), 10)
            scene.save(os.path.join(folder, "town.stl"))
            scene.objects[0].mesh.save(os.path.join(folder, "house.glb"))
            with self.assertRaises(sgm.UsageError):
                scene.objects[0].mesh.save(os.path.join(folder, "house.glb"), levels=2)
            with self.assertRaises(sgm.UsageError):
                scene.save(os.path.join(folder, "town.glb"), sgm.parse(BOX).model().mesh(16))
        with self.assertRaises(sgm.UsageError):
            sgm.parse(self.TOWN).model().scene(16)
        with self.assertRaises(sgm.BudgetError):
            model.scene(16, max_places=3)
        self.assertEqual(len(sgm.parse(BOX).model(apart=True).scene().objects), 0)


if __name__ == "__main__":
    unittest.main(verbosity=1)
