// The walk from a file to a mesh, one stage a function, with its times: what `build`, `render`, `tree` share.
// Enters: what the user asked for. Leaves: each stage's product. Assumes stages are called in order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/targets.h"
#include "viewer/document/meshing.h"

namespace CLI {
class App;
}

namespace sgm::cli {

using viewer::makeMesh;
using viewer::makeModel;
using viewer::MeshedModel;
using viewer::Model;
using viewer::optionsFor;
using viewer::Stages;
using viewer::timed;

/// Which model of which file: the options that every command about a model takes.
struct ModelRequest : viewer::ModelChoice {
    std::string file;
    std::vector<Target> targets;  ///< what will be written, which may replace no file that is read
};
/// Adds FILE, --start, --derive, --set, --style, --seed and the budgets.
void addModelOptions(CLI::App& command, ModelRequest& request);

/// How fine and how: --resolution or --cell, --surface and --threads.
struct GridRequest {
    int resolution = 128;
    double cell_m = 0;  ///< > 0 wins over resolution
    mesh::Surface surface = mesh::Surface::Crisp;
    int threads = 0;
};
void addGridOptions(CLI::App& command, GridRequest& request);

/// Parse and check. Prints diagnostics to stderr; when there were errors, the error is empty, as they are told already.
/// Error::Usage where a target of the request is a file that was read; all of these are added to `read` unless it is
/// null.
Result<std::shared_ptr<const rules::Grammar>> loadGrammar(const ModelRequest& request, Stages& stages,
                                                          const Progress* progress = nullptr,
                                                          std::vector<std::filesystem::path>* read = nullptr);

/// A model from the file on.
Result<Model> makeModel(const ModelRequest& request, Stages& stages, Progress* progress);

/// Prints derive::warnings, what every command about a model tells.
void printWarnings(const Model& model);

/// How the mesher is to work; `bare` as in PolygonizeOptions.
mesh::PolygonizeOptions meshingOf(const GridRequest& request, bool bare = false);
/// The grid that is asked for over these bounds.
mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request);
/// The mesh of the model over its own bounds, `bare` or with normals and origins.
Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Stages& stages, Progress* progress,
                             bool bare = false);

/// Prints "sgm: …" to stderr and gives the exit code: 1 input, 2 usage, 3 budget, 130 cancelled.
int fail(const Error& error);

}  // namespace sgm::cli
