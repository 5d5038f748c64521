"""Builds in the background: what is asked for, what runs, what it told, and when it is brought into the scene."""
import os
import shutil
import tempfile
import time

import bpy
from bpy.app.handlers import persistent

from . import clouds, importing, link, program

SETTLED_S = 0.3  # a slider that is still moving isn't built
POLL_S = 0.1
waiting = {}  # root's key → when to start
running = {}  # root's key → (Job, state)
asked = {}  # root's key → the state that was last asked for
messages = {}  # root's key → what the last build told
_paused = False


class paused:
    """While it lasts, changes of parameters ask for nothing: bakes run through frames."""

    def __enter__(self):
        global _paused
        _paused = True

    def __exit__(self, *_):
        global _paused
        _paused = False


def preferences():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def find_program():
    found = preferences()
    return program.find(found.program if found else "")


def threads():
    found = preferences()
    return found.threads if found else 0


def request(root, delay_s=SETTLED_S):
    """Asks for a build; a later one of the same model takes its place."""
    link.own_key(root)
    key = root[link.ROOT]
    waiting[key] = time.monotonic() + delay_s
    asked[key] = link.state_of(root)
    if not bpy.app.background and not bpy.app.timers.is_registered(step):
        bpy.app.timers.register(step)


def cancel(root):
    key = root[link.ROOT]
    waiting.pop(key, None)
    if key in running:
        running[key][0].cancel()


def busy(root):
    return root[link.ROOT] in running or root[link.ROOT] in waiting


def progress(root):
    """(stage, share) of the build that runs, or None."""
    job = running.get(root[link.ROOT])
    return (job[0].stage, job[0].fraction) if job else None


def command(root, folder, arguments=()):
    """sgm's arguments for a build of the model into a folder."""
    stem = os.path.splitext(os.path.basename(link.grammar_path(root)))[0]
    form = root.sgm.form
    made = [find_program(), "build", link.grammar_path(root), "--quiet", "--progress", "--threads", str(threads())]
    made += link.settings_arguments(root) + link.form_arguments(root) + list(arguments)
    if form != "cloud":
        made += ["-o", os.path.join(folder, stem + ".glb")]
    if form != "mesh":
        made += ["-o", os.path.join(folder, stem + ".vdb")] + clouds.arguments(root)
    return made


def _start(root):
    key = root[link.ROOT]
    try:
        link.read_panel(root, find_program())
    except program.Failed as problem:
        messages[key] = problem.messages
        return
    folder = tempfile.mkdtemp(prefix="sgm-")
    asked[key] = state = link.state_of(root)
    try:
        running[key] = (program.Job(command(root, folder), folder), state)
    except OSError as problem:
        messages[key] = [program.Message("error", f"sgm doesn't run: {problem}")]
        shutil.rmtree(folder, ignore_errors=True)


def _files(folder, ending):
    return [os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(ending)]


def _window():
    """What importers need of the context where a timer runs: a window, if there is one."""
    manager = bpy.context.window_manager
    return bpy.context.temp_override(window=manager.windows[0]) if manager and manager.windows else None


def _bring_in(root, folder, state):
    def bring():
        for path in _files(folder, ".glb"):
            importing.update(root, path)
        volumes = _files(folder, ".vdb")
        for path in volumes:
            clouds.update(root, path)
        if not volumes:
            clouds.remove(root)
        if not _files(folder, ".glb"):
            importing.clear(root)
        root[link.BUILT] = state

    override = _window()
    if override is None:
        bring()
    else:
        with override:
            bring()
            bpy.ops.ed.undo_push(message="Build " + root.name)


def _finish(key):
    job, state = running[key]
    code = job.poll()
    if code is None or bpy.context.mode not in ("OBJECT", "PAINT_TEXTURE"):  # importers need object mode: it waits
        return
    del running[key]
    root = link.root_by_key(key)
    if root is not None and not job.cancelled:
        messages[key] = job.messages()
        if code == 0:
            _bring_in(root, job.folder, state)
    shutil.rmtree(job.folder, ignore_errors=True)


def step():
    """Starts what is due and finishes what has ended. Returns the seconds until it wants to be called again, or None."""
    for key in list(running):
        _finish(key)
    now = time.monotonic()
    for key, due in list(waiting.items()):
        root = link.root_by_key(key)
        if root is None:
            del waiting[key]
        elif key in running:
            running[key][0].cancel()
        elif due <= now:
            del waiting[key]
            _start(root)
    redraw()
    return POLL_S if waiting or running else None


def wait(timeout_s=600):
    """Steps until nothing is left to do: for scripts, where no timer runs."""
    end = time.monotonic() + timeout_s
    while step() is not None and time.monotonic() < end:
        time.sleep(0.02)


def redraw():
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def stop_all():
    """Ends every run, as when another file is opened."""
    waiting.clear()
    for job, _ in running.values():
        job.end()
        shutil.rmtree(job.folder, ignore_errors=True)
    running.clear()
    asked.clear()
    messages.clear()


@persistent
def on_change(_scene, depsgraph):
    """Sliders, keyframes and undo: a model whose values changed is asked for again."""
    if _paused:
        return
    for changed in depsgraph.updates:
        if not isinstance(changed.id, bpy.types.Object):
            continue
        root = changed.id.original
        if link.ROOT not in root or link.PANEL not in root or not root.sgm.live:
            continue
        before = asked.get(root[link.ROOT], root.get(link.BUILT))
        if before is not None and link.state_of(root) != before:
            request(root)


@persistent
def on_load(_file):
    stop_all()
