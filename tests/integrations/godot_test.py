#!/usr/bin/python3
"""Puts grammars and the importer into a project, lets Godot's editor import them, and looks at the scenes.  godot_test.py SGM"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SGM = os.path.realpath(sys.argv[1])
PROJECT = """config_version=4
[application]
config/name="grammars"
[editor_plugins]
enabled=PoolStringArray( "sgm" )
[sgm]
program="%s"
"""
IMPORT = """[remap]
importer="sgm.grammar"
type="PackedScene"
[deps]
source_file="res://%s"
[params]
settings="%s"
seed=1
start=""
style=""
resolution=%d
objects="%s"
collider=%d
levels_of_detail=%d
"""
LOOK = """extends SceneTree
func _init():
	for name in %s:
		var scene = load("res://" + name)
		var found = {"file": name, "meshes": [], "surfaces": 0, "triangles": 0, "shapes": 0, "bodies": 0, "hidden": 0, "height": 0.0}
		if scene != null:
			count(scene.instance(), found)
		found["loaded"] = scene != null
		print("FACTS ", to_json(found))
	quit()
func count(node, found):
	if node is MeshInstance:
		found["meshes"].append(node.name)
		found["surfaces"] += node.mesh.get_surface_count()
		found["height"] = max(found["height"], node.mesh.get_aabb().size.y)
		for i in range(node.mesh.get_surface_count()):
			found["triangles"] += node.mesh.surface_get_array_index_len(i) / 3
	if node is StaticBody:
		found["bodies"] += 1
	if node is CollisionShape and node.shape is ConvexPolygonShape:
		found["shapes"] += 1
	if node is Spatial and not node.visible:
		found["hidden"] += 1
	for child in node.get_children():
		count(child, found)
"""
TOWER = "grammar 1\nparam floors = 3 in 1..9\nterminal wall = cube color #c9b18c\nstart A -> wall size (4, 3, 4) : B\n" \
        "rule B repeat floors - 1 -> + wall size (4, 3, 4) at +y : B\n  finally + pyramid size (4, 2, 4) on last at +y color #a4503a\n"


def godot(folder, log, *arguments):
    """Runs Godot on the project, what it prints going to a file."""
    command = ["timeout", "60", "godot3-server", "--path", folder, *arguments]
    with open(log, "w", encoding="utf-8") as output:
        return subprocess.Popen(command, env={**os.environ, "HOME": folder}, stdout=output, stderr=subprocess.STDOUT)


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def import_all(folder, count, log):
    """Runs the editor until so many files are imported; what it printed. Godot 3.2 doesn't always end by --quit, and now and
    then stands still before it imports anything."""
    cache = os.path.join(folder, ".import")
    printed = ""
    for _ in range(4):
        editor = godot(folder, log, "--editor", "--quit")
        done = False
        while not done and editor.poll() is None:
            time.sleep(.2)
            done = os.path.isdir(cache) and sum(name.endswith(".md5") for name in os.listdir(cache)) >= count
        time.sleep(5)  # the refused one comes last
        editor.terminate()
        editor.wait()
        printed += read(log)
        if done:
            break
    return printed


def main(folder):
    shutil.copytree("integrations/godot/addons", os.path.join(folder, "addons"))
    write(folder, "project.godot", PROJECT % SGM)
    names = {"plain.sgm": ("", 32, "material", 0, 1), "tall.sgm": ("floors=6", 32, "wall,pyramid", 2, 1), "levels.sgm": ("", 64, "material", 0, 3)}
    for name, options in names.items():
        write(folder, name, TOWER)
        write(folder, name + ".import", IMPORT % (name, *options))
    write(folder, "wrong.sgm", "grammar 1\nstart A -> spere\n")
    log = os.path.join(folder, "log")
    printed = import_all(folder, 3, log)
    assert "unknown solid 'spere'" in printed and "wrong.sgm:2:12" in printed, printed
    write(folder, "look.gd", LOOK % json.dumps([*names, "wrong.sgm"]))
    godot(folder, log, "-s", "look.gd").wait()
    said = read(log)
    facts = {found["file"]: found for found in (json.loads(line[6:]) for line in said.splitlines() if line.startswith("FACTS "))}
    assert facts, said
    plain, tall, levels = (facts[name] for name in names)
    assert plain["surfaces"] == 2 and plain["bodies"] == 0, plain
    assert abs(plain["height"] - 11) < .5, plain
    assert tall["bodies"] == 1 and tall["shapes"] == 7, tall
    assert sorted(tall["meshes"]) == ["pyramid", "tall"], tall
    assert levels["hidden"] == 2, levels
    assert not facts["wrong.sgm"]["loaded"]
    report = os.path.join(folder, "report.json")
    subprocess.run([SGM, "build", os.path.join(folder, "plain.sgm"), "--resolution", "32", "-q", "--report", report], check=True)
    assert plain["triangles"] == json.loads(read(report))["mesh"]["triangles"], plain
    print("three grammars are scenes, one is refused with its line")


if shutil.which("godot3-server") is None:
    print("godot3-server isn't installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    main(folder)
