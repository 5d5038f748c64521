// The walk from a file to a mesh, one stage a function, with its times: what `build`, `render`, `tree` share.
// Enters: what the user asked for. Leaves: each stage's product. Assumes stages are called in order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/rebuild.h"
#include "viewer/document/model.h"

namespace CLI {
class App;
}

namespace sgm::cli {

using viewer::makeModel;
using viewer::Model;
using viewer::optionsFor;
using viewer::Stages;
using viewer::timed;

/// Which model of which file: the options that every command about a model takes.
struct ModelRequest : viewer::ModelChoice {
    std::string file;
};
/// Adds FILE, --start, --derive, --set, --style, --seed and the budgets.
void addModelOptions(CLI::App& command, ModelRequest& request);

/// How fine: --resolution or --cell, and --threads.
struct GridRequest {
    int resolution = 128;
    double cell_m = 0;  ///< > 0 wins over resolution
    int threads = 0;
};
void addGridOptions(CLI::App& command, GridRequest& request);

/// Parse and check. Prints diagnostics to stderr; null when there were errors.
std::shared_ptr<const rules::Grammar> loadGrammar(const std::string& file, Stages& stages);

/// A model from the file on.
Result<Model> makeModel(const ModelRequest& request, Stages& stages, Progress* progress);

/// A mesh with the grid and blocks it came from.
struct MeshedModel {
    mesh::Grid grid;
    std::vector<mesh::Block> blocks;
    mesh::Mesh mesh;
    mesh::Counts counts;
};
Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, int threads, Stages& stages, Progress* progress);
/// The same, taking what didn't change from the last mesh of `rebuild`; without blocks, which only volumes want.
Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::Rebuild& rebuild, Stages& stages, Progress* progress);
/// The grid that is asked for over these bounds.
mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request);
/// The same over the model's own bounds.
Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Stages& stages, Progress* progress);

/// Prints "sgm: …" to stderr and gives the exit code: 1 input, 2 usage, 3 budget, 130 cancelled.
int fail(const Error& error);

}  // namespace sgm::cli
