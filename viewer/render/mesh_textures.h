// Textures as pictures of meshes show them.
// Enters: a mesh and what covers its parts. Leaves: how tiles lie on each triangle, and pictures for the GPU. Needs no
// GPU.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::render {

/// What the shader of meshes reads of textures.
struct MeshTextures {
    static constexpr int edge = 1024;  ///< pixels of every picture, whatever it had
    /// One way in which tiles lie: coordinates are dot products with a place in metres.
    struct Frame {
        Vec3f u;
        float colorLayer;  ///< into `colors`; -1: none
        Vec3f v;
        float normalLayer;  ///< into `numbers`; -1: none
        float roughnessLayer;
        float begin[2]{};  ///< taken from the products
        float unused{};
    };
    std::vector<uint32_t> frameOfTriangle;  ///< place in `frames` + 1, 0 for triangles without; empty: none has any
    std::vector<Frame> frames;
    std::vector<std::vector<uint8_t>> colors, numbers;  ///< RGBA, from the lowest row up
};

/// Triangles in the mesh's order. Error::Input for a picture that is damaged.
Result<MeshTextures> prepareMeshTextures(const mesh::Mesh& mesh, const Provenance& provenance);

}  // namespace sgm::render
