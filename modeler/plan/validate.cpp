#include "modeler/plan/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "modeler/plan/lattice.h"

namespace sgm::plan {
namespace {

const Ring& ringAt(const Footprint& footprint, size_t polygon, size_t ring) {
    const Polygon& p = footprint.polygons[polygon];
    return ring == 0 ? p.outer : p.courts[ring - 1];
}

/// fn(ring, polygon, number of the ring) until it gives a fault.
template <class Fn>
std::optional<Fault> firstOfRings(const Footprint& footprint, Fn&& fn) {
    for (size_t p = 0; p < footprint.polygons.size(); ++p)
        for (size_t r = 0; r <= footprint.polygons[p].courts.size(); ++r)
            if (std::optional<Fault> fault = fn(ringAt(footprint, p, r), p, r)) return fault;
    return {};
}

Fault faultAt(FaultKind kind, size_t polygon, size_t ring, size_t edge, Vec2 at = {}) {
    Fault fault;
    fault.kind = kind, fault.polygon = polygon, fault.ring = ring, fault.edge = edge, fault.at = at;
    return fault;
}

/// Whether length(v) < distance_m, which most answer without a root.
bool isNearer(Vec2 v, double distance_m) {
    return std::max(std::abs(v.x), std::abs(v.z)) < 2 * distance_m && length(v) < distance_m;
}

std::optional<Fault> faultOfNumbers(const Footprint& footprint, const Limits& limits) {
    size_t points = 0;
    for (const Polygon& polygon : footprint.polygons) points += polygon.edgeCount();
    if (footprint.polygons.empty()) return faultAt(FaultKind::Empty, 0, 0, 0);
    if (points > limits.mostPoints) return faultAt(FaultKind::TooManyPoints, 0, 0, points);
    if (const auto fault = firstOfRings(footprint, [&](const Ring& ring, size_t p, size_t r) -> std::optional<Fault> {
            for (size_t i = 0; i < ring.size(); ++i) {
                const Vec2 at = ring.points[i];
                if (!std::isfinite(at.x) || !std::isfinite(at.z)) return faultAt(FaultKind::NotFinite, p, r, i);
                if (std::max(std::abs(at.x), std::abs(at.z)) > limits.farthest_m)
                    return faultAt(FaultKind::TooFar, p, r, i, at);
            }
            return {};
        }))
        return fault;
    return firstOfRings(footprint, [&](const Ring& ring, size_t p, size_t r) -> std::optional<Fault> {
        if (ring.size() == 0) return faultAt(FaultKind::Empty, p, r, 0);
        if (ring.size() < 3) return faultAt(FaultKind::TooFewPoints, p, r, 0, ring.points[0]);
        if (ring.edges.size() != ring.size()) return faultAt(FaultKind::EdgeList, p, r, 0, ring.points[0]);
        for (size_t i = 0; i < ring.size(); ++i) {
            if (ring.edges[i].tag >= footprint.tags.size())
                return faultAt(FaultKind::EdgeList, p, r, i, ring.points[i]);
            const Vec2 along = ring.to(i) - ring.from(i);
            if (!isNearer(along, std::max(limits.leastEdge_m, 4 / unitsPerMetre))) continue;
            if (latticePoint(ring.to(i)) == latticePoint(ring.from(i)))
                return faultAt(FaultKind::SamePoint, p, r, i, ring.points[i]);
            if (length(along) < limits.leastEdge_m) return faultAt(FaultKind::ShortEdge, p, r, i, ring.points[i]);
        }
        return {};
    });
}

/// An edge on the lattice.
struct Segment {
    LatticePoint from, to;
    uint32_t polygon, ring, index, ringSize;
    int64_t lowX() const { return std::min(from.x, to.x); }
    int64_t highX() const { return std::max(from.x, to.x); }
};

std::vector<Segment> segmentsOf(const Footprint& footprint) {
    std::vector<Segment> all;
    for (const PlacedEdge& e : edgesOf(footprint))
        all.push_back({latticePoint(e.from), latticePoint(e.to), e.polygon, e.ring, e.index,
                       static_cast<uint32_t>(ringAt(footprint, e.polygon, e.ring).size())});
    return all;
}

/// Whether two edges share more than the corner at which neighbours join.
bool collide(const Segment& a, const Segment& b) {
    const bool sameRing = a.polygon == b.polygon && a.ring == b.ring;
    if (sameRing && (a.index + 1) % a.ringSize == b.index) {
        return onSegment(a.from, a.to, b.to) || onSegment(b.from, b.to, a.from);
    }
    if (sameRing && (b.index + 1) % b.ringSize == a.index) return collide(b, a);
    return meet(a.from, a.to, b.from, b.to);
}

/// Whether a ring turns to the left at every corner, and once in all: then no two of its edges cross. O(n), without the
/// sweep over edges.
bool isConvexRing(const Ring& ring) {
    const auto goesUp = [](LatticePoint d) { return d.z > 0 || (d.z == 0 && d.x > 0); };
    LatticePoint last = latticePoint(ring.points.back()), from = latticePoint(ring.points[0]), before = from - last;
    size_t turns = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
        const LatticePoint to = latticePoint(ring.to(i)), along = to - from;
        if (wideCross(before, along) <= 0) return false;
        turns += !goesUp(before) && goesUp(along);
        before = along, from = to;
    }
    return turns == 1;
}

bool isOneConvexRing(const Footprint& footprint) {
    return footprint.polygons.size() == 1 && footprint.polygons[0].courts.empty() &&
           isConvexRing(footprint.polygons[0].outer);
}

/// A point that both edges are near.
Vec2 meetingPoint(const Segment& a, const Segment& b) {
    const Vec2 p = metres(a.from), d = metres(a.to) - p, q = metres(b.from), e = metres(b.to) - q;
    const double by = plan::cross(d, e);
    if (by != 0) return p + d * std::clamp(plan::cross(q - p, e) / by, 0.0, 1.0);
    return onSegment(a.from, a.to, b.from) ? q : metres(b.to);
}

/// The crossing pair of edges that comes first in the list. A sweep along x over pairs whose x-ranges meet.
std::optional<Fault> firstCrossing(const std::vector<Segment>& segments) {
    std::vector<uint32_t> order(segments.size()), open;
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::pair(segments[a].lowX(), a) < std::pair(segments[b].lowX(), b);
    });
    std::pair<uint32_t, uint32_t> first{UINT32_MAX, UINT32_MAX};
    for (const uint32_t next : order) {
        const Segment& s = segments[next];
        const auto [lowZ, highZ] = std::minmax(s.from.z, s.to.z);
        size_t kept = 0;
        for (const uint32_t other : open) {
            const Segment& o = segments[other];
            if (o.highX() < s.lowX()) continue;
            open[kept++] = other;
            const std::pair<uint32_t, uint32_t> both = std::minmax(next, other);
            if (both >= first || std::min(o.from.z, o.to.z) > highZ || std::max(o.from.z, o.to.z) < lowZ) continue;
            if (collide(segments[both.first], segments[both.second])) first = both;
        }
        open.resize(kept);
        open.push_back(next);
    }
    if (first.first == UINT32_MAX) return {};
    const Segment &a = segments[first.first], &b = segments[first.second];
    Fault fault = faultAt(FaultKind::Crossing, a.polygon, a.ring, a.index, meetingPoint(a, b));
    fault.otherPolygon = b.polygon, fault.otherRing = b.ring, fault.otherEdge = b.index;
    return fault;
}

