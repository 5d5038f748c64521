// Footprints: polygons with courts in the plan, with a tag and a source for every edge.
// Enters: points in metres. Leaves: plain values and their measures. Assumes nothing of the numbers; validate.h judges
// them. The plan is seen with x to the right and z up the page, so "counter-clockwise" is Σ(xᵢ·zᵢ₊₁ − xᵢ₊₁·zᵢ) > 0; in
// a right-handed space with y up that is clockwise seen from above. Outer rings run counter-clockwise and courts
// clockwise, so that the solid lies on the left of every edge and (dz, −dx) points out of it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sgm::plan {

/// A point or direction of the plan, metres.
struct Vec2 {
    double x = 0, z = 0;
    friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
    friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.z + b.z}; }
    friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.z - b.z}; }
    friend constexpr Vec2 operator*(Vec2 a, double s) { return {a.x * s, a.z * s}; }
};
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.z * b.z; }
/// > 0 where b turns left from a.
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.z - a.z * b.x; }
inline double length(Vec2 a) { return std::hypot(a.x, a.z); }

/// An axis-aligned rectangle; empty as long as lo > hi.
struct Box2 {
    static constexpr double far = std::numeric_limits<double>::infinity();
    Vec2 lo{far, far}, hi{-far, -far};
    bool empty() const { return !(lo.x <= hi.x && lo.z <= hi.z); }
    Vec2 size() const { return hi - lo; }
    Vec2 centre() const { return (lo + hi) * 0.5; }
    void add(Vec2 p);
};

/// What an edge came from.
enum class EdgeSource : uint8_t {
    Side,   ///< the outline as it was given
    Court,  ///< a court
    Cut     ///< a split, a clip or a boolean's second operand
};

/// What is known of an edge besides its ends.
struct Edge {
    uint32_t tag = 0;  ///< index into Footprint::tags
    EdgeSource source = EdgeSource::Side;
    friend bool operator==(const Edge&, const Edge&) = default;
};

/// A closed chain: edges[i] runs from points[i] to points[i + 1], the last one back to points[0].
struct Ring {
    std::vector<Vec2> points;
    std::vector<Edge> edges;  ///< as many as points
    size_t size() const { return points.size(); }
    Vec2 from(size_t i) const { return points[i]; }
    Vec2 to(size_t i) const { return points[i + 1 == points.size() ? 0 : i + 1]; }
    friend bool operator==(const Ring&, const Ring&) = default;
};

/// An outline and the courts inside it.
struct Polygon {
    Ring outer;                ///< counter-clockwise
    std::vector<Ring> courts;  ///< clockwise
    size_t edgeCount() const;
    friend bool operator==(const Polygon&, const Polygon&) = default;
};

/// One or more polygons that don't overlap, and the words their edges are tagged with.
struct Footprint {
    std::vector<Polygon> polygons;
    std::vector<std::string> tags{""};  ///< tags[0] is "": no tag
    size_t edgeCount() const;
    bool empty() const { return polygons.empty(); }
    /// The index of `tag`, which is added where it is new.
    uint32_t tag(std::string_view word);
    friend bool operator==(const Footprint&, const Footprint&) = default;
};

/// An edge with its place, counted through polygons, then rings (the outer one first), then edges: the number that
/// Formula and everything else names edges by.
struct PlacedEdge {
    Vec2 from, to;
    Edge edge;
    uint32_t polygon = 0, ring = 0, index = 0;  ///< ring 0 is the outer one, 1 + k court k
    Vec2 normal() const;                        ///< unit, out of the solid; (0, 0) for an edge without length
    double length() const { return plan::length(to - from); }
};
/// All edges in that order. O(n).
std::vector<PlacedEdge> edgesOf(const Footprint& footprint);

/// A ring through `points` whose edges all carry `edge`; runs as the points do.
Ring ringOf(std::vector<Vec2> points, Edge edge = {});
/// The same ring the other way round; edges keep their tags.
Ring reversed(const Ring& ring);
/// A polygon of an outline that runs either way, without courts.
Polygon polygonOf(std::vector<Vec2> outline, Edge edge = {});
Footprint footprintOf(Polygon polygon);

/// m², > 0 for counter-clockwise rings.
double signedArea(const Ring& ring);
/// m², courts taken off.
double area(const Polygon& polygon);
double area(const Footprint& footprint);
/// Metres around all rings.
double perimeter(const Polygon& polygon);
double perimeter(const Footprint& footprint);
Box2 bounds(const Ring& ring);
Box2 bounds(const Footprint& footprint);
/// The centre of mass; the middle of the bounds where the area is 0.
Vec2 centroid(const Footprint& footprint);
/// Whether `p` lies inside, by crossings of the ray towards +x; points on an edge belong to either side. O(n).
bool contains(const Footprint& footprint, Vec2 p);
/// Metres from `p` to an edge.
double distanceTo(const PlacedEdge& edge, Vec2 p);
/// Metres from `p` to the nearest edge, unsigned. O(n).
double distanceToEdges(const Footprint& footprint, Vec2 p);

/// p ↦ p·scale + offset, component by component. Negative scales mirror; rings keep their senses. Tags stay.
Footprint placed(const Footprint& footprint, Vec2 scale, Vec2 offset);
/// Turned about (0, 0) by `angle` radians, from +x towards +z.
Footprint turned(const Footprint& footprint, double angle);

/// Which side of a box a direction faces: within 45° of +z front, −z back, −x left, +x right; ties go to front and
/// back.
enum class Facing : uint8_t { Front, Back, Left, Right };
Facing facingOf(Vec2 normal);

}  // namespace sgm::plan
