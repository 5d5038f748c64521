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
/// The depth by which two oriented boxes overlap (separating axes), metres; negative when they are apart.
double penetration(const Scope& a, const Scope& b);

/// A solid's shape and its extent along x, for the sweep.
struct Boxed {
    double lo, hi;
    ShapeId shape;
};
/// All shapes with a solid, by their least x.
std::vector<Boxed> solidsByX(const ShapeTree& tree);

/// Calls f(a, b) for every pair of solids whose extents along x share more than −margin.
template <class F>
void forPairs(const ShapeTree& tree, double margin, F f) {
    const auto boxes = solidsByX(tree);
    for (size_t i = 0; i < boxes.size(); ++i)
        for (size_t k = i + 1; k < boxes.size() && boxes[k].lo <= boxes[i].hi + margin; ++k) f(boxes[i].shape, boxes[k].shape);
}

}  // namespace sgm::derive
