#include "modeler/town/lots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/town/point.h"

namespace sgm::town {
namespace {

using plan::Footprint;
using plan::PlacedEdge;
using plan::Vec2;

constexpr int mostCuts = 24;     // one inside the other
constexpr double mostDepth = 2;  // of a lot, in roots of its area

/// A rectangle around a footprint in the direction of one of its edges.
struct OrientedBox {
    Vec2 along{1, 0};  ///< unit, its longer side
    double from = 0, length = 0, width = 0;
};

OrientedBox boxAlong(const Footprint& land, Vec2 u) {
    const Vec2 n{-u.z, u.x};
    plan::Box2 box;
    for (const plan::Polygon& polygon : land.polygons)
        for (const Vec2 p : polygon.outer.points) box.add({dot(p, u), dot(p, n)});
    if (box.size().x >= box.size().z) return {u, box.lo.x, box.size().x, box.size().z};
    return {n, box.lo.z, box.size().z, box.size().x};
}

/// The least box; one in the direction of an edge is the least of all for convex outlines.
OrientedBox leastBox(const Footprint& land) {
    std::optional<OrientedBox> least;
    for (const PlacedEdge& e : plan::edgesOf(land)) {
        if (e.ring != 0) continue;
        const OrientedBox box = boxAlong(land, unit(e.to - e.from));
        if (!least || box.length * box.width < least->length * least->width * (1 - 1e-9)) least = box;
    }
    return least.value_or(OrientedBox{});
}

double streetOf(const Footprint& land) {
    double sum = 0;
    for (const PlacedEdge& e : plan::edgesOf(land))
        if (isStreet(land, e.edge)) sum += e.length();
    return sum;
}

bool isConvex(const Footprint& land) {
    if (land.polygons.size() != 1 || !land.polygons[0].courts.empty()) return false;
    const plan::Ring& ring = land.polygons[0].outer;
    for (size_t i = 0; i < ring.size(); ++i) {
        const size_t k = (i + 1) % ring.size();
        if (cross(ring.to(i) - ring.from(i), ring.to(k) - ring.from(k)) < 0) return false;
    }
    return true;
}

/// The part of a convex outline where dot(n, p) ≤ at (Sutherland & Hodgman 1974): exact to rounding, tags stay.
Footprint convexPart(const Footprint& land, Vec2 n, double at) {
    constexpr double same_m = 1e-3;
    const plan::Ring& ring = land.polygons[0].outer;
    plan::Ring out;
    const auto add = [&](Vec2 p, plan::Edge edge) {
        if (!out.points.empty() && length(p - out.points.back()) < same_m)
            out.edges.back() = edge;
        else
            out.points.push_back(p), out.edges.push_back(edge);
    };
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring.from(i), b = ring.to(i);
        const double u = dot(n, a) - at, v = dot(n, b) - at;
        if (u <= 0) add(a, ring.edges[i]);
        if ((u < 0 && v > 0) || (u > 0 && v < 0)) {
            const Vec2 p = a + (b - a) * (u / (u - v));
            add(p, u < 0 ? plan::Edge{0, plan::EdgeSource::Cut} : ring.edges[i]);
        } else if (u == 0 && v > 0 && !out.edges.empty()) {
            out.edges.back() = {0, plan::EdgeSource::Cut};
        }
    }
    if (out.size() > 1 && length(out.points.front() - out.points.back()) < same_m)
        out.points.pop_back(), out.edges.pop_back();
    Footprint part{{}, land.tags};
    if (out.size() >= 3) part.polygons.push_back({std::move(out), {}});
    return part;
}

/// Both sides of a line, each polygon by itself.
std::vector<Footprint> cutAcross(const Footprint& land, Vec2 n, double at) {
    std::vector<Footprint> parts;
    const bool convex = isConvex(land);
    for (const double side : {1.0, -1.0}) {
        Footprint part = convex ? convexPart(land, n * side, at * side) : plan::clipped(land, {n * side, at * side});
        for (plan::Polygon& polygon : part.polygons)
            if (area(polygon) > 1e-3) parts.push_back({{std::move(polygon)}, land.tags});
    }
    return parts;
}

class Cutter {
public:
    Cutter(const LotParameters& parameters, std::vector<Lot>& out, const Progress* progress)
        : parameters_(parameters), out_(out), progress_(progress) {}

