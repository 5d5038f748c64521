// Edges of a surface that are exchanged for the other diagonals of the triangles beside them.
// Enters: a flat mesh some of whose vertices move. Leaves: what triangles were before, and which lie beyond an edge.
// Assumes a closed 2-manifold.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "modeler/mesh/touched_triangles.h"

namespace sgm::mesh {

/// Triangles of one piece between which edges were exchanged for other diagonals, as they were before.
struct EdgeFlips {
    struct Side {
        uint32_t triangle;
        Triangle corners;
        double before;  ///< as TouchedTriangles::Touched::before
    };
    std::vector<Side> sides;
    bool undone = false;

    /// False for a triangle that others have changed.
    bool add(const TouchedTriangles::Touched& touched, const FlatMesh& flat) {
        if (touched.hasFlipped) return false;
        const uint32_t t = touched.triangle;
        if (std::none_of(sides.begin(), sides.end(), [&](const Side& side) { return side.triangle == t; }))
            sides.push_back({t, flat.triangles[t], touched.before});
        return true;
    }
};

/// The triangles beyond those edges of touched triangles that face the only vertex of these that moves.
class EdgesBeyond {
public:
    /// `moveOf` by vertex: TouchedTriangles::none for one that stays. O(n) in all triangles.
    EdgesBeyond(const FlatMesh& flat, TouchedTriangles& touched, const PageVector<uint32_t>& moveOf);
    /// The triangle that had an edge from a to b; `none` where none beyond such an edge had.
    uint32_t triangleWith(uint32_t a, uint32_t b) const;

    static constexpr uint32_t none = TouchedTriangles::none;

private:
    static uint64_t keyOf(uint32_t a, uint32_t b) { return uint64_t{a} << 32 | b; }

    std::unordered_map<uint64_t, uint32_t> triangles_;  ///< by edge
};

}  // namespace sgm::mesh
