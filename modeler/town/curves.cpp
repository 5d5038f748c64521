#include "modeler/town/curves.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

constexpr double tolerance_m = .2;     // between an arc and its chords
constexpr double share = .48;          // of a piece that an arc at one of its ends may take
constexpr double straight = .99985;    // cosine of 1°: bends of less stay
constexpr double curveSample_m = 5;    // between the places where a curve reads the maps
constexpr double leastTangent_m = .5;  // shorter ones round nothing

/// Whether q lies on the ray from `shared` through `end`: two pieces that leave one node would overlap.
bool runsAlong(Point shared, Point end, Point q) {
    if (turnOf(shared, end, q) != 0) return false;
    return (int64_t{end.x} - shared.x) * (int64_t{q.x} - shared.x) +
               (int64_t{end.z} - shared.z) * (int64_t{q.z} - shared.z) >
           0;
}

/// A bend: the node, both its edges, and where they lead.
struct Bend {
    uint32_t node = noIndex, edges[2]{noIndex, noIndex}, ends[2]{noIndex, noIndex};
    Vec2 ways[2];  ///< unit, away from the node
    RoadClass kind = RoadClass::Street;
};

class Rounder {
public:
    Rounder(RoadGraph& graph, const RoadParameters& parameters, const Land& land)
        : graph_(graph), parameters_(parameters), land_(land) {}

    void run() {
        const auto count = static_cast<uint32_t>(graph_.nodes().size());
        rooms_.resize(count, 0);
        for (uint32_t n = 0; n < count; ++n) rooms_[n] = roomAt(n);
        for (uint32_t n = 0; n < count; ++n)
            if (rooms_[n] > 0) round(n);
    }

private:
    double leastRadius(RoadClass kind) const {
        const double radius = kind == RoadClass::Highway ? parameters_.highwayRadius_m : parameters_.streetRadius_m;
        // Tighter ones would have no inner side.
        return radius > 0 ? std::max(radius, parameters_.width_m(kind) / 2 + 1) : 0;
    }

    /// How far an arc may reach along both pieces at a node; 0 where no curve may be.
    double roomAt(uint32_t n) const {
        if (graph_.degree(n) != 2) return 0;
        const RoadEdge &e = graph_.edge(graph_.nodes()[n].edges[0]), &f = graph_.edge(graph_.nodes()[n].edges[1]);
        if (e.kind != f.kind || e.bridge || f.bridge || e.tunnel || f.tunnel || e.own || f.own ||
            leastRadius(e.kind) <= 0)
            return 0;
        return share * std::min(lengthOf(graph_.along(graph_.nodes()[n].edges[0], n)),
                                lengthOf(graph_.along(graph_.nodes()[n].edges[1], n)));
    }

    void round(uint32_t n) {
        Bend bend;
        bend.node = n;
        for (int i = 0; i < 2; ++i) {
            bend.edges[i] = graph_.nodes()[n].edges[static_cast<size_t>(i)];
            bend.ends[i] = graph_.edge(bend.edges[i]).other(n);
            bend.ways[i] = unit(graph_.along(bend.edges[i], n));
        }
        if (bend.ends[0] == bend.ends[1]) return;
        bend.kind = graph_.edge(bend.edges[0]).kind;
        const double cosine = -dot(bend.ways[0], bend.ways[1]), sine = std::abs(cross(bend.ways[0], bend.ways[1]));
        if (cosine > straight || 1 + cosine < 1e-3) return;
        const double tangent = sine / (1 + cosine);  // of half the bend
        for (double t = rooms_[n]; t >= leastTangent_m && t / tangent >= leastRadius(bend.kind); t *= .7) {
            const std::vector<Point> line = lineOf(bend, t, t / tangent);
            if (!isLegal(line) || !isFree(bend, line)) continue;
            replace(bend, line);
            return;
        }
    }

