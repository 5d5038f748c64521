// Declarations: what a file consists of.
// Enters: a Cursor at a declaration's word. Leaves: its node in the Ast, kept as far as its name was read.
#pragma once

#include "grammar/syntax/ast.h"
#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

/// A word in column one and how what it begins is read.
struct Declaration {
    std::string_view word;
    void (*read)(Cursor&, Ast&);
};

std::span<const Declaration> declarations();
/// The row of `word`, or null.
const Declaration* findDeclaration(std::string_view word);

}  // namespace sgm::syntax
