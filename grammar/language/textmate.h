// Highlighting for editors that take no semantic tokens: a TextMate grammar from the parser's tables.
// Enters: nothing. Leaves: JSON. Assumes the lexer's rules, which a test compares over all grammars.
#pragma once

#include <string>

namespace sgm::language {

/// The TextMate grammar of the language, scope `source.sgm`.
std::string textMateGrammar();

}  // namespace sgm::language
