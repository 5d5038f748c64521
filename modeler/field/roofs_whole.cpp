// Roofs that don't rise from their edges by planes: one or two planes over all, one point, flat ones, curved ones.
#include <fmt/format.h>

#include <algorithm>

#include "modeler/field/ops.h"
#include "modeler/field/roof_parts.h"
#include "modeler/plan/validate.h"

namespace sgm::field {

namespace {

using namespace roof_parts;

/// A product that keeps the piece of surface its factors lie on, which a square forgets.
NodeRef squareWithLabel(NodeRef a) { return a.graph().apply(codeOf<ops::Mul>, {a, a}); }

/// A unit direction of the plan; +z for none.
plan::Vec2 unit(plan::Vec2 v) {
    const double l = length(v);
    return l > 0 ? v * (1 / l) : plan::Vec2{0, 1};
}

/// Metres along `way` from the line through `from` square to it.
NodeRef along(const PlanField& plan, uint64_t path, plan::Vec2 way, double from) {
    const auto number = [&](uint64_t i, double v) { return pathSlot(plan.graph(), path, "direction", i, v); };
    return plan.position().x * number(0, way.x) + plan.position().z * number(1, way.z) - number(2, from);
}

/// The least and the greatest dot(way, corner).
std::pair<double, double> extentAlong(const PlanField& plan, plan::Vec2 way) {
    double lo = plan::Box2::far, hi = -lo;
    for (const plan::PlacedEdge& e : plan.edges())
        lo = std::min(lo, dot(way, e.from)), hi = std::max(hi, dot(way, e.from));
    return {lo, hi};
}

/// Depth below the outline as a share of `run`, from 1 at the outline to 0 there and beyond.
NodeRef shareLeft(const PlanField& plan, Quantity run) { return max(plan.outside() + run.node, 0.0f) / run.node; }

/// `run`, or the depth of the footprint where it is 0.
Quantity wholeRun(const PlanField& plan, const RoofFoot& foot, Quantity run) {
    if (run.value > 0) return run;
    const double depth = depthOf(plan);
    return {pathSlot(plan.graph(), foot.path, "run", 0, depth), depth};
}

/// Height above the fascia.
NodeRef aboveFascia(const RoofFoot& foot, const Foot& at) { return at.hasFascia ? at.up - foot.fascia.node : at.up; }

/// Curved roofs come to nothing where they meet the eaves' height: only the board at the eaves can stand out.
RoofFoot ofCurved(RoofFoot foot, Graph& graph) {
    if (foot.fascia.value <= 0) foot.overhang = fixed(graph, 0);
    return foot;
}

/// The walls of a curved roof, moved out to the overhang, which begins at the eaves' height.
NodeRef walls(const PlanField& plan, const RoofFoot& foot) { return plan.outside() - foot.overhang.node; }

}  // namespace

Field shedRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, plan::Vec2 up) {
    const plan::Vec2 way = unit(up);
    const auto [lo, hi] = extentAlong(plan, way);
    const Quantity pitches[] = {pitch};
    const Foot at = footOf(plan, foot, pitches);
    const NodeRef raised = aboveFascia(foot, at);
    const NodeRef plane = raised * cos(pitch.node) - along(plan, foot.path, way, lo) * sin(pitch.node);
    const double height = std::tan(pitch.value) * (hi - lo + foot.overhang.value * 4) + foot.fascia.value;
    return onFoot(plan, foot, at, max(walls(plan, foot), plane), height);
}

Field butterflyRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, plan::Vec2 valley) {
    const plan::Vec2 v = unit(valley), across{-v.z, v.x};
    const auto [lo, hi] = extentAlong(plan, across);
    const NodeRef off = along(plan, foot.path, across, (lo + hi) / 2);
    const NodeRef up = plan.position().y - foot.eaves.node - foot.fascia.node;
    const NodeRef planes =
        min(up * cos(pitch.node) - off * sin(pitch.node), up * cos(pitch.node) + off * sin(pitch.node));
    const Foot at = footOf(plan, foot, {});
    const double height = std::tan(pitch.value) * ((hi - lo) / 2 + foot.overhang.value * 4) + foot.fascia.value;
    return onFoot(plan, foot, at, max(walls(plan, foot), planes), height);
}

Field pyramidRoof(const PlanField& plan, const RoofFoot& foot, Quantity height) {
    const plan::Vec2 apex = centroid(plan.footprint());
    const auto distances = plan.numbers().distances();
    const bool seen =
        std::all_of(distances.begin(), distances.end(), [&](const plan::Linear& d) { return d.at(apex) < -1e-6; });
    const auto pitchFor = [&](uint64_t edge, double depth) {
        const NodeRef run = pathSlot(plan.graph(), foot.path, "depth of the apex", edge, depth);
        return Quantity{atan2(height.node, run), std::atan2(height.value, depth)};
    };
    const auto plane = [&](Quantity angle) {
        return RoofSide{{{angle, fixed(plan.graph(), 0), fixed(plan.graph(), 0)}}};
    };
    if (!seen)
        return roof(plan, foot,
                    std::vector{plane(pitchFor(0, plan::deepestPoint(plan.footprint(), plan.formula()).depth))});
    std::vector<RoofSide> sides;
    for (size_t i = 0; i < distances.size(); ++i) sides.push_back(plane(pitchFor(i, -distances[i].at(apex))));
    return roof(plan, foot, sides);
}

