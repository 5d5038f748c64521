// What is wrong with a closed surface: crossings, edges that are there twice and vertices where fans meet.
// Enters: triangles. Leaves: those at fault. Assumes that each region's own triangles wind one way.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/mesh/compose.h"

namespace sgm::mesh {

/// The triangles that meet another one elsewhere than in common vertices and edges, or whose edge another triangle runs
/// along the same way, or which stand around a vertex together with another fan; ascending. Exact on the coordinates
/// given. Triangles are compared by a hierarchy of boxes;
/// nothing is compared within a small part of it whose normals are all in one half-space, for there a closed surface
/// hardly crosses itself without crossing another part too (after Volino and Magnenat-Thalmann, "Efficient self-collision
/// detection on smoothly discretized surface animations", 1994). O(n log n) as a rule; `threads` 0: all.
std::vector<uint32_t> findFaults(std::span<const Vec3f> positions, std::span<const SimpleTriangle> triangles,
                                 int threads, const Progress* progress);

}  // namespace sgm::mesh
