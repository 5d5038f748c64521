"""Settings of a model and of the add-on, and the panel in the sidebar of the 3D view."""
import os

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from . import bake, jobs, link, operators, tiles


def on_setting(settings, _context):
    root = settings.id_data
    if settings.live and link.PANEL in root:
        jobs.request(root)


class SgmPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: StringProperty(name="Program", subtype="FILE_PATH", description="The program sgm; empty: the one on the PATH")
    threads: IntProperty(name="Threads", min=0, max=1024, description="Threads of a build; 0: all")

    def draw(self, _context):
        self.layout.prop(self, "program")
        self.layout.prop(self, "threads")
        found = jobs.find_program()
        self.layout.label(text=found or "sgm isn't found", icon="CHECKMARK" if found else "ERROR")


class SgmSettings(bpy.types.PropertyGroup):
    """What is kept of a model besides its parameters."""

    grammar: StringProperty(name="Grammar", subtype="FILE_PATH", update=on_setting)
    start: StringProperty(name="Start")
    way: StringProperty(name="Way")
    live: BoolProperty(name="Live", default=True, description="Build again as soon as something changes")
    seed: IntProperty(name="Seed", default=1, min=0, update=on_setting)
    resolution: IntProperty(name="Resolution", default=128, min=2, max=8192, soft_max=512, update=on_setting,
                            description="Cells along the longest side")
    form: EnumProperty(name="Form", default="mesh", update=on_setting, items=(
        ("mesh", "Mesh", "A closed mesh"), ("cloud", "Fog", "A volume"), ("both", "Both", "A mesh and a volume")))
    divide: EnumProperty(name="Objects", default="material", update=on_setting, items=(
        ("material", "One", "One object, divided by material"), ("symbols", "Symbols", "The shapes of these symbols"),
        ("shape", "Shapes", "Every shape that shows"), ("none", "Plain", "One object with colours alone")))
    symbols: StringProperty(name="Symbols", update=on_setting, description="Symbols of the grammar: Storey,Window")
    levels: IntProperty(name="Levels of Detail", default=1, min=1, max=8, update=on_setting,
                        description="Coarser meshes besides, hidden at first")
    collider: EnumProperty(name="Colliders", default="none", update=on_setting, items=(
        ("none", "None", "No colliders"), ("boxes", "Boxes", "Boxes"), ("convex", "Convex", "Convex parts"), ("mesh", "Mesh", "The mesh, simplified")))
    wisps: FloatProperty(name="Wisps", default=0.6, min=0, max=0.95, update=on_setting, description="How far noise eats into the edge")
    edge: FloatProperty(name="Edge", default=0, min=0, max=100000, soft_max=100, update=on_setting,
                        description="Metres of depth over which the fog thickens; 0: three voxels")


class ModelPanel(bpy.types.Panel):
    """Base of the panels about the model of the active object."""

    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "sgm"

    @classmethod
    def poll(cls, context):
        return link.root_of(context.object) is not None


class SGM_PT_model(bpy.types.Panel):
    bl_idname, bl_label = "SGM_PT_model", "sgm"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "sgm"

    def draw(self, context):
        layout, root = self.layout, link.root_of(context.object)
        city = tiles.root_of(context.object)
        if root is None and city is not None:
            draw_tiles(layout, city)
            return
        if root is None:
            layout.operator("sgm.add", text="Grammar…", icon="FILE_FOLDER")
            layout.operator("sgm.tiles", text="City…", icon="FILE_FOLDER")
            return
        panel = link.panel_of(root)
        layout.prop(root.sgm, "grammar", text="")
        draw_names(layout, "Start", [start["name"] for start in panel["starts"]], operators.used_start(root), "sgm.start", "start")
        if panel["ways"]:
            draw_names(layout, "Way", panel["ways"], root.sgm.way, "sgm.way", "way", none="Automatic")
        start = operators.used_start(root)
        styles = [style["name"] for style in panel["styles"] if style.get("start", start) == start]
        if styles:
            draw_names(layout, "Style", styles, None, "sgm.style", "style")
        row = layout.row(align=True)
        row.prop(root.sgm, "seed")
        row.operator("sgm.random_seed", text="", icon="FILE_REFRESH")
        draw_build(layout, root)
        draw_messages(layout, jobs.messages.get(root[link.ROOT], []))


def draw_tiles(layout, root):
    layout.prop(root, f'["{tiles.FOLDER}"]', text="")
    running = tiles.imports.get(root.name)
    row = layout.row(align=True)
    if running is not None:
        row.label(text=running.stage)
        row.operator("sgm.tiles_cancel", icon="X")
    else:
        row.operator("sgm.tiles_again", icon="FILE_REFRESH")
    draw_messages(layout, tiles.messages.get(root.name, []))


