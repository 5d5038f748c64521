// Rule bodies: siblings, chains, elements, attributes, cases.
// Enters: a Cursor at a body. Leaves: the Body. Assumes the caller says what may follow it.
#pragma once

#include "grammar/syntax/ast.h"
#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

Body readBody(Cursor& cursor);
/// Whether the word at the cursor is an operation's.
bool atAttribute(const Cursor& cursor);
/// Words of operations that later versions of the language will have: nothing may be called so.
bool isLaterOperation(std::string_view word);
Attribute readAttribute(Cursor& cursor);
/// Reads { name = value … }; fails where no brace opens.
std::vector<Setting> readSettings(Cursor& cursor);
/// The hint for a missing '=' before the token at the cursor, or "".
std::string missingEqualsHint(const Cursor& cursor, const Name& name);
/// "did you mean 'size'?" for the word of an operation or a declaration's part that is nearest to `word`, or "".
std::string nearestWord(const OperationTable& operations, std::string_view word);

}  // namespace sgm::syntax
