// The nodes of a glTF scene, and what its extras say of shapes and rules. For gltf.cpp only.
#pragma once

#include "modeler/export/exporter.h"
#include "modeler/export/shared_objects.h"
#include "modeler/export/surface.h"

namespace tinygltf {
class Model;
class Value;
}  // namespace tinygltf

namespace sgm::exporter {

/// Adds the scene with its nodes: the first one is the whole, with the input's extras; below it a node for each node of
/// the input's object tree that holds triangles or stands above one that does, with shape, rule, line and values in its
/// extras. `meshOfNode` is the mesh of each object, -1 where it has none; nodes that share another's surface have its
/// mesh and a translation, and say in `origins` which of its origins stand for which of theirs. `shared` is set where
/// the input has objects.
void addScene(tinygltf::Model& model, const ExportInput& input, const SharedObjects* shared,
              const std::vector<int>& meshOfNode);

/// {`origins`: lists id, path, rule, file and line with an element an origin of the mesh}.
tinygltf::Value originTable(const Provenance& provenance, const mesh::Mesh& mesh);

/// Extras of a primitive, {"origins": [origin, count, origin, count …]}: whose the patch's triangles are, in their
/// order.
tinygltf::Value originRuns(const PatchedMesh& patched, const Patch& patch);

}  // namespace sgm::exporter
