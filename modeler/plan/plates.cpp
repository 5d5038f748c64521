#include "modeler/plan/plates.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/edge_match.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

constexpr double plateMitreLimit = 4;
constexpr Edge cut{0, EdgeSource::Cut};

/// Where the lines of two edges cross after both moved inward; bevelled corners have none.
std::optional<Vec2> insetCorner(Vec2 before, Vec2 at, Vec2 after, double by) {
    const Vec2 a = (at - before) * (1 / length(at - before)), b = (after - at) * (1 / length(after - at));
    const Vec2 sum = Vec2{-a.z, a.x} + Vec2{-b.z, b.x};
    const double square = dot(sum, sum);
    if (square < 4 / (plateMitreLimit * plateMitreLimit)) return {};
    return at + sum * (2 * by / square);
}

/// The ring with every corner moved inward; nothing where an edge would vanish or turn round.
std::optional<Ring> insetRing(const Ring& ring, double by) {
    Ring inset;
    inset.edges = ring.edges;
    const size_t n = ring.size();
    for (size_t i = 0; i < n; ++i) {
        const auto corner = insetCorner(ring.points[(i + n - 1) % n], ring.points[i], ring.points[(i + 1) % n], by);
        if (!corner) return {};
        inset.points.push_back(*corner);
    }
    for (size_t i = 0; i < n; ++i)
        if (dot(inset.to(i) - inset.from(i), ring.to(i) - ring.from(i)) <= 2e-3 * length(ring.to(i) - ring.from(i)))
            return {};
    return inset;
}

/// The core with an edge for every edge of the footprint, where there is such a one.
std::optional<Footprint> edgeForEdge(const Footprint& footprint, double by) {
    Footprint core = footprint;
    for (Polygon& polygon : core.polygons) {
        const auto outer = insetRing(polygon.outer, by);
        if (!outer) return {};
        polygon.outer = *outer;
        for (Ring& court : polygon.courts) {
            const auto inset = insetRing(court, by);
            if (!inset) return {};
            court = *inset;
        }
    }
    if (firstFault(core)) return {};
    return core;
}

/// The trapezoid between an edge and its place in the core; its first edge is the edge itself.
Footprint trapezoid(const PlacedEdge& edge, Vec2 insetFrom, Vec2 insetTo, const std::vector<std::string>& tags) {
    Ring ring = ringOf({edge.from, edge.to, insetTo, insetFrom}, cut);
    ring.edges[0] = edge.edge;
    Footprint plate = footprintOf({std::move(ring), {}});
    plate.tags = tags;
    return plate;
}

/// As far as a plate may reach at a corner: to the mitre, or a bevel's middle.
Vec2 reachAt(Vec2 before, Vec2 at, Vec2 after, double by) {
    if (const auto corner = insetCorner(before, at, after, by)) return *corner;
    const Vec2 a = (at - before) * (1 / length(at - before)), b = (after - at) * (1 / length(after - at));
    const bool convex = cross(a, b) > 0;
    const Vec2 bisector = (b - a) * (1 / std::max(length(b - a), 1e-9));
    return at + bisector * (convex ? plateMitreLimit * by : -by);
}

/// Each plate cut in turn from what is left of the rim; what no plate reaches goes to the nearest edge.
std::vector<Plate> cutInTurn(const Footprint& footprint, const std::vector<PlacedEdge>& edges, const Footprint& core,
                             double by) {
    Footprint rest = boolean(Boolean::Difference, footprint, core);
    std::vector<Plate> plates;
    for (size_t begin = 0, end; begin < edges.size(); begin = end) {
        for (end = begin + 1; end < edges.size() && edges[end].index != 0;) ++end;
        const size_t n = end - begin;
        for (size_t i = begin; i < end; ++i) {
            const PlacedEdge &e = edges[i], &before = edges[begin + (i - begin + n - 1) % n],
                             &after = edges[begin + (i - begin + 1) % n];
            const Vec2 from = reachAt(before.from, e.from, e.to, by), to = reachAt(e.from, e.to, after.to, by);
            const Vec2 in = e.normal() * -by;
            // The trapezoid, and the strip square to the edge where the mitres leave more.
            LatticePaths reach;
            for (const Ring& quad :
                 {ringOf({e.from, e.to, to, from}), ringOf({e.from, e.to, e.to + in, e.from + in})}) {
                LatticePath& path = reach.emplace_back();
                for (const Vec2 p : quad.points) path.push_back(latticePoint(p));
            }
            Footprint mask = tidied(booleanOf(PathBoolean::Union, {reach[0]}, {}));
            Footprint plate = boolean(Boolean::Intersection, rest, mask);
            if (plate.empty()) continue;
            rest = boolean(Boolean::Difference, rest, mask);
            plates.push_back({static_cast<uint32_t>(i), std::move(plate)});
        }
    }
    for (const Polygon& left : rest.polygons) {
        Footprint piece = footprintOf(left);
        piece.tags = rest.tags;
        const Vec2 middle = centroid(piece);
        Plate* nearest = nullptr;
        double least = Box2::far;
        for (Plate& plate : plates)
            if (const double d = distanceToEdges(plate.footprint, middle); d < least) least = d, nearest = &plate;
        if (nearest) nearest->footprint = boolean(Boolean::Union, nearest->footprint, piece);
    }
    return plates;
}

