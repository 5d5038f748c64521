// CGAL's exact arrangement of segments, as a judge.
// Enters: segments with whole coordinates. Leaves: how many vertices, edges and faces they make. Assumes nothing.
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

}  // namespace sgm::town::test
