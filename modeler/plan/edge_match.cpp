#include "modeler/plan/edge_match.h"

#include <algorithm>

namespace sgm::plan {
namespace {

/// A source edge's line, ready to be held against points.
struct Line {
    Vec2 from, along, normal;  // unit vectors
    double length, out;
    /// How badly a segment fits: its distance from the moved line, and past its ends at a thousandth, metres.
    double misfit(Vec2 a, Vec2 b) const {
        const double off = std::max(std::abs(dot(a - from, normal) - out), std::abs(dot(b - from, normal) - out));
        const double at = dot((a + b) * 0.5 - from, along);
        return off + 1e-3 * std::max({0.0, -at, at - length});
    }
};

constexpr double sure_m = 4e-6;

/// The line that fits the segment from a to b best; the search begins at `first`.
size_t bestFor(Vec2 a, Vec2 b, const std::vector<Line>& lines, size_t first) {
    double least = Box2::far;
    size_t best = first;
    for (size_t n = 0, i = first; n < lines.size(); ++n, i = i + 1 == lines.size() ? 0 : i + 1) {
        const double misfit = lines[i].misfit(a, b);
        if (misfit >= least) continue;
        least = misfit, best = i;
        if (least < sure_m && std::abs(dot(lines[i].normal, b - a)) < sure_m) break;
    }
    return best;
}

}  // namespace

void matchEdges(Footprint& footprint, const std::vector<SourceEdge>& sources) {
    if (sources.empty()) return;
    std::vector<Line> lines;
    lines.reserve(sources.size());
    for (const SourceEdge& s : sources) {
        const double l = std::max(length(s.to - s.from), 1e-12);
        const Vec2 along = (s.to - s.from) * (1 / l);
        lines.push_back({s.from, along, {along.z, -along.x}, l, s.out});
    }
    // Neighbours come from neighbours for the most part: the search begins where the last one ended.
    size_t last = 0;
    const auto match = [&](Ring& ring) {
        for (size_t i = 0; i < ring.size(); ++i) {
            last = bestFor(ring.from(i), ring.to(i), lines, last);
            ring.edges[i] = sources[last].edge;
        }
    };
    for (Polygon& polygon : footprint.polygons) {
        match(polygon.outer);
        for (Ring& court : polygon.courts) match(court);
    }
}

std::vector<SourceEdge> sourcesOf(const Footprint& footprint, const std::vector<double>& out) {
    std::vector<SourceEdge> sources;
    for (const PlacedEdge& e : edgesOf(footprint))
        sources.push_back({e.from, e.to, out.empty() ? 0 : out[sources.size()], e.edge});
    return sources;
}

std::vector<uint32_t> addTags(Footprint& footprint, const std::vector<std::string>& words) {
    std::vector<uint32_t> numbers;
    for (const std::string& word : words) numbers.push_back(footprint.tag(word));
    return numbers;
}

}  // namespace sgm::plan
