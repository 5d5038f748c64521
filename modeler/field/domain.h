// Maps of the domain: what happens to coordinates before a solid sees them.
// Enters: a Point. Leaves: the Point in the solid's own frame. Assumes rigid maps keep distances; others say their
// factor.
#pragma once

#include <functional>

#include "modeler/core/vec.h"
#include "modeler/field/field.h"

namespace sgm::field {

/// Where an oriented box stands: centre and rotation, in the object's frame. UniformParams become slots under `path`.
struct Frame {
    Vec3d centre;   ///< metres
    Mat3 rotation;  ///< world from local; identity adds no nodes beyond the translation
};

/// p along the axes of a rotation: Rᵀp. What only exchanges and turns round axes adds no numbers; the nine of any other
/// are slots under `rotationPath`.
Point turned(Point p, const Mat3& rotation, uint64_t rotationPath);
/// p in the frame's own axes: Rᵀp − Rᵀcentre. Frames that share `rotationPath` share the three dot products of
/// `turned`.
Point toLocal(Point p, const Frame& frame, uint64_t path, uint64_t rotationPath);
inline Point toLocal(Point p, const Frame& frame, uint64_t path) { return toLocal(p, frame, path, path); }
/// The bounds of `local` (a box in the frame's axes) in the object's frame.
Box3f toWorld(const Box3f& local, const Frame& frame);
/// `value` with x, y, z replaced by `p`: the same formula asked at another place. UniformParams keep their slots.
/// O(nodes of value).
NodeRef substitute(NodeRef value, Point p);
/// |x| in each axis whose flag is set: mirror about the local planes. Continuous and 1-Lipschitz: a field of it keeps
/// its lipschitz and growth, and its bounds become `mirrored`.
Point mirror(Point p, bool x, bool y, bool z);
/// Bounds of f(mirror(p)) from those of f.
Box3f mirrored(const Box3f& bounds, bool x, bool y, bool z);
/// Floor-mod repetition with the period in metres along one axis (0 … 2), centred on the origin. It jumps at odd
/// multiples of period/2: only of a solid that is symmetric in that axis is the field continuous (then with the same
/// lipschitz); mirror(repeat(p)) always is, as its copies alternate with their mirror images. For any solid take
/// `repeated`.
Point repeat(Point p, int axis, NodeRef period);
/// `count` ≥ 1 copies of a solid in a row of cells of one period along `axis`, centred on the origin, each cut to its
/// cell. The least of the two copies nearest to p, capped where a third could be nearer (papers guide, section 2, "what
/// the field should be"): continuous, with the solid's lipschitz and growth. `solid` is called for two positions.
Field repeated(Point p, int axis, NodeRef period, double periodValue, int count,
               const std::function<Field(Point)>& solid);

}  // namespace sgm::field
