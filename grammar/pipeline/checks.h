// A grammar's own tests: `check START { settings } expect EXPR`.
// Enters: a grammar. Leaves: a verdict for each check. Assumes nothing is meshed: figures are of shapes and their
// boxes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/pipeline/context.h"
#include "grammar/rules/grammar.h"

namespace sgm::pipeline {

/// One check's verdict, for `sgm check`.
struct Verdict {
    bool passed = false;
    std::string message;
    syntax::SourceSpan span;
};

/// Runs every `check` of the grammar with its settings over the defaults. Figures of objects that `place` puts are of
/// those at all places. Error::Budget where so many seconds are over when a check begins; its derivation has
/// what is left then, and so has that of each object whose figures it uses. Error::Cancelled.
Result<std::vector<Verdict>> runChecks(const std::shared_ptr<const rules::Grammar>& grammar, uint64_t seed,
                                       Context& context, double seconds = 60);

}  // namespace sgm::pipeline
