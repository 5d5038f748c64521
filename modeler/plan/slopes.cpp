// What roofs ask of a formula: how deep it is, how far slopes reach, where gables stand.
#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include "modeler/plan/formula.h"
#include "modeler/plan/grouped_formula.h"

namespace sgm::plan {

namespace {

/// The least the formula can be in a rectangle, and the rectangle's number: what moves in the queue is small.
struct Candidate {
    double bound;
    uint32_t box;
    friend bool operator<(const Candidate& a, const Candidate& b) { return a.bound > b.bound; }
};

/// Branch and bound for the least value inside an outline.
struct Search {
    const Formula& formula;
    std::span<const Linear> leaves, outline;
    double tolerance;
    GroupedFormula inside{formula, outline};
    std::optional<GroupedFormula> other{};  ///< of the leaves, where they aren't the outline's
    double reached = Box2::far;             ///< the least value found
    Vec2 where{};                           ///< its place
    std::vector<Box2> boxes{};
    std::priority_queue<Candidate> queue{};

    void add(const Box2& first, const Box2& second) {
        const BoxPair pair(first, second);
        const BoxPair::Lanes outside = inside.evaluate(pair);
        if (outside[0] > 0 && outside[1] > 0) return;
        const BoxPair::Lanes over = other ? other->evaluate(pair) : outside;
        add(first, outside[0], over[0], outside[2], over[2]);
        add(second, outside[1], over[1], outside[3], over[3]);
    }
    /// With the bounds of the outline and of the leaves over the box, and both values at its centre.
    void add(const Box2& box, double outside, double bound, double outsideAtCentre, double atCentre) {
        if (outside > 0) return;
        if (outsideAtCentre <= 0 && atCentre < reached) reached = atCentre, where = box.centre();
        if (!(bound < reached - tolerance)) return;
        queue.push({bound, static_cast<uint32_t>(boxes.size())});
        boxes.push_back(box);
    }

    /// A lower bound of what the boxes hold that were left.
    double run(const Box2& box) {
        constexpr size_t mostBoxes = 4096;
        if (leaves.data() != outline.data()) other.emplace(formula, leaves);
        const BoxPair pair(box, box);
        const BoxPair::Lanes outside = inside.evaluate(pair), over = other ? other->evaluate(pair) : outside;
        add(box, outside[0], over[0], outside[2], over[2]);
        for (size_t n = 0; n < mostBoxes && !queue.empty() && queue.top().bound < reached - tolerance; ++n) {
            const Box2 b = boxes[queue.top().box];
            queue.pop();
            Box2 low = b, high = b;
            if (b.size().x > b.size().z)
                low.hi.x = high.lo.x = b.centre().x;
            else
                low.hi.z = high.lo.z = b.centre().z;
            add(low, high);
        }
        return queue.empty() ? Box2::far : queue.top().bound;
    }

    /// Goes to the line or the vertex of leaves beside the least value found, where it is less there.
    void settle() {
        constexpr size_t most = 8;
        std::vector<std::pair<double, const Linear*>> near;
        for (const Linear& l : leaves)
            if (const double off = std::abs(l.at(where) - reached); off < 4 * tolerance) near.emplace_back(off, &l);
        std::sort(near.begin(), near.end());
        near.resize(std::min(near.size(), most));
        for (size_t i = 0; i < near.size(); ++i)
            for (size_t j = i + 1; j < near.size(); ++j) {
                tryBetween(*near[i].second, *near[j].second);
                for (size_t k = j + 1; k < near.size(); ++k)
                    tryVertex(*near[i].second, *near[j].second, *near[k].second);
            }
    }

private:
    void tryAt(Vec2 at) {
        if (!(valueOf(formula, outline, at) <= 0)) return;
        if (const double value = valueOf(formula, leaves, at); value < reached) reached = value, where = at;
    }

    /// The nearest point where two leaves are equal: of a level ridge.
    void tryBetween(const Linear& p, const Linear& q) {
        const Vec2 across{p.a - q.a, p.b - q.b};
        const double square = dot(across, across);
        if (square > 1e-9) tryAt(where - across * ((p.at(where) - q.at(where)) / square));
    }

