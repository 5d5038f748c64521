"""What the panel's buttons do."""
import os
import random

import bpy
from bpy.props import IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import bake, jobs, link, program, tiles


class ForModel(bpy.types.Operator):
    """Base of operators on the model of the active object."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return link.root_of(context.object) is not None

    def execute(self, context):
        return self.run(context, link.root_of(context.object)) or {"FINISHED"}


class SGM_OT_add(bpy.types.Operator, ImportHelper):
    """Pick a grammar and build it in the scene"""

    bl_idname, bl_label, bl_options = "sgm.add", "sgm Grammar", {"REGISTER", "UNDO"}
    filename_ext = ".sgm"
    filter_glob: StringProperty(default="*.sgm", options={"HIDDEN"})

    def execute(self, context):
        if not os.path.isfile(self.filepath):
            self.report({"ERROR"}, f"no grammar {self.filepath}")
            return {"CANCELLED"}
        root = link.make_root(self.filepath, context.collection, context.scene.cursor.location)
        try:
            link.read_panel(root, jobs.find_program())
        except program.Failed as problem:
            jobs.messages[root[link.ROOT]] = problem.messages
            self.report({"ERROR"}, str(problem))
        else:
            jobs.request(root, 0)
        for thing in context.selected_objects:
            thing.select_set(False)
        context.view_layer.objects.active = root
        root.select_set(True)
        return {"FINISHED"}


class SGM_OT_build(ForModel):
    """Build the model and bring it into the scene, in place"""

    bl_idname, bl_label = "sgm.build", "Build"

    def run(self, _context, root):
        jobs.request(root, 0)


class SGM_OT_cancel(ForModel):
    """Cancel the build or the bake; the objects stay as they are"""

    bl_idname, bl_label, bl_options = "sgm.cancel", "Cancel", {"INTERNAL"}

    def run(self, _context, root):
        jobs.cancel(root)
        if root[link.ROOT] in bake.bakes:
            bake.bakes[root[link.ROOT]].cancel()


class SGM_OT_random_seed(ForModel):
    """Draw another seed"""

    bl_idname, bl_label = "sgm.random_seed", "Random Seed"

    def run(self, _context, root):
        root.sgm.seed = random.randrange(1, 2**31 - 1)


class SGM_OT_reset(ForModel):
    """Set every parameter to its default"""

    bl_idname, bl_label = "sgm.reset", "Defaults"

    def run(self, _context, root):
        link.reset_values(root)
        changed(root)


class SGM_OT_style(ForModel):
    """Set the parameters to the values of a style"""

    bl_idname, bl_label = "sgm.style", "Style"
    style: StringProperty(name="Style")

    def run(self, _context, root):
        for style in link.panel_of(root)["styles"]:
            if style["name"] == self.style and style.get("start", "") in ("", used_start(root)):
                link.reset_values(root, style["values"])
        changed(root)


class SGM_OT_start(ForModel):
    """Begin with this symbol"""

    bl_idname, bl_label = "sgm.start", "Start"
    start: StringProperty(name="Start")

    def run(self, _context, root):
        root.sgm.start = self.start
        link.reset_values(root)
        changed(root)


class SGM_OT_way(ForModel):
    """Apply the rules in this order; without a name, automatically"""

    bl_idname, bl_label = "sgm.way", "Way"
    way: StringProperty(name="Way")

    def run(self, _context, root):
        root.sgm.way = self.way
        changed(root)


class SGM_OT_choose(ForModel):
    """Set the parameter to this choice"""

    bl_idname, bl_label = "sgm.choose", "Choose"
    parameter: StringProperty(name="Parameter")
    value: StringProperty(name="Value")

    def run(self, _context, root):
        root[link.property_name(self.parameter)] = self.value
        changed(root)


class SGM_OT_toggle(ForModel):
    """Switch the parameter on or off"""

    bl_idname, bl_label = "sgm.toggle", "Toggle"
    parameter: StringProperty(name="Parameter")

    def run(self, _context, root):
        name = link.property_name(self.parameter)
        root[name] = 0 if root[name] else 1
        changed(root)


class SGM_OT_bake(ForModel):
    """Build every frame in which a parameter has another value"""

    bl_idname, bl_label = "sgm.bake", "Bake Frames"
    first: IntProperty(name="First", default=-1, description="First frame; -1: the scene's")
    last: IntProperty(name="Last", default=-1, description="Last frame; -1: the scene's")

    def run(self, context, root):
        scene = context.scene
        first = scene.frame_start if self.first < 0 else self.first
        last = scene.frame_end if self.last < 0 else self.last
        if last < first:
            self.report({"ERROR"}, f"frame {last} comes before frame {first}")
            return {"CANCELLED"}
        try:
            bake.start(scene, root, first, last)
        except program.Failed as problem:
            jobs.messages[root[link.ROOT]] = problem.messages
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}


class SGM_OT_unbake(ForModel):
    """Take the baked frames away and show the model again"""

    bl_idname, bl_label = "sgm.unbake", "Remove Frames"

    def run(self, _context, root):
        bake.remove(root)


class SGM_OT_tiles(bpy.types.Operator, ImportHelper):
    """Bring in a city that `sgm bake` made: pick its manifest.json"""

    bl_idname, bl_label, bl_options = "sgm.tiles", "sgm City", {"REGISTER", "UNDO"}
    filename_ext = ".json"
    filter_glob: StringProperty(default="manifest.json;plan.json", options={"HIDDEN"})

    def execute(self, context):
        folder = os.path.dirname(os.path.abspath(self.filepath))
        if not os.path.isfile(os.path.join(folder, "plan.json")):
            self.report({"ERROR"}, f"{folder} is no folder that sgm bake wrote")
            return {"CANCELLED"}
        root = tiles.make_root(folder)
        for thing in context.selected_objects:
            thing.select_set(False)
        context.view_layer.objects.active = root
        root.select_set(True)
        return read_tiles(self, root)


class ForTiles(bpy.types.Operator):
    """Base of operators on the city of the active object."""

    @classmethod
    def poll(cls, context):
        return tiles.root_of(context.object) is not None


class SGM_OT_tiles_again(ForTiles):
    """Read the folder again: what has changed is replaced, the rest stays"""

    bl_idname, bl_label, bl_options = "sgm.tiles_again", "Read Again", {"REGISTER", "UNDO"}

    def execute(self, context):
        return read_tiles(self, tiles.root_of(context.object))


class SGM_OT_tiles_cancel(ForTiles):
    """Stop; the cells that are there stay"""

    bl_idname, bl_label, bl_options = "sgm.tiles_cancel", "Cancel", {"INTERNAL"}

    def execute(self, context):
        name = tiles.root_of(context.object).name
        if name in tiles.imports:
            tiles.imports[name].cancel()
        return {"FINISHED"}


class SGM_OT_open_line(bpy.types.Operator):
    """Open the grammar at this line in Blender's text editor"""

    bl_idname, bl_label, bl_options = "sgm.open_line", "Open", {"INTERNAL"}
    filepath: StringProperty()
    line: IntProperty()

    def execute(self, context):
        path = os.path.realpath(self.filepath)
        same = (t for t in bpy.data.texts if t.filepath and os.path.realpath(bpy.path.abspath(t.filepath)) == path)
        text = next(same, None) or bpy.data.texts.load(path)
        text.cursor_set(max(self.line - 1, 0))
        for area in context.screen.areas if context.screen else ():
            if area.type == "TEXT_EDITOR":
                area.spaces.active.text = text
                break
        else:
            self.report({"INFO"}, f"{text.name} is at line {self.line} in the text editor")
        return {"FINISHED"}


def read_tiles(operator, root):
    try:
        tiles.start(root)
    except program.Failed as problem:
        tiles.messages[root.name] = problem.messages
        operator.report({"ERROR"}, str(problem))
        return {"CANCELLED"}
    return {"FINISHED"}


def used_start(root):
    starts = link.panel_of(root)["starts"]
    return root.sgm.start or (starts[0]["name"] if starts else "")


def changed(root):
    """Custom properties that a button sets tell nobody."""
    root.update_tag()
    if root.sgm.live:
        jobs.request(root, 0)


CLASSES = (SGM_OT_add, SGM_OT_build, SGM_OT_cancel, SGM_OT_random_seed, SGM_OT_reset, SGM_OT_style, SGM_OT_start, SGM_OT_way,
           SGM_OT_choose, SGM_OT_toggle, SGM_OT_bake, SGM_OT_unbake, SGM_OT_open_line, SGM_OT_tiles,
           SGM_OT_tiles_again, SGM_OT_tiles_cancel)
