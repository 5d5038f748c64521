#include "modeler/field/footprint.h"

#include <algorithm>

#include "modeler/plan/validate.h"

namespace sgm::field {

namespace {

/// What lies between two heights.
NodeRef between(const PlanField& plan, Quantity bottom, Quantity top) {
    const NodeRef y = plan.position().y;
    return max(bottom.node - y, y - top.node);
}

}  // namespace

Field prism(const PlanField& plan, Quantity bottom, Quantity top, uint64_t path) {
    return plan.boxed(max(plan.outside(), between(plan, bottom, top)), path, bottom.value, top.value);
}

Field taperedPrism(const PlanField& plan, Quantity bottom, Quantity top, Quantity angle, uint64_t path) {
    const NodeRef up = plan.position().y - bottom.node;
    const NodeRef sides = plan.outside() * cos(angle.node) + up * sin(angle.node);
    const double out = -std::tan(angle.value) * (top.value - bottom.value);
    return plan.boxed(max(sides, between(plan, bottom, top)), path, bottom.value, top.value, std::max(out, 0.0));
}

// The rooms are what lies deeper than the walls, above the floor and below the ceiling; a floor or ceiling of 0 is
// open.
Field shell(const PlanField& plan, Quantity bottom, Quantity top, Quantity wall, Quantity floor, Quantity ceiling,
            uint64_t path) {
    const NodeRef y = plan.position().y;
    NodeRef rooms = plan.outside() + wall.node;
    if (floor.value > 0) rooms = max(rooms, bottom.node + floor.node - y);
    if (ceiling.value > 0) rooms = max(rooms, y - (top.node - ceiling.node));
    const NodeRef block = max(plan.outside(), between(plan, bottom, top));
    return plan.boxed(max(block, -rooms), path, bottom.value, top.value);
}

// The profile is itself a footprint, over the coordinates (Φ, y).
Result<Field> moulding(const PlanField& plan, std::span<const plan::Vec2> profile, Quantity foot, uint64_t path) {
    const plan::Footprint section = plan::footprintOf(plan::polygonOf({profile.begin(), profile.end()}));
    const auto formula = plan::monotoneFormula(section);
    if (!formula) return Error{formula.error().kind, "profile of a moulding: " + formula.error().message};
    const NodeRef up = plan.position().y - foot.node;
    const PlanField swept(section, *formula, {plan.outside(), up, up}, path);
    const plan::Box2 box = bounds(section);
    return plan.boxed(swept.outside(), path, foot.value + box.lo.z, foot.value + box.hi.z, std::max(box.hi.x, 0.0));
}

}  // namespace sgm::field
