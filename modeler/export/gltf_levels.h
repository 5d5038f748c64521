// Levels of detail in a glTF scene. For gltf.cpp only.
#pragma once

#include <tiny_gltf.h>

#include "modeler/export/gltf_append.h"

namespace sgm::exporter {

/// Adds the input's coarser levels. What hung on node 0 moves to a node of its own below it, named as level 0 of the
/// model, which names the other levels' nodes by MSFT_lod, with the shares of a picture's height down to which each
/// stands for the model. By the option `levels` these nodes hang on node 0 as well, or on nothing. Materials are
/// shared. Nothing where the input has no levels. The errors of `modelOf`.
Status addLevels(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf);

}  // namespace sgm::exporter
