// Levels of detail as writers take them: each as a mesh of its own.
#pragma once

#include <string>

#include "modeler/export/exporter.h"

namespace sgm::exporter {

/// "NAME_LOD2": what Unreal, Unity and Godot scripts look for as level 2 of NAME; level 0 is the finest.
std::string levelName(const std::string& name, size_t level);

/// How many levels an input has, the finest included.
inline size_t levelCount(const ExportInput& input) { return 1 + input.levels.size(); }

/// The input of one level alone, without levels and colliders, named by levelName; the input itself where it has one
/// level. Coarser levels aren't divided into objects.
ExportInput inputOfLevel(const ExportInput& input, size_t level);

}  // namespace sgm::exporter
