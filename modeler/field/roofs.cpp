#include "modeler/field/roofs.h"

#include <algorithm>

#include "modeler/core/conventions.h"
#include "modeler/field/combine.h"
#include "modeler/field/roof_parts.h"
#include "modeler/plan/reflex.h"

namespace sgm::field {

namespace roof_parts {

NodeRef tangent(NodeRef angle) { return sin(angle) / cos(angle); }

NodeRef slopePlane(NodeRef outside, NodeRef up, const Pitch& pitch, const Foot& at) {
    if (at.knows(pitch.angle)) return (up - pitch.rise.node) * at.cosine + (outside + pitch.inset.node) * at.sine;
    return (up - pitch.rise.node) * cos(pitch.angle.node) + (outside + pitch.inset.node) * sin(pitch.angle.node);
}

Foot footOf(const PlanField& plan, const RoofFoot& foot, std::span<const Quantity> pitches) {
    Foot result;
    result.up = plan.position().y - foot.eaves.node;
    result.hasFascia = foot.fascia.value > 0;
    if (foot.overhang.value <= 0 || pitches.empty()) {
        result.drop = plan.graph().literal(0);
        return result;
    }
    NodeRef least = tangent(pitches[0].node);
    if (const auto ratio = plan.graph().operands(least.id()); ratio.size() == 2) {
        result.angle = pitches[0].node, result.hasAngle = true;
        result.sine = {&plan.graph(), ratio[0].node}, result.cosine = {&plan.graph(), ratio[1].node};
    }
    double leastValue = std::tan(pitches[0].value);
    NodeId last = pitches[0].node.id();
    for (const Quantity& p : pitches.subspan(1)) {
        if (p.node.id() != last) least = min(least, tangent(p.node));
        last = p.node.id(), leastValue = std::min(leastValue, std::tan(p.value));
    }
    result.drop = foot.overhang.node * least;
    result.dropValue = foot.overhang.value * leastValue;
    return result;
}

Field onFoot(const PlanField& plan, const RoofFoot& foot, const Foot& at, NodeRef sides, double height) {
    const double bottom = foot.eaves.value - at.dropValue, top = foot.eaves.value + std::max(height, 0.0);
    return plan.boxed(max(sides, -at.drop - at.up), foot.path, bottom, top, foot.overhang.value);
}

double depthOf(const PlanField& plan) { return plan.numbers().depth(); }

}  // namespace roof_parts

namespace {

using namespace roof_parts;

/// Height of the roof's highest point above the eaves: each side's last plane, walls without end.
double peakOf(const PlanField& plan, std::span<const RoofSide* const> sides) {
    std::vector<plan::Linear> distances = plan.numbers().distances(), leaves = distances;
    double steepest = 0;
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (sides[i]->pitches.empty()) {
            leaves[i] = {0, 0, -1e12};
            continue;
        }
        const Pitch& last = sides[i]->pitches.back();
        const double t = std::tan(last.angle.value);
        steepest = std::max(steepest, t);
        leaves[i] = {distances[i].a * t, distances[i].b * t, (distances[i].c + last.inset.value) * t - last.rise.value};
    }
    const plan::Box2 box = bounds(plan.footprint());
    const double size = std::max(box.size().x, box.size().z);
    const double least = plan::leastInside(plan.formula(), leaves, distances, box,
                                           1e-3 * steepest * std::min(box.size().x, box.size().z));
    return std::clamp(-least, 0.0, 1e3 * size * std::max(steepest, 1.0));
}

/// The same planes over every edge: the profile of Φ itself, which costs no more for many edges.
Field uniformRoof(const PlanField& plan, const RoofFoot& foot, const RoofSide& side) {
    std::vector<Quantity> angles{side.pitches.front().angle};
    const Foot at = footOf(plan, foot, angles);
    const NodeRef up = at.hasFascia ? at.up - foot.fascia.node : at.up;
    NodeRef sides = slopePlane(plan.outside(), up, side.pitches[0], at);
    for (size_t i = 1; i < side.pitches.size(); ++i)
        sides = max(sides, slopePlane(plan.outside(), up, side.pitches[i], at));
    if (at.hasFascia) sides = max(sides, plan.outside() - foot.overhang.node);
    const Pitch& last = side.pitches.back();
    const double height =
        last.rise.value + std::tan(last.angle.value) * std::max(depthOf(plan) - last.inset.value, 0.0);
    return onFoot(plan, foot, at, sides, height + foot.fascia.value);
}

Pitch planeOf(const PlanField& plan, Quantity angle) { return {angle, fixed(plan.graph(), 0), fixed(plan.graph(), 0)}; }

/// One side an edge: `ends` have `end`, the others `side`.
std::vector<RoofSide> sidesWithEnds(const PlanField& plan, const RoofSide& side, const RoofSide& end,
                                    std::span<const uint32_t> ends) {
    std::vector<RoofSide> sides(plan.edges().size(), side);
    for (const uint32_t e : ends)
        if (e < sides.size()) sides[e] = end;
    return sides;
}

/// Steep up to a height, then flatter.
RoofSide brokenSide(const PlanField& plan, Quantity lower, Quantity height, Quantity upper) {
    Graph& g = plan.graph();
    const Quantity inset{height.node / tangent(lower.node), height.value / std::tan(lower.value)};
    return {{{lower, fixed(g, 0), fixed(g, 0)}, {upper, inset, height}}};
}

}  // namespace

