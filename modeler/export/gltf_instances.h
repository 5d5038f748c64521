// Objects that stand at many places of a glTF scene. For gltf.cpp only.
#pragma once

#include "modeler/export/gltf_append.h"

namespace sgm::exporter {

/// Adds the objects of the input's scene below node 0: a mesh an object, with the table of its origins in the mesh's
/// extras, and a node a place with its shape, rule and line; or, by the option `places`, a node an object with all
/// places in EXT_mesh_gpu_instancing. Nothing where the input has no scene. The errors of `modelOf`; Error::Usage for
/// `places=gpu` in packed files.
Status addInstances(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf);

}  // namespace sgm::exporter