/// Trapezoids that share their mitres, as trapezoid() makes them: booleans would leave gaps of the lattice's width.
std::optional<Footprint> joinedTrapezoids(const std::vector<Plate>& plates, bool closed) {
    Ring out, in;  // the latter from the first plate to the last
    for (size_t i = 0; i < plates.size(); ++i) {
        const Footprint& plate = plates[i].footprint;
        if (plate.polygons.size() != 1 || plate.polygons[0].outer.size() != 4) return {};
        const Ring& ring = plate.polygons[0].outer;
        if (i > 0 && (out.points.back() != ring.points[0] || in.points.back() != ring.points[3])) return {};
        if (i == 0) out.points.push_back(ring.points[0]), in.points.push_back(ring.points[3]);
        out.points.push_back(ring.points[1]), in.points.push_back(ring.points[2]);
        out.edges.push_back(ring.edges[0]), in.edges.push_back(cut);
    }
    Polygon polygon;
    if (closed) {
        if (out.points.back() != out.points[0] || in.points.back() != in.points[0]) return {};
        out.points.pop_back(), in.points.pop_back();
        const bool isCourt = signedArea(out) < 0;
        polygon.outer = isCourt ? reversed(in) : std::move(out);
        polygon.courts.push_back(isCourt ? std::move(out) : reversed(in));
    } else {
        out.points.insert(out.points.end(), in.points.rbegin(), in.points.rend());
        out.edges.resize(out.points.size(), cut);
        polygon.outer = std::move(out);
    }
    Footprint whole = footprintOf(std::move(polygon));
    whole.tags = plates[0].footprint.tags;
    if (firstFault(whole)) return {};
    return whole;
}

/// Calls what isn't cut `outer` as well.
void nameOutline(Footprint& face) {
    const size_t words = face.tags.size();
    std::vector<uint32_t> outer(words, 0);
    const auto outerOf = [&](uint32_t tag) {
        if (outer[tag] != 0) return outer[tag];
        const std::string word = face.tags[tag];
        const bool has = (" " + word + " ").find(" outer ") != std::string::npos;
        return outer[tag] = has ? tag : face.tag(word.empty() ? "outer" : word + " outer");
    };
    for (Polygon& polygon : face.polygons) {
        const auto name = [&](Ring& ring) {
            for (Edge& edge : ring.edges)
                if (edge.source != EdgeSource::Cut) edge.tag = outerOf(edge.tag);
        };
        name(polygon.outer);
        for (Ring& court : polygon.courts) name(court);
    }
}

}  // namespace

Result<Plates> platesOf(const Footprint& footprint, double thickness_m) {
    if (!(thickness_m > 0)) return Error{Error::Kind::Input, "the thickness of plates must be more than 0"};
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    Plates result;
    if (const auto core = edgeForEdge(footprint, thickness_m)) {
        const std::vector<PlacedEdge> inset = edgesOf(*core);
        for (size_t i = 0; i < edges.size(); ++i)
            result.plates.push_back(
                {static_cast<uint32_t>(i), trapezoid(edges[i], inset[i].from, inset[i].to, footprint.tags)});
        result.core = *core;
        return result;
    }
    result.core = offset(footprint, -thickness_m);
    result.plates = cutInTurn(footprint, edges, result.core, thickness_m);
    return result;
}

Footprint joined(const std::vector<Plate>& plates, bool closed) {
    Footprint whole;
    if (plates.size() == 1) {
        whole = plates[0].footprint;
    } else if (auto direct = joinedTrapezoids(plates, closed)) {
        whole = std::move(*direct);
    } else {
        whole = plates[0].footprint;
        for (size_t i = 1; i < plates.size(); ++i) whole = boolean(Boolean::Union, whole, plates[i].footprint);
    }
    nameOutline(whole);
    return whole;
}

Result<Footprint> band(const Ring& chain, const std::vector<std::string>& tags, double width_m, bool closed) {
    if (chain.size() < 2 || chain.edges.size() < chain.size() - (closed ? 0 : 1))
        return Error{Error::Kind::Input, "a band needs two points or more, and an entry for every segment"};
    if (!(width_m >= 2e-3 && width_m < 1e4)) return Error{Error::Kind::Input, "a band must be 2 mm wide or more"};
    LatticePath path;
    for (const Vec2 p : chain.points) {
        if (!(std::abs(p.x) <= 1e5 && std::abs(p.z) <= 1e5))
            return Error{Error::Kind::Input, "a point of a band is no number, or more than 100 km from the origin"};
        if (path.empty() || path.back() != latticePoint(p)) path.push_back(latticePoint(p));
    }
    if (path.size() < 2) return Error{Error::Kind::Input, "the points of a band are all one"};
    for (const Edge& edge : chain.edges)
        if (edge.tag >= tags.size())
            return Error{Error::Kind::Input, "a segment of a band has a tag that isn't in the list"};
    Footprint result = bandOf(path, width_m / 2, closed);
    result.tags = tags;
    std::vector<SourceEdge> sources;
    for (size_t i = 0; i + (closed ? 0 : 1) < chain.size(); ++i)
        for (const double side : {.5, -.5})
            sources.push_back({chain.from(i), chain.to(i), side * width_m, chain.edges[i]});
    matchEdges(result, sources);
    return tidied(std::move(result));
}

}  // namespace sgm::plan
