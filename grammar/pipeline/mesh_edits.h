// What is done to a mesh after it was made, so that a picture of a mesh is the mesh that is written.
// Enters: a mesh as it comes from makeMesh. Leaves: the edited one.
#pragma once

#include <optional>

#include "grammar/pipeline/context.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/simplify.h"

namespace sgm::pipeline {

struct MeshEdits {
    mesh::Keep keep = mesh::Keep::All;         ///< which connected components stay
    int smooth = 0;                            ///< passes of Laplacian smoothing
    double simplify = 1;                       ///< share of the triangles it would have otherwise that stay
    std::optional<double> tolerance_m = {};    ///< none: see toleranceOf
    mesh::SimplifiedPieces* pieces = nullptr;  ///< of the frame before, in an animation
    size_t* otherwise = nullptr;               ///< set to the triangles that `simplify` is a share of

    bool isAsked() const { return smooth > 0 || simplify < 1 || tolerance_m || keep != mesh::Keep::All; }
};

/// How far simplification may move the surface before `simplify` takes a share of its triangles, metres: of a crisp
/// mesh a hundredth of a cell, unless the edits say otherwise or smooth it; 0 keeps all triangles. Nothing unless the
/// edits say so in a build without CGAL.
double toleranceOf(const MeshEdits& edits, mesh::Surface surface, float cell_m);

/// What a mesh was made of.
struct MeshSource {
    const eval::Tape& field;
    mesh::Surface surface;
    float cell_m;
};

/// Completes the tips of a crisp mesh, smooths and simplifies: stages "tips", "smooth" and "simplify"; components were
/// dropped before (mesh::keepOnly).
Result<mesh::Mesh> edited(mesh::Mesh mesh, const MeshEdits& edits, const MeshSource& source, Context& context);

}  // namespace sgm::pipeline
