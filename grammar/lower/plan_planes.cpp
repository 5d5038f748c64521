#include "grammar/lower/plan_planes.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/scope_footprint.h"
#include "modeler/core/conventions.h"
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

/// A roof with the same profile over every edge: what of it lies between two heights.
class ProfiledRoof {
public:
    /// `run_m` inward and `height_m` above `foot_m`, which is about the scope's centre, the profile ends.
    ProfiledRoof(const Plan& plan, double run_m, double foot_m, double height_m)
        : plan_(plan), run_m_(run_m), foot_m_(foot_m), height_m_(height_m) {}

    /// Half of a line in shares: a * u + b * v <= c, u from 1 at the edge to 0 at the run, v from 0 to 1 at the top.
    struct Line {
        double a, b, c;
    };
    PlanPlanes between(double from, double to, const std::vector<Line>& lines) const {
        PlanPlanes planes{plan_.formula, {foot_m_ + from * height_m_, foot_m_ + to * height_m_, {}}, std::nullopt};
        for (const plan::PlacedEdge& edge : plan_.edges) {
            ConvexPart& side = planes.outer.sides.emplace_back(ConvexPart{wall(edge, 0)});
            for (const Line& line : lines) side.push_back(planeOver(edge, line));
        }
        return planes;
    }
    /// Planes that touch the quarter of a circle of `radius` about (0, centre): five, so that they stand out by 1.3 %.
    static std::vector<Line> tangents(double radius, double centre) {
        constexpr int count = 5;
        std::vector<Line> lines;
        for (int i = 0; i < count; ++i) {
            const double angle = pi / 2 * (i + .5) / count, a = std::cos(angle), b = std::sin(angle);
            lines.push_back({a, b, radius + b * centre});
        }
        return lines;
    }

private:
    HalfSpace planeOver(const plan::PlacedEdge& edge, const Line& line) const {
        const plan::Vec2 n = edge.normal();
        const Vec3d normal{n.x * line.a / run_m_, line.b / height_m_, n.z * line.a / run_m_};
        const double l = length(normal);
        const double offset = line.c - line.a + line.a * dot(n, edge.from) / run_m_ + line.b * foot_m_ / height_m_;
        return {normal * (1 / l), offset / l};
    }

    const Plan& plan_;
    double run_m_, foot_m_, height_m_;
};

/// The lower half of a bell is hollow: pieces between heights, each under a chord.
void addBell(const ProfiledRoof& roof, std::vector<PlanPlanes>& pieces) {
    constexpr int chords = 4;
    const auto at = [](int i) {
        const double angle = pi / 2 * i / chords;
        return plan::Vec2{1 - std::sin(angle) / 2, (1 - std::cos(angle)) / 2};
    };
    for (int i = 0; i < chords; ++i) {
        const plan::Vec2 from = at(i), to = at(i + 1), way = to - from;
        const ProfiledRoof::Line chord{way.z, -way.x, way.z * from.x - way.x * from.z};
        pieces.push_back(roof.between(from.z, to.z, {chord}));
    }
    pieces.push_back(roof.between(.5, 1, ProfiledRoof::tangents(.5, .5)));
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

std::vector<PlanPlanes> roundPlanesOver(const derive::SolidValue& solid, const Scope& scope,
                                        const derive::Footprints& footprints) {
    const std::string_view name = solid.primitive->name;
    const bool isBell = name == "bellRoof", isPyramid = name == "pyramidRoof";
    if (!isBell && !isPyramid && name != "domeRoof") return {};
    const auto number = [&](size_t i) {
        const field::PrimitiveParameter& p = solid.primitive->parameters[i];
        return std::clamp(solid.args[i].num(), p.lo, p.hi);
    };
    const Plan plan = planOf(scope, footprints);
    const double half = scope.half().y, overhang = number(0), fascia = number(1), foot = -half + fascia;
    const double depth = plan::deepestPoint(plan.footprint, plan.formula).depth;
    std::vector<PlanPlanes> pieces;
    if (isPyramid) {
        const plan::Vec2 apex = centroid(plan.footprint);
        std::vector<double> pitches;
        for (const plan::Linear& d : plan::distancesOf(plan.footprint))
            pitches.push_back(std::atan2(2 * half, -d.at(apex)));
        // Where the centroid isn't inside an edge's line, all slopes have the pitch that the depth gives.
        if (std::any_of(pitches.begin(), pitches.end(), [](double p) { return p >= pi / 2 - 1e-9; }))
            pitches.assign(pitches.size(), std::atan2(2 * half, depth));
        const double drop = overhang * std::tan(*std::min_element(pitches.begin(), pitches.end()));
        PlanPlanes planes{plan.formula, {-half - drop, half + fascia, {}}, std::nullopt};
        for (size_t i = 0; i < plan.edges.size(); ++i)
            planes.outer.sides.push_back({wall(plan.edges[i], overhang), slopeOver(plan.edges[i], {pitches[i]}, foot)});
        return {planes};
    }
    const ProfiledRoof roof(plan, depth, foot, std::max(2 * half - fascia, 1e-3));
    if (fascia > 0) {
        PlanPlanes board{plan.formula, {-half, foot, {}}, std::nullopt};
        for (const plan::PlacedEdge& edge : plan.edges) board.outer.sides.push_back({wall(edge, overhang)});
        pieces.push_back(std::move(board));
    }
    if (isBell)
        addBell(roof, pieces);
    else
        pieces.push_back(roof.between(0, 1, ProfiledRoof::tangents(1, 0)));
    return pieces;
}

}  // namespace sgm::lower
