// Decimation of curved regions by collapsing edges, to a tolerance in metres.
// Enters: the triangles of curved regions with their borders. Leaves: fewer triangles over the same vertices. Assumes a
// closed, oriented 2-manifold. A collapse moves a vertex into a neighbour (Hoppe, "Progressive Meshes", 1996) chosen by
// the quadric of the planes around (Garland and Heckbert 1997, without memory as Lindstrom and Turk 1998) and is made
// only where the old and the new triangles lie within the tolerance of the original surface everywhere: over the plane
// of the star, the greatest distance is at a vertex that is gone or where an original edge crosses a new one.
#pragma once

#include <span>
#include <utility>

#include "modeler/core/progress.h"
#include "modeler/mesh/chains.h"
#include "modeler/mesh/compose.h"

namespace sgm::mesh {

struct DecimationLimits {
    double surface_m = 0;  ///< how far the surface may move
    double chain_m = 0;    ///< how far the borders of regions may move
};

/// What decimation works on.
struct DecimationInput {
    const FlatMesh& mesh;
    const SurfaceRegions& regions;
    const Chains& chains;
    std::span<const Plane> planes;
};

/// Curved regions while they are decimated, in jobs that share no vertex they move.
struct Decimation {
    static constexpr uint32_t none = 0xffffffffu;

    DecimationInput input;
    DecimationLimits limits;
    std::vector<SimpleTriangle> triangles;  ///< of curved regions
    std::vector<uint32_t> firstPoint;       ///< by triangle: an original vertex that lies over it and is gone, or none
    PageVector<uint32_t> nextPoint;         ///< by vertex that is gone: the next one of its triangle, or none
    PageVector<uint8_t> kept;               ///< by vertex: whether it must stay
    std::vector<uint32_t> previous, next;   ///< by place in the chains: the places beside it that are left
    std::vector<uint32_t> neighbours;       ///< of vertices in the original surface, as neighboursBegin tells
    float longestEdge_m = 0;                ///< of the original surface
    PageVector<uint32_t> neighboursBegin;   ///< by vertex and one more
    std::vector<std::array<uint32_t, 2>> planarAtNodes;  ///< ascending: node and planar region beside it

    /// The original triangles of curved regions; nothing is kept yet.
    Decimation(const DecimationInput& input, const DecimationLimits& limits);

    /// Decimates the original triangles on `threads` threads (0: all), with the same result for any number. Vertices
    /// that are `kept` stay.
    void run(int threads, Progress* progress);

    /// Whether the vertex at a place of the chains is left.
    bool isLeft(uint32_t place) const { return next[place] != place; }
    /// Keeps the original vertices around the corners of a triangle of the result, and those that lay over it; whether
    /// one of them was not kept before.
    bool keepAround(uint32_t triangle);
    /// Keeps all vertices of a chain; whether one of them was not kept before.
    bool keepChain(const Chain& chain);

private:
    void reset();
    bool keep(uint32_t vertex) { return !std::exchange(kept[vertex], uint8_t{1}); }
};

}  // namespace sgm::mesh
