// The models that `sgm check` makes of a grammar: what `sgm build` would refuse is told without building.
// Enters: a checked grammar. Leaves: diagnostics in its text. Assumes the grammar is kept while they are read.
#pragma once

#include <memory>

#include "cli/requests.h"
#include "grammar/derive/derive.h"
#include "grammar/pipeline/floating.h"
#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::cli {

struct TrialOptions {
    pipeline::ModelChoice model{};  ///< the main model, as `sgm build` makes it; others differ in one thing
    double otherSeconds = 5;        ///< for all others together; those that are left then aren't tried
    GridRequest grid{};             ///< of the mesh of the main model
};

/// How the trials went.
struct Trials {
    size_t tried = 0, all = 0;                   ///< settings
    bool budgetSpent = false;                    ///< the main model's error was one of a budget
    std::vector<pipeline::MeshWarning> ofCells;  ///< of the main model where its cells lack parts
};

/// Derives and lowers the main model, whose problems are those of `sgm build`: errors are errors. Then every other
/// start, every style and `derive` way, and every parameter of the main file at the ends of its range or at each
/// choice, one at a time: what fails there is a warning that names the setting; so is, at a choice, a style or a way,
/// what floats by its boxes where nothing of the start as it is does. What floats in the mesh of the main model is a
/// warning too, unless these cells lack parts: then all that is told of the mesh is returned. Error::Usage and
/// Error::Input as of pipeline::optionsFor, Error::Cancelled.
Result<Trials> tryModels(std::shared_ptr<const rules::Grammar> grammar, const TrialOptions& options, Progress* progress,
                         syntax::Diagnostics& diagnostics);

}  // namespace sgm::cli
