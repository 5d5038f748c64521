// Files read back by other people's readers (tinygltf, OpenMesh), and .usda by a small parse.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modeler/mesh/mesh.h"

namespace sgm::exporter {

struct ReadBack {
    std::vector<Vec3f> positions, normals;
    std::vector<std::array<float, 2>> uvs;  ///< by vertex; empty where the format has none
    std::vector<mesh::Triangle> triangles;
    std::vector<std::string> materials;   ///< by triangle; empty where the format has none
    std::map<std::string, Vec3f> colors;  ///< by material
    std::map<std::string, std::string> extras;
    std::string generator;
};

/// By the file's extension; an empty ReadBack where the reader refuses the file.
ReadBack readBack(const std::filesystem::path& path);

/// Vertices of equal position made one, in order of first appearance.
ReadBack welded(const ReadBack& in);

}  // namespace sgm::exporter
