// Parts of a ground that its cells are too coarse for.
// Enters: the triangles of finest cells with their origins, as they are made. Leaves: warnings. Assumes that a part
// that is thicker than a cell is there.
#pragma once

#include <set>
#include <span>
#include <vector>

#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/scene.h"
#include "modeler/tiles/cell.h"

namespace sgm::pipeline {

/// Measures how much of a model's parts shows in the ground of finest cells, to warn of those of which less shows than
/// should.
class GroundParts {
public:
    /// The model has to outlive it. `side_m` is of the finest cells.
    GroundParts(const Model& model, double side_m) : model_(model), side_m_(side_m) {}

    /// The triangles of a cell, by number in the mesh.
    void add(const tiles::Cell& cell, const mesh::PackedMesh& mesh, std::span<const uint32_t> triangles);

    /// A warning for each line of the grammar of whose parts less than half shows from above in the cells that were
    /// added, where they are thinner than `pitch_m`, the edge of a cell of the grid; those with the largest first. A
    /// few parts of a line are looked at. O(parts of the model).
    std::vector<MeshWarning> warnings(double pitch_m) const;

private:
    double openArea(OriginId part) const;

    const Model& model_;
    const double side_m_;
    std::set<tiles::Cell> cells_;
    std::vector<double> shown_m2_;  ///< from above, by OriginId
};

}  // namespace sgm::pipeline