bool insideRing(const Ring& ring, Vec2 p) {
    bool inside = false;
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring.from(i), b = ring.to(i);
        if ((a.z > p.z) != (b.z > p.z) && (cross(b - a, p - a) > 0) == (b.z > a.z)) inside = !inside;
    }
    return inside;
}

/// In the outline and in no court.
bool insidePolygon(const Polygon& polygon, Vec2 p) {
    return insideRing(polygon.outer, p) && std::none_of(polygon.courts.begin(), polygon.courts.end(),
                                                        [&](const Ring& court) { return insideRing(court, p); });
}

/// Of rings that cross nowhere: those that lie where they mustn't.
std::optional<Fault> faultOfNesting(const Footprint& footprint) {
    if (const auto fault = firstOfRings(footprint, [&](const Ring& ring, size_t p, size_t r) -> std::optional<Fault> {
            if (r == 0) return {};
            if (!insideRing(footprint.polygons[p].outer, ring.points[0]))
                return faultAt(FaultKind::CourtOutside, p, r, 0, ring.points[0]);
            for (size_t o = 1; o <= footprint.polygons[p].courts.size(); ++o)
                if (o != r && insideRing(ringAt(footprint, p, o), ring.points[0])) {
                    Fault fault = faultAt(FaultKind::CourtOutside, p, r, 0, ring.points[0]);
                    fault.otherPolygon = p, fault.otherRing = o;
                    return fault;
                }
            return {};
        }))
        return fault;
    if (footprint.polygons.size() < 2) return {};
    std::vector<Box2> boxes;
    for (const Polygon& polygon : footprint.polygons) boxes.push_back(bounds(polygon.outer));
    for (size_t p = 0; p < footprint.polygons.size(); ++p)
        for (size_t o = 0; o < footprint.polygons.size(); ++o) {
            const Vec2 at = footprint.polygons[p].outer.points[0];
            const Box2& box = boxes[o];
            if (o == p || at.x < box.lo.x || at.x > box.hi.x || at.z < box.lo.z || at.z > box.hi.z) continue;
            if (!insidePolygon(footprint.polygons[o], at)) continue;
            Fault fault = faultAt(FaultKind::Overlap, p, 0, 0, at);
            fault.otherPolygon = o;
            return fault;
        }
    return {};
}

