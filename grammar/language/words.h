// The words that a grammar may hold, with their docs: the language's own, those of its tables, and the text's.
// Enters: names. Leaves: docs in Markdown. Assumes the tables of operations, primitives, plans and functions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/language/analysis.h"

namespace sgm::language {

/// A word of the language itself.
struct Keyword {
    std::string_view word;
    std::string_view doc;
};

/// Words that begin a declaration, in column one.
std::span<const Keyword> declarationWords();
/// Words within declarations that aren't operations: repeat, finally, for, of …
std::span<const Keyword> clauseWords();
/// Words that stand for values: axes, scope, true, last …
std::span<const Keyword> valueWords();

/// The doc of a word of the language or of a table, in Markdown; "" for other words. A word may have several.
std::string docOf(std::string_view word);

/// What a declaration's author wrote of it: the comment lines above it, or the comment behind it.
std::string commentOf(syntax::SourceSpan declaration);

/// The first comment of a text, in one line: what it is for.
std::string purposeOf(const syntax::Source& source);

/// The definition of an occurrence: in the text itself or a file that it uses; null where there is none.
const Occurrence* definitionOf(const Analysis& analysis, const Occurrence& occurrence);

/// What a hover shows of a name: its declaration, comment, value at the defaults, figures. Markdown.
std::string describe(const Analysis& analysis, const Occurrence& occurrence);

}  // namespace sgm::language
