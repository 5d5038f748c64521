// Convex solids as half-spaces, and the convex parts of each primitive.
// Enters: half-sizes and parameters of a primitive. Leaves: planes in the solid's own frame, in metres about the
// scope's centre. Assumes half-sizes > 0.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::field {

/// The points with dot(normal, p) ≤ offset; `normal` has length 1, `offset` is in metres.
struct HalfSpace {
    Vec3d normal{0, 1, 0};
    double offset = 0;
};

/// What all of these half-spaces share; bounded or not. An empty list is all of space.
using ConvexPart = std::vector<HalfSpace>;

namespace convex {

/// How many faces round solids have: Coarse for what is cut away, which every face splits once more.
enum class Roundness { Fine, Coarse };

/// The convex parts whose union is a primitive: (half-sizes in metres, the row's arguments, faces). Flat solids are
/// exact. Round ones have faces that lie so that the volume is the solid's to 1 %: their borders stand out a little,
/// their middles are a little inside. Arguments are metres, radians and shares as in the row.
using PartsOf = std::vector<ConvexPart> (*)(Vec3d half, std::span<const double> arguments, Roundness roundness);

std::vector<ConvexPart> cube(Vec3d half, std::span<const double>, Roundness);
/// Also the sphere: 54 faces, or 22.
std::vector<ConvexPart> ellipsoid(Vec3d half, std::span<const double>, Roundness roundness);
/// (tube): 12 parts of 8 sides, or 8 of 6.
std::vector<ConvexPart> torus(Vec3d half, std::span<const double> arguments, Roundness roundness);
std::vector<ConvexPart> cylinder(Vec3d half, std::span<const double>, Roundness roundness);  ///< 12 sides, or 8
std::vector<ConvexPart> cone(Vec3d half, std::span<const double>, Roundness roundness);      ///< 12 sides, or 8
std::vector<ConvexPart> capsule(Vec3d half, std::span<const double>, Roundness roundness);   ///< 54 faces, or 22
std::vector<ConvexPart> pyramid(Vec3d half, std::span<const double>, Roundness);
std::vector<ConvexPart> prism(Vec3d half, std::span<const double>, Roundness);
std::vector<ConvexPart> wedge(Vec3d half, std::span<const double>, Roundness);
std::vector<ConvexPart> halfspace(Vec3d half, std::span<const double>, Roundness);

}  // namespace convex
}  // namespace sgm::field
