// Bounded convex polyhedra: what half-spaces cut out of each other.
// Enters: half-spaces. Leaves: faces, volumes, triangles. Assumes lengths in metres between a millimetre and 100 km:
// what is thinner than `leastThickness_m` counts as nothing.
#pragma once

#include <optional>
#include <vector>

#include "modeler/core/vec.h"
#include "modeler/field/convex.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

inline constexpr double leastThickness_m = 1e-3;

class ConvexPolyhedron {
public:
    /// A face: its half-space, and its corners counter-clockwise seen from outside.
    struct Face {
        field::HalfSpace plane;
        std::vector<Vec3d> corners;
    };

    explicit ConvexPolyhedron(const Box3d& box);
    /// What half-spaces leave of a box; none where that is thinner than `leastThickness_m`.
    static std::optional<ConvexPolyhedron> of(const field::ConvexPart& part, const Box3d& box);

    /// What the half-space leaves of this; none where that is thinner than `leastThickness_m`. O(corners).
    std::optional<ConvexPolyhedron> clipped(const field::HalfSpace& by) const;

    const std::vector<Face>& faces() const { return faces_; }
    const Box3d& bounds() const { return bounds_; }
    double volume_m3() const;
    /// The largest dot(direction, p) of its points.
    double support(Vec3d direction) const;
    /// True when it lies within all of these half-spaces, give or take 1e-6 m.
    bool within(const std::vector<Face>& faces) const;
    /// Its surface: each corner once, faces as fans.
    void triangulate(std::vector<Vec3f>& positions, std::vector<Triangle>& triangles) const;

private:
    ConvexPolyhedron() = default;
    bool settle();

    std::vector<Face> faces_;
    Box3d bounds_;
};

/// `whole` less a convex part, as convex pieces that touch in faces and together are exactly what is left; `whole`
/// itself where the part doesn't reach into it. At most one piece for each half-space of the part.
std::vector<ConvexPolyhedron> subtracted(const ConvexPolyhedron& whole, const field::ConvexPart& part);

/// Joins pieces that share a face and are convex together, until there are none; all pieces are disjoint. Their order
/// hangs on the order of `pieces` alone. O(n²) per pass.
void joinConvex(std::vector<ConvexPolyhedron>& pieces);

}  // namespace sgm::mesh
