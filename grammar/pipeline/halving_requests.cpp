#include "grammar/pipeline/halving_requests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grammar/pipeline/triangles_of_cells.h"

namespace sgm::pipeline {
namespace {

constexpr double costOfHalved = 4;    ///< what a triangle takes in halved cells beside others, by one of a whole mesh
constexpr double leftInHalves = 0.6;  ///< of what is to be halved oftener, for parts reach farther in larger cells

}  // namespace

mesh::CellSet cellsOf(std::span<const HalvingRequest> asked) {
    mesh::CellSet all;
    for (const HalvingRequest& one : asked)
        for (const Vec3i cell : one.cells) all.insert(cell);
    return all;
}

void leaveOutFiner(RequestsByHalvings& asked) {
    mesh::CellSet finer;
    for (size_t halvings = asked.size() - 1; halvings > 0; --halvings) {
        for (HalvingRequest& one : asked[halvings])
            std::erase_if(one.cells, [&](Vec3i cell) { return finer.contains(cell); });
        std::erase_if(asked[halvings], [](const HalvingRequest& one) { return one.cells.empty(); });
        if (halvings == 1) break;
        for (const HalvingRequest& one : asked[halvings])
            for (const Vec3i cell : one.cells) finer.insert(cell);
    }
}

std::vector<size_t> guessGrowth(std::span<const HalvingRequest> asked, const mesh::Mesh& mesh, const mesh::Grid& grid,
                                int halvings, size_t budget) {
    const mesh::CellSet all = cellsOf(asked);
    const size_t after = trianglesOfHalved(halvings);
    if (all.size() * after <= budget) return {};
    std::vector<size_t> growth(asked.size());
    const std::vector<uint32_t> counts = countTriangles(mesh, grid, all);
    size_t next = 0;  // of all cells, which come in the order of the requests
    for (size_t i = 0; i < asked.size(); ++i)
        for (const Vec3i cell : asked[i].cells) {
            if (next == all.size() || all.list()[next] != cell) continue;
            if (counts[next++] > 0) growth[i] += after;
        }
    // Where the mesh shows nothing of a part, its size tells how many there will be.
    for (size_t i = 0; i < asked.size(); ++i)
        growth[i] = std::max(growth[i], static_cast<size_t>(std::ldexp(asked[i].wholeTriangles, 2 * halvings)));
    return growth;
}

GrowthByHalvings growthBy(const RequestsByHalvings& asked, const mesh::Mesh& mesh, const mesh::Grid& grid) {
    GrowthByHalvings growth{};
    for (size_t halvings = 1; halvings < asked.size(); ++halvings) {
        if (asked[halvings].empty()) continue;
        const std::vector<uint32_t> counts = countTriangles(mesh, grid, cellsOf(asked[halvings]));
        const auto empty = static_cast<size_t>(std::count(counts.begin(), counts.end(), 0u));
        growth[halvings] = (counts.size() - empty) * trianglesOfHalved(static_cast<int>(halvings));
    }
    return growth;
}

GrowthByHalvings multiplied(GrowthByHalvings growth, int times, size_t triangles) {
    const auto all = static_cast<double>(triangles) / static_cast<double>(trianglesOfHalved(0));
    double cells = 0;
    for (int halvings = 1; halvings <= mostHalvingsOfCells; ++halvings)
        cells += static_cast<double>(growth[static_cast<size_t>(halvings)]) /
                 static_cast<double>(trianglesOfHalved(halvings));
    if (cells == 0) return growth;
    const double share = std::min(cells / all, 1.0), ofAll = 1 - std::pow(1 - share, times);
    for (size_t& g : growth) g = static_cast<size_t>(static_cast<double>(g) * ofAll / share);
    return growth;
}

int halvingsOfAll(const GrowthByHalvings& growth, size_t triangles, int most, size_t mostTriangles) {
    auto whole = static_cast<double>(triangles);
    double left = std::accumulate(growth.begin(), growth.end(), 0.0), least = costOfHalved * left, share = 1;
    int best = 0;
    for (int halvings = 1; halvings <= most; ++halvings) {
        whole *= 4, share *= leftInHalves;
        left = share * std::accumulate(growth.begin() + halvings + 1, growth.end(), 0.0);
        if (whole + left > static_cast<double>(mostTriangles)) break;
        if (const double cost = whole + costOfHalved * left; cost < least) least = cost, best = halvings;
    }
    return best;
}

}  // namespace sgm::pipeline
