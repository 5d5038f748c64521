// A mesh made on the GPU from one moment to the next: blocks of 32³ cells polygonised by compute shaders (SG-M III-G),
// for a preview of what is being dragged. Enters: a tape and a grid. Leaves: triangles in GPU memory, without
// refinement, owners and shared vertices. Assumes a current GL 4.3 context for all but `prepareBlocks`.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/eval/glsl.h"
#include "modeler/mesh/subdivide.h"
#include "viewer/render/gpu.h"

namespace sgm::render {

/// Everything about the blocks that needs no GPU, so that any thread can make it.
struct PreparedBlocks {
    mesh::Grid grid;
    std::vector<uint32_t> words;                 ///< the blocks' tapes
    std::vector<std::array<int32_t, 4>> blocks;  ///< index of the block, texel where its tape starts
    std::vector<eval::Tape> tapes;               ///< the same tapes, for `ownersOf`
    uint32_t registers = 0;
    eval::OpSet ops;
};
/// Error::Cancelled when `progress` says so.
Result<PreparedBlocks> prepareBlocks(const eval::Tape& tape, const mesh::Grid& grid, int threads, Progress* progress);

/// The shaders, kept while they know every op of the fields that come.
struct BlockPrograms {
    Program corners, triangles;
    Buffer cases;
    uint32_t registers = 0;
    eval::OpSet ops;
    bool cover(const PreparedBlocks& blocks) const {
        return blocks.registers <= registers && (blocks.ops & ~ops).none();
    }
};
/// Programs for these blocks and those that `before` covers (null: none): `before` itself where it covers them.
Result<std::shared_ptr<const BlockPrograms>> programsFor(const PreparedBlocks& blocks,
                                                         std::shared_ptr<const BlockPrograms> before);

/// A list of triangles, three vertices each.
struct GpuTriangles {
    size_t count = 0;
    Buffer positions, normals;  ///< three floats a vertex
    Buffer indices;             ///< 0, 1, 2 …
};
/// Error::Cancelled when `progress` says so.
Result<GpuTriangles> polygonizeOnGpu(const PreparedBlocks& blocks, const BlockPrograms& programs, Progress* progress);

/// Whose surface each triangle is: asked of its block's tape, at its middle.
std::vector<OriginId> ownersOf(const PreparedBlocks& blocks, const GpuTriangles& triangles, int threads);

/// The corners of the triangles, three a triangle, made by a context of its own; for tests that compare with the CPU.
Result<std::vector<Vec3f>> polygonizeOnGpu(const eval::Tape& tape, const mesh::Grid& grid);

}  // namespace sgm::render
