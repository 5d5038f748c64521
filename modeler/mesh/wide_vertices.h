// Vertices around which the surface's normals differ a lot, as below the tip of a cone or a pyramid.
// Enters: a crisp mesh. Leaves: these vertices with the planes around them. Assumes normals as `polygonize` gives them.
#pragma once

#include <vector>

#include "modeler/mesh/tip_mesh.h"

namespace sgm::mesh {

inline constexpr Label noLabel = 0xffffffffu;

/// A vertex around which normals differ a lot, or a corner that was kept in its cell.
struct WideVertex {
    uint32_t vertex;
    TangentPlanes planes;      ///< of vertices beside it that lie on them, relative to it
    TangentPlanes directions;  ///< of all, as if through it
    OriginId origin;           ///< of one of its triangles
    Label label;               ///< of one of its triangles
    bool isCorner = false;     ///< its triangles have more than two labels
    bool hasCreases = false;   ///< its triangles have several labels
    Label second = noLabel;    ///< another label of its triangles

    /// Adds the tangent plane at a corner of a triangle, unless its vertex is confined.
    void addPlane(const TipMesh& mesh, const TipTriangle& triangle, size_t corner);
};

/// Vertices where the mean of all normals of their triangles' corners is short, as of smooth cones within 45° of their
/// axis and of pyramids within 30°, and confined corners. Ascending, the same for any number of threads; none after
/// cancelling. O(n).
std::vector<WideVertex> findWideVertices(const TipMesh& mesh, const Progress* progress);

}  // namespace sgm::mesh
