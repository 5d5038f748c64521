# Prints a JSON line on the bodies and shapes that each imported model of the project got.
# godot3-server --path PROJECT -s godot_colliders.gd
extends SceneTree

func _init():
	for name in ["boxes.glb", "convex.glb", "mesh.glb"]:
		var found = {"file": name, "meshes": 0, "bodies": 0, "convex": 0, "concave": 0, "low": INF, "high": -INF}
		count(load("res://" + name).instance(), found)
		print("FACTS ", to_json(found))
	quit()

func count(node, found):
	if node is MeshInstance:
		found["meshes"] += 1
	if node is StaticBody:
		found["bodies"] += 1
	if node is CollisionShape:
		var points = []
		if node.shape is ConvexPolygonShape:
			found["convex"] += 1
			points = node.shape.points
		if node.shape is ConcavePolygonShape:
			found["concave"] += 1
			points = node.shape.get_faces()
		for point in points:
			found["low"] = min(found["low"], point.y)
			found["high"] = max(found["high"], point.y)
	for child in node.get_children():
		count(child, found)
