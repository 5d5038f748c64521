// Expressions, by precedence climbing.
// Enters: a Cursor at an expression. Leaves: the Expr; an Error node where none could be read (the cursor then has
// failed).
#pragma once

#include "grammar/syntax/ast.h"
#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

/// A whole expression, operators and all.
Expr readExpr(Cursor& cursor);
/// What an attribute takes: a literal, a name, a call, a range or a ramp of them, or anything in parentheses.
Expr readArgument(Cursor& cursor);
/// A name or a call: what stands where a solid or a symbol is meant.
Expr readSolid(Cursor& cursor);
/// Whether an argument begins at the cursor. A word that begins something else there is no argument.
bool startsArgument(const Cursor& cursor);
/// A word that names something; `what` ("a rule", "a parameter") is for the message. Words of the language are refused.
Name readName(Cursor& cursor, std::string_view what);
/// `distinct` or `shuffled`: how a `choose` draws along a repetition.
bool isSeries(std::string_view word);
/// A word of the language, which can name nothing.
bool isReserved(std::string_view word);

}  // namespace sgm::syntax
