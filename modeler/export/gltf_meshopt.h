// glTF whose buffer views are packed by meshoptimizer. For gltf.cpp only.
#pragma once

#include <tiny_gltf.h>

#include <ostream>
#include <string>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::exporter {

/// What EXT_meshopt_compression says of a buffer view.
struct MeshoptView {
    size_t offset = 0, length = 0;  ///< of the packed bytes in buffer 0
    size_t stride = 0, count = 0;   ///< of the elements once unpacked
    const char* mode = "";
    const char* filter = "NONE";
};

/// A model whose buffer 0 is packed, and what tinygltf doesn't write of it: extensions of views and buffers.
struct MeshoptModel {
    tinygltf::Model model;
    std::vector<MeshoptView> views;  ///< by view of the model
    size_t unpackedBytes = 0;        ///< of all views
};

/// Packs a model by KHR_mesh_quantization and EXT_meshopt_compression. In meshes with normals positions become 16-bit
/// numbers on one grid for all of them, which the transforms of nodes turn into metres; a node with children or a
/// rotation gets one for its mesh alone. Normals become 8-bit octahedral coordinates, texture coordinates floats of 16
/// bits. At most extent / 65534 of the largest mesh is lost along an axis. Triangles stay the same, in the same order.
/// Colliders are packed without loss. Wants all data in buffer 0. Error::Input for attributes that it doesn't know,
/// Error::Cancelled.
Result<MeshoptModel> packByMeshopt(tinygltf::Model model, Progress* progress);

/// Writes a packed model as .glb, or as JSON with its buffer inside.
void writeMeshopt(MeshoptModel& packed, std::ostream& out, bool binary);

}  // namespace sgm::exporter
