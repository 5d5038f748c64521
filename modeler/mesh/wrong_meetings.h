// Triangles of a surface that changed and meet others where they shouldn't.
// Enters: a surface and which of its triangles changed. Leaves: pairs. Assumes that the others don't meet wrongly.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Pairs of triangles that meet wrongly (meetWrongly), the second one of `changed`, which has to ascend, the first any
/// other; of two that changed, the second is the later one. On `threads` threads (0: all), in no order. O(n) for n
/// triangles where few are near those that changed.
std::vector<std::array<uint32_t, 2>> findWrongMeetings(std::span<const Vec3f> positions,
                                                       std::span<const Triangle> triangles,
                                                       std::span<const uint32_t> changed, int threads,
                                                       const Progress* progress);

}  // namespace sgm::mesh
