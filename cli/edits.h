// What is done to a mesh after it was made: the options that `build` and `render` share, so that a picture of a mesh is
// the mesh that is written. Enters: a mesh as it comes from makeMesh. Leaves: the edited one.
#pragma once

#include <optional>
#include <string>

#include "cli/pipeline.h"
#include "modeler/mesh/pieces.h"

namespace sgm::cli {

struct EditRequest {
    int smooth = 0;                     ///< passes
    double simplify = 1;                ///< share of the triangles that stay
    std::optional<double> tolerance_m;  ///< none: see toleranceOf
    std::string keep = "all";

    bool isAsked() const { return smooth > 0 || simplify < 1 || tolerance_m || keep != "all"; }
};
/// Adds --keep, --smooth, --simplify and --tolerance.
void addEditOptions(CLI::App& command, EditRequest& request);

mesh::Keep keepOf(const EditRequest& request);

/// How far simplification may move the surface, metres: of a crisp mesh a hundredth of a cell, unless the user says
/// otherwise or smooths it.
double toleranceOf(const EditRequest& request, mesh::Surface surface, float cell_m);

/// Smooths and simplifies; separate solids were dropped before (keepOnly).
Result<mesh::Mesh> edited(mesh::Mesh mesh, const EditRequest& request, const GridRequest& grid, float cell_m,
                          Stages& stages, Progress* progress);

}  // namespace sgm::cli
