// The arguments of an operation.
// Enters: a cursor behind the operation's word. Leaves: expressions, one per argument that is given. For this folder's
// sources alone.
#pragma once

#include "grammar/syntax/ast.h"
#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

/// Reads the arguments that `row` declares into `attribute`, with a diagnostic where one is missing.
void readArguments(Cursor& cursor, const Operation& row, Attribute& attribute);
/// Fails where a calculation without parentheses goes on behind the argument of `word`.
void refuseCalculation(Cursor& cursor, std::string_view word);

}  // namespace sgm::syntax
