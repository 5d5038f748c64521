// From `grammar 1` to `grammar 2`.
// Enters: the tree of a text of version 1. Leaves: the text as version 2, which means the same, and notes of what
// differs. Assumes a text without errors.
#pragma once

#include <string>
#include <vector>

#include "grammar/syntax/ast.h"

namespace sgm::rules {

struct Upgrade {
    std::string text;
    std::vector<syntax::Diagnostic> notes;  ///< warnings, each at the place that was rewritten or means something else
};

/// The text of `ast` as `grammar 2`; unchanged where it is no `grammar 1`. Rewritten are bodies whose first shape has a
/// size, a move or a turn that later shapes were measured by, and shares in a `size` behind a `turn`.
Upgrade upgraded(const syntax::Ast& ast);

}  // namespace sgm::rules
