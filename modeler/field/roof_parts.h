// What the sources of roofs share: planes, the height at which a roof ends below, and its box.
// Enters: nodes and quantities of one graph. Leaves: the same. Not for other folders.
#pragma once

#include "modeler/field/roofs.h"

namespace sgm::field::roof_parts {

/// The lower end of a roof.
struct Foot {
    NodeRef up;    ///< height above the eaves
    NodeRef drop;  ///< how far below the eaves the roof ends
    double dropValue = 0;
    bool hasFascia = false;
    NodeRef angle, sine, cosine;  ///< of the first pitch, where the drop has made them
    bool knows(const Quantity& pitch) const { return hasAngle && pitch.node.id() == angle.id(); }
    bool hasAngle = false;
};

NodeRef tangent(NodeRef angle);
/// The signed distance to the plane that rises inward of `outside` = −inset from `up` = rise. Sine and cosine that `at`
/// knows aren't looked for in the graph.
NodeRef slopePlane(NodeRef outside, NodeRef up, const Pitch& pitch, const Foot& at);
/// Slopes of at least the least of the pitches go down to the overhang.
Foot footOf(const PlanField& plan, const RoofFoot& foot, std::span<const Quantity> pitches);
/// `sides` above the roof's lower end, with bounds up to `height` metres above the eaves.
Field onFoot(const PlanField& plan, const RoofFoot& foot, const Foot& at, NodeRef sides, double height);
/// The greatest depth of the footprint, metres: at most a thousandth too much.
double depthOf(const PlanField& plan);

}  // namespace sgm::field::roof_parts
