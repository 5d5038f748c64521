// Text to syntax tree, by recursive descent. The grammar of the language stands below, whole.
// Enters: a Source. Leaves: an Ast of everything that could be read, and diagnostics for the rest. Never throws; recovery
// restarts at a keyword in column one, so one run shows all problems and a slip is reported once.
#pragma once

#include "grammar/syntax/ast.h"

namespace sgm::syntax {

Ast parse(SourcePtr source, Diagnostics& diagnostics);

}  // namespace sgm::syntax
