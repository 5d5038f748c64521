#include "modeler/town/grower.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

constexpr double roadSample_m = 5;  // between the places where a road reads the maps
constexpr double inland_m = 15;     // behind the shore, where a bridge ends
constexpr double bridgeStep_m = 20;
constexpr double least_m = 8;  // shortest piece
constexpr double deep_m = 10;  // cuts and fills that are deeper become tunnels and bridges

/// The place on a–b nearest to p.
Vec2 footOn(Vec2 a, Vec2 b, Vec2 p) {
    const Vec2 d = b - a;
    const double t = dot(p - a, d) / dot(d, d);
    return a + d * std::clamp(t, 0.0, 1.0);
}

}  // namespace

bool Grower::isInside(Vec2 p) const {
    return p.x >= parameters_.lo.x && p.x <= parameters_.hi.x && p.z >= parameters_.lo.z && p.z <= parameters_.hi.z;
}

Grower::Survey Grower::survey(Vec2 from, Vec2 to) const {
    Survey out;
    const Vec2 d = to - from;
    out.length_m = lengthOf(d);
    const int count = std::max(1, static_cast<int>(std::ceil(out.length_m / roadSample_m)));
    const double low = land_.height ? land_.height(from) : 0, rise = land_.height ? land_.height(to) - low : 0;
    for (int i = 1; i <= count; ++i) {
        const Vec2 p = from + d * (static_cast<double>(i) / count);
        if (!isInside(p) || isPark(p)) out.legal = false;
        if (!out.legal) return out;
        out.water = out.water || isWater(p);
        if (!land_.height) continue;
        const double over = land_.height(p) - low - rise * i / count;
        out.above_m = std::max(out.above_m, over), out.below_m = std::max(out.below_m, -over);
    }
    if (isWater(to)) out.legal = false;
    out.rise_m = std::abs(rise);
    if (out.legal && !out.water && land_.height) out.legal = out.rise_m <= parameters_.slope * out.length_m;
    return out;
}

/// Whether a straight piece is a tunnel: so deep in a hill that a cut would be no road any more.
bool Grower::tunnels(const Survey& survey) const {
    return survey.above_m > deep_m && survey.below_m < deep_m / 2 && !survey.water &&
           survey.length_m <= parameters_.tunnel_m + 2 * inland_m;
}

/// Whether it is a bridge over a valley.
bool Grower::spans(const Survey& survey) const {
    return survey.below_m > deep_m && survey.above_m < deep_m / 2 &&
           survey.length_m <= parameters_.bridge_m + 2 * inland_m;
}

/// Where a piece ends that goes through a hill or over a valley which it can't follow.
std::optional<Vec2> Grower::beyondSlope(Vec2 from, Vec2 heading, double first_m) const {
    const double most_m = std::max(parameters_.tunnel_m, parameters_.bridge_m);
    for (double l = first_m + bridgeStep_m; l <= most_m; l += bridgeStep_m) {
        const Survey found = survey(from, from + heading * l);
        if (found.legal && (tunnels(found) || spans(found))) return from + heading * l;
    }
    return std::nullopt;
}

/// How long a piece must be to land beyond the water.
std::optional<double> Grower::bridgeLength(Vec2 from, Vec2 heading, double first_m) const {
    for (double l = first_m; l <= parameters_.bridge_m; l += bridgeStep_m) {
        const Vec2 shore = from + heading * l, end = from + heading * (l + inland_m);
        if (!isWater(shore) && !isWater(end)) return l + inland_m;
    }
    return std::nullopt;
}

/// The crossing nearest to `node` with an edge that doesn't end there.
std::optional<Grower::Target> Grower::firstCrossing(uint32_t node, Point to) const {
    const Point from = graph_.at(node);
    const Vec2 a = metres(from), d = metres(to) - a;
    std::optional<Target> first;
    double least = 2;
    for (const uint32_t index : graph_.edgesNear(from, to, 0)) {
        const RoadEdge& e = graph_.edge(index);
        if (e.a == node || e.b == node) continue;
        const Point p = graph_.at(e.a), q = graph_.at(e.b);
        if (!segmentsMeet(from, to, p, q)) continue;
        const Vec2 along = metres(q) - metres(p);
        const double by = cross(d, along);
        const double t = by == 0 ? 0 : std::clamp(cross(metres(p) - a, along) / by, 0.0, 1.0);
        if (t >= least) continue;
        least = t;
        first = Target{pointAt(a + d * t), noIndex, index, true};
    }
    return first;
}

/// A crossing near an end of its road is that end: roads gravitate to major intersections (paper A, 3.2).
Grower::Target Grower::snappedToEnds(Target target) const {
    const RoadEdge& e = graph_.edge(target.edge);
    double least = parameters_.snap_m;
    for (const uint32_t end : {e.a, e.b})
        if (const double away = lengthOf(graph_.metresAt(end) - metres(target.at)); away < least) {
            least = away;
            target.node = end;
        }
    if (target.node == noIndex) return target;
    return {graph_.at(target.node), target.node, noIndex, target.crossing};
}

