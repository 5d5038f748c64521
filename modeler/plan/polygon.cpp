#include "modeler/plan/polygon.h"

#include <algorithm>

#include "modeler/core/conventions.h"

namespace sgm::plan {
namespace {

template <class Fn>
void forEachRing(const Footprint& footprint, Fn&& fn) {
    for (const Polygon& polygon : footprint.polygons) {
        fn(polygon.outer);
        for (const Ring& court : polygon.courts) fn(court);
    }
}

double length(const Ring& ring) {
    double sum = 0;
    for (size_t i = 0; i < ring.size(); ++i) sum += plan::length(ring.to(i) - ring.from(i));
    return sum;
}

/// The footprint with every point moved by `move`.
template <class Fn>
Footprint moved(Footprint footprint, bool mirrors, Fn&& move) {
    const auto change = [&](Ring& ring) {
        for (Vec2& p : ring.points) p = move(p);
        if (mirrors) ring = reversed(ring);
    };
    for (Polygon& polygon : footprint.polygons) {
        change(polygon.outer);
        for (Ring& court : polygon.courts) change(court);
    }
    return footprint;
}

}  // namespace

void Box2::add(Vec2 p) {
    lo = {std::min(lo.x, p.x), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.z, p.z)};
}

size_t Polygon::edgeCount() const {
    size_t n = outer.size();
    for (const Ring& court : courts) n += court.size();
    return n;
}

size_t Footprint::edgeCount() const {
    size_t n = 0;
    for (const Polygon& polygon : polygons) n += polygon.edgeCount();
    return n;
}

uint32_t Footprint::tag(std::string_view word) {
    const auto at = std::find(tags.begin(), tags.end(), word);
    if (at != tags.end()) return static_cast<uint32_t>(at - tags.begin());
    tags.emplace_back(word);
    return static_cast<uint32_t>(tags.size() - 1);
}

Vec2 PlacedEdge::normal() const {
    const Vec2 d = to - from;
    const double l = plan::length(d);
    return l > 0 ? Vec2{d.z / l, -d.x / l} : Vec2{};
}

std::vector<PlacedEdge> edgesOf(const Footprint& footprint) {
    std::vector<PlacedEdge> all;
    all.reserve(footprint.edgeCount());
    const auto add = [&](const Ring& ring, size_t polygon, size_t number) {
        for (size_t i = 0; i < ring.size(); ++i)
            all.push_back({ring.from(i), ring.to(i), i < ring.edges.size() ? ring.edges[i] : Edge{},
                           static_cast<uint32_t>(polygon), static_cast<uint32_t>(number), static_cast<uint32_t>(i)});
    };
    for (size_t p = 0; p < footprint.polygons.size(); ++p) {
        const Polygon& polygon = footprint.polygons[p];
        add(polygon.outer, p, 0);
        for (size_t c = 0; c < polygon.courts.size(); ++c) add(polygon.courts[c], p, c + 1);
    }
    return all;
}

Ring ringOf(std::vector<Vec2> points, Edge edge) {
    Ring ring{std::move(points), {}};
    ring.edges.assign(ring.points.size(), edge);
    return ring;
}

// Edge i of the reversed ring runs from point n − 1 − i to point n − 2 − i: edge n − 2 − i of the ring, backwards.
Ring reversed(const Ring& ring) {
    const size_t n = ring.size();
    Ring back{{ring.points.rbegin(), ring.points.rend()}, std::vector<Edge>(ring.edges.size())};
    for (size_t i = 0; i < ring.edges.size() && n == ring.edges.size(); ++i)
        back.edges[i] = ring.edges[(2 * n - 2 - i) % n];
    return back;
}

Polygon polygonOf(std::vector<Vec2> outline, Edge edge) {
    Ring ring = ringOf(std::move(outline), edge);
    return {signedArea(ring) < 0 ? reversed(ring) : std::move(ring), {}};
}

Footprint footprintOf(Polygon polygon) {
    Footprint footprint;
    footprint.polygons.push_back(std::move(polygon));
    return footprint;
}

// About the first point, so that far from 0 no digits are lost.
double signedArea(const Ring& ring) {
    double sum = 0;
    for (size_t i = 1; i + 1 < ring.size(); ++i)
        sum += cross(ring.points[i] - ring.points[0], ring.points[i + 1] - ring.points[0]);
    return sum / 2;
}

double area(const Polygon& polygon) {
    double sum = std::abs(signedArea(polygon.outer));
    for (const Ring& court : polygon.courts) sum -= std::abs(signedArea(court));
    return sum;
}

double area(const Footprint& footprint) {
    double sum = 0;
    for (const Polygon& polygon : footprint.polygons) sum += area(polygon);
    return sum;
}

double perimeter(const Polygon& polygon) {
    double sum = length(polygon.outer);
    for (const Ring& court : polygon.courts) sum += length(court);
    return sum;
}

double perimeter(const Footprint& footprint) {
    double sum = 0;
    for (const Polygon& polygon : footprint.polygons) sum += perimeter(polygon);
    return sum;
}

Box2 bounds(const Ring& ring) {
    Box2 box;
    for (const Vec2 p : ring.points) box.add(p);
    return box;
}

Box2 bounds(const Footprint& footprint) {
    Box2 box;
    forEachRing(footprint, [&](const Ring& ring) {
        for (const Vec2 p : ring.points) box.add(p);
    });
    return box;
}

Vec2 centroid(const Footprint& footprint) {
    const Box2 box = bounds(footprint);
    if (box.empty()) return {};
    const Vec2 about = box.centre();
    double sum = 0;
    Vec2 moment;
    forEachRing(footprint, [&](const Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = ring.from(i) - about, b = ring.to(i) - about;
            sum += cross(a, b);
            moment = moment + (a + b) * cross(a, b);
        }
    });
    return sum > 0 ? about + moment * (1 / (3 * sum)) : about;
}

bool contains(const Footprint& footprint, Vec2 p) {
    bool inside = false;
    forEachRing(footprint, [&](const Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = ring.from(i), b = ring.to(i);
            if ((a.z > p.z) == (b.z > p.z)) continue;
            const double side = cross(b - a, p - a);
            if ((side > 0) == (b.z > a.z)) inside = !inside;
        }
    });
    return inside;
}

double distanceTo(const PlacedEdge& edge, Vec2 p) {
    const Vec2 along = edge.to - edge.from;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(dot(p - edge.from, along) / square, 0.0, 1.0) : 0;
    return plan::length(p - edge.from - along * share);
}

double distanceToEdges(const Footprint& footprint, Vec2 p) {
    double least = Box2::far;
    forEachRing(footprint, [&](const Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i) least = std::min(least, distanceTo({ring.from(i), ring.to(i), {}}, p));
    });
    return least;
}

Footprint placed(const Footprint& footprint, Vec2 scale, Vec2 offset) {
    return moved(footprint, scale.x * scale.z < 0, [=](Vec2 p) {
        return Vec2{p.x * scale.x + offset.x, p.z * scale.z + offset.z};
    });
}

Footprint turned(const Footprint& footprint, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return moved(footprint, false, [=](Vec2 p) { return Vec2{p.x * c - p.z * s, p.x * s + p.z * c}; });
}

Facing facingOf(Vec2 normal) {
    if (std::abs(normal.x) > std::abs(normal.z)) return normal.x < 0 ? Facing::Left : Facing::Right;
    return normal.z < 0 ? Facing::Back : Facing::Front;
}

}  // namespace sgm::plan
