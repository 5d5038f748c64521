// L-systems: settings, axiom and productions, whose texts are letters with calculations.
// Enters: a cursor at the word `lsystem`. Leaves: an LsystemDecl. For this folder's sources alone.
#pragma once

#include "grammar/syntax/ast.h"
#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

/// Takes a text in quotes, or fails.
Expr readText(Cursor& cursor, std::string_view what);
/// Takes '->', also where another arrow was written.
void expectArrow(Cursor& cursor, std::string_view where);
/// lsystem NAME settings axiom "…" productions
void readLsystem(Cursor& cursor, Ast& ast);

}  // namespace sgm::syntax
