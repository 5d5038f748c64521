// What users ask for of a model, a grid and edits of the mesh: the options that commands share, and the stages of
// grammar/pipeline called as they say.
// Enters: a command line. Leaves: each stage's product. Assumes stages are called in order.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/targets.h"
#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/scene.h"

namespace CLI {
class App;
}

namespace sgm::cli {

using pipeline::Context;
using pipeline::FloatCause;
using pipeline::Floating;
using pipeline::makeMesh;
using pipeline::makeModel;
using pipeline::MeshEdits;
using pipeline::MeshedModel;
using pipeline::Model;
using pipeline::optionsFor;
using pipeline::Stages;
using pipeline::Support;

/// Which model of which file: the options that every command about a model takes.
struct ModelRequest : pipeline::ModelChoice {
    std::string file;
    std::string section;          ///< as pipeline::parseSection reads it; "" for the whole model
    std::vector<Target> targets;  ///< what will be written, which may replace no file that is read
    bool quiet = false;           ///< warnings of the text and of the section aren't printed
};
/// Adds --start, --derive, --set, --style, --seed and the budgets.
void addChoiceOptions(CLI::App& command, pipeline::ModelChoice& choice);
/// Adds FILE and the options that choose a model of it, as addChoiceOptions does.
void addModelOptions(CLI::App& command, ModelRequest& request);

/// Adds --section.
void addSectionOption(CLI::App& command, ModelRequest& request);

/// How fine and how: --resolution or --cell, --surface, --halvings and --threads.
struct GridRequest {
    int resolution = 128;
    double cell_m = 0;        ///< > 0 wins over resolution
    double objectCell_m = 0;  ///< of objects that `place` puts; 0: as the others say
    mesh::Surface surface = mesh::Surface::Crisp;
    int halvings = 3;  ///< at most, of crisp cells around parts that are too thin for them
    int threads = 0;
};
void addGridOptions(CLI::App& command, GridRequest& request);
/// Adds --object-cell.
void addObjectOptions(CLI::App& command, GridRequest& request);

/// Adds --keep, --smooth, --simplify and --tolerance.
void addEditOptions(CLI::App& command, MeshEdits& edits);

/// Parse and check, stages "parse" and "check". Prints diagnostics to stderr; Error::Reported when there were errors.
/// Error::Usage where a target of the request is a file that was read; all of these are added to `read` unless it is
/// null.
Result<std::shared_ptr<const rules::Grammar>> loadGrammar(const ModelRequest& request, Context& context,
                                                          std::vector<std::filesystem::path>* read = nullptr);

/// Error::Input where the file has another text by now than the grammar was read from: nothing may be saved into it.
Status checkUnchanged(const std::string& file, const rules::Grammar& grammar);

/// A model from the file on.
Result<Model> makeModel(const ModelRequest& request, Context& context,
                        pipeline::Objects objects = pipeline::Objects::Grafted);

/// How finely the objects of a model are meshed, and their budget.
pipeline::SceneRequest sceneRequestOf(const ModelRequest& request, const GridRequest& grid);
/// The objects of a model that was made without them. Error::Usage where `objectCell_m` is said and there are none.
Result<pipeline::MadeScene> makeScene(const Model& model, const ModelRequest& request, const GridRequest& grid,
                                      const MeshEdits& edits, bool quiet, Context& context);

/// Prints derive::warnings, what every command about a model tells.
void printWarnings(const Model& model);

/// Prints what pipeline::meshWarnings and its parts say, a line each.
void printMeshWarnings(const std::vector<pipeline::MeshWarning>& warnings);

/// Drops debris and floating components as `keep` says, and prints what was dropped unless `quiet`.
void keepOnly(mesh::Keep keep, MeshedModel& meshed, int threads, bool quiet);

/// How the mesher is to work; `positionsOnly` as in PolygonizeOptions.
mesh::PolygonizeOptions meshingOf(const GridRequest& request, bool positionsOnly = false);
/// The grid that is asked for over these bounds.
mesh::Grid gridOver(const Box3f& bounds, const GridRequest& request);
/// The grid that is asked for over a model, moved off its planes for a crisp surface (pipeline::moveOffPlanes).
mesh::Grid gridOver(const Model& model, const GridRequest& request);
/// The mesh of the model over its own bounds, `positionsOnly` or with normals and origins.
Result<MeshedModel> makeMesh(const Model& model, const GridRequest& request, Context& context,
                             bool positionsOnly = false);

/// The error with the options that say how fine a mesh is.
Error withOptions(Error error);

/// Prints "sgm: …" to stderr unless the error was reported already, and gives the exit code: 1 input, 2 usage, 3
/// budget, 130 cancelled.
int fail(const Error& error);

}  // namespace sgm::cli
