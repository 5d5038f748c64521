// Highlighting for editors that read tree-sitter grammars: the tokens of the language, from the parser's tables.
// Enters: nothing. Leaves: JavaScript, the input of `tree-sitter generate`. Assumes the lexer's rules, which a test
// compares over all grammars.
#pragma once

#include <string>

namespace sgm::language {

/// A grammar whose tree is the list of tokens, by kind: what a text means is the language server's to say.
std::string treeSitterGrammar();

}  // namespace sgm::language
