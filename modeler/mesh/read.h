// Meshes from files.
// Enters: a path. Leaves: triangles in double precision. Assumes nothing of the file: whatever its bytes are, reading
// takes time and memory that grow with its size alone.
#pragma once

#include <filesystem>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/mesh/triangle_soup.h"

namespace sgm::mesh {

/// The mesh in an OBJ, PLY, STL, OFF or glTF 2.0 file of at most 1 GiB, by its ending; polygons are cut into fans. Of
/// other files that it names only a glTF's buffers are opened, in its own folder and below: `named` gets their paths.
/// Error::Input, which begins with the file's name, when it can't be read, is damaged,
/// holds no triangle or a coordinate that is no number; Error::Cancelled when `progress` says so.
Result<TriangleSoup> readMesh(const std::filesystem::path& path, const Progress* progress = nullptr,
                              std::vector<std::filesystem::path>* named = nullptr);

}  // namespace sgm::mesh