    /// From one end to the other over the arc that touches both pieces `t` metres from the bend.
    std::vector<Point> lineOf(const Bend& bend, double t, double radius) const {
        const Vec2 at = graph_.metresAt(bend.node), first = at + bend.ways[0] * t, last = at + bend.ways[1] * t;
        const Vec2 inward = unit(bend.ways[0] + bend.ways[1]);
        const Vec2 centre = at + inward * std::sqrt(radius * radius + t * t);
        std::vector<Vec2> arms{unit(first - centre), unit(last - centre)};
        const auto halfCosine = [&] { return std::sqrt(std::max(0.0, (1 + dot(arms[0], arms[1])) / 2)); };
        while (radius * (1 - halfCosine()) > tolerance_m && arms.size() < 65) {
            std::vector<Vec2> finer{arms[0]};
            for (size_t i = 1; i < arms.size(); ++i)
                finer.push_back(unit(arms[i - 1] + arms[i])), finer.push_back(arms[i]);
            arms = std::move(finer);
        }
        std::vector<Point> line{graph_.at(bend.ends[0]), pointAt(first)};
        for (size_t i = 1; i + 1 < arms.size(); ++i) line.push_back(pointAt(centre + arms[i] * radius));
        line.push_back(pointAt(last));
        line.push_back(graph_.at(bend.ends[1]));
        return line;
    }

    bool isLegal(const std::vector<Point>& line) const {
        const auto isBad = [&](Vec2 p) {
            return p.x < parameters_.lo.x || p.x > parameters_.hi.x || p.z < parameters_.lo.z ||
                   p.z > parameters_.hi.z || (land_.park && land_.park(p)) || (land_.water && land_.water(p));
        };
        for (size_t i = 1; i + 1 < line.size(); ++i) {
            const Vec2 a = metres(line[i - 1]), d = metres(line[i]) - a;
            const int count = std::max(1, static_cast<int>(std::ceil(lengthOf(d) / curveSample_m)));
            for (int k = 1; k <= count && i > 1; ++k)
                if (isBad(a + d * (static_cast<double>(k) / count))) return false;
            if (land_.height &&
                std::abs(land_.height(a + d) - land_.height(a)) > parameters_.slope * lengthOf(d) * (1 + 1e-9) && i > 1)
                return false;
        }
        return true;
    }

    /// Whether the line meets nothing but what ends where it ends, itself included.
    bool isFree(const Bend& bend, const std::vector<Point>& line) const {
        for (size_t i = 1; i < line.size(); ++i) {
            if (line[i - 1] == line[i]) return false;
            for (size_t k = i + 1; k < line.size(); ++k) {
                if (k == i + 1 ? runsAlong(line[i], line[i - 1], line[k])
                               : segmentsMeet(line[i - 1], line[i], line[k - 1], line[k]))
                    return false;
            }
            for (const uint32_t index : graph_.edgesNear(line[i - 1], line[i], 0)) {
                if (index == bend.edges[0] || index == bend.edges[1]) continue;
                const RoadEdge& e = graph_.edge(index);
                const uint32_t own = i == 1 ? bend.ends[0] : i + 1 == line.size() ? bend.ends[1] : noIndex;
                if (own != noIndex && (e.a == own || e.b == own)) {
                    if (runsAlong(graph_.at(own), graph_.at(e.other(own)), i == 1 ? line[i] : line[i - 1]))
                        return false;
                } else if (segmentsMeet(line[i - 1], line[i], graph_.at(e.a), graph_.at(e.b))) {
                    return false;
                }
            }
        }
        return true;
    }

    void replace(const Bend& bend, const std::vector<Point>& line) {
        for (const uint32_t e : bend.edges) graph_.remove(e);
        ++curves_;
        uint32_t last = bend.ends[0];
        for (size_t i = 1; i < line.size(); ++i) {
            const bool isEnd = i + 1 == line.size();
            const uint32_t next = isEnd ? bend.ends[1] : graph_.addNode(line[i]);
            graph_.addEdge(last, next, bend.kind, false, false, i == 1 || isEnd ? 0 : curves_);
            last = next;
        }
    }

    RoadGraph& graph_;
    const RoadParameters& parameters_;
    const Land& land_;
    std::vector<double> rooms_;
    uint32_t curves_ = 0;
};

}  // namespace

void curveBends(RoadGraph& graph, const RoadParameters& parameters, const Land& land) {
    if (parameters.highwayRadius_m > 0 || parameters.streetRadius_m > 0) Rounder(graph, parameters, land).run();
}

}  // namespace sgm::town
