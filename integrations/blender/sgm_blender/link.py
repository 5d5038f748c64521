"""The link between a grammar and its objects, kept in the .blend: an empty, the root, with settings and a custom property
for each parameter (`sgm.floors`), which sliders, keyframes and drivers reach; all objects below carry the root's key."""
import json
import os
import uuid

import bpy

from . import program

ROOT, MODEL, PANEL, BUILT = "sgm.root", "sgm.model", "sgm.panel", "sgm.built"
PREFIX = "sgm."
RESERVED = ("root", "model", "panel", "built", "node", "matrix", "slots", "absent", "frame", "cloud", "material", "look")
_parsed = {}


def property_name(name):
    """The custom property that holds a parameter."""
    return PREFIX + name + ("_" if name in RESERVED else "")


def path_of(name):
    return f'["{property_name(name)}"]'


def roots():
    return [thing for thing in bpy.data.objects if ROOT in thing]


def root_by_key(key):
    return next((thing for thing in bpy.data.objects if thing.get(ROOT) == key), None)


def root_of(thing):
    """The root of the model that an object belongs to, or None."""
    at = thing
    while at is not None:
        if ROOT in at:
            return at
        at = at.parent
    return root_by_key(thing[MODEL]) if thing is not None and MODEL in thing else None


def members(root):
    """The objects of a model without its root, wherever they hang."""
    return [thing for thing in bpy.data.objects if thing.get(MODEL) == root[ROOT] and ROOT not in thing]


def make_root(grammar, collection, location=(0, 0, 0)):
    root = bpy.data.objects.new(os.path.basename(grammar), None)
    root.empty_display_type = "PLAIN_AXES"
    root.location = location
    root[ROOT] = root[MODEL] = uuid.uuid4().hex
    root.sgm.grammar = grammar
    collection.objects.link(root)
    return root


def own_key(root):
    """A duplicate of a root becomes a model of its own, with the duplicates below it."""
    old = root[ROOT]
    if not any(other is not root and other.get(ROOT) == old for other in bpy.data.objects):
        return
    root[ROOT] = root[MODEL] = uuid.uuid4().hex
    for thing in root.children_recursive:
        if thing.get(MODEL) == old:
            thing[MODEL] = root[ROOT]
            if thing.data is not None and thing.data.users > 1:
                thing.data = thing.data.copy()


def panel_of(root):
    """Parameters, starts, styles and ways as last read from the grammar."""
    text = root.get(PANEL, '{"parameters": [], "starts": [], "styles": [], "ways": []}')
    if text not in _parsed:
        if len(_parsed) > 64:
            _parsed.clear()
        _parsed[text] = json.loads(text)
    return _parsed[text]


def grammar_path(root):
    return os.path.realpath(bpy.path.abspath(root.sgm.grammar))


def read_panel(root, sgm):
    """Reads the grammar again: new parameters begin at their defaults, old ones keep their values. Raises Failed."""
    panel = program.read_panel(sgm, grammar_path(root))
    fresh = PANEL not in root
    known = {parameter["name"]: parameter for parameter in panel_of(root)["parameters"]}
    root[PANEL] = json.dumps(panel)
    starts = [start["name"] for start in panel["starts"]]
    if root.sgm.start not in starts:
        root.sgm["start"] = ""
    defaults = start_values(root)
    for parameter in panel["parameters"]:
        name = parameter["name"]
        same = name in known and known[name]["kind"] == parameter["kind"] and _width(known[name]) == _width(parameter)
        if fresh or not same or property_name(name) not in root:
            set_value(root, parameter, defaults[name])
        elif parameter["kind"] == "choice" and value_of(root, parameter) not in parameter.get("choices", []):
            set_value(root, parameter, defaults[name])
        _show(root, parameter, defaults[name])
    for name in known.keys() - {parameter["name"] for parameter in panel["parameters"]}:
        if property_name(name) in root:
            del root[property_name(name)]


