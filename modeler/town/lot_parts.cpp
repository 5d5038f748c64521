#include "modeler/town/lot_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/town/point.h"

namespace sgm::town {

using plan::Footprint;
using plan::Vec2;

namespace {

/// Faster than std::hypot, and the same on every machine.
double lengthOf(Vec2 v) { return std::sqrt(dot(v, v)); }

OrientedBox boxAlong(const plan::Ring& outline, Vec2 u) {
    const Vec2 n{-u.z, u.x};
    plan::Box2 box;
    for (const Vec2 p : outline.points) box.add({dot(p, u), dot(p, n)});
    if (box.size().x >= box.size().z) return {u, box.lo.x, box.size().x, box.size().z};
    return {n, box.lo.z, box.size().z, box.size().x};
}

/// The longest run of street edges and its direction.
std::pair<double, Vec2> longestRun(const plan::Ring& ring, const StreetTags& isStreet) {
    constexpr double bend = .94;  // cos 20°
    std::pair<double, Vec2> best{0, {1, 0}};
    for (size_t i = 0; i < ring.size(); ++i) {
        Vec2 sum, last;
        double run = 0;
        for (size_t k = 0, at = i; k < ring.size(); ++k, at = at + 1 == ring.size() ? 0 : at + 1) {
            if (!isStreet(ring.edges[at])) break;
            const Vec2 d = ring.to(at) - ring.from(at), way = unit(d);
            if (k > 0 && dot(way, last) < bend) break;
            sum = sum + d, run += lengthOf(d), last = way;
        }
        if (run > best.first) best = {run, unit(sum)};
    }
    return best;
}

bool isCorner(const plan::Polygon& land, const StreetTags& isStreet) {
    std::optional<Vec2> first;
    const auto turns = [&](const plan::Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i) {
            const Vec2 d = ring.to(i) - ring.from(i);
            if (!isStreet(ring.edges[i]) || lengthOf(d) <= 1) continue;
            if (!first) first = unit(d);
            if (dot(unit(d), *first) < .7) return true;
        }
        return false;
    };
    return turns(land.outer) || std::any_of(land.courts.begin(), land.courts.end(), turns);
}

}  // namespace

StreetTags::StreetTags(const Footprint& block) {
    for (const std::string& tag : block.tags) isStreet_.push_back(tag.starts_with("street"));
}

bool isConvex(const plan::Polygon& land) {
    if (!land.courts.empty()) return false;
    const plan::Ring& ring = land.outer;
    for (size_t i = 0; i < ring.size(); ++i) {
        const size_t k = i + 1 == ring.size() ? 0 : i + 1;
        if (cross(ring.to(i) - ring.from(i), ring.to(k) - ring.from(k)) < 0) return false;
    }
    return true;
}

plan::Ring convexPart(const plan::Ring& ring, Vec2 n, double at, plan::Edge edge) {
    constexpr double same_m = 1e-3;
    plan::Ring out;
    out.points.reserve(ring.size() + 1), out.edges.reserve(ring.size() + 1);
    const auto isSame = [](Vec2 d) { return dot(d, d) < same_m * same_m; };
    const auto add = [&](Vec2 p, plan::Edge own) {
        if (!out.points.empty() && isSame(p - out.points.back()))
            out.edges.back() = own;
        else
            out.points.push_back(p), out.edges.push_back(own);
    };
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring.from(i), b = ring.to(i);
        const double u = dot(n, a) - at, v = dot(n, b) - at;
        if (u <= 0) add(a, ring.edges[i]);
        if ((u < 0 && v > 0) || (u > 0 && v < 0)) {
            const Vec2 p = a + (b - a) * (u / (u - v));
            add(p, u < 0 ? edge : ring.edges[i]);
        } else if (u == 0 && v > 0 && !out.edges.empty()) {
            out.edges.back() = edge;
        }
    }
    if (out.size() > 1 && isSame(out.points.front() - out.points.back())) out.points.pop_back(), out.edges.pop_back();
    return out;
}

Footprint partBelow(const Footprint& land, Vec2 n, double at) {
    if (land.polygons.size() != 1 || !isConvex(land.polygons[0])) return plan::clipped(land, {n, at});
    plan::Ring ring = convexPart(land.polygons[0].outer, n, at);
    Footprint part{{}, land.tags};
    if (ring.size() >= 3) part.polygons.push_back({std::move(ring), {}});
    return part;
}

OrientedBox leastBox(const plan::Ring& outline) {
    std::optional<OrientedBox> least;
    for (size_t i = 0; i < outline.size(); ++i) {
        const OrientedBox box = boxAlong(outline, unit(outline.to(i) - outline.from(i)));
        if (!least || box.length * box.width < least->length * least->width * (1 - 1e-9)) least = box;
    }
    return least.value_or(OrientedBox{});
}

double streetOf(const plan::Polygon& land, const StreetTags& isStreet) {
    double sum = 0;
    const auto add = [&](const plan::Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i)
            if (isStreet(ring.edges[i])) sum += lengthOf(ring.to(i) - ring.from(i));
    };
    add(land.outer);
    for (const plan::Ring& court : land.courts) add(court);
    return sum;
}

double longestStreet(const plan::Polygon& land, const StreetTags& isStreet) {
    return longestRun(land.outer, isStreet).first;
}

Lot lotOf(plan::Polygon land, const std::vector<std::string>& tags, const StreetTags& isStreet) {
    Lot lot;
    lot.street_m = streetOf(land, isStreet);
    lot.corner = isCorner(land, isStreet);
    auto [run, along] = longestRun(land.outer, isStreet);
    if (!(run > 0)) along = leastBox(land.outer).along;
    // The outline runs counter-clockwise, so (dz, −dx) points out, to the street.
    lot.front = {along.z, -along.x};
    lot.right = {lot.front.z, -lot.front.x};
    plan::Box2 box;
    for (const Vec2 p : land.outer.points) box.add({dot(p, lot.right), dot(p, lot.front)});
    const Vec2 c = box.centre();
    lot.centre = lot.right * c.x + lot.front * c.z;
    const auto place = [&](plan::Ring& r) {
        for (Vec2& p : r.points) p = Vec2{dot(p, lot.right), dot(p, lot.front)} - c;
    };
    place(land.outer);
    for (plan::Ring& court : land.courts) place(court);
    const Point at = pointAt(lot.centre);
    lot.key = combine(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.z));
    lot.land.tags = tags;
    lot.land.polygons.push_back(std::move(land));
    return lot;
}

}  // namespace sgm::town
