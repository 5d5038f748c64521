// Setbacks: what is nearer to an edge than its distance goes, by strips along edges and wedges at corners.
#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/crossings.h"
#include "modeler/plan/edge_match.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/ring_parts.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

/// Edges that booleans of single strips may look at, ten seconds of work.
constexpr size_t mostSteps = 20'000'000;
constexpr size_t unlimited = static_cast<size_t>(-1);

LatticePath strip(std::initializer_list<Vec2> corners) {
    Ring ring = ringOf(corners);
    if (signedArea(ring) < 0) ring = reversed(ring);
    LatticePath path;
    for (const Vec2 p : ring.points) path.push_back(latticePoint(p));
    return path;
}

/// The part of a strip that hangs together with its edge inside the footprint: not what lies beyond a gap.
LatticePaths partAt(const PlacedEdge& edge, const LatticePath& whole, const Footprint& footprint) {
    Footprint inside = booleanOf(PathBoolean::Intersection, pathsOf(footprint), {whole});
    const Vec2 middle = (edge.from + edge.to) * 0.5;
    std::erase_if(inside.polygons, [&](const Polygon& p) { return distanceToEdges(footprintOf(p), middle) > 1e-4; });
    return pathsOf(inside);
}

/// Whether the strip may reach over other edges than its neighbours.
bool reachesOver(const std::vector<PlacedEdge>& edges, size_t of, const Box2& box) {
    for (size_t i = 0; i < edges.size(); ++i) {
        const PlacedEdge& e = edges[i];
        if (i == of || e.to == edges[of].from || e.from == edges[of].to) continue;
        if (std::max(e.from.x, e.to.x) >= box.lo.x && std::min(e.from.x, e.to.x) <= box.hi.x &&
            std::max(e.from.z, e.to.z) >= box.lo.z && std::min(e.from.z, e.to.z) <= box.hi.z)
            return true;
    }
    return false;
}

/// All that lies too near to some edge; nothing where finding it takes more than `most` steps.
std::optional<LatticePaths> stripsOf(const Footprint& footprint, const std::vector<PlacedEdge>& edges,
                                     std::span<const double> in, size_t most) {
    LatticePaths strips;
    size_t steps = 0;
    for (size_t i = 0, ringBegin = 0; i < edges.size(); ++i) {
        const PlacedEdge& e = edges[i];
        if (e.index == 0) ringBegin = i;
        const bool last = i + 1 == edges.size() || edges[i + 1].index == 0;
        const size_t next = last ? ringBegin : i + 1;
        if (in[i] > 0) {
            const Vec2 deep = e.normal() * -in[i];
            Box2 box;
            for (const Vec2 p : {e.from, e.to, e.from + deep, e.to + deep}) box.add(p);
            const LatticePath whole = strip({e.from, e.to, e.to + deep, e.from + deep});
            if (!reachesOver(edges, i, box))
                strips.push_back(whole);
            else if ((steps += edges.size()) > most)
                return std::nullopt;
            else
                for (LatticePath& part : partAt(e, whole, footprint)) strips.push_back(std::move(part));
        }
        const Vec2 n = e.normal(), m = edges[next].normal(), at = e.to, foot = at - n * in[i];
        const Vec2 footAfter = at - m * in[next];
        const double turn = cross(n, m);
        const auto corner = cornerMovedIn({-n.z, n.x}, {-m.z, m.x}, in[i], in[next]);
        if (corner && std::abs(turn) >= 1e-9) {
            const Vec2 tip = at + *corner;
            strips.push_back(strip({at, foot, tip}));
            strips.push_back(strip({at, tip, footAfter}));
        } else if (turn < 0) {
            strips.push_back(strip({at, foot, footAfter}));
        }
    }
    return strips;
}

/// Nothing where the outline `isLimited` and asks for too much.
std::optional<Footprint> setBack(const Footprint& footprint, std::span<const double> distances_m, bool isLimited) {
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    std::vector<double> in(edges.size()), out(edges.size());
    for (size_t i = 0; i < edges.size(); ++i) {
        in[i] = i < distances_m.size() && distances_m[i] > 0 ? std::min(distances_m[i], 1e5) : 0;
        out[i] = -in[i];
    }
    if (std::all_of(in.begin(), in.end(), [](double d) { return d == 0; })) return footprint;
    if (footprint.polygons.size() == 1 && footprint.polygons[0].courts.empty())
        if (auto ring = movedIn(footprint.polygons[0].outer, in)) {
            Footprint result{{}, footprint.tags};
            if (ring->size() >= 3) result.polygons.push_back({std::move(*ring), {}});
            return result;
        }
    auto strips = stripsOf(footprint, edges, in, isLimited ? mostSteps : unlimited);
    if (!strips) return std::nullopt;
    if (isLimited) {
        LatticePaths all = pathsOf(footprint);
        all.insert(all.end(), strips->begin(), strips->end());
        if (countCrossings(all, mostCrossings) > mostCrossings) return std::nullopt;
    }
    Footprint result = booleanOf(PathBoolean::Difference, pathsOf(footprint), *strips);
    result.tags = footprint.tags;
    matchEdges(result, sourcesOf(footprint, out));
    return tidied(std::move(result));
}

}  // namespace

Footprint setback(const Footprint& footprint, std::span<const double> distances_m) {
    return *setBack(footprint, distances_m, false);
}

Result<Footprint> setbackInBudget(const Footprint& footprint, std::span<const double> distances_m) {
    if (auto result = setBack(footprint, distances_m, true)) return std::move(*result);
    return Error{Error::Kind::Budget,
                 "the outline has so many edges within the setback of others that they would take minutes: draw it "
                 "with fewer points, or set it back by less"};
}

}  // namespace sgm::plan
