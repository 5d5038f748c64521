// Which shapes take something away.
// Enters: a shape tree. Leaves: a verdict a shape. Assumes that parents come before their children.
#pragma once

#include <vector>

#include "grammar/derive/shapes.h"

namespace sgm::lower {

/// By shape: whether it takes something away from what stands: it, or one that holds it, is a difference; what is cut
/// from a cut stands. O(shapes).
inline std::vector<bool> cutters(const derive::Shapes& shapes) {
    std::vector<bool> cuts(shapes.size());
    for (derive::ShapeId s = 0; s < shapes.size(); ++s) {
        const bool around = shapes[s].parent != derive::none && cuts[shapes[s].parent];
        cuts[s] = around != (shapes[s].op == rules::Operator::Difference);
    }
    return cuts;
}

}  // namespace sgm::lower