std::string nameOfEdge(const Footprint& footprint, size_t polygon, size_t ring, size_t edge) {
    const std::string of = footprint.polygons.size() > 1 ? fmt::format(" of polygon {}", polygon + 1) : "";
    if (ring == 0) return fmt::format("edge {} of the outline{}", edge + 1, of);
    const bool several = footprint.polygons[polygon].courts.size() > 1;
    return several ? fmt::format("edge {} of court {}{}", edge + 1, ring, of)
                   : fmt::format("edge {} of the court{}", edge + 1, of);
}

/// Without the points that aren't needed; empty where nothing is left.
Ring cleaned(const Ring& ring, double near, double straightness, bool clockwise) {
    Ring apart;  // first without points that are one
    apart.points.reserve(ring.size()), apart.edges.reserve(ring.size());
    for (size_t i = 0; i < ring.size(); ++i) {
        if (!apart.points.empty() && isNearer(ring.points[i] - apart.points.back(), near)) {
            apart.edges.back() = ring.edges[i];
            continue;
        }
        apart.points.push_back(ring.points[i]);
        apart.edges.push_back(ring.edges[i]);
    }
    while (apart.size() > 1 && isNearer(apart.points.back() - apart.points.front(), near))
        apart.points.pop_back(), apart.edges.pop_back();
    Ring straight;
    straight.points.reserve(apart.size()), straight.edges.reserve(apart.size());
    for (size_t i = 0; i < apart.size(); ++i) {
        const Vec2 before = straight.points.empty() ? apart.points.back() : straight.points.back(),
                   at = apart.points[i], after = apart.to(i);
        const Edge arriving = apart.edges[(i + apart.size() - 1) % apart.size()];
        const Vec2 along = after - before;
        const bool between = dot(at - before, along) > 0 && dot(after - at, along) > 0;
        const double off = std::abs(cross(along, at - before));
        const bool isFar = off > 2 * straightness * (std::abs(along.x) + std::abs(along.z));  // without a root
        if (arriving == apart.edges[i] && between && !isFar && off <= straightness * length(along)) continue;
        straight.points.push_back(at);
        straight.edges.push_back(apart.edges[i]);
    }
    if (straight.size() < 3 || std::abs(signedArea(straight)) < near * near) return {};
    return (signedArea(straight) < 0) == clockwise ? straight : reversed(straight);
}

}  // namespace