Field flatRoof(const PlanField& plan, const RoofFoot& foot, Quantity slab, Quantity parapetHeight,
               Quantity parapetThickness) {
    const Foot at = footOf(plan, foot, {});
    const NodeRef inside = walls(plan, foot) + parapetThickness.node;  // < 0 behind the parapet
    const NodeRef basin = min(at.up - slab.node, -inside);
    const NodeRef top = at.up - slab.node - parapetHeight.node;
    const NodeRef whole =
        parapetHeight.value > 0 ? max(max(walls(plan, foot), top), basin) : max(walls(plan, foot), at.up - slab.node);
    return onFoot(plan, foot, at, whole, slab.value + std::max(parapetHeight.value, 0.0));
}

// In shares (u, v) of run and height: the quarter of a circle about (run, 0). The gradient is at most 1 over the least
// scale.
Field domeRoof(const PlanField& plan, const RoofFoot& given, Quantity height, Quantity run) {
    const RoofFoot foot = ofCurved(given, plan.graph());
    const Quantity r = wholeRun(plan, foot, run);
    const Foot at = footOf(plan, foot, {});
    const NodeRef u = shareLeft(plan, r), v = max(aboveFascia(foot, at), 0.0f) / height.node;
    NodeRef round = (sqrt(squareWithLabel(u) + square(v)) - 1.0f) * min(r.node, height.node);
    if (foot.overhang.value > 0) round = min(round, aboveFascia(foot, at));  // the board, beyond the circle
    return onFoot(plan, foot, at, max(walls(plan, foot), round), height.value + foot.fascia.value);
}

// Two quarters of circles of half the run and half the height: outside of the one about the foot, inside of the one
// about the top.
Field bellRoof(const PlanField& plan, const RoofFoot& given, Quantity height, Quantity run) {
    const RoofFoot foot = ofCurved(given, plan.graph());
    const Quantity r = wholeRun(plan, foot, run);
    const Foot at = footOf(plan, foot, {});
    const NodeRef left = shareLeft(plan, r), v = aboveFascia(foot, at) / height.node;
    const NodeRef in = 1.0f - left, half = plan.graph().literal(0.5f);
    const NodeRef upper = sqrt(squareWithLabel(left) + square(max(v - half, 0.0f))) - half;
    const NodeRef hollow = half - sqrt(squareWithLabel(max(in, 0.0f)) + square(max(half - v, 0.0f)));
    const NodeRef bell = min(upper, max(v - half, hollow)) * min(r.node, height.node);
    return onFoot(plan, foot, at, max(walls(plan, foot), bell), height.value + foot.fascia.value);
}

Result<Field> profileRoof(const PlanField& plan, const RoofFoot& foot, std::span<const plan::Vec2> points) {
    if (points.size() < 2) return Error{Error::Kind::Input, "the profile of a roof needs two points or more"};
    double top = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        if (!(std::abs(points[i].x) < 1e4 && std::abs(points[i].z) < 1e4) || (i > 0 && points[i].x < points[i - 1].x))
            return Error{
                Error::Kind::Input,
                fmt::format(
                    "point {} of a roof's profile, ({:.6g}, {:.6g}), must lie farther inward than the one before",
                    i + 1, points[i].x, points[i].z)};
        top = std::max(top, points[i].z);
    }
    // The region below the profile, out to where nothing of the roof is, over (Φ, height).
    const double far =
        10 * (top + foot.overhang.value + std::abs(points.back().x) + length(bounds(plan.footprint()).size()));
    std::vector<plan::Vec2> outline{{-points.front().x, -far}, {-far, -far}, {-far, points.back().z}};
    for (size_t i = points.size(); i-- > 0;) outline.push_back({-points[i].x, points[i].z});
    const plan::Footprint section = plan::cleaned(plan::footprintOf(plan::polygonOf(outline)), 1e-6, 1e-6);
    const auto formula = plan::monotoneFormula(section);
    if (!formula) return Error{formula.error().kind, "profile of a roof: " + formula.error().message};
    const Foot at = footOf(plan, foot, {});
    const NodeRef up = aboveFascia(foot, at);
    const PlanField swept(section, *formula, {plan.outside() - foot.overhang.node, up, up}, foot.path);
    return onFoot(plan, foot, at, max(walls(plan, foot), swept.outside()), top + foot.fascia.value);
}

}  // namespace sgm::field
