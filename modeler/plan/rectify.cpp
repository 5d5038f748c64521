// Laying edges along the main direction of a plan.
#include <algorithm>
#include <cmath>

#include "modeler/core/conventions.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

/// The angle in [0, π/2) along which, or square to which, most metres run: the mean of those within 5° of the fullest
/// half degree.
double mainDirection(const std::vector<PlacedEdge>& edges) {
    constexpr int bins = 180;
    constexpr double quarter = pi / 2;
    std::vector<double> metres(bins);
    const auto angleOf = [](const PlacedEdge& e) {
        const double a = std::fmod(std::atan2(e.to.z - e.from.z, e.to.x - e.from.x) + 4 * quarter, quarter);
        return a < 0 ? a + quarter : a;
    };
    for (const PlacedEdge& e : edges)  // a triangle's worth to the neighbours, so that a border of bins decides nothing
        for (int d = -2; d <= 2; ++d)
            metres[(static_cast<int>(angleOf(e) / quarter * bins) + d + bins) % bins] += e.length() * (3 - std::abs(d));
    const auto fullest = std::max_element(metres.begin(), metres.end()) - metres.begin();
    const double about = (static_cast<double>(fullest) + 0.5) / bins * quarter;
    double sum = 0, weight = 0;
    for (const PlacedEdge& e : edges) {
        double off = angleOf(e) - about;
        off -= quarter * std::round(off / quarter);
        if (std::abs(off) > radians(5)) continue;
        sum += off * e.length(), weight += e.length();
    }
    return weight > 0 ? about + sum / weight : about;
}

/// A line a ring's edge lies on.
struct Line {
    Vec2 through, along;  // along: unit
    bool laid;            // along the main direction or square to it
};

/// The ring with its edges on the lines; parallel neighbours are joined by a step in the middle between them.
Ring onLines(const Ring& ring, const std::vector<Line>& lines) {
    Ring result;
    const size_t n = ring.size();
    for (size_t i = 0; i < n; ++i) {
        const Line &before = lines[(i + n - 1) % n], &at = lines[i];
        const double by = cross(before.along, at.along);
        const Vec2 corner = ring.points[i];
        if (std::abs(by) > 0.02) {
            result.points.push_back(before.through +
                                    before.along * (cross(at.through - before.through, at.along) / by));
            result.edges.push_back(ring.edges[i]);
            continue;
        }
        const auto foot = [&](const Line& l) { return l.through + l.along * dot(corner - l.through, l.along); };
        result.points.push_back(foot(before));
        result.edges.push_back(ring.edges[i]);
        if (length(foot(at) - foot(before)) > 1e-3) {
            result.points.push_back(foot(at));
            result.edges.push_back(ring.edges[i]);
        }
    }
    return result;
}

}  // namespace

Footprint rectified(const Footprint& footprint, double tolerance) {
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    if (edges.empty()) return footprint;
    const double main = mainDirection(edges);
    const auto lay = [&](const Ring& ring) {
        std::vector<Line> lines;
        for (size_t i = 0; i < ring.size(); ++i) {
            const Vec2 d = ring.to(i) - ring.from(i);
            const double angle = std::atan2(d.z, d.x);
            const double laid = main + pi / 2 * std::round((angle - main) / (pi / 2));
            const bool near = std::abs(angle - laid) <= tolerance;
            const double use = near ? laid : angle;
            lines.push_back({(ring.from(i) + ring.to(i)) * 0.5, {std::cos(use), std::sin(use)}, near});
        }
        // Runs of parallel edges lie on one line, through the mean of their middles by length, where they are near it.
        const size_t n = ring.size();
        for (size_t i = 0; i < n; ++i) {
            const size_t next = (i + 1) % n;
            Line &a = lines[i], &b = lines[next];
            if (!a.laid || !b.laid || dot(a.along, b.along) < 0.999) continue;
            const double la = length(ring.to(i) - ring.from(i)), lb = length(ring.to(next) - ring.from(next));
            const double apart = cross(a.along, b.through - a.through);
            if (std::abs(apart) > std::sin(tolerance) * (la + lb) / 2) continue;
            const Vec2 normal{-a.along.z, a.along.x};
            a.through = a.through + normal * (apart * lb / (la + lb));
            b.through = b.through + normal * (-apart * la / (la + lb));
        }
        return onLines(ring, lines);
    };
    Footprint result = footprint;
    for (Polygon& polygon : result.polygons) {
        polygon.outer = lay(polygon.outer);
        for (Ring& court : polygon.courts) court = lay(court);
    }
    result = cleaned(result, 1e-3, 1e-6);
    return !result.empty() && !firstFault(result) ? result : footprint;
}

}  // namespace sgm::plan
