// CGAL's exact arrangement of segments and union of polygons, as a judge.
// Enters: segments with whole coordinates, or outlines. Leaves: how many vertices, edges and faces they make; how much
// they share. Assumes nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgm::town::test {

struct ArrangementCounts {
    size_t vertices = 0, edges = 0, boundedFaces = 0;
};

/// Of segments (x, z, x, z), wherever they cross. O((n + k) log n).
ArrangementCounts arrangementOf(const std::vector<std::array<int32_t, 4>>& segments);

/// Square metres that belong to more than one of the polygons, exactly; each is a simple outline of (x, z).
double overlapOf(const std::vector<std::vector<std::array<double, 2>>>& outlines);

}  // namespace sgm::town::test
