// Which short segments meet a mesh.
// Enters: a mesh and segments in metres. Leaves: a verdict a segment. Assumes segments of about one length.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// By segment: 1 where it meets a triangle of the mesh; one that passes within a thousandth of a triangle's size of an
/// edge does. O(triangles + segments) where the triangles are about as large as the segments. Means nothing once
/// cancelled.
std::vector<uint8_t> segmentsThatMeet(const mesh::Mesh& mesh, std::span<const std::array<Vec3f, 2>> segments,
                                      const Progress* progress);

}  // namespace sgm::lower