/// The nearest node in reach, else the nearest edge, else open ground.
Grower::Target Grower::nearestJoin(uint32_t node, Point to) const {
    const double snap = parameters_.snap_m;
    const Vec2 end = metres(to);
    Target best{to, noIndex, noIndex, false};
    double least = snap;
    for (const uint32_t n : graph_.nodesNear(to, to, snap)) {
        const double away = lengthOf(graph_.metresAt(n) - end);
        if (n == node || graph_.degree(n) == 0 || away >= least) continue;
        least = away;
        best = {graph_.at(n), n, noIndex, false};
    }
    if (best.node != noIndex) return best;
    for (const uint32_t index : graph_.edgesNear(to, to, snap)) {
        const RoadEdge& e = graph_.edge(index);
        if (e.a == node || e.b == node) continue;
        const Vec2 foot = footOn(graph_.metresAt(e.a), graph_.metresAt(e.b), end);
        const double away = lengthOf(foot - end);
        if (away >= least) continue;
        least = away;
        best = {pointAt(foot), noIndex, index, false};
    }
    return best.edge == noIndex ? best : snappedToEnds(best);
}

Grower::Target Grower::resolve(uint32_t node, Vec2 to) const {
    const Point end = pointAt(to);
    if (const auto crossing = firstCrossing(node, end)) return snappedToEnds(*crossing);
    return nearestJoin(node, end);
}

/// Whether all roads at `node` leave it in directions far enough from this one.
bool Grower::hasAngle(uint32_t node, Vec2 direction) const {
    const double most = directionAt(parameters_.angle).x;  // cosine
    for (const uint32_t e : graph_.nodes()[node].edges)
        if (dot(unit(graph_.along(e, node)), direction) > most) return false;
    return true;
}

/// Whether no node lies beside the piece so near that a sliver would remain.
bool Grower::isClear(uint32_t node, const Target& target) const {
    const Point from = graph_.at(node);
    const double clear = parameters_.snap_m / 2;
    for (const uint32_t n : graph_.nodesNear(from, target.at, clear)) {
        if (n == node || n == target.node || graph_.degree(n) == 0) continue;
        const Vec2 p = graph_.metresAt(n);
        if (lengthOf(footOn(metres(from), metres(target.at), p) - p) < clear) return false;
    }
    return true;
}

std::optional<Built> Grower::build(uint32_t node, const Target& target, RoadClass kind, bool mayBridge) {
    const Point from = graph_.at(node);
    const Vec2 way = metres(target.at) - metres(from), direction = unit(way);
    if (target.node == node || lengthOf(way) < least_m || !hasAngle(node, direction)) return std::nullopt;
    if (target.node != noIndex && !hasAngle(target.node, direction * -1)) return std::nullopt;
    if (target.edge != noIndex) {
        const RoadEdge& e = graph_.edge(target.edge);
        const Point p = graph_.at(e.a), q = graph_.at(e.b);
        const Vec2 line = unit(metres(q) - metres(p));
        if (e.bridge || e.tunnel || std::abs(dot(line, direction)) > directionAt(parameters_.angle).x)
            return std::nullopt;
        if (target.at == p || target.at == q) return std::nullopt;
        if (!graph_.isFree(p, target.at, e.a, noIndex, target.edge) ||
            !graph_.isFree(target.at, q, noIndex, e.b, target.edge))
            return std::nullopt;
    }
    if (!graph_.isFree(from, target.at, node, target.node, target.edge) || !isClear(node, target)) return std::nullopt;
    const Survey found = survey(metres(from), metres(target.at));
    if (!found.legal || (found.water && (!mayBridge || lengthOf(way) > parameters_.bridge_m + 2 * inland_m)))
        return std::nullopt;
    Built built;
    built.joined = target.node != noIndex || target.edge != noIndex;
    built.node = target.node != noIndex   ? target.node
                 : target.edge != noIndex ? graph_.splitEdge(target.edge, target.at)
                                          : graph_.addNode(target.at);
    const bool bridge = found.water || (mayBridge && spans(found));
    built.edge = graph_.addEdge(node, built.node, kind, bridge, false, 0, !bridge && mayBridge && tunnels(found));
    return built;
}

std::optional<Built> Grower::extend(uint32_t node, Vec2 heading, RoadClass kind, bool mayBridge) {
    const Vec2 from = graph_.metresAt(node);
    const double piece_m = kind == RoadClass::Highway ? parameters_.step_m : parameters_.block_m;
    Vec2 to = from + heading * piece_m;
    const Survey ideal = survey(from, to);
    if (ideal.water || isWater(to)) {
        if (!mayBridge) return std::nullopt;
        const auto length_m = bridgeLength(from, heading, piece_m);
        if (!length_m) return std::nullopt;
        to = from + heading * *length_m;
    } else if (land_.height && mayBridge && ideal.rise_m > parameters_.slope * ideal.length_m) {
        to = beyondSlope(from, heading, piece_m).value_or(to);
    }
    if (!isInside(to)) return std::nullopt;
    return build(node, resolve(node, to), kind, mayBridge);
}

bool Grower::join(uint32_t node, double reach_m) {
    const uint32_t last = graph_.nodes()[node].edges.front();
    const Vec2 heading = unit(graph_.along(last, node)) * -1, from = graph_.metresAt(node);
    const Vec2 to = from + heading * reach_m;
    if (!isInside(to)) return false;
    Target target = resolve(node, to);
    if (target.node == noIndex && target.edge == noIndex) return false;
    return build(node, target, graph_.edge(last).kind, false).has_value();
}

}  // namespace sgm::town
