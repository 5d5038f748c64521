#include "grammar/syntax/parser.h"

#include <algorithm>

#include "grammar/syntax/declarations.h"
#include "grammar/syntax/expressions.h"

namespace sgm::syntax {

namespace {

/// Says what is wrong with a token where a declaration should begin.
void refuse(Cursor& cursor) {
    std::vector<std::string> words;
    for (const Declaration& d : declarations()) words.emplace_back(d.word);
    const std::string near = cursor.peek().columnOne ? didYouMean(cursor.peekText(), words) : std::string();
    if (cursor.at("grammar"))
        cursor.fail("'grammar' stands once, in the first line");
    else if (!near.empty())
        cursor.fail(cursor.found() + " begins no declaration", "did you mean '" + near + "'?");
    else
        cursor.fail("unexpected " + cursor.found());
}

/// The declarations of one slice: one, unless a second wasn't put in column one.
void readDeclarations(Cursor& cursor, Ast& ast) {
    for (bool first = true; !cursor.done(); first = false) {
        const Declaration* declaration = findDeclaration(cursor.peekText());
        if (!declaration) {
            refuse(cursor);
            return;
        }
        if (!first || !cursor.peek().columnOne)
            cursor.complain(cursor.span(cursor.peek()), cursor.found() + " begins a declaration",
                            "begin a line with it, no blanks before");
        declaration->read(cursor, ast);
    }
}

/// grammar 1. False when the rest can't be read as this language.
bool readVersion(Cursor& cursor, Ast& ast) {
    if (!cursor.at("grammar")) {
        const std::string message = "a grammar file begins with its version";
        const std::string mend = "write 'grammar 1' in the first line";
        if (findDeclaration(cursor.peekText()))
            cursor.complain(cursor.span(cursor.peek()), message, mend);
        else
            cursor.fail(message, mend);
        return true;
    }
    cursor.take();
    const Token version = cursor.peek();
    if (!cursor.at(Token::Kind::Number)) {
        cursor.fail("expected a version after 'grammar', found " + cursor.found(), "write 'grammar 1'");
        return true;
    }
    ast.version = static_cast<int>(std::min(readArgument(cursor).number, 1e6));
    if (cursor.text(version) == "1") return true;
    cursor.failAt(cursor.span(version),
                  "this program reads grammar version 1, not " + std::string(cursor.text(version)),
                  "write 'grammar 1', or use a newer program");
    return false;
}

/// Tokens without blanks and comments.
std::vector<Token> significant(const Source& source) {
    std::vector<Token> tokens = lex(source);
    tokens.erase(std::remove_if(tokens.begin(), tokens.end(), [](const Token& t) { return isTrivia(t.kind); }),
                 tokens.end());
    return tokens;
}

}  // namespace

Ast parse(SourcePtr source, Diagnostics& diagnostics) {
    Ast ast;
    ast.source = source;
    const std::vector<Token> tokens = significant(*source);
    const auto begins = [&](const Token& t) {
        return t.columnOne && (textOf(*source, t) == "grammar" || findDeclaration(textOf(*source, t)));
    };
    size_t begin = 0;
    do {
        size_t end = begin + (begin < tokens.size());
        while (end < tokens.size() && !begins(tokens[end])) ++end;
        Cursor cursor(*source, std::span(tokens).subspan(begin, end - begin), diagnostics);
        if (begin == 0 && !readVersion(cursor, ast)) return ast;
        readDeclarations(cursor, ast);
        begin = end;
    } while (begin < tokens.size());
    return ast;
}

Expr parseExpression(SourcePtr source, Diagnostics& diagnostics) {
    const std::vector<Token> tokens = significant(*source);
    Cursor cursor(*source, tokens, diagnostics);
    Expr expression = readExpr(cursor);
    if (!cursor.done()) cursor.fail("unexpected " + cursor.found());
    return expression;
}

}  // namespace sgm::syntax