def draw_names(layout, label, names, used, operator, argument, none=None):
    """A button for each of some names, the used one pressed. One name alone needs no choice."""
    if len(names) < 2 and none is None and used is not None:
        return
    layout.label(text=label)
    grid = layout.grid_flow(columns=min(len(names) + (none is not None), 3), align=True)
    for name in ([""] if none is not None else []) + names:
        setattr(grid.operator(operator, text=name or none, depress=name == used), argument, name)


def draw_build(layout, root):
    row = layout.row(align=True)
    running, baking = jobs.progress(root), bake.bakes.get(root[link.ROOT])
    if baking is not None:
        row.label(text=f"frame {baking.done + 1} of {len(baking.builds)}: {baking.job.stage} {baking.job.fraction:.0%}")
    elif running is not None:
        row.label(text=f"{running[0]} {running[1]:.0%}" if running[0] else "reads")
    if baking is not None or jobs.busy(root):
        row.operator("sgm.cancel", icon="X")
    else:
        row.operator("sgm.build", icon="MOD_BUILD")
    row.prop(root.sgm, "live", toggle=True)


def draw_messages(layout, told):
    for message in told[:12]:
        box = layout.box().column(align=True)
        row = box.row()
        place = f"{os.path.basename(message.file)}:{message.line}: " if message.line else ""
        icon = {"error": "ERROR", "warning": "QUESTION"}.get(message.severity, "INFO")
        row.label(text=place + message.text, icon=icon)
        if message.line:
            opened = row.operator("sgm.open_line", text="", icon="TEXT")
            opened.filepath, opened.line = message.file, message.line
        if message.fix:
            box.label(text=message.fix, icon="RIGHTARROW")


def draw_parameter(layout, root, parameter):
    label, kind = parameter.get("label", parameter["name"]), parameter["kind"]
    if "unit" in parameter:
        label += f" ({parameter['unit']})"
    if kind == "choice":
        layout.label(text=label)
        grid = layout.grid_flow(columns=3, align=True)
        for choice in parameter.get("choices", []):
            chosen = grid.operator("sgm.choose", text=choice, depress=choice == link.value_of(root, parameter))
            chosen.parameter, chosen.value = parameter["name"], choice
    elif kind == "boolean":
        on = bool(link.value_of(root, parameter))
        button = layout.operator("sgm.toggle", text=label, depress=on, icon="CHECKBOX_HLT" if on else "CHECKBOX_DEHLT")
        button.parameter = parameter["name"]
    elif kind == "vector":
        layout.label(text=label)
        layout.prop(root, link.path_of(parameter["name"]), text="")
    else:
        layout.prop(root, link.path_of(parameter["name"]), text=label, slider="minimum" in parameter)


class SGM_PT_parameters(ModelPanel):
    bl_idname, bl_label, bl_parent_id = "SGM_PT_parameters", "Parameters", "SGM_PT_model"

    def draw(self, context):
        root = link.root_of(context.object)
        groups = {}
        for parameter in link.panel_of(root)["parameters"]:
            groups.setdefault(parameter.get("group", ""), []).append(parameter)
        for group, parameters in groups.items():
            box = self.layout.box().column() if group else self.layout.column()
            if group:
                box.label(text=group)
            for parameter in parameters:
                if link.property_name(parameter["name"]) in root:
                    draw_parameter(box, root, parameter)
        self.layout.operator("sgm.reset", icon="LOOP_BACK")


class SGM_PT_form(ModelPanel):
    bl_idname, bl_label, bl_parent_id = "SGM_PT_form", "Objects", "SGM_PT_model"

    def draw(self, context):
        layout, settings = self.layout, link.root_of(context.object).sgm
        layout.prop(settings, "form", expand=True)
        layout.prop(settings, "resolution")
        if settings.form != "mesh":
            layout.prop(settings, "wisps", slider=True)
            layout.prop(settings, "edge")
            if not bpy.data.filepath:
                layout.label(text="Save the file to keep its volumes", icon="INFO")
        if settings.form != "cloud":
            layout.prop(settings, "divide")
            if settings.divide == "symbols":
                layout.prop(settings, "symbols")
            layout.prop(settings, "levels")
            layout.prop(settings, "collider")


class SGM_PT_frames(ModelPanel):
    bl_idname, bl_label, bl_parent_id = "SGM_PT_frames", "Animation", "SGM_PT_model"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.label(text="Keyframe parameters, then bake", icon="KEYFRAME")
        row = self.layout.row(align=True)
        row.operator("sgm.bake", icon="RENDER_ANIMATION")
        row.operator("sgm.unbake", icon="TRASH")


def add_to_menu(self, _context):
    self.layout.operator("sgm.add", text="sgm Grammar", icon="MOD_BUILD")
    self.layout.operator("sgm.tiles", text="sgm City", icon="COMMUNITY")


CLASSES = (SgmPreferences, SgmSettings, SGM_PT_model, SGM_PT_parameters, SGM_PT_form, SGM_PT_frames)
