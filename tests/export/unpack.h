// Packed glTF unpacked by the libraries' own decoders.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/export/read_back.h"

namespace sgm::exporter {

/// One mesh as a node places it.
struct UnpackedMesh {
    std::string node, mesh;
    double scale = 1;                           ///< of the node that holds the mesh
    ReadBack data;                              ///< positions in metres; normals at unit length
    std::vector<std::array<double, 4>> colors;  ///< COLOR_0 by vertex, 0 … 1
};

struct Unpacked {
    nlohmann::json json;               ///< null where the file can't be read
    std::vector<UnpackedMesh> meshes;  ///< in the order of the nodes
};

/// Reads a .glb with EXT_meshopt_compression, KHR_draco_mesh_compression or neither. Nodes may be turned, moved and
/// scaled.
Unpacked unpack(const std::filesystem::path& path);

}  // namespace sgm::exporter
