#include "modeler/field/roof_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/field/roof_planes.h"

namespace sgm::field {
namespace {

using plan::Linear;
using plan::PlacedEdge;
using plan::Vec2;

constexpr double leastFace_m = 1e-3;

double valueAt(std::span<const Argument> arguments, size_t i) { return arguments[i].value[0]; }

/// How far the slope of `edge` goes on from `from` toward `way`, inside the outline.
double reach(const RoofSurface& roof, uint32_t edge, Vec2 from, Vec2 way) {
    const auto alongWay = [&](const Linear& l) { return l.a * way.x + l.b * way.z; };
    const Linear& own = roof.slopes[edge];
    std::vector<double> stops;
    const auto stopWhere = [&](double value, double by) {
        if (std::abs(by) < 1e-12) return;
        if (const double t = value / by; t > 1e-9 && t < 1e6) stops.push_back(t);
    };
    for (const Linear& l : roof.slopes) stopWhere(l.at(from) - own.at(from), alongWay(own) - alongWay(l));
    for (const Linear& l : roof.outline) stopWhere(-l.at(from), alongWay(l));
    std::sort(stops.begin(), stops.end());
    double reached = 0;
    for (const double stop : stops) {
        const Vec2 middle = from + way * ((reached + stop) / 2);
        const double value = own.at(middle);
        if (plan::valueOf(roof.formula, roof.outline, middle) > 0) return reached;
        if (std::abs(plan::valueOf(roof.formula, roof.slopes, middle) - value) > 1e-9 * (1 + std::abs(value)))
            return reached;
        reached = stop;
    }
    return reached;
}

/// How much longer an edge moved outward is at the end where `a` goes over into `b`, per metre.
double mitre(const PlacedEdge& a, const PlacedEdge& b) {
    const Vec2 m = a.normal(), n = b.normal();
    const double c = 1 + dot(m, n);
    return c > 1e-6 ? std::clamp(cross(m, n) / c, -4.0, 4.0) : 4.0;
}

/// The edges before and behind one of the same ring.
struct Neighbours {
    size_t before, after;
};
Neighbours neighboursOf(const std::vector<PlacedEdge>& edges, size_t i) {
    const size_t first = i - edges[i].index;
    size_t end = i + 1;
    while (end < edges.size() && edges[end].polygon == edges[i].polygon && edges[end].ring == edges[i].ring) ++end;
    return {i == first ? end - 1 : i - 1, i + 1 == end ? first : i + 1};
}

/// An edge's own place, moved out by `out` metres.
RoofFace onEdge(RoofFace::Kind kind, const std::vector<PlacedEdge>& edges, size_t i, double out) {
    const PlacedEdge& e = edges[i];
    const Neighbours next = neighboursOf(edges, i);
    const double before = out * mitre(edges[next.before], e), after = out * mitre(e, edges[next.after]);
    const Vec2 along = (e.to - e.from) * (1 / e.length());
    RoofFace face;
    face.kind = kind;
    face.edge = static_cast<uint32_t>(i);
    face.outward = e.normal();
    face.at = (e.from + e.to) * .5 + along * ((after - before) / 2) + face.outward * out;
    face.width_m = e.length() + before + after;
    return face;
}

Vec3d pointAt(Vec2 at, double height_m) { return {at.x, height_m, at.z}; }

/// The corners of a face that is as wide at its top as below: upright where it has no run.
std::array<Vec3d, 4> rectangleOf(const RoofFace& face) {
    const Vec2 along = Vec2{face.outward.z * -1, face.outward.x} * (face.width_m / 2),
               out = face.outward * (face.run_m / 2);
    const double low = face.height_m - face.rise_m / 2, high = face.height_m + face.rise_m / 2;
    return {pointAt(face.at + out - along, low), pointAt(face.at + out + along, low),
            pointAt(face.at - out + along, high), pointAt(face.at - out - along, high)};
}

/// The middle of the slope over an edge, where it is as wide as the lines around leave it.
std::optional<RoofFace> slopeOver(const RoofPlanes& planes, const RoofSurface& roof,
                                  const std::vector<PlacedEdge>& edges, size_t i) {
    RoofFace face = onEdge(RoofFace::Kind::Slope, edges, i, 0);
    const RoofPlanes::Side& side = planes.sides[i];
    const Vec2 in = face.outward * -1, along{face.outward.z * -1, face.outward.x};
    const double whole = std::min(reach(roof, face.edge, face.at, in), std::max(0.0, planes.highest_m / side.slope));
    if (whole < leastFace_m) return std::nullopt;
    const Vec2 middle = face.at + in * (whole / 2);
    const double left = reach(roof, face.edge, middle, along), right = reach(roof, face.edge, middle, along * -1);
    face.at = middle + along * ((left - right) / 2);
    face.width_m = left + right;
    face.run_m = whole;
    face.rise_m = whole * side.slope;
    face.height_m = planes.fascia_m + side.rise + face.rise_m / 2;
    if (face.width_m < leastFace_m) return std::nullopt;
    // Beside the end of the middle line, a little below where other slopes begin.
    const double run_m = whole * .999, foot_m = planes.fascia_m + side.rise, top_m = foot_m + run_m * side.slope;
    const Vec2 top = (edges[i].from + edges[i].to) * .5 + in * run_m;
    face.corners = {pointAt(edges[i].from, foot_m), pointAt(edges[i].to, foot_m),
                    pointAt(top + along * reach(roof, face.edge, top, along), top_m),
                    pointAt(top - along * reach(roof, face.edge, top, along * -1), top_m)};
    return face;
}

std::vector<RoofFace> facesOf(const RoofPlanes& planes, const plan::Footprint& footprint, const plan::Formula& formula,
                              double height_m) {
    const std::vector<PlacedEdge> edges = plan::edgesOf(footprint);
    const RoofSurface roof = surfaceOf(planes, footprint, formula);
    double least = 1e9;
    for (const RoofPlanes::Side& side : planes.sides)
        if (side.slope > 0) least = std::min(least, side.slope);
    std::vector<RoofFace> faces;
    for (size_t i = 0; i < edges.size(); ++i) {
        if (planes.sides[i].slope > 0) {
            if (auto slope = slopeOver(planes, roof, edges, i)) faces.push_back(*slope);
            RoofFace& eave = faces.emplace_back(onEdge(RoofFace::Kind::Eave, edges, i, planes.overhang_m));
            eave.rise_m = planes.fascia_m;
            eave.height_m = planes.fascia_m / 2 - planes.overhang_m * least;
            eave.corners = rectangleOf(eave);
            continue;
        }
        RoofFace& gable = faces.emplace_back(onEdge(RoofFace::Kind::Gable, edges, i, planes.overhang_m));
        const Vec2 inside = (edges[i].from + edges[i].to) * .5 - gable.outward * 1e-4;
        gable.rise_m = std::max(0.0, -plan::valueOf(formula, roof.slopes, inside)) + planes.fascia_m;
        gable.height_m = gable.rise_m / 2;
        gable.corners = rectangleOf(gable);
        gable.corners[2] = gable.corners[3] = pointAt(gable.at, gable.rise_m);
    }
    const auto isOther = [&](const RoofPlanes::Side& side) { return side.slope > least; };
    const bool isUneven = std::any_of(planes.sides.begin(), planes.sides.end(), isOther);
    RoofFace& apex = faces.emplace_back();
    apex.kind = RoofFace::Kind::Apex;
    apex.at = isUneven ? plan::leastPoint(footprint, formula, roof.slopes) : plan::deepestPoint(footprint, formula).at;
    apex.outward = {0, 1};
    // Roofs of two pitches and cut-off ones end below where their first slopes would meet.
    apex.height_m = std::min(height_m, planes.fascia_m - plan::valueOf(formula, roof.slopes, apex.at));
    apex.corners.fill(pointAt(apex.at, apex.height_m));
    return faces;
}

/// The one plane of a shed roof, over the middle of the outline.
RoofFace shedSlope(const plan::Footprint& footprint, std::span<const Argument> a) {
    constexpr Vec2 down[] = {{0, 1}, {0, -1}, {1, 0}, {-1, 0}};
    RoofFace face;
    face.outward = down[std::min<size_t>(static_cast<size_t>(valueAt(a, 4)), 3)];
    const plan::Box2 box = bounds(footprint);
    const Vec2 size = box.size();
    const bool alongX = face.outward.x != 0;
    face.at = box.centre();
    face.run_m = alongX ? size.x : size.z;
    face.width_m = alongX ? size.z : size.x;
    face.rise_m = face.run_m * std::tan(valueAt(a, 0));
    face.height_m = valueAt(a, 2) + face.rise_m / 2;
    face.corners = rectangleOf(face);
    return face;
}

/// The planes of a pyramid, to the point over the centre of mass.
std::vector<RoofFace> pyramidSlopes(const plan::Footprint& footprint, double fascia_m, double height_m) {
    const std::vector<PlacedEdge> edges = plan::edgesOf(footprint);
    const Vec2 top = plan::centroid(footprint);
    std::vector<RoofFace> faces;
    for (size_t i = 0; i < edges.size(); ++i) {
        RoofFace face = onEdge(RoofFace::Kind::Slope, edges, i, 0);
        face.run_m = dot(face.at - top, face.outward);
        if (face.run_m < leastFace_m) return {};  // an edge looks away from the point: no pyramid stands there
        face.at = (face.at + top) * .5;
        face.width_m /= 2;
        face.rise_m = height_m - fascia_m;
        face.height_m = fascia_m + face.rise_m / 2;
        const Vec3d point = pointAt(top, height_m);
        face.corners = {pointAt(edges[i].from, fascia_m), pointAt(edges[i].to, fascia_m), point, point};
        faces.push_back(face);
    }
    return faces;
}

}  // namespace

bool isRoof(const Primitive& row) { return row.name.ends_with("Roof"); }

std::vector<RoofFace> roofFaces(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                std::span<const Argument> arguments, double height_m) {
    if (!isRoof(row) || footprint.empty()) return {};
    if (const auto planes = roofPlanes(row, footprint, formula, arguments))
        return facesOf(*planes, footprint, formula, height_m);
    if (row.name == "shedRoof") return {shedSlope(footprint, arguments)};
    if (row.plan != PlanUse::Fills) return {};
    std::vector<RoofFace> faces;
    if (row.name == "pyramidRoof") faces = pyramidSlopes(footprint, valueAt(arguments, 1), height_m);
    const bool isPyramid = !faces.empty();
    RoofFace& apex = faces.emplace_back();
    apex.kind = RoofFace::Kind::Apex;
    apex.at = isPyramid ? plan::centroid(footprint) : plan::deepestPoint(footprint, formula).at;
    apex.outward = {0, 1};
    apex.height_m = height_m;
    apex.corners.fill(pointAt(apex.at, height_m));
    return faces;
}

namespace {

/// The number of the leaf that is the formula's value at a point: of slopes in one plane that over the nearest edge.
uint32_t leafAt(const plan::Formula& formula, std::span<const Linear> leaves, std::span<const PlacedEdge> edges,
                Vec2 at) {
    constexpr double tie_m = 1e-7;
    const double value = plan::valueOf(formula, leaves, at);
    const auto away = [&](uint32_t i) { return std::max(std::abs(leaves[i].at(at) - value), tie_m); };
    const auto isNearer = [&](uint32_t i, uint32_t k) {
        return std::pair(away(i), plan::distanceTo(edges[i], at)) < std::pair(away(k), plan::distanceTo(edges[k], at));
    };
    uint32_t nearest = 0;
    for (uint32_t i = 1; i < leaves.size(); ++i)
        if (isNearer(i, nearest)) nearest = i;
    return nearest;
}

/// The plane of a slope, as its height negated.
Linear planeOf(const RoofFace& slope) {
    const double pitch = slope.rise_m / slope.run_m;
    return {pitch * slope.outward.x, pitch * slope.outward.z, -slope.height_m - pitch * dot(slope.outward, slope.at)};
}

/// What a point of a roof of planes lies on: its kind and edge.
std::pair<RoofFace::Kind, uint32_t> placeOn(const RoofPlanes& planes, const plan::Footprint& footprint,
                                            const plan::Formula& formula, Vec2 at, double above_m) {
    constexpr double tolerance_m = .01;
    const RoofSurface roof = surfaceOf(planes, footprint, formula);
    const double value = plan::valueOf(formula, roof.slopes, at);
    const double top_m = planes.fascia_m + std::min(-value, planes.highest_m);
    const std::vector<PlacedEdge> edges = plan::edgesOf(footprint);
    if (above_m >= top_m - tolerance_m) return {RoofFace::Kind::Slope, leafAt(formula, roof.slopes, edges, at)};
    uint32_t edge = 0;
    for (uint32_t i = 1; i < edges.size(); ++i)
        if (plan::distanceTo(edges[i], at) < plan::distanceTo(edges[edge], at)) edge = i;
    return {planes.sides[edge].slope > 0 ? RoofFace::Kind::Eave : RoofFace::Kind::Gable, edge};
}

}  // namespace

std::optional<RoofFace> roofFaceAt(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                   std::span<const Argument> arguments, double height_m, plan::Vec2 at,
                                   double above_m) {
    const std::vector<RoofFace> faces = roofFaces(row, footprint, formula, arguments, height_m);
    const auto find = [&](RoofFace::Kind kind, uint32_t edge) -> std::optional<RoofFace> {
        for (const RoofFace& face : faces)
            if (face.kind == kind && face.edge == edge) return face;
        return std::nullopt;
    };
    if (const auto planes = roofPlanes(row, footprint, formula, arguments)) {
        const auto [kind, edge] = placeOn(*planes, footprint, formula, at, above_m);
        return find(kind, edge);
    }
    if (row.name == "shedRoof") return find(RoofFace::Kind::Slope, 0);
    std::vector<Linear> slopes;  // of a pyramid, one an edge
    for (const RoofFace& face : faces)
        if (face.kind == RoofFace::Kind::Slope) slopes.push_back(planeOf(face));
    if (slopes.empty()) return std::nullopt;
    return find(RoofFace::Kind::Slope, leafAt(formula, slopes, plan::edgesOf(footprint), at));
}

}  // namespace sgm::field
