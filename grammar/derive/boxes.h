// The oriented boxes of solids: how far they reach, by how much they overlap, which pairs may.
// Enters: scopes and trees. Leaves: depths in metres and pairs of shapes.
#pragma once

#include <algorithm>
#include <vector>

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

/// Boxes that meet by less only touch.
inline constexpr double boxSlack_m = 1e-4;

/// Half the box's extent along a unit axis, metres.
double reach(const Scope& scope, Vec3d axis);
/// What `share` times the box takes up along x, y and z about its middle, metres.
Box3d boxOf(const Scope& scope, double share = 1);
/// How far eaves and mouldings of a solid, or of one that it is made of, stand out of a scope of such a height beyond
/// its outline, metres; 0 of what has none.
double standsOut_m(const SolidValue& solid, double height_m);
/// The scope of a solid, wider by what stands out of it: mouldings, eaves. A shape without a solid has its own.
Scope outerScope(const ShapeTree& tree, ShapeId shape);
/// The depth by which two oriented boxes overlap (separating axes), metres; negative when they are apart.
double penetration(const Scope& a, const Scope& b);

/// A solid's shape and its extents along the axes.
struct Boxed {
    Box3d box;
    ShapeId shape;
};
/// All shapes with a solid, by their least coordinate along the axis on which they share least; `axis` is set to it.
/// With what stands out of their scopes (outerScope).
std::vector<Boxed> solidsInOrder(const ShapeTree& tree, int& axis);

/// Calls f(a, b) for every pair of solids whose extents share more than −margin along all axes, until f gives false.
template <class F>
void forPairs(const ShapeTree& tree, double margin, F f) {
    int axis = 0;
    const auto boxes = solidsInOrder(tree, axis);
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    const auto apart = [&](const Box3d& a, const Box3d& b, int i) {
        return a.hi[i] + margin < b.lo[i] || b.hi[i] + margin < a.lo[i];
    };
    for (size_t i = 0; i < boxes.size(); ++i)
        for (size_t k = i + 1; k < boxes.size() && boxes[k].box.lo[axis] <= boxes[i].box.hi[axis] + margin; ++k)
            if (!apart(boxes[i].box, boxes[k].box, second) && !apart(boxes[i].box, boxes[k].box, third) &&
                !f(boxes[i].shape, boxes[k].shape))
                return;
}

}  // namespace sgm::derive
