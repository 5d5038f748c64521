# Prints a JSON line on the levels of detail that each imported model of the project got: nodes by name with their triangles.
# godot3-server --path PROJECT -s godot_levels.gd
extends SceneTree

func _init():
	for name in ["tower.glb"]:
		var found = {"file": name, "levels": {}}
		collect(load("res://" + name).instance(), found["levels"])
		print("FACTS ", to_json(found))
	quit()

func collect(node, levels):
	if node is MeshInstance:
		var triangles = 0
		for surface in range(node.mesh.get_surface_count()):
			triangles += node.mesh.surface_get_arrays(surface)[Mesh.ARRAY_INDEX].size() / 3
		levels[node.name] = triangles
	for child in node.get_children():
		collect(child, levels)
