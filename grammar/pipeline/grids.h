// Grids for the surfaces of models.
// Enters: a model and how fine its mesh is asked for. Leaves: a grid. Assumes finite bounds.
#pragma once

#include "grammar/pipeline/model.h"
#include "modeler/mesh/rebuild.h"

namespace sgm::pipeline {

/// How fine a mesh is.
struct CellSize {
    int resolution = 128;  ///< cells along the longest side of the bounds
    double cell_m = 0;     ///< metres; > 0 goes before `resolution`
};

constexpr int mostResolution = 8192;  ///< cells that the options --resolution and the Python module take

/// The option for cells of at most so many metres: "--resolution 160", or "--cell 0.0012" where that is more
/// than `mostResolution`.
std::string optionForCells(const Box3f& bounds, double cell_m);

/// The largest number of two significant digits that is no larger than `value`, which is > 0.
double withTwoDigits(double value);

/// The grid over bounds.
mesh::Grid gridOver(const Box3f& bounds, const CellSize& size);
/// The grid over the model's bounds. For crisp surfaces it is moved off the model's planes.
mesh::Grid gridOver(const Model& model, const CellSize& size, mesh::Surface surface);
/// The same for a crisp surface with so many cells along the longest side of the bounds.
mesh::Grid gridOf(const Model& model, int cells);

/// The grid to go on with while a model changes: the previous one while it fits (mesh::gridToKeep), else one for the
/// model as it is now.
mesh::Grid gridToKeep(const mesh::Grid& previous, const Box3f& bounds, float cell_m,
                      const derive::Derivation& derivation, mesh::Surface surface);

/// The grid moved by at most a fifth of a cell along each axis, so that as few as possible of the model's creases run
/// within a fiftieth of a cell of its samples, where they have no room in the faces of cells, and as few gaps as
/// possible between neighbouring planes pass between its samples. Planes are those of boxes and footprints that lie
/// along the axes. For grids of mesh::gridFor, which leave that room. O(shapes log shapes).
mesh::Grid moveOffPlanes(mesh::Grid grid, const derive::Derivation& derivation);

}  // namespace sgm::pipeline
