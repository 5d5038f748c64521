# Prints a JSON line on what each imported model of the project became. godot3-server --path PROJECT -s godot.gd
extends SceneTree

func _init():
	for name in ["tower.glb", "tower.obj"]:
		var model = load("res://" + name)
		var meshes = [model] if model is Mesh else meshes_below(model.instance())
		var triangles = 0
		var surfaces = 0
		var box = AABB()
		for mesh in meshes:
			box = box.merge(mesh.get_aabb())
			surfaces += mesh.get_surface_count()
			for i in mesh.get_surface_count():
				triangles += mesh.surface_get_array_index_len(i) / 3
		print("FACTS ", to_json({"file": name, "triangles": triangles, "surfaces": surfaces,
				"size": [box.size.x, box.size.y, box.size.z]}))
	quit()

func meshes_below(node):
	var found = [node.mesh] if node is MeshInstance else []
	for child in node.get_children():
		found += meshes_below(child)
	return found