Field roof(const PlanField& plan, const RoofFoot& foot, std::span<const RoofSide> sides) {
    const auto pitched = std::find_if(sides.begin(), sides.end(), [](const RoofSide& s) { return !s.pitches.empty(); });
    if (pitched == sides.end()) return nothing(plan.graph());
    if (sides.size() == 1) return uniformRoof(plan, foot, sides[0]);

    const size_t n = plan.edges().size();
    const std::vector<bool> reflex = plan::edgesAtReflexCorners(plan.footprint());
    std::vector<const RoofSide*> chosen(n, &*pitched);
    for (size_t i = 0; i < std::min(n, sides.size()); ++i)
        if (!sides[i].pitches.empty() || !reflex[i]) chosen[i] = &sides[i];
    if (std::all_of(chosen.begin(), chosen.end(), [](const RoofSide* s) { return s->pitches.empty(); }))
        return nothing(plan.graph());

    std::vector<Quantity> angles;
    for (const RoofSide* side : chosen)
        if (!side->pitches.empty()) angles.push_back(side->pitches.front().angle);
    const Foot at = footOf(plan, foot, angles);
    const NodeRef up = at.hasFascia ? at.up - foot.fascia.node : at.up;
    const NodeRef sidesValue = plan.fold([&](uint32_t edge) {
        const NodeRef d = plan.distance(edge);
        const RoofSide& side = *chosen[edge];
        const bool hasWall = side.pitches.empty() || at.hasFascia || side.pitches.front().rise.value > 0;
        NodeRef value = hasWall ? d - foot.overhang.node : slopePlane(d, up, side.pitches[0], at);
        for (size_t k = hasWall ? 0 : 1; k < side.pitches.size(); ++k)
            value = max(value, slopePlane(d, up, side.pitches[k], at));
        return value;
    });
    return onFoot(plan, foot, at, sidesValue, peakOf(plan, chosen) + foot.fascia.value);
}

Field hipRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch) {
    return uniformRoof(plan, foot, {{planeOf(plan, pitch)}});
}

Field gableRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, std::span<const uint32_t> ends) {
    return roof(plan, foot, sidesWithEnds(plan, {{planeOf(plan, pitch)}}, {}, ends));
}

// The hip of an end begins at `share` of the height at which its two neighbours meet over it.
Field halfHipRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, std::span<const uint32_t> ends,
                  Quantity share) {
    Graph& g = plan.graph();
    std::vector<RoofSide> sides(plan.edges().size(), RoofSide{{planeOf(plan, pitch)}});
    for (const uint32_t e : ends) {
        if (e >= sides.size()) continue;
        const double half = plan.edges()[e].length() / 2;
        const NodeRef rise = share.node * tangent(pitch.node) * pathSlot(g, foot.path, "half width", e, half);
        sides[e].pitches[0].rise = {rise, share.value * std::tan(pitch.value) * half};
    }
    return roof(plan, foot, sides);
}

Field mansardRoof(const PlanField& plan, const RoofFoot& foot, Quantity lower, Quantity height, Quantity upper) {
    return uniformRoof(plan, foot, brokenSide(plan, lower, height, upper));
}

Field gambrelRoof(const PlanField& plan, const RoofFoot& foot, Quantity lower, Quantity height, Quantity upper,
                  std::span<const uint32_t> ends) {
    return roof(plan, foot, sidesWithEnds(plan, brokenSide(plan, lower, height, upper), {}, ends));
}

Field saltboxRoof(const PlanField& plan, const RoofFoot& foot, Quantity frontPitch, Quantity backPitch,
                  plan::Vec2 front, std::span<const uint32_t> ends) {
    std::vector<RoofSide> sides;
    for (const plan::PlacedEdge& e : plan.edges())
        sides.push_back({{planeOf(plan, dot(e.normal(), front) > 0 ? frontPitch : backPitch)}});
    for (const uint32_t e : ends)
        if (e < sides.size()) sides[e].pitches.clear();
    return roof(plan, foot, sides);
}

}  // namespace sgm::field
