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

/// What decimation makes of a patch of triangles.
struct DecimatedPatch {
    uint32_t cube = 0;    ///< of the lattice that its triangles were chosen by
    uint32_t before = 0;  ///< triangles that there were
    std::vector<SimpleTriangle> triangles;
    std::vector<uint32_t> pointsEnd;  ///< by triangle: the end of its points
    std::vector<uint32_t> points;     ///< original vertices that are gone, by the triangle that they lie over
    std::vector<uint32_t> unlinked;   ///< places in the chains that are gone
};

/// Cubes of space that divide triangles into patches.
struct PatchLattice {
    Vec3d low;
    double side_m = 0;
    Vec3<uint32_t> size;

    uint32_t cubeOf(Vec3f p) const;
    size_t cubes() const { return static_cast<size_t>(size.x) * size.y * size.z; }
};

/// All triangles once through a lattice, with what became of them the last time.
struct DecimationPass {
    PatchLattice lattice;
    std::vector<DecimatedPatch> patches;  ///< ascending by cube
};

/// The vertices beside each vertex.
struct Neighbours {
    std::vector<uint32_t> list;  ///< vertex after vertex
    PageVector<uint32_t> begin;  ///< by vertex and one more
};

/// Curved regions while they are decimated, in jobs that share no vertex they move.
struct Decimation {
    static constexpr uint32_t none = 0xffffffffu;

    DecimationInput input;
    DecimationLimits limits;
    PageVector<SimpleTriangle> triangles;  ///< of curved regions
    PageVector<uint32_t> pointsEnd;        ///< by triangle: the end of its points
    PageVector<uint32_t> points;           ///< original vertices that are gone, by the triangle that they lie over
    PageVector<uint8_t> kept;              ///< by vertex: whether it must stay
    PageVector<uint8_t> settled;           ///< by vertex: the first pass that looked at it, counted from 1, or 0
    std::vector<uint32_t> previous, next;  ///< by place in the chains: the places beside it that are left
    Neighbours neighbours;                 ///< in the original surface
    float longestEdge_m = 0;               ///< of the original surface
    std::vector<std::array<uint32_t, 2>> planarAtNodes;  ///< ascending: node and planar region beside it

    /// The original triangles of curved regions; nothing is kept yet.
    Decimation(const DecimationInput& input, const DecimationLimits& limits);

    /// Decimates the original triangles on `threads` threads (0: all), with the same result for any number. Vertices
    /// that are `kept` stay. Called again, decimates those patches anew that vertices kept since then have changed.
    void run(int threads, Progress* progress);

    /// Whether the vertex at a place of the chains is left.
    bool isLeft(uint32_t place) const { return next[place] != place; }
    /// Takes the vertex at a place out of its chain.
    void unlink(uint32_t place) {
        next[previous[place]] = next[place], previous[next[place]] = previous[place];
        next[place] = previous[place] = place;
    }
    /// The original vertices that are gone and lie over a triangle of the result.
    std::span<const uint32_t> pointsOver(uint32_t triangle) const {
        const uint32_t begin = triangle == 0 ? 0 : pointsEnd[triangle - 1];
        return {points.data() + begin, points.data() + pointsEnd[triangle]};
    }
    /// Keeps the original vertices around the corners of a triangle of the result, and those that lay over it; whether
    /// one of them was not kept before.
    bool keepAround(uint32_t triangle);
    /// Keeps all vertices of a chain; whether one of them was not kept before.
    bool keepChain(const Chain& chain);

private:
    void reset();
    void runPass(size_t number, int threads, Progress* progress);
    bool isChanged(std::span<const uint32_t> patch) const;
    void append(const DecimatedPatch& patch);
    void markDifference(const DecimatedPatch& before, const DecimatedPatch& after, size_t pass);
    void mark(uint32_t vertex, size_t passes);
    bool keep(uint32_t vertex);

    std::vector<DecimationPass> passes_;
    PageVector<uint8_t> changed_;  ///< by vertex: whether it or a triangle at it differs from the last run
};

}  // namespace sgm::mesh
