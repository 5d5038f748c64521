tool
extends EditorPlugin
# Lets the editor import .sgm files, and says where the program is.

const PROGRAM = "sgm/program"

var importer


func _enter_tree():
	if not ProjectSettings.has_setting(PROGRAM):
		ProjectSettings.set_setting(PROGRAM, "sgm")
	ProjectSettings.set_initial_value(PROGRAM, "sgm")
	ProjectSettings.add_property_info({"name": PROGRAM, "type": TYPE_STRING, "hint": PROPERTY_HINT_GLOBAL_FILE})
	importer = preload("importer.gd").new()
	add_import_plugin(importer)


func _exit_tree():
	remove_import_plugin(importer)
	importer = null
