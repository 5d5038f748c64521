// The formatter behind `sgm fmt`.
// Enters: source text that parses. Leaves: the same tokens and comments in canonical layout; formatting twice changes nothing.
#pragma once

#include "grammar/syntax/ast.h"

namespace sgm::syntax {

/// The canonical layout of `source`. Every token and comment is kept, in order.
std::string format(const Source& source);

/// "+", "-", "&", "morph", and "" for none.
std::string_view sign(Operator op);

}  // namespace sgm::syntax
