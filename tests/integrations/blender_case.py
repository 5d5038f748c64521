# What tests of the add-on share: the add-on out of its zip, and a test's scene. Imported in Blender by those that are run as
# blender -b --factory-startup --python blender_addon.py -- ADDON.zip SGM SCRATCH
import os
import shutil
import sys
import unittest

import addon_utils
import bpy

archive, sgm, scratch = (os.path.abspath(name) for name in sys.argv[sys.argv.index("--") + 1 :])
examples = os.path.abspath("examples")
# The zip goes where a user's add-ons go, but for this run alone.
bpy.context.preferences.filepaths.script_directory = scratch
os.makedirs(os.path.join(scratch, "addons"), exist_ok=True)
shutil.unpack_archive(archive, os.path.join(scratch, "addons"))
sys.path.insert(0, os.path.join(scratch, "addons"))


def enable():
    module = addon_utils.enable("sgm_blender", default_set=True)
    assert module is not None
    bpy.context.preferences.addons["sgm_blender"].preferences.program = sgm
    return module


class Addon(unittest.TestCase):
    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        addon = enable()
        self.jobs, self.bake, self.link, self.tiles = addon.jobs, addon.bake, addon.link, addon.tiles

    def tearDown(self):
        self.jobs.stop_all()
        self.tiles.stop_all()

    def add(self, grammar, **settings):
        """Picks a grammar by the operator and builds it."""
        self.assertEqual(bpy.ops.sgm.add(filepath=os.path.join(examples, grammar)), {"FINISHED"})
        root = bpy.context.object
        root.sgm["resolution"] = 64
        for name, value in settings.items():
            setattr(root.sgm, name, value)
        self.jobs.wait()
        self.assertEqual(self.messages(root), [])
        return root

    def messages(self, root):
        told = self.jobs.messages.get(root["sgm.root"], [])
        return [message.text for message in told if message.severity == "error"]

    def slide(self, root, name, value):
        """What a slider does: the property changes, and Blender tells those who listen."""
        root["sgm." + name] = value
        root.update_tag()
        bpy.context.view_layer.update()

    def meshes(self, root):
        return {thing["sgm.node"]: thing for thing in self.link.members(root) if thing.type == "MESH"}

    def height(self, thing):
        return max((thing.matrix_world @ vertex.co).z for vertex in thing.data.vertices)


def main():
    """Runs the tests of the script that Blender was started with; SGM_ADDON_TESTS names some of them."""
    only = filter(None, os.environ.get("SGM_ADDON_TESTS", "").split())
    result = unittest.main(argv=["addon", *only], exit=False, verbosity=2).result
    sys.exit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)
