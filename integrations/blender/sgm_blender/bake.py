"""Animated parameters as a sequence: a build for every frame whose values differ, meshes shown each on its frames by
keyframes, volumes as Blender's own sequence of files. What is baked needs no add-on."""
import json
import os
import shutil
import tempfile
import time

import bpy
from bpy.app.handlers import persistent

from . import clouds, importing, jobs, link, program

FRAMES, HIDDEN = "sgm.frames", "sgm.hidden"
bakes = {}  # root's key → Bake


def values_by_frame(scene, root, first, last):
    """[(arguments, [frames])]: the builds that the frames need, in the order of their first frames."""
    now = scene.frame_current
    builds = {}
    with jobs.paused():
        for frame in range(first, last + 1):
            scene.frame_set(frame)
            builds.setdefault(tuple(link.settings_arguments(root)), []).append(frame)
        scene.frame_set(now)
    return list(builds.items())


class Bake:
    """Builds frame after frame. All frames have the cells of the first one, so that what stands still looks the same."""

    def __init__(self, scene, root, first, last):
        self.key, self.first, self.last = root[link.ROOT], first, last
        self.builds = values_by_frame(scene, root, first, last)
        self.folder = tempfile.mkdtemp(prefix="sgm-")
        self.done, self.job, self.cell = 0, None, ""
        self._begin = jobs.command(root, self.folder)
        self._own = link.settings_arguments(root)
        remove(root)
        self._next()

    def _next(self):
        arguments = list(self._begin)
        at = arguments.index(self._own[0])
        arguments[at : at + len(self._own)] = self.builds[self.done][0]
        if self.cell:
            at = arguments.index("--resolution")
            arguments[at : at + 2] = ["--cell", self.cell]
        else:
            arguments += ["--report", os.path.join(self.folder, "report.json")]
        self.job = program.Job(arguments, self.folder)

    def step(self):
        """True while there is more to do."""
        code = self.job.poll()
        root = link.root_by_key(self.key)
        if root is None or self.job.cancelled:
            self._end()
            return False
        if code is None or bpy.context.mode != "OBJECT":
            return True
        if code != 0:
            jobs.messages[self.key] = self.job.messages()
            self._end()
            return False
        if not self.cell:
            self.cell = self._first_cell(root)
        self._bring_in(root)
        self.done += 1
        if self.done < len(self.builds):
            self._next()
            return True
        _hide_model(root)
        self._end()
        return False

    def _first_cell(self, root):
        """Metres of a cell of the first frame, by the box of its mesh."""
        with open(os.path.join(self.folder, "report.json"), encoding="utf-8") as file:
            low, high = json.load(file)["mesh"]["bounds"]
        return f"{max(b - a for a, b in zip(low, high)) / root.sgm.resolution:.6g}"

    def _bring_in(self, root):
        override = jobs._window()
        if override is None:
            self._take_files(root)
        else:
            with override:
                self._take_files(root)

    def _take_files(self, root):
        frames = self.builds[self.done][1]
        for path in jobs._files(self.folder, ".glb"):
            add_frames(root, path, frames)
            os.remove(path)
        for path in jobs._files(self.folder, ".vdb"):
            self._take_volume(root, path, frames)

    def _take_volume(self, root, path, frames):
        kept = [clouds.keep_file(root, _copy(path), f"{frame:04d}") for frame in frames]
        os.remove(path)
        if self.done > 0:
            return
        data = bpy.data.volumes.new(os.path.splitext(root.name)[0] + " fog frames")
        data.filepath = clouds.blend_path(kept[0])
        live = clouds.cloud_of(root)
        data.materials.append(live.data.materials[0] if live and live.data.materials else clouds.fog_material(root, data))
        data.is_sequence, data.frame_start = True, self.first
        data.frame_duration = self.last - self.first + 1
        thing = clouds.add(root, data)
        thing[FRAMES] = thing.pop(link.MODEL)
        thing.matrix_basis = clouds.UPRIGHT

    def cancel(self):
        self.job.cancel()

    def _end(self):
        self.job.end()
        shutil.rmtree(self.folder, ignore_errors=True)


def _copy(path):
    return shutil.copy(path, path + ".frame")


def _shown_on(frames, first_frame):
    """An action that shows an object on its frames alone."""
    action = bpy.data.actions.new(f"sgm frame {frames[0]}")
    keys = {first_frame - 1: 1.0}
    for frame in frames:
        keys[frame] = 0.0
        keys.setdefault(frame + 1, 1.0)
    for path in ("hide_viewport", "hide_render"):
        curve = action.fcurves.new(path)
        curve.keyframe_points.add(len(keys))
        for point, (frame, value) in zip(curve.keyframe_points, sorted(keys.items())):
            point.co, point.interpolation = (frame, value), "CONSTANT"
        curve.update()
    return action


def add_frames(root, path, frames):
    """The objects of a file, below the root, shown on these frames."""
    new, fresh = importing.read_file(path)
    materials = importing.Materials(root, fresh)
    action = _shown_on(frames, bpy.context.scene.frame_start)
    given = set()
    for thing in new:
        thing[FRAMES] = root[link.ROOT]
        if thing.parent is None:
            thing.parent = root
        importing.relink(thing, root.users_collection)
        thing.name = f"{importing.plain_name(thing.name)} {frames[0]:04d}"
        if thing.type == "MESH" and thing.data not in given:
            given.add(thing.data)
            materials.give(thing, [])
        thing.animation_data_create().action = action
    for material in fresh:
        if material.users == 0:
            bpy.data.materials.remove(material)


def frames_of(root):
    return [thing for thing in bpy.data.objects if thing.get(FRAMES) == root[link.ROOT]]


def _hide_model(root):
    for thing in link.members(root):
        thing[HIDDEN] = [int(thing.hide_viewport), int(thing.hide_render)]
        thing.hide_viewport = thing.hide_render = True


def remove(root):
    """Takes the baked frames away and shows the model again."""
    for thing in frames_of(root):
        data, action = thing.data, thing.animation_data.action if thing.animation_data else None
        bpy.data.objects.remove(thing)
        if data is not None and data.users == 0:
            (bpy.data.meshes if isinstance(data, bpy.types.Mesh) else bpy.data.volumes).remove(data)
        if action is not None and action.users == 0:
            bpy.data.actions.remove(action)
    for thing in link.members(root):
        if HIDDEN in thing:
            thing.hide_viewport, thing.hide_render = (bool(hidden) for hidden in thing[HIDDEN])
            del thing[HIDDEN]


def start(scene, root, first, last):
    jobs.cancel(root)
    link.read_panel(root, jobs.find_program())
    bakes[root[link.ROOT]] = Bake(scene, root, first, last)
    if not bpy.app.background and not bpy.app.timers.is_registered(step):
        bpy.app.timers.register(step)


def step():
    for key, bake in list(bakes.items()):
        if not bake.step():
            del bakes[key]
    jobs.redraw()
    return jobs.POLL_S if bakes else None


def wait(timeout_s=600):
    """Steps until all is baked: for scripts, where no timer runs."""
    end = time.monotonic() + timeout_s
    while step() is not None and time.monotonic() < end:
        time.sleep(0.02)


def stop_all():
    for bake in bakes.values():
        bake._end()
    bakes.clear()


@persistent
def on_load(_file):
    stop_all()
