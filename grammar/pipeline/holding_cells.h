// The cells of a whole mesh that hold thin parts once they are halved.
// Enters: what a mesh lacks. Leaves: sizes of cells. Assumes nothing of the mesh.
#pragma once

#include <vector>

#include "grammar/lower/thin_parts.h"

namespace sgm::pipeline {

/// Tells which smaller cells of a mesh hold what larger ones lack.
class HoldingCells {
public:
    /// `cell_m` is that of the mesh; `missing`, as holdThinParts gives it, has to stay.
    HoldingCells(float cell_m, const std::vector<lower::ThinPart>& missing);

    /// The largest cells smaller than the mesh's that come to be as small as `least_m` when they are halved, up to
    /// `halvings` times and without more triangles than a mesh may have, by a guess. O(missing).
    double before(double least_m, int halvings) const;

private:
    double trianglesAt(double cell_m) const;

    double cell_m_;
    const std::vector<lower::ThinPart>& missing_;
    double mostTriangles_ = 0;  ///< of halved cells
};

}  // namespace sgm::pipeline
