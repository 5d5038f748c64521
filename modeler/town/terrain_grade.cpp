// Heights of a road graph's nodes under a limit of slope.
#include <algorithm>
#include <cmath>

#include "modeler/town/terrain.h"

namespace sgm::town {
namespace {

constexpr double clearance_m = 3;  // of a bridge above the water
constexpr int mostTurns = 400;

}  // namespace

/// Roads that are too steep push their ends towards each other, half way each, in turn until none is; an end of a
/// bridge gives way upward alone. Each turn brings all heights nearer to every set of heights that holds the limit
/// (projection onto convex sets: Bregman, 1967), so that they converge where there is one.
void Terrain::solve(const RoadGraph& graph) {
    const size_t count = graph.nodes().size();
    nodeHeights_.assign(count, 0);
    std::vector<double> least(count, -1e9);
    for (uint32_t n = 0; n < count; ++n) nodeHeights_[n] = naturalAt(graph.metresAt(n));
    for (const RoadEdge& e : graph.edges()) {
        if (e.removed || !e.bridge) continue;
        const Vec2 a = graph.metresAt(e.a), d = graph.metresAt(e.b) - a;
        const int steps = std::max(1, static_cast<int>(lengthOf(d) / lattice_.cell_m));
        double surface = -1e9;
        for (int i = 0; i <= steps; ++i) {
            const Vec2 p = a + d * (static_cast<double>(i) / steps);
            const int x =
                std::clamp(static_cast<int>((p.x - lattice_.low.x) / lattice_.cell_m + .5), 0, lattice_.columns - 1);
            const int z =
                std::clamp(static_cast<int>((p.z - lattice_.low.z) / lattice_.cell_m + .5), 0, lattice_.rows - 1);
            if (const double w = water_[lattice_.indexOf(x, z)]; w > surface) surface = w;
        }
        for (const uint32_t end : {e.a, e.b}) {
            least[end] = std::max(least[end], surface + clearance_m);
            nodeHeights_[end] = std::max(nodeHeights_[end], least[end]);
        }
    }
    const auto lengthOfEdge = [&](const RoadEdge& e) { return lengthOf(graph.metresAt(e.b) - graph.metresAt(e.a)); };
    bool steep = true;
    for (int turn = 0; steep && turn < mostTurns; ++turn) {
        steep = false;
        for (const RoadEdge& e : graph.edges()) {
            if (e.removed) continue;
            const bool up = nodeHeights_[e.b] >= nodeHeights_[e.a];
            double &low = nodeHeights_[up ? e.a : e.b], &high = nodeHeights_[up ? e.b : e.a];
            const double over = high - low - parameters_.slope * lengthOfEdge(e);
            if (over <= 1e-3) continue;
            steep = true;
            const double down = std::min(over / 2, std::max(0.0, high - least[up ? e.b : e.a]));
            high -= down, low += over - down;
        }
    }
    steepest_ = {};
    for (const RoadEdge& e : graph.edges()) {
        if (e.removed) continue;
        const double slope = std::abs(nodeHeights_[e.b] - nodeHeights_[e.a]) / lengthOfEdge(e);
        if (slope > steepest_.slope) steepest_ = {slope, (graph.metresAt(e.a) + graph.metresAt(e.b)) * .5};
    }
}

}  // namespace sgm::town
