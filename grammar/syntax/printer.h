// The formatter behind `sgm fmt`.
// Enters: source text that parses. Leaves: the same tokens and comments in canonical layout; formatting twice changes
// nothing.
#pragma once

#include "grammar/syntax/ast.h"

namespace sgm::syntax {

/// The canonical layout of `source`, read with `operations`. Every token and comment is kept, in order; a text with
/// errors stays as it is.
std::string format(const Source& source, const OperationTable& operations);

/// "+", "-", "&", "morph", and "" for none.
std::string_view sign(Operator op);

}  // namespace sgm::syntax
