tool
extends EditorImportPlugin
# A .sgm file as a scene: `sgm build` writes a .glb into a folder of its own, which the editor's glTF importer reads. Meshes whose
# names end as colliders' become static bodies.

const SETTINGS_HELP = "Parameters as NAME=VALUE, separated by blanks or lines"


func get_importer_name():
	return "sgm.grammar"


func get_visible_name():
	return "Grammar"


func get_recognized_extensions():
	return ["sgm"]


func get_save_extension():
	return "scn"


func get_resource_type():
	return "PackedScene"


func get_preset_count():
	return 1


func get_preset_name(_preset):
	return "Default"


func get_import_options(_preset):
	return [
		{"name": "settings", "default_value": "", "property_hint": PROPERTY_HINT_MULTILINE_TEXT, "hint_string": SETTINGS_HELP},
		{"name": "seed", "default_value": 1, "property_hint": PROPERTY_HINT_RANGE, "hint_string": "0,1000000,1"},
		{"name": "start", "default_value": ""},
		{"name": "style", "default_value": ""},
		{"name": "resolution", "default_value": 128, "property_hint": PROPERTY_HINT_RANGE, "hint_string": "2,1024,1"},
		{"name": "objects", "default_value": "material"},
		{"name": "collider", "default_value": 0, "property_hint": PROPERTY_HINT_ENUM, "hint_string": "none,boxes,convex,mesh"},
		{"name": "levels_of_detail", "default_value": 1, "property_hint": PROPERTY_HINT_RANGE, "hint_string": "1,8,1"},
	]


func get_option_visibility(_option, _options):
	return true


# What `sgm build` is called with.
func arguments_for(grammar, glb, options):
	var arguments = ["build", grammar, "-o", glb, "-q", "--seed", str(options.seed), "--resolution", str(options.resolution)]
	for text in options.settings.replace("\n", " ").split(" ", false):
		arguments += ["--set", text]
	for name in ["start", "style"]:
		if options[name] != "":
			arguments += ["--" + name, options[name]]
	if options.objects != "" and options.objects != "material":
		arguments += ["--objects", options.objects]
	if options.collider > 0:
		arguments += ["--collider", ["none", "boxes", "convex", "mesh"][options.collider]]
	if options.levels_of_detail > 1:
		arguments += ["--lod", str(options.levels_of_detail)]
	return arguments


func import(source, save_path, options, _platform_variants, _gen_files):
	var folder = OS.get_user_data_dir().plus_file("sgm")
	var problem = Directory.new().make_dir_recursive(folder)
	if problem != OK:
		return problem
	var glb = folder.plus_file(source.md5_text() + ".glb")
	var program = ProjectSettings.get_setting("sgm/program")
	var told = []
	var code = OS.execute(program, arguments_for(ProjectSettings.globalize_path(source), glb, options), true, told, true)
	if code != 0:
		var why = told[0].strip_edges() if told.size() > 0 else ""
		if why == "":
			why = "the program '%s' doesn't run: Project Settings > Sgm > Program names it" % program
		push_error("%s: %s" % [source, why])
		return ERR_PARSE_ERROR
	var scene = read_glb(glb)
	Directory.new().remove(glb)
	if scene == null:
		return ERR_FILE_CORRUPT
	scene.name = source.get_file().get_basename()
	add_colliders(scene, scene)
	hide_coarser_levels(scene)
	var packed = PackedScene.new()
	problem = packed.pack(scene)
	scene.free()
	return ResourceSaver.save("%s.%s" % [save_path, get_save_extension()], packed) if problem == OK else problem


func read_glb(path):
	var reader = EditorSceneImporter.new()
	var flags = EditorSceneImporter.IMPORT_SCENE | EditorSceneImporter.IMPORT_GENERATE_TANGENT_ARRAYS
	return reader.import_scene_from_other_importer(path, flags, 15)


# Turns meshes called NAME-convcolonly and NAME-colonly, as `--collider` writes them for Godot, into shapes of one static body.
func add_colliders(node, scene):
	for child in node.get_children():
		add_colliders(child, scene)
		if not child is MeshInstance:
			continue
		var shape = null
		if "-convcolonly" in child.name:
			shape = child.mesh.create_convex_shape()
		elif "-colonly" in child.name:
			shape = child.mesh.create_trimesh_shape()
		if shape == null:
			continue
		var body = scene.get_node_or_null("Body")
		if body == null:
			body = StaticBody.new()
			body.name = "Body"
			scene.add_child(body)
			body.owner = scene
		var collision = CollisionShape.new()
		collision.shape = shape
		collision.transform = child.transform
		body.add_child(collision)
		collision.owner = scene
		node.remove_child(child)
		child.free()


func hide_coarser_levels(node):
	for child in node.get_children():
		hide_coarser_levels(child)
		for level in range(1, 8):
			if child is Spatial and child.name.ends_with("_LOD%d" % level):
				child.hide()
