#include "modeler/town/lot_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/core/random.h"
#include "modeler/town/point.h"

namespace sgm::town {

using plan::Footprint;
using plan::Vec2;

namespace {

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
    const size_t n = ring.size();
    const auto next = [n](size_t i) { return i + 1 == n ? 0 : i + 1; };
    const auto wayOf = [&](size_t i) { return unit(ring.to(i) - ring.from(i)); };
    std::pair<double, Vec2> best{0, {1, 0}};
    Vec2 before = wayOf(n - 1);
    bool beganSomewhere = false;
    for (size_t i = 0; i < n; ++i) {
        const Vec2 first = wayOf(i);
        const bool goesOn = isStreet(ring.edges[i == 0 ? n - 1 : i - 1]) && dot(first, before) >= bend;
        before = first;
        // A run that the edge before belongs to as well is part of a longer one; all of a ring is a run from anywhere.
        if (!isStreet(ring.edges[i]) || (goesOn && (beganSomewhere || i + 1 < n))) continue;
        beganSomewhere = true;
        Vec2 sum, last = first;
        double run = 0;
        for (size_t k = 0, at = i; k < n && isStreet(ring.edges[at]); ++k, at = next(at)) {
            const Vec2 d = ring.to(at) - ring.from(at), way = k == 0 ? first : unit(d);
            if (dot(way, last) < bend) break;
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
