#include "grammar/lower/plan_planes.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/scope_footprint.h"
#include "modeler/field/plan_solids.h"

namespace sgm::lower {
namespace {

using derive::Scope;
using field::ConvexPart;
using field::HalfSpace;

/// A footprint with its formula, metres about the scope's centre.
struct Plan {
    plan::Footprint footprint;
    plan::Formula formula;
    std::vector<plan::PlacedEdge> edges;
};

Plan planOf(const Scope& scope, const derive::Footprints& footprints) {
    Plan plan{derive::footprintOf(scope, footprints), {}, {}};
    const bool known = scope.footprint != derive::none;
    plan.formula = known ? footprints[scope.footprint].formula : plan::monotoneFormula(plan.footprint).value();
    plan.edges = plan::edgesOf(plan.footprint);
    return plan;
}

HalfSpace wall(const plan::PlacedEdge& edge, double out) {
    const plan::Vec2 n = edge.normal();
    return {{n.x, 0, n.z}, dot(n, edge.from) + out};
}

/// A plane that rises inward by `pitch` through the line `inset` metres inside an edge and `rise` metres above the
/// eaves.
struct Slope {
    double pitch, inset = 0, rise = 0;
};

HalfSpace slopeOver(const plan::PlacedEdge& edge, const Slope& slope, double eaves) {
    const plan::Vec2 n = edge.normal();
    const double s = std::sin(slope.pitch), c = std::cos(slope.pitch);
    return {{n.x * s, c, n.z * s}, (dot(n, edge.from) - slope.inset) * s + (eaves + slope.rise) * c};
}

/// By edge: whether a wall goes up there.
std::vector<bool> gablesOf(const Plan& plan, field::GableEnds ends) {
    std::vector<bool> gables(plan.edges.size(), false);
    for (const uint32_t edge : field::gablesOf(plan.footprint, plan.formula, ends)) gables[edge] = true;
    return gables;
}

struct Pitched {
    std::vector<Slope> slopes;
    double overhang, eaves;  ///< metres; the height of the slopes over the outline, about the scope's centre
};

PlanRise pitchedRise(const Plan& plan, const Scope& scope, const Pitched& roof, const std::vector<bool>& gables,
                     double bottom) {
    PlanRise rise{bottom, scope.half().y, {}};
    for (size_t i = 0; i < plan.edges.size(); ++i) {
        ConvexPart& side = rise.sides.emplace_back(ConvexPart{wall(plan.edges[i], roof.overhang)});
        for (const Slope& slope : roof.slopes)
            if (!gables[i]) side.push_back(slopeOver(plan.edges[i], slope, roof.eaves));
    }
    return rise;
}

}  // namespace

HalfSpace inObject(HalfSpace plane, const Scope& scope) {
    plane.normal = scope.axes * plane.normal;
    plane.offset += dot(plane.normal, scope.centre);
    return plane;
}

std::optional<PlanPlanes> planesOver(const derive::SolidValue& solid, const Scope& scope,
                                     const derive::Footprints& footprints) {
    const std::string_view name = solid.primitive->name;
    const bool isPrism = name == "block" || name == "flatRoof",
               hasGables = name == "gableRoof" || name == "gambrelRoof";
    const bool isBroken = name == "mansardRoof" || name == "gambrelRoof";
    if (!isPrism && !isBroken && name != "gableRoof" && name != "hipRoof") return std::nullopt;
    const double half = scope.half().y;
    const auto number = [&](size_t i) {
        const field::PrimitiveParameter& p = solid.primitive->parameters[i];
        return std::clamp(solid.args[i].num(), p.lo, p.hi);
    };
    const Plan plan = planOf(scope, footprints);
    PlanPlanes planes{plan.formula, {}, std::nullopt};
    if (isPrism) {
        const bool isFlat = name == "flatRoof";
        const double slab = isFlat ? number(0) : 0, parapet = isFlat ? number(1) : 0;
        planes.outer = {-half, isFlat ? -half + slab + parapet : half, {}};
        for (const plan::PlacedEdge& edge : plan.edges) planes.outer.sides.push_back({wall(edge, 0)});
        if (parapet <= 0) return planes;
        planes.hollow = {-half + slab, -half + slab + parapet + 1, {}};
        for (const plan::PlacedEdge& edge : plan.edges) planes.hollow->sides.push_back({wall(edge, -number(2))});
        return planes;
    }
    const size_t first = isBroken ? 3 : 1;  // of overhang, fascia, cover, ends
    const double overhang = number(first), fascia = number(first + 1), cover = number(first + 2);
    Pitched roof{{{number(0)}}, overhang, -half + fascia};
    if (isBroken) roof.slopes.push_back({std::min(number(0), number(2)), number(1) / std::tan(number(0)), number(1)});
    const std::vector<bool> gables =
        hasGables ? gablesOf(plan, static_cast<field::GableEnds>(static_cast<int>(number(first + 3))))
                  : std::vector<bool>(plan.edges.size(), false);
    const double bottom = -half - overhang * std::tan(number(0));
    planes.outer = pitchedRise(plan, scope, roof, gables, bottom);
    if (cover <= 0) return planes;
    roof.overhang += 1;
    roof.eaves -= cover / std::cos(roof.slopes.back().pitch);
    planes.hollow = pitchedRise(plan, scope, roof, gables, bottom - 1);
    return planes;
}

}  // namespace sgm::lower
