// Vertices on the grid edges that the surface cuts: found on the edge, refined against the field, with normal and
// origin. Enters: a brick, its samples and its tape. Leaves: positions, normals, origins in the brick's vertex order.
// Assumes the two ends of a cut edge differ in sign. Linear interpolation is Lorensen & Cline 1987; root finding is the
// Illinois form of regula falsi (Dowell & Jarratt 1971), which keeps its bracket and so can't leave the edge.
#pragma once

#include <vector>

#include "modeler/mesh/brick.h"

namespace sgm::mesh {

/// Vertices keep this share of a cell away from the ends of their edge, so that no two ever meet at a corner.
inline constexpr float edgeMargin = 0x1.0p-10f;

/// What one worker has found of a block so far.
struct BlockVertices {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;     ///< unit; zero where the field has no usable derivative
    std::vector<OriginId> origins;  ///< empty when the tape knows none
    void clear() { positions.clear(), normals.clear(), origins.clear(); }
};

/// Scratch of `appendVertices`: one lane a vertex.
struct EdgeLanes {
    std::vector<float> x, y, z;           ///< where the field is evaluated, metres
    std::vector<float> base, span;        ///< moving coordinate of the low end, and the way to the high end, metres
    std::vector<float> tIn, fIn, wIn;     ///< end of the bracket that is inside: place on the edge, value, weight
    std::vector<float> tOut, fOut, wOut;  ///< the other end
    std::vector<float> lastSide;          ///< sign of the end that moved last: 1 inside, −1 outside, 0 none yet
    std::vector<float> t, f, dx, dy, dz;
    std::array<size_t, 4> axisBegin{};  ///< lanes [axisBegin[a], axisBegin[a + 1]) move along axis a
    size_t size() const { return x.size(); }
    void resize(size_t n);
};

/// Appends the vertices of `brick`, refined in at most `refineSteps` evaluations each.
void appendVertices(const Brick& brick, Vec3i blockIndex, const Grid& grid, const BlockSamples& samples,
                    int refineSteps, bool wantOrigins, eval::Workspace& workspace, EdgeLanes& lanes,
                    BlockVertices& vertices, Counts& counts);

}  // namespace sgm::mesh
