// glTF whose meshes are packed by Draco. For gltf.cpp only.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace tinygltf {
class Model;
}

namespace sgm::exporter {

/// Packs all meshes with normals by KHR_draco_mesh_compression: positions and texture coordinates to 16 bits, normals
/// to 8 bits an octahedral coordinate. Positions of all meshes lie on one grid, so that they meet as exactly as before;
/// at most extent / 65534 of the largest mesh is lost along an axis. Triangles stay the same, in another order.
/// Colliders stay as they are. Wants all data in buffer 0 and leaves it there. Error::Input for attributes that it
/// doesn't know, Error::Cancelled.
Status packByDraco(tinygltf::Model& model, Progress* progress);

}  // namespace sgm::exporter
