// Level ground has two triangles a square of the grid; squares of squares need a few.
// Enters: triangles whose vertices lie on a grid where the ground is level. Leaves: the same surface with the same
// border in fewer triangles, so that a simplification, whose time grows with them, has less to do.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::tiles {

/// Replaces the triangles of level squares of the grid, 16, 8 or 4 a side, by a fan about their middle that keeps all
/// vertices on the square's sides. Squares are aligned with `origin`, so they are the same wherever the list begins.
/// @param corners  three vertices a triangle, anticlockwise from outside
/// @param positions  metres, y up
/// @param origin  a corner of the grid, metres; its height has no say
/// @param pitch_m  side of a square of the grid
/// @return three vertices a triangle, of those in `corners`; triangles that were kept come first, in their order.
/// Time is linear in the number of triangles.
std::vector<uint32_t> mergedSquares(std::span<const uint32_t> corners, std::span<const Vec3f> positions, Vec3d origin,
                                    double pitch_m);

}  // namespace sgm::tiles
