// Meshes from files.
// Enters: a path. Leaves: one chunk of triangles. Assumes nothing of the file. OBJ, PLY, STL and OFF by OpenMesh.
#pragma once

#include <filesystem>

#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// The mesh in a file; polygons are cut into triangles, normals are those of the triangles around. Error::Input, which
/// begins with the file's name, when it can't be read, holds no triangle or a coordinate that is no number.
Result<Mesh> readMesh(const std::filesystem::path& path);

}  // namespace sgm::mesh
