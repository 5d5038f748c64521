#include "viewer/document/colours.h"

#include <algorithm>
#include <set>
#include <string>

#include "grammar/operations/operations.h"
#include "grammar/syntax/declarations.h"
#include "grammar/syntax/expressions.h"
#include "grammar/syntax/lexer.h"
#include "modeler/field/primitives.h"

namespace sgm::document {
namespace {

using syntax::Token;

class Names {
public:
    explicit Names(const syntax::Ast& ast) {
        for (const auto& param : ast.params) params_.insert(param.name.text);
        for (const auto& terminal : ast.terminals)
            for (const auto& name : terminal.names) terminals_.insert(name.text);
    }

    TextColour of(std::string_view word) const {
        if (word == "grammar" || word == "joint" || word == "facing" || word == "group" || word == "key" ||
            word == "of" || word == "axiom" || word == "true" || word == "false" || syntax::isReserved(word) ||
            syntax::findDeclaration(word))
            return TextColour::Keyword;
        if (params_.contains(word)) return TextColour::Parameter;
        if (terminals_.contains(word)) return TextColour::Terminal;
        if (operations::table().find(word)) return TextColour::Operation;
        if (word == "morph" || word == "nil" || field::findPrimitive(word)) return TextColour::Solid;
        return word[0] >= 'A' && word[0] <= 'Z' ? TextColour::NonTerminal : TextColour::Plain;
    }

private:
    std::set<std::string, std::less<>> params_, terminals_;
};

TextColour colourOf(const Token& token, std::string_view text, const Names& names) {
    switch (token.kind) {
        case Token::Kind::Word:
            return names.of(text);
        case Token::Kind::Comment:
            return TextColour::Comment;
        case Token::Kind::Number:
            return TextColour::Number;
        case Token::Kind::Text:
            return TextColour::Text;
        case Token::Kind::Color:
            return TextColour::Hex;
        case Token::Kind::Symbol:
            return TextColour::Sign;
        case Token::Kind::Unknown:
            return TextColour::Wrong;
        case Token::Kind::Blank:
        case Token::Kind::End:
            break;
    }
    return TextColour::Plain;
}

}  // namespace

std::vector<std::vector<Coloured>> colours(const syntax::Ast& ast) {
    const syntax::Source& source = *ast.source;
    const Names names(ast);
    const auto lines = static_cast<size_t>(std::count(source.text().begin(), source.text().end(), '\n')) + 1;
    std::vector<std::vector<Coloured>> coloured(lines);
    for (const Token& token : syntax::lex(source)) {
        if (token.kind == Token::Kind::Blank) continue;
        const auto place = source.place(token.begin);
        // No token but blanks goes over a line's end.
        const uint32_t begin = place.column - 1;
        coloured[place.line - 1].push_back(
            {begin, begin + token.end - token.begin, colourOf(token, textOf(source, token), names)});
    }
    return coloured;
}

}  // namespace sgm::document
