// Rectangles side by side in a square.
// Enters: sizes. Leaves: places. Assumes positive sizes.
#pragma once

#include <vector>

namespace sgm::exporter {

struct Rectangle {
    int width, height;
    int x, y;  ///< of its lower left corner
};

/// Puts all of them into a square by its skyline, without turning any (Jylänki, "A Thousand Ways to Pack the Bin",
/// 2010; stb_rect_pack). False where they don't fit; then the places mean nothing.
bool packRectangles(std::vector<Rectangle>& rectangles, int side);

}  // namespace sgm::exporter
