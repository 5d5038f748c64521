// Colliders in a glTF scene. For gltf.cpp only.
#pragma once

#include "modeler/export/exporter.h"

namespace tinygltf {
class Model;
}

namespace sgm::exporter {

/// Adds a node with a mesh of its own for each of the input's colliders, below the scene's first node and named for the
/// option `engine`. Positions alone, without material. Appends to buffer 0; nothing where there are no colliders.
/// Error::Usage for a collider that isn't convex where the engine takes no other.
Status addColliders(tinygltf::Model& model, const ExportInput& input);

}  // namespace sgm::exporter