def _width(parameter):
    return len(parameter["default"]) if isinstance(parameter["default"], list) else 1


def start_values(root):
    """What the parameters are before anybody changes them: their defaults and the start's own style."""
    panel = panel_of(root)
    values = {parameter["name"]: parameter["default"] for parameter in panel["parameters"]}
    for at, start in enumerate(panel["starts"]):
        if start["name"] == root.sgm.start or (at == 0 and not root.sgm.start):
            values.update(start["values"])
    return values


def reset_values(root, changed=None):
    values = {**start_values(root), **(changed or {})}
    for parameter in panel_of(root)["parameters"]:
        set_value(root, parameter, values[parameter["name"]])
        _show(root, parameter, start_values(root)[parameter["name"]])


def set_value(root, parameter, value):
    kind, name = parameter["kind"], property_name(parameter["name"])
    if kind == "color":
        root[name] = [int(value[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    elif kind == "boolean":
        root[name] = int(bool(value))
    elif kind == "vector":
        root[name] = [(int if program.is_whole(parameter) else float)(number) for number in value]
    elif kind == "real":
        root[name] = float(value)
    elif kind == "integer":
        root[name] = int(value)
    else:
        root[name] = str(value)


def value_of(root, parameter):
    """The property's value in the kind of the parameter: a colour as #rrggbb."""
    value = root[property_name(parameter["name"])]
    if parameter["kind"] == "color":
        return "#" + "".join(f"{min(max(round(part * 255), 0), 255):02x}" for part in value)
    if parameter["kind"] == "vector":
        return list(value)
    return value


def _show(root, parameter, default):
    """Gives the property the range and the text of the parameter."""
    kind = parameter["kind"]
    unit = f" ({parameter['unit']})" if "unit" in parameter else ""
    shown = {"description": parameter.get("label", parameter["name"]) + unit}
    if kind == "color":
        shown.update(subtype="COLOR_GAMMA", min=0.0, max=1.0, soft_min=0.0, soft_max=1.0)
    elif kind == "boolean":
        shown.update(min=0, max=1, soft_min=0, soft_max=1, default=int(default))
    elif kind in ("integer", "real", "vector"):
        cast = int if program.is_whole(parameter) else float
        for end, pick in (("min", min), ("max", max)):
            limit = parameter.get(end + "imum")
            if limit is not None:
                shown[end] = shown["soft_" + end] = cast(pick(limit) if isinstance(limit, list) else limit)
        shown["default"] = [cast(number) for number in default] if kind == "vector" else cast(default)
        if cast is float:
            shown["precision"] = 3
    root.id_properties_ui(property_name(parameter["name"])).update(**shown)


def settings_arguments(root):
    """The arguments of `sgm build` that say which model: start, seed and every parameter."""
    arguments = ["--seed", str(root.sgm.seed)]
    if root.sgm.start:
        arguments += ["--start", root.sgm.start]
    if root.sgm.way:
        arguments += ["--derive", root.sgm.way]
    for parameter in panel_of(root)["parameters"]:
        arguments += ["--set", parameter["name"] + "=" + program.value_text(parameter, value_of(root, parameter))]
    return arguments


def form_arguments(root):
    """Those that say how it is meshed and divided."""
    settings = root.sgm
    arguments = ["--resolution", str(settings.resolution)]
    divide = settings.symbols.replace(" ", "") if settings.divide == "symbols" else settings.divide
    if divide and divide != "material":
        arguments += ["--objects", divide]
    if settings.levels > 1:
        arguments += ["--lod", str(settings.levels)]
    if settings.collider != "none":
        arguments += ["--collider", settings.collider]
    return arguments


def state_of(root):
    """A text that changes with whatever the built objects depend on, but for the grammar's text."""
    settings = root.sgm
    return json.dumps([settings.grammar, settings_arguments(root), form_arguments(root), settings.form, settings.wisps, settings.edge])
