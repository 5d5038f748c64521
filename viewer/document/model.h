// From a checked grammar to a field that can be drawn or meshed, stage by stage with times: what the window and the
// commands share.
// Enters: a Grammar and what is chosen of it. Leaves: a Model. Assumes nothing; long stages report and can be
// cancelled.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grammar/derive/derive.h"
#include "grammar/lower/lower.h"
#include "modeler/core/stopwatch.h"
#include "modeler/eval/tape.h"

namespace sgm::viewer {

/// Seconds by stage, in order.
using Stages = std::vector<std::pair<std::string, double>>;

/// Runs `work` and appends its seconds to `stages` under `name`.
template <class Work>
auto timed(Stages& stages, const char* name, Work&& work) {
    const Stopwatch watch;
    auto result = work();
    stages.emplace_back(name, watch.seconds());
    return result;
}

/// Which model of a grammar, by names.
struct ModelChoice {
    std::string start, derive, style;   ///< "" for the first, the automatic one, none
    std::vector<std::string> settings;  ///< "NAME=VALUE"
    uint64_t seed = 1;
    uint64_t shapeBudget = derive::Budget{}.shapes;
    double secondsBudget = derive::Budget{}.seconds;
};

/// Resolves the names against the grammar; Error::Usage for unknown ones, Error::Input for bad values.
Result<derive::Options> optionsFor(const rules::Grammar& grammar, const ModelChoice& choice);

/// A field ready to draw or mesh.
struct Model {
    derive::Derivation derivation;
    std::unique_ptr<lower::Model> lowered;
    eval::Tape tape;
};
/// Stages "derive", "lower", "compile". Errors as of those doors.
Result<Model> makeModel(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Stages& stages,
                        Progress* progress);
/// The last two stages, for a derivation that was made otherwise.
Result<Model> makeModel(derive::Derivation derivation, Stages& stages, Progress* progress);

}  // namespace sgm::viewer
