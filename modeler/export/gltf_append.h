// Meshes that come to a glTF scene beside its own. For the files gltf_*.cpp only.
#pragma once

#include <tiny_gltf.h>

#include <functional>

#include "modeler/export/exporter.h"

namespace sgm::exporter {

/// Makes a model of an input's mesh alone: its buffer, materials and one mesh.
using ModelOfMesh = std::function<Result<tinygltf::Model>(const ExportInput& input)>;

/// Appends the first mesh of another model, with all of its buffer and the materials that aren't there yet; its number.
int appendMesh(tinygltf::Model& model, const tinygltf::Model& other);
/// Appends a node; its number.
int addNode(tinygltf::Model& model, tinygltf::Node node);
/// Appends a node as a child of the first one.
void addToRoot(tinygltf::Model& model, tinygltf::Node node);

}  // namespace sgm::exporter
