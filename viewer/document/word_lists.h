// The words that a field of the Rules panel offers, in groups, each with a line of help.
// Enters: the shown model's grammar, for what files declare, and the tables. Leaves: names with docs, sorted within
// their groups. Assumes nothing: without a grammar the tables' words are all.
#pragma once

#include <string>
#include <vector>

#include "grammar/rules/grammar.h"
#include "grammar/syntax/ast.h"

namespace sgm::document {

struct ListedWord {
    std::string name;
    std::string group;  ///< "Solids"
    std::string doc;    ///< one line or more; "" for none
};

/// What may stand as a shape: symbols with rules, terminals, of the text and the files that it uses, and solids that
/// need no file.
std::vector<ListedWord> placeableWords(const rules::Grammar* grammar);
/// What may stand behind `of`.
std::vector<ListedWord> materialWords(const rules::Grammar* grammar);
/// The attributes that an element hasn't yet, by what they are about; and, where it is a shape that no rule goes on
/// with, the ways to divide it ("split", "split { }*", "faces", "row" …: see `edits::divide`).
std::vector<ListedWord> attributeWords(const syntax::Ast& ast, const syntax::Element& element);

}  // namespace sgm::document