std::optional<Fault> firstFault(const Footprint& footprint, const Limits& limits) {
    if (const auto fault = faultOfNumbers(footprint, limits)) return fault;
    if (!isOneConvexRing(footprint))
        if (const auto fault = firstCrossing(segmentsOf(footprint))) return fault;
    if (const auto fault = firstOfRings(footprint, [&](const Ring& ring, size_t p, size_t r) -> std::optional<Fault> {
            if (std::abs(signedArea(ring)) < limits.leastArea_m2)
                return faultAt(FaultKind::NoArea, p, r, 0, ring.points[0]);
            if ((signedArea(ring) < 0) != (r > 0)) return faultAt(FaultKind::WrongWay, p, r, 0, ring.points[0]);
            return {};
        }))
        return fault;
    return faultOfNesting(footprint);
}

std::string sentenceOf(const Fault& fault, const Footprint& footprint) {
    const auto edge = [&] { return nameOfEdge(footprint, fault.polygon, fault.ring, fault.edge); };
    const auto at = [&] { return fmt::format("({:.6g}, {:.6g})", fault.at.x, fault.at.z); };
    const auto other = [&] { return nameOfEdge(footprint, fault.otherPolygon, fault.otherRing, fault.otherEdge); };
    switch (fault.kind) {
        case FaultKind::Empty:
            return "an outline has no points; give it three or more";
        case FaultKind::TooManyPoints:
            return fmt::format("an outline of {} points is too large; simplify it", fault.edge);
        case FaultKind::NotFinite:
            return fmt::format("the first point of {} is not a number", edge());
        case FaultKind::TooFar:
            return fmt::format("{} begins at {}, too far from the origin; move the outline nearer or check its unit",
                               edge(), at());
        case FaultKind::TooFewPoints:
            return fmt::format("the ring of {} has fewer than three points", edge());
        case FaultKind::EdgeList:
            return fmt::format("{} has no entry in the list of edges or tags", edge());
        case FaultKind::SamePoint:
            return fmt::format("{} begins and ends at {}; leave one of the points out", edge(), at());
        case FaultKind::ShortEdge:
            return fmt::format("{} at {} is too short; leave one of its points out", edge(), at());
        case FaultKind::Crossing:
            return fmt::format("{} meets {} near {}; outlines may not cross or touch themselves", edge(), other(),
                               at());
        case FaultKind::NoArea:
            return fmt::format("the ring of {} encloses no area", edge());
        case FaultKind::WrongWay:
            return fmt::format("the ring of {} runs the wrong way round", edge());
        case FaultKind::CourtOutside:
            return fmt::format("the ring of {} does not lie inside its outline, or lies in another court", edge());
        case FaultKind::Overlap:
            return fmt::format("polygon {} lies in polygon {}", fault.polygon + 1, fault.otherPolygon + 1);
    }
    return "the outline is damaged";
}

Result<Footprint> checked(Footprint footprint, const Limits& limits) {
    if (const auto fault = firstFault(footprint, limits))
        return Error{Error::Kind::Input, sentenceOf(*fault, footprint)};
    return footprint;
}

Footprint cleaned(const Footprint& footprint, double near_m, double straight_m) {
    Footprint result;
    result.tags = footprint.tags;
    for (const Polygon& polygon : footprint.polygons) {
        Polygon clean{cleaned(polygon.outer, near_m, straight_m, false), {}};
        if (clean.outer.size() == 0) continue;
        for (const Ring& court : polygon.courts)
            if (Ring ring = cleaned(court, near_m, straight_m, true); ring.size() > 0)
                clean.courts.push_back(std::move(ring));
        result.polygons.push_back(std::move(clean));
    }
    return result;
}

}  // namespace sgm::plan
