// Where planes around a vertex meet.
// Enters: planes. Leaves: a point.
#pragma once

#include <span>

#include "modeler/core/vec.h"

namespace sgm::mesh {

/// A plane by its unit normal and a point of it, metres.
struct PlaneAt {
    Vec3d normal, point;
};

/// The point of the first three planes that aren't nearly parallel which is nearest to `near`, of fewer a point of
/// these. `near` itself where that is farther away than the planes' points, or so near that it makes no difference.
Vec3f meetingPoint(std::span<const PlaneAt> planes, Vec3f near);

}  // namespace sgm::mesh
