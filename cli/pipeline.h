// The walk from a file to a mesh, one stage a function, with its times: what `build`, `render`, `tree` share.
// Enters: what the user asked for. Leaves: each stage's product. Assumes stages are called in order.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grammar/derive/derive.h"
#include "grammar/lower/lower.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/rebuild.h"

namespace CLI {
class App;
}

namespace sgm::cli {

/// Which model: the options that every command about a model takes.
struct ModelRequest {
    std::string file, start, derive, style;
    std::vector<std::string> settings;  ///< "NAME=VALUE"
    uint64_t seed = 1;
    uint64_t shapeBudget = derive::Budget{}.shapes;
    double secondsBudget = derive::Budget{}.seconds;
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

/// Seconds by stage, in order.
using Stages = std::vector<std::pair<std::string, double>>;

/// Runs `work` and appends its seconds to `stages` under `name`.
template <class Work>
auto timed(Stages& stages, const char* name, Work&& work);
double secondsNow();

/// Parse and check. Prints diagnostics to stderr; null when there were errors.
std::shared_ptr<const rules::Grammar> loadGrammar(const std::string& file, Stages& stages);

/// Resolves --start, --style and --set against the grammar; Error::Usage for unknown names, Error::Input for bad values.
Result<derive::Options> optionsFor(const rules::Grammar& grammar, const ModelRequest& request);

/// A field ready to draw or mesh.
struct Model {
    derive::Derivation derivation;
    std::unique_ptr<lower::Model> lowered;
    eval::Tape tape;
};
Result<Model> makeModel(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Stages& stages, Progress* progress);
/// The same from the file on.
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

template <class Work>
auto timed(Stages& stages, const char* name, Work&& work) {
    const double start = secondsNow();
    auto result = work();
    stages.emplace_back(name, secondsNow() - start);
    return result;
}

}  // namespace sgm::cli
