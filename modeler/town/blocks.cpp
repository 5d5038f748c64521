#include "modeler/town/blocks.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/random.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"
#include "modeler/town/lot_parts.h"
#include "modeler/town/outline.h"

namespace sgm::town {
namespace {

using plan::Boolean;
using plan::Footprint;

constexpr double leastBlock_m2 = 1;

/// The word for the side of a block along an edge.
const char* tagOf(const RoadEdge& edge) {
    if (edge.kind == RoadClass::Highway) return edge.bridge ? "bridge highway" : "street highway";
    return edge.bridge ? "bridge" : "street";
}

plan::Ring ringOf(const RoadGraph& graph, const std::vector<HalfEdge>& loop, Footprint& tags) {
    plan::Ring ring;
    for (const HalfEdge h : loop) {
        ring.points.push_back(graph.metresAt(beginOf(graph, h)));
        ring.edges.push_back({tags.tag(tagOf(graph.edge(edgeOf(h)))), plan::EdgeSource::Side});
    }
    return ring;
}

/// A road with both sides in one face, with some ground at its ends, so that nothing is built on a turning place.
Footprint stripOf(const RoadGraph& graph, const RoadParameters& parameters, uint32_t edge) {
    const RoadEdge& e = graph.edge(edge);
    const double half = parameters.width_m(e.kind) / 2;
    const Vec2 a = graph.metresAt(e.a), b = graph.metresAt(e.b), d = unit(b - a) * half, n{-d.z, d.x};
    Footprint out;
    const plan::Edge tagged{out.tag(tagOf(e)), plan::EdgeSource::Side};
    plan::Ring ring = plan::ringOf({a - d - n, b + d - n, b + d + n, a - d + n}, tagged);
    out.polygons.push_back({std::move(ring), {}});
    return out;
}

/// Where `holds` in the box of the land, taken off it. Edges of `what` keep their tag.
void cut(Footprint& land, const std::function<bool(Vec2)>& holds, double cell_m, const char* tag) {
    if (!holds || land.empty()) return;
    const plan::Box2 box = bounds(land);
    cell_m = std::max(cell_m, std::max(box.size().x, box.size().z) / 512);
    const Footprint off = outlineOf(holds, box.lo - Vec2{cell_m, cell_m}, box.hi + Vec2{cell_m, cell_m}, cell_m, tag);
    if (!off.empty()) land = plan::boolean(Boolean::Difference, land, off);
}

uint64_t keyOf(const Footprint& land) {
    Point least = pointAt(land.polygons[0].outer.points[0]);
    for (const Vec2 p : land.polygons[0].outer.points) least = std::min(least, pointAt(p));
    return combine(static_cast<uint32_t>(least.x), static_cast<uint32_t>(least.z));
}

/// A face's edge at a node as the node sees it: `direction` leaves the node.
struct Arm {
    uint32_t edge = noIndex;
    Vec2 direction;
    double half_m = 0;
    double cut_m = 0;            ///< where the crossing ends along it
    Vec2 left, right;            ///< corners of its surface at this end
    std::vector<Vec2> leftTurn;  ///< corner points between its left side and the next arm's right one
};

Vec2 leftNormal(Vec2 d) { return {-d.z, d.x}; }

/// The corners between an arm and the next one around the node, counter-clockwise.
void meet(Vec2 at, Arm& arm, Arm& next) {
    constexpr double mitre = 4;
    const Vec2 n = leftNormal(arm.direction), m = leftNormal(next.direction);
    const double by = cross(arm.direction, next.direction), half = std::max(arm.half_m, next.half_m);
    const Vec2 own = at + n * arm.half_m, other = at - m * next.half_m;
    if (std::abs(by) > 1e-9) {
        const double t = cross(other - own, next.direction) / by, s = cross(other - own, arm.direction) / by;
        const Vec2 corner = own + arm.direction * t;
        if (length(corner - at) <= mitre * half) {
            arm.leftTurn = {corner};
            arm.cut_m = std::max(arm.cut_m, t);
            next.cut_m = std::max(next.cut_m, s);
            return;
        }
    }
    arm.leftTurn = {own, other};
}

/// All arms of a node in counter-clockwise order.
std::vector<Arm> armsOf(const RoadGraph& graph, const RoadParameters& parameters, uint32_t node,
                        const std::vector<uint32_t>& around) {
    std::vector<Arm> arms;
    for (const uint32_t e : around)
        arms.push_back({e, unit(graph.along(e, node)), parameters.width_m(graph.edge(e).kind) / 2, 0, {}, {}, {}});
    const Vec2 at = graph.metresAt(node);
    const size_t n = arms.size();
    for (size_t i = 0; n > 1 && i < n; ++i) meet(at, arms[i], arms[(i + 1) % n]);
    for (size_t i = 0; i < n; ++i) {
        Arm& arm = arms[i];
        arm.cut_m = std::min(arm.cut_m, length(graph.along(arm.edge, node)) / 2);
        const Vec2 begin = at + arm.direction * (n > 2 ? arm.cut_m : 0), side = leftNormal(arm.direction) * arm.half_m;
        arm.left = begin + side, arm.right = begin - side;
        if (n != 2) continue;
        // A bend has no crossing: both pieces meet along its bisector.
        arm.left = arm.leftTurn.front();
        arm.right = arms[1 - i].leftTurn.back();
    }
    return arms;
}

/// The crossing's polygon; nothing where it is no simple one.
std::optional<Footprint> crossingOf(const std::vector<Arm>& arms) {
    std::vector<Vec2> points;
    const auto add = [&](Vec2 p) {
        if (points.empty() || length(p - points.back()) > 2e-3) points.push_back(p);
    };
    for (const Arm& arm : arms) {
        add(arm.right);
        add(arm.left);
        for (const Vec2 p : arm.leftTurn) add(p);
    }
    while (points.size() > 2 && length(points.front() - points.back()) <= 2e-3) points.pop_back();
    if (points.size() < 3) return std::nullopt;
    Footprint raw;
    raw.polygons.push_back({plan::ringOf(std::move(points)), {}});
    if (!plan::firstFault(raw)) return raw;
    auto resolved = plan::resolved(raw);
    if (!resolved.ok() || resolved->empty()) return std::nullopt;
    return std::move(*resolved);
}

}  // namespace

std::vector<Block> blocksOf(const RoadGraph& graph, const RoadParameters& parameters, const Face& face,
                            const LandCuts& cuts) {
    Footprint land;
    land.polygons.push_back({ringOf(graph, face.outline, land), {}});
    for (const auto& hole : face.holes) {
        Footprint island;
        island.polygons.push_back({plan::reversed(ringOf(graph, hole, island)), {}});
        land = plan::boolean(Boolean::Difference, land, island);
    }
    std::vector<double> distances;
    for (const plan::PlacedEdge& e : plan::edgesOf(land)) {
        const bool highway = land.tags[e.edge.tag].find("highway") != std::string::npos;
        distances.push_back(parameters.width_m(highway ? RoadClass::Highway : RoadClass::Street) / 2);
    }
    land = plan::setback(land, distances);
    for (const uint32_t spur : face.spurs)
        land = plan::boolean(Boolean::Difference, land, stripOf(graph, parameters, spur));
    cut(land, cuts.water, cuts.cell_m, "water");
    cut(land, cuts.park, cuts.cell_m, "park");
    std::vector<Block> blocks;
    for (plan::Polygon& polygon : land.polygons) {
        if (area(polygon) < leastBlock_m2) continue;
        Block& block = blocks.emplace_back();
        block.land = {{std::move(polygon)}, land.tags};
        block.key = keyOf(block.land);
    }
    return blocks;
}

std::vector<RoadSurface> surfacesOf(const RoadGraph& graph, const RoadParameters& parameters) {
    constexpr double least_m = .05;
    const auto around = edgesAround(graph);
    std::vector<RoadSurface> out;
    struct Ends {
        Vec2 left[2], right[2];  ///< of the end at a, then at b, each as seen from its node
        double cut_m[2] = {0, 0};
    };
    std::vector<Ends> ends(graph.edges().size());
    for (uint32_t n = 0; n < around.size(); ++n) {
        const std::vector<Arm> arms = armsOf(graph, parameters, n, around[n]);
        for (const Arm& arm : arms) {
            const int end = graph.edge(arm.edge).a == n ? 0 : 1;
            ends[arm.edge].left[end] = arm.left, ends[arm.edge].right[end] = arm.right;
            ends[arm.edge].cut_m[end] = arms.size() > 2 ? arm.cut_m : 0;
        }
        if (arms.size() < 3) continue;
        if (auto area = crossingOf(arms)) out.push_back({std::move(*area), noIndex, n, {}, {}});
    }
    for (uint32_t e = 0; e < ends.size(); ++e) {
        const RoadEdge& edge = graph.edge(e);
        if (edge.curve) {  // all edges of a curve stand side by side, each going on where the one before ends
            uint32_t last = e;
            while (last + 1 < ends.size() && graph.edge(last + 1).curve == edge.curve) ++last;
            std::vector<Vec2> band{ends[e].right[0]};
            for (uint32_t i = e; i <= last; ++i) band.push_back(ends[i].left[1]);
            for (uint32_t i = last + 1; i-- > e;) band.push_back(ends[i].right[1]);
            band.push_back(ends[e].left[0]);
            out.push_back({plan::footprintOf(plan::polygonOf(std::move(band))), e, noIndex, graph.metresAt(edge.a),
                           graph.metresAt(graph.edge(last).b)});
            e = last;
            continue;
        }
        const Vec2 a = graph.metresAt(edge.a), b = graph.metresAt(edge.b), d = unit(b - a);
        const Ends& at = ends[e];
        if (length(b - a) - at.cut_m[0] - at.cut_m[1] < least_m) continue;
        Footprint area = plan::footprintOf(plan::polygonOf({at.right[0], at.left[1], at.right[1], at.left[0]}));
        out.push_back({std::move(area), e, noIndex, a + d * at.cut_m[0], b - d * at.cut_m[1]});
    }
    return out;
}

}  // namespace sgm::town
