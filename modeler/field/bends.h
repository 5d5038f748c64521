// Runs of nearly parallel edges in a formula, which are folded relative to a common plane.
// Enters: a monotone formula and its edges. Leaves: for every node the plane that its value is relative to. Assumes a
// formula of those edges. Why: over a box, the intervals of nearly parallel half-planes are as wide as the box and
// overlap, so that none can be dropped; less what they have in common they are narrow. A round wall of 1,000 edges
// keeps a tenth of them in a brick.
#pragma once

#include <span>
#include <vector>

#include "modeler/plan/formula.h"

namespace sgm::field {

/// dot(normal, p) − offset.
struct PlanPlane {
    plan::Vec2 normal;
    double offset = 0;
};

/// Which planes the nodes of a formula are relative to.
struct Bends {
    static constexpr uint32_t none = UINT32_MAX;
    std::vector<PlanPlane> planes;  ///< of the bends; each by itself, not relative to another
    std::vector<uint32_t> ofNode;   ///< by node: the bend whose plane its value is relative to, or none
    std::vector<uint32_t>
        beginsAt;                 ///< by node: the bend whose top it is, or none; its value is relative to outer[bend]
    std::vector<uint32_t> outer;  ///< by bend: the bend around it, or none
};

/// Finds subtrees of at least 8 edges whose normals lie within 24°, and in these again within a quarter of their angle.
Bends bendsOf(const plan::Formula& formula, std::span<const plan::PlacedEdge> edges);

}  // namespace sgm::field
