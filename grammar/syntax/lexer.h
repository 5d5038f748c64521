// Text to tokens. Every byte belongs to exactly one token, blanks and comments included.
// Enters: a Source, any bytes. Leaves: tokens in order, whose texts joined give the file back. Never fails: what is no
// token of the language is Unknown, and the parser says so where it meets it.
#pragma once

#include <vector>

#include "grammar/syntax/source.h"

namespace sgm::syntax {

struct Token {
    enum class Kind : uint8_t {
        Blank,    ///< spaces, tabs, line ends, a byte order mark
        Comment,  ///< // to the end of the line
        Word,     ///< letters, digits and _, not beginning with a digit
        Number,   ///< 14 .5 1e-3, with its unit glued on: 8m 12deg 30% 2.2/m
        Text,     ///< "…"; without the closing quote it ends with the line
        Color,    ///< # and what is glued to it
        Symbol,   ///< one of the symbols of the language, the longest that fits
        Unknown,  ///< anything else
        End,      ///< past the last token; never in the list
    };
    /// What it is to its neighbours, said by the parser for the formatter.
    enum class Role : uint8_t {
        Plain,   ///< blanks around it, as its text asks
        Prefix,  ///< no blank behind it: a sign, ~
        Suffix,  ///< no blank before it: the ( of a call, the : of a label, the * of { }*
        Tight,   ///< no blank on either side: the . of a member, the / of a path
        Part,    ///< it begins a part of a parameter: in, of, the label, group, key
    };
    Kind kind = Kind::End;
    Role role = Role::Plain;
    bool glued = false;      ///< nothing stands between it and the token before
    bool columnOne = false;  ///< it begins its line
    uint32_t begin = 0, end = 0;
};

/// Whether all of a text is one word: letters, digits and _, not beginning with a digit.
bool isWord(std::string_view text);
std::vector<Token> lex(const Source& source);
/// The tokens of `source` without blanks and comments.
std::vector<Token> lexSignificant(const Source& source);

/// Blank or comment.
constexpr bool isTrivia(Token::Kind kind) { return kind == Token::Kind::Blank || kind == Token::Kind::Comment; }

/// The text of a token of `source`.
inline std::string_view textOf(const Source& source, const Token& token) {
    return source.text().substr(token.begin, token.end - token.begin);
}

}  // namespace sgm::syntax
