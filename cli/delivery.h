// What `sgm build` does with a model: mesh, edits, validation, figures, files.
// Enters: a request, a model. Leaves: files, and lines on stdout. Assumes a request that was checked.
#pragma once

#include "cli/outputs.h"
#include "cli/requests.h"
#include "cli/watch.h"
#include "grammar/pipeline/products.h"
#include "grammar/pipeline/scene.h"

namespace sgm::cli {

/// The options of `sgm build`.
struct BuildRequest {
    ModelRequest model;
    GridRequest grid;
    OutputRequest out;
    std::vector<std::string> animations;  ///< "NAME=FROM..TO:FRAMES"
    std::string report, agent, floor;     ///< agent as `parseAgent` reads it, "" for the usual one
    MeshEdits edits;
    bool validate = false, cave = false, flipNormals = false, stream = false, quiet = false, progress = false;
    bool seeksThinParts = true;  ///< even without a report: parts thinner than the mesh's cells are named
};

/// How a build shows its progress.
inline ProgressDisplay displayOf(const BuildRequest& request) {
    if (request.progress) return ProgressDisplay::Lines;
    return request.quiet ? ProgressDisplay::None : ProgressDisplay::Terminal;
}

/// Whether the report is printed, in place of the summary.
inline bool reportsToStdout(const BuildRequest& request) { return request.report == "-"; }

/// Whether the cave is surveyed.
inline bool surveys(const BuildRequest& request) { return request.cave || !request.floor.empty(); }
/// Whether the blocks are needed, from which a level set is sampled.
inline bool wantsLevelSet(const BuildRequest& request) { return wantsVolume(request.out) || surveys(request); }
/// Whether the mesh's normals and origins are unused: by the files, edits, the floor and the figures.
bool needsPositionsOnly(const BuildRequest& request);
/// Whether files of the solid tree are all that is wanted.
bool needsNoMesh(const BuildRequest& request);

/// Writes the solid tree where that is wanted: before meshing, for a model that isn't exactly one is refused.
Status writeMeshless(const BuildRequest& request, const Model& model, Context& context);
/// Whether all that is asked for holds objects that `place` puts apart from the model, each meshed once; what wants one
/// field or one mesh has them grafted.
bool keepsObjectsApart(const BuildRequest& request);
/// From a mesh, and the scene of objects beside it, to what was asked for.
Status deliver(const BuildRequest& request, const Model& model, pipeline::Division division, MeshedModel meshed,
               const pipeline::MadeScene& made, Context& context);
/// Meshes and writes layer by layer.
Status stream(const BuildRequest& request, const Model& model, Context& context);
/// Prints which files were written, unless the request is quiet.
void printFiles(const BuildRequest& request);

}  // namespace sgm::cli
