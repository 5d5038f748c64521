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
#include "grammar/pipeline/context.h"
#include "modeler/eval/tape.h"

namespace sgm::pipeline {

/// Which model of a grammar, by names.
struct ModelChoice {
    std::string start, derive, style;   ///< "" for the first, the automatic one, none
    std::vector<std::string> settings;  ///< "NAME=VALUE"
    uint64_t seed = 1;
    uint64_t shapeBudget = derive::Budget{}.shapes;
    double secondsBudget = derive::Budget{}.seconds;
};

/// A value that is another than the grammar's own: what an edit of the text changes while a slider is dragged.
struct ValueChange {
    uint32_t param = rules::none;             ///< index in Grammar::params; none where nothing changes
    const rules::Setting* setting = nullptr;  ///< the style's setting that has it; null for the parameter's default
    rules::Value value = {};
};

/// Resolves the names against the grammar; Error::Usage for unknown ones, Error::Input for bad values. With `change`
/// the values are those of the grammar that has this value.
Result<derive::Options> optionsFor(const rules::Grammar& grammar, const ModelChoice& choice,
                                   const ValueChange& change = {});

/// What becomes of the objects that `place` puts.
enum class Objects {
    Grafted,   ///< they are part of the field, a copy at every place
    Sketched,  ///< the same, or a box at every place where the copies would spend the budget of shapes
    Apart      ///< the field is without them: makeScene makes each once
};

/// A field ready to draw or mesh.
struct Model {
    derive::Derivation derivation;
    std::shared_ptr<const lower::Model> lowered;
    eval::Tape tape;
    bool keepsAxes = false;  ///< it is meshed along its own axes whatever its walls face, as what a section cuts open
};
/// Stages "derive", "objects" where there are some to graft, "lower", "compile". Errors as of those stages.
Result<Model> makeModel(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Context& context,
                        Objects objects = Objects::Grafted);
/// A copy without the field's graph, which nobody needs once there is a tape but who changes the field; of a large
/// model it takes as much memory as its shapes.
std::shared_ptr<const lower::Model> withoutGraph(const lower::Model& model);
/// What is to be said of a model whose objects are sketched; "" where none are.
std::string sketchNote(const derive::Derivation& derivation);
/// The same from a derivation on, within a budget for what is grafted. `joinsBoxes`: see lower::lower.
Result<Model> makeModel(derive::Derivation derivation, Context& context, Objects objects = Objects::Grafted,
                        const derive::Budget& budget = {}, bool joinsBoxes = false);

}  // namespace sgm::pipeline