    /// The point where three leaves are equal.
    void tryVertex(const Linear& p, const Linear& q, const Linear& r) {
        const Vec2 a{p.a - q.a, p.b - q.b}, b{p.a - r.a, p.b - r.b};
        const double area = cross(a, b), u = q.c - p.c, v = r.c - p.c;
        if (!(std::abs(area) > 1e-9)) return;
        tryAt({(u * b.z - v * a.z) / area, (a.x * v - b.x * u) / area});
    }
};

}  // namespace

double leastInside(const Formula& formula, std::span<const Linear> leaves, std::span<const Linear> outline, Box2 box,
                   double tolerance) {
    Search search{formula, leaves, outline, tolerance};
    const double open = search.run(box);
    return std::min(open, search.reached - tolerance);
}

Deepest deepestPoint(const Footprint& footprint, const Formula& formula) {
    const std::vector<Linear> distances = distancesOf(footprint);
    const Box2 box = bounds(footprint);
    Search search{formula, distances, distances, 1e-3 * std::min(box.size().x, box.size().z)};
    search.run(box);
    search.settle();
    return {search.where, -search.reached};
}

Vec2 leastPoint(const Footprint& footprint, const Formula& formula, std::span<const Linear> leaves) {
    const std::vector<Linear> distances = distancesOf(footprint);
    const Box2 box = bounds(footprint);
    Search search{formula, leaves, distances, 1e-4 * std::min(box.size().x, box.size().z)};
    search.run(box);
    search.settle();
    return search.where;
}

double slopeDepth(const Footprint& footprint, const Formula& formula, std::span<const Linear> leaves, uint32_t edge,
                  double share) {
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    if (edge >= edges.size() || edge >= leaves.size()) return 0;
    const PlacedEdge& e = edges[edge];
    const Vec2 from = e.from + (e.to - e.from) * std::clamp(share, 0.0, 1.0), in = e.normal() * -1;
    // Where another leaf has the edge's own value on the way inward.
    const auto slopeOf = [&](const Linear& l) { return l.a * in.x + l.b * in.z; };
    std::vector<double> stops;
    for (const Linear& l : leaves) {
        const double by = slopeOf(leaves[edge]) - slopeOf(l);
        if (std::abs(by) < 1e-12) continue;
        const double t = (l.at(from) - leaves[edge].at(from)) / by;
        if (t > 1e-9 && t < 1e6) stops.push_back(t);
    }
    std::sort(stops.begin(), stops.end());
    double reached = 0;
    for (const double stop : stops) {
        const Vec2 middle = from + in * ((reached + stop) / 2);
        const double own = leaves[edge].at(middle);
        if (std::abs(valueOf(formula, leaves, middle) - own) > 1e-9 * (1 + std::abs(own))) return reached;
        reached = stop;
    }
    return reached;
}

std::vector<uint32_t> gableEnds(const Footprint& footprint, const Formula& formula) {
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    const std::vector<Linear> distances = distancesOf(footprint);
    const auto ringStart = [&](size_t i) { return i - edges[i].index; };
    std::vector<size_t> ringEnd(edges.size());
    for (size_t i = edges.size(); i-- > 0;) {
        const bool last =
            i + 1 == edges.size() || edges[i + 1].ring != edges[i].ring || edges[i + 1].polygon != edges[i].polygon;
        ringEnd[i] = last ? i + 1 : ringEnd[i + 1];
    }
    struct End {
        double length;
        uint32_t edge, before, after;
        bool isApex;  // more than three slopes meet there: a pyramid or a cone
    };
    std::vector<End> found;
    for (size_t i = 0; i < edges.size(); ++i) {
        const size_t begin = ringStart(i), end = ringEnd[i];
        const size_t before = i == begin ? end - 1 : i - 1, after = i + 1 == end ? begin : i + 1;
        const Vec2 d = edges[i].to - edges[i].from;
        if (cross(edges[before].to - edges[before].from, d) <= 0 || cross(d, edges[after].to - edges[after].from) <= 0)
            continue;
        // The point that is as far from the edge as from both neighbours.
        const Linear &a = distances[before], &b = distances[i], &c = distances[after];
        const double px = a.a - b.a, pz = a.b - b.b, qx = c.a - b.a, qz = c.b - b.b;
        const double by = px * qz - pz * qx;
        if (std::abs(by) < 1e-12) continue;
        const double r = b.c - a.c, s = b.c - c.c;
        const Vec2 top{(r * qz - s * pz) / by, (px * s - qx * r) / by};
        const double depth = b.at(top);
        const double l = length(d);
        if (depth >= 0 || std::abs(valueOf(formula, distances, top) - depth) > 1e-6 * l) continue;
        const bool isApex = std::any_of(distances.begin(), distances.end(), [&](const Linear& other) {
            const auto parallel = [&](const Linear& o) { return other.a * o.a + other.b * o.b > 1 - 1e-9; };
            return std::abs(other.at(top) - depth) < 1e-6 * l && !parallel(a) && !parallel(b) && !parallel(c);
        });
        found.push_back(
            {l, static_cast<uint32_t>(i), static_cast<uint32_t>(before), static_cast<uint32_t>(after), isApex});
    }
    if (edges.size() != 4) std::erase_if(found, [](const End& e) { return e.isApex; });
    std::stable_sort(found.begin(), found.end(),
                     [](const End& a, const End& b) { return a.length < b.length * (1 - 1e-9); });
    std::vector<bool> taken(edges.size());
    std::vector<uint32_t> ends;
    for (const End& e : found) {
        if (taken[e.before] || taken[e.after]) continue;
        taken[e.edge] = true;
        ends.push_back(e.edge);
    }
    std::sort(ends.begin(), ends.end());
    return ends;
}

}  // namespace sgm::plan
