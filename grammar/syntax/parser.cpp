#include "grammar/syntax/parser.h"

#include <algorithm>

#include "grammar/syntax/bodies.h"
#include "grammar/syntax/declarations.h"
#include "grammar/syntax/expressions.h"
#include "grammar/syntax/hints.h"

namespace sgm::syntax {

namespace {

/// Says what is wrong with a token where a declaration should begin.
void refuse(Cursor& cursor) {
    const Token token = cursor.peek();
    if (cursor.at("grammar")) {
        cursor.fail("'grammar' stands once, in the first line");
    } else if (cursor.at("/") && cursor.at("*", 1)) {
        cursor.fail("unexpected '/*'", "a comment begins with '//' and ends with its line");
    } else if (token.columnOne && token.kind == Token::Kind::Word) {
        std::vector<std::string> words;
        for (const Declaration& d : declarations()) words.emplace_back(d.word);
        const std::string near = didYouMean(cursor.peekText(), words);
        const ForeignDeclaration* foreign = findForeignDeclaration(cursor.peekText());
        const bool isRule = cursor.at("->", 1) || (cursor.at("-", 1) && cursor.at("->", 2));
        cursor.fail(cursor.found() + " begins no declaration",
                    foreign             ? std::string(foreign->hint)
                    : isRule            ? "write " + quoted("rule " + std::string(cursor.peekText()) + " -> …")
                    : cursor.at("=", 1) ? "write " + quoted("let " + std::string(cursor.peekText()) + " = …") +
                                              ", or 'param' for what users may change"
                    : near.empty() ? "later lines of a declaration are indented"
                                   : "did you mean " + quoted(near) + "?");
    } else {
        const std::string foreign = foreignAttributeHint(cursor.peekText());
        cursor.fail("unexpected " + cursor.found(),
                    foreign.empty() ? nearestWord(cursor.operations(), cursor.peekText()) : foreign);
    }
}

/// The declaration that the token at the cursor begins: also one that another language calls otherwise, which is
/// reported.
const Declaration* declarationAt(Cursor& cursor) {
    if (const Declaration* declaration = findDeclaration(cursor.peekText())) return declaration;
    const ForeignDeclaration* foreign = cursor.peek().columnOne ? findForeignDeclaration(cursor.peekText()) : nullptr;
    if (!foreign || foreign->means.empty()) return nullptr;
    cursor.complain(cursor.span(cursor.peek()), cursor.found() + " begins no declaration", std::string(foreign->hint));
    return findDeclaration(foreign->means);
}

/// The declarations of one slice: one, unless a second wasn't put in column one.
void readDeclarations(Cursor& cursor, Ast& ast) {
    for (bool first = true; !cursor.done(); first = false) {
        if (cursor.at(";")) {
            cursor.complain(cursor.span(cursor.take()), "unexpected ';'",
                            "a declaration ends with its line: leave ';' out");
            continue;
        }
        const size_t begin = cursor.position();
        const Declaration* declaration = declarationAt(cursor);
        if (!declaration) {
            refuse(cursor);
        } else {
            if (!first || !cursor.peek().columnOne)
                cursor.complain(cursor.span(cursor.peek()), cursor.found() + " begins a declaration",
                                "begin a line with it, no blanks before");
            declaration->read(cursor, ast);
        }
        cursor.resume(begin + 1, Cursor::Next::Declaration);
    }
}

/// grammar 1. False when the rest can't be read as this language.
bool readVersion(Cursor& cursor, Ast& ast) {
    if (!cursor.at("grammar")) {
        const std::string message = "a grammar file begins with its version";
        const std::string hint = "write 'grammar 2' in the first line";
        if (findDeclaration(cursor.peekText()))
            cursor.complain(cursor.span(cursor.peek()), message, hint);
        else
            cursor.fail(message, hint);
        return true;
    }
    cursor.take();
    const Token version = cursor.peek();
    if (!cursor.at(Token::Kind::Number)) {
        cursor.fail("expected a version after 'grammar', found " + cursor.found(), "write 'grammar 2'");
        return true;
    }
    ast.version = static_cast<int>(std::min(readArgument(cursor).number, 1e6));
    if (cursor.text(version) == "1" || cursor.text(version) == "2") return true;
    cursor.failAt(cursor.span(version),
                  "this program reads grammar versions 1 and 2, not " + std::string(cursor.text(version)),
                  "write 'grammar 2', or use a newer program");
    return false;
}

}  // namespace

Ast parse(SourcePtr source, std::span<Token> tokens, const OperationTable& operations, Diagnostics& diagnostics) {
    diagnostics.keep(source);
    Ast ast;
    ast.source = source;
    ast.operations = &operations;
    const auto begins = [&](const Token& t) {
        const std::string_view text = textOf(*source, t);
        return t.columnOne && (text == "grammar" || findDeclaration(text) || findForeignDeclaration(text));
    };
    size_t begin = 0;
    do {
        size_t end = begin + (begin < tokens.size());
        while (end < tokens.size() && !begins(tokens[end])) ++end;
        Cursor cursor(*source, tokens.subspan(begin, end - begin), operations, diagnostics);
        if (begin == 0 && !readVersion(cursor, ast)) return ast;
        readDeclarations(cursor, ast);
        begin = end;
    } while (begin < tokens.size());
    return ast;
}

Ast parse(SourcePtr source, const OperationTable& operations, Diagnostics& diagnostics) {
    std::vector<Token> tokens = lexSignificant(*source);
    return parse(std::move(source), tokens, operations, diagnostics);
}

Expr parseExpression(SourcePtr source, Diagnostics& diagnostics) {
    std::vector<Token> tokens = lexSignificant(*source);
    const OperationTable none;
    Cursor cursor(*source, tokens, none, diagnostics);
    Expr expression = readExpr(cursor);
    if (!cursor.done()) cursor.fail("unexpected " + cursor.found());
    return expression;
}

}  // namespace sgm::syntax