    void run(const Footprint& land, uint64_t key, int depth) {
        if (cancelled(progress_)) return;
        if (depth < mostCuts && area(land) > 1.5 * parameters_.area_m2)
            if (const auto parts = divide(land, key)) {
                for (size_t i = 0; i < parts->size(); ++i) run((*parts)[i], combine(key, i), depth + 1);
                return;
            }
        out_.push_back(lotOf(land));
    }

private:
    /// Across the longer side of the box; else across the shorter one; else the back is cut off; else nothing is.
    std::optional<std::vector<Footprint>> divide(const Footprint& land, uint64_t key) const {
        if (streetOf(land) <= 0) return std::nullopt;
        const OrientedBox box = leastBox(land);
        const OrientedBox across = boxAcross(land, {-box.along.z, box.along.x});
        const double share = .5 + uniform(combine(key, 3), -parameters_.jitter, parameters_.jitter);
        const auto haveFront = [&](const std::vector<Footprint>& parts) {
            return parts.size() > 1 && std::all_of(parts.begin(), parts.end(), [&](const Footprint& part) {
                       return longestStreet(part) >= parameters_.front_m;
                   });
        };
        auto parts = cutAcross(land, box.along, box.from + box.length * share);
        if (haveFront(parts)) return parts;
        // Strips deeper than this are no lots any more.
        const double deep_m = mostDepth * std::sqrt(parameters_.area_m2);
        if (box.length > 1.5 * deep_m)
            for (const double at : {box.from + deep_m, box.from + box.length - deep_m}) {
                parts = cutAcross(land, box.along, at);
                const auto hasStreet = [](const Footprint& part) { return streetOf(part) > 0; };
                if (parts.size() == 2 && hasStreet(parts[0]) != hasStreet(parts[1])) return parts;
            }
        parts = cutAcross(land, across.along, across.from + across.length * share);
        if (haveFront(parts)) return parts;
        return std::nullopt;
    }

    static OrientedBox boxAcross(const Footprint& land, Vec2 u) {
        plan::Box2 box;
        for (const plan::Polygon& polygon : land.polygons)
            for (const Vec2 p : polygon.outer.points) box.add({dot(p, u), 0});
        return {u, box.lo.x, box.size().x, 0};
    }

    /// Metres of the longest side along a street; pieces that bend by less than 20° are one side.
    static double longestStreet(const Footprint& land) {
        double most = 0;
        for (const plan::Polygon& polygon : land.polygons) most = std::max(most, longestRun(land, polygon.outer).first);
        return most;
    }

    /// The longest run of street edges and its direction.
    static std::pair<double, Vec2> longestRun(const Footprint& land, const plan::Ring& ring) {
        constexpr double bend = .94;  // cos 20°
        std::pair<double, Vec2> best{0, {1, 0}};
        for (size_t i = 0; i < ring.size(); ++i) {
            Vec2 sum;
            double run = 0;
            for (size_t k = 0; k < ring.size(); ++k) {
                const size_t at = (i + k) % ring.size(), before = (at + ring.size() - 1) % ring.size();
                const Vec2 d = ring.to(at) - ring.from(at);
                if (!isStreet(land, ring.edges[at])) break;
                if (k > 0 && dot(unit(d), unit(ring.to(before) - ring.from(before))) < bend) break;
                sum = sum + d, run += length(d);
            }
            if (run > best.first) best = {run, unit(sum)};
        }
        return best;
    }

    static bool isCorner(const Footprint& land) {
        std::vector<Vec2> normals;
        for (const PlacedEdge& e : plan::edgesOf(land))
            if (isStreet(land, e.edge) && e.length() > 1) normals.push_back(e.normal());
        for (const Vec2 n : normals)
            if (dot(n, normals[0]) < .7) return true;
        return false;
    }

    static Lot lotOf(const Footprint& land) {
        Lot lot;
        lot.street_m = streetOf(land);
        lot.corner = isCorner(land);
        const plan::Ring& ring = land.polygons[0].outer;
        auto [run, along] = longestRun(land, ring);
        if (!(run > 0)) along = leastBox(land).along;
        // The outline runs counter-clockwise, so (dz, −dx) points out, to the street.
        lot.front = {along.z, -along.x};
        lot.right = {lot.front.z, -lot.front.x};
        plan::Box2 box;
        for (const Vec2 p : ring.points) box.add({dot(p, lot.right), dot(p, lot.front)});
        const Vec2 c = box.centre();
        lot.centre = lot.right * c.x + lot.front * c.z;
        lot.land = land;
        const auto place = [&](plan::Ring& r) {
            for (Vec2& p : r.points) p = Vec2{dot(p, lot.right), dot(p, lot.front)} - c;
        };
        place(lot.land.polygons[0].outer);
        for (plan::Ring& court : lot.land.polygons[0].courts) place(court);
        const Point at = pointAt(lot.centre);
        lot.key = combine(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.z));
        return lot;
    }

    const LotParameters& parameters_;
    std::vector<Lot>& out_;
    const Progress* progress_;
};

}  // namespace

bool isStreet(const plan::Footprint& land, const plan::Edge& edge) { return land.tags[edge.tag].starts_with("street"); }

std::vector<Lot> lotsOf(const plan::Footprint& block, const LotParameters& parameters, uint64_t key,
                        const Progress* progress) {
    std::vector<Lot> lots;
    Cutter cutter(parameters, lots, progress);
    for (const plan::Polygon& polygon : block.polygons) cutter.run({{polygon}, block.tags}, key, 0);
    return lots;
}

}  // namespace sgm::town
