"""Builds sgm's grammars in place: see docs/blender.md."""
import bpy

from . import bake, jobs, operators, panels, tiles

bl_info = {
    "name": "sgm: grammars of implicit solids",
    "author": "the sgm project",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > sgm, Add > sgm Grammar",
    "description": "Builds .sgm grammars as objects and volumes, and again whenever a parameter changes",
    "category": "Object",
}

HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, jobs.on_change),
    (bpy.app.handlers.load_pre, jobs.on_load),
    (bpy.app.handlers.load_pre, bake.on_load),
    (bpy.app.handlers.load_pre, tiles.on_load),
)


def register():
    for each in panels.CLASSES + operators.CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Object.sgm = bpy.props.PointerProperty(type=panels.SgmSettings)
    bpy.types.VIEW3D_MT_add.append(panels.add_to_menu)
    for handlers, handler in HANDLERS:
        handlers.append(handler)


def unregister():
    jobs.stop_all()
    bake.stop_all()
    tiles.stop_all()
    for handlers, handler in HANDLERS:
        handlers.remove(handler)
    for step in (jobs.step, bake.step, tiles.step):
        if bpy.app.timers.is_registered(step):
            bpy.app.timers.unregister(step)
    bpy.types.VIEW3D_MT_add.remove(panels.add_to_menu)
    del bpy.types.Object.sgm
    for each in reversed(panels.CLASSES + operators.CLASSES):
        bpy.utils.unregister_class(each)
