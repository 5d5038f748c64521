// Maps of the domain: what happens to coordinates before a solid sees them.
// Enters: a Point. Leaves: the Point in the solid's own frame. Assumes rigid maps keep distances; others say their factor.
#pragma once

#include "modeler/core/vec.h"
#include "modeler/field/field.h"

namespace sgm::field {

/// Where an oriented box stands: centre and rotation, in the object's frame. Numbers become slots under `path`.
struct Frame {
    Vec3d centre;   ///< metres
    Mat3 rotation;  ///< world from local; identity adds no nodes beyond the translation
};

/// p in the frame's own axes: Rᵀ(p − centre). The rotation's nine numbers are slots when it isn't the identity.
Point toLocal(Point p, const Frame& frame, uint64_t path);
/// The bounds of `local` (a box in the frame's axes) in the object's frame.
Box3f toWorld(const Box3f& local, const Frame& frame);
/// |x| in each axis whose flag is set: mirror about the local planes.
Point mirror(Point p, bool x, bool y, bool z);
/// Floor-mod repetition with the period in metres along one axis (0 … 2), centred on the origin.
Point repeat(Point p, int axis, Num period);

}  // namespace sgm::field
