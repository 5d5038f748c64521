// The Text panel's syntax colours.
// Enters: a source's text and what its names mean. Leaves: stretches of each line. Assumes nothing: any text has
// colours.
#pragma once

#include <cstdint>
#include <vector>

#include "grammar/syntax/ast.h"

namespace sgm::document {

enum class TextColour : uint8_t {
    Plain,
    Keyword,      ///< rule, repeat, when …
    Operation,    ///< size, at, shift …
    Solid,        ///< cube, sphere …
    NonTerminal,  ///< capital
    Terminal,     ///< declared by `terminal`
    Parameter,    ///< declared by `param`
    Number,
    Text,  ///< "…"
    Hex,   ///< #rrggbb
    Comment,
    Sign,   ///< + - & -> | { } …
    Wrong,  ///< no token of the language
};

/// Bytes [begin, end) of a line have a colour.
struct Coloured {
    uint32_t begin = 0, end = 0;
    TextColour colour = TextColour::Plain;
    friend bool operator==(const Coloured&, const Coloured&) = default;
};

/// The lines of the tree's source, each with its stretches from left to right; blanks have none.
std::vector<std::vector<Coloured>> colours(const syntax::Ast& ast);

}  // namespace sgm::document
