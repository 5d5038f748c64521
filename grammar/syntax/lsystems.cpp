#include "grammar/syntax/lsystems.h"

#include "grammar/syntax/expressions.h"

namespace sgm::syntax {

namespace {

/// What stands from the cursor to the next blank: std/walls.sgm, F+F.
std::string textToBlank(const Cursor& cursor) {
    std::string text(cursor.peekText());
    for (size_t i = 1; !cursor.at(Token::Kind::End, i) && cursor.peek(i).glued; ++i) text += cursor.peekText(i);
    return text;
}

}  // namespace

Expr readText(Cursor& cursor, std::string_view what) {
    if (!cursor.at(Token::Kind::Text))
        cursor.fail("expected " + std::string(what) + " in quotes, found " + cursor.found(),
                    cursor.at(Token::Kind::Word) ? "write '\"" + textToBlank(cursor) + "\"'" : "");
    return readArgument(cursor);
}

/// Takes '->', also where another arrow was written.
void expectArrow(Cursor& cursor, std::string_view where) {
    if (cursor.at("=>") || cursor.at("=") || cursor.at("~>")) {
        const std::string found = cursor.found();
        cursor.complain(cursor.span(cursor.take()), "expected '->' " + std::string(where) + ", found " + found,
                        "write '->'");
    } else {
        cursor.expect("->", where);
    }
}

namespace {

using Module = LsystemDecl::Module;

/// The end of the parentheses that begin at `at`, or npos.
size_t closing(std::string_view text, size_t at) {
    int depth = 0;
    for (; at < text.size(); ++at) {
        depth += (text[at] == '(') - (text[at] == ')');
        if (depth == 0) return at;
    }
    return std::string_view::npos;
}

/// The letters of a text; a parenthesis that follows one holds its numbers.
std::vector<Module> readModules(Cursor& cursor, const Expr& text) {
    std::vector<Module> modules;
    if (text.kind != Expr::Kind::Text || text.span.end < text.span.begin + 2) return modules;
    const SourceSpan inner{text.span.source, text.span.begin + 1, text.span.end - 1};
    const std::string_view letters = inner.text();
    const auto spanOf = [&](size_t from, size_t to) {
        return SourceSpan{inner.source, inner.begin + static_cast<uint32_t>(from),
                          inner.begin + static_cast<uint32_t>(to)};
    };
    for (size_t i = 0; i < letters.size() && !cursor.failed(); ++i) {
        if (letters[i] == ' ' || letters[i] == '\t') continue;
        Module& module = modules.emplace_back();
        module.letter = letters[i];
        module.span = spanOf(i, i + 1);
        if (i + 1 == letters.size() || letters[i + 1] != '(' || letters[i] == '(') continue;
        const size_t end = closing(letters, i + 1);
        if (end == std::string_view::npos) {
            cursor.failAt(spanOf(i + 1, i + 2), "this '(' has no ')' behind it", "write 'F(2m)'");
            break;
        }
        cursor.within(spanOf(i + 2, end), [&](Cursor& numbers) {
            do module.args.push_back(readExpr(numbers));
            while (!numbers.failed() && numbers.accept(","));
        });
        module.span = spanOf(i, end + 1);
        i = end;
    }
    return modules;
}

bool atProduction(const Cursor& cursor) {
    if (!cursor.at(Token::Kind::Word)) return false;
    return cursor.at("->", 1) || cursor.at("<", 1) || cursor.at(">", 1) || cursor.at("(", 1);
}

/// before < letter(parameters) > behind
void readPattern(Cursor& cursor, LsystemDecl::Production& production) {
    production.symbol = readName(cursor, "a letter");
    if (cursor.accept("<")) {
        production.before = production.symbol;
        production.symbol = readName(cursor, "a letter");
    }
    const Token open = cursor.peek();
    if (cursor.accept("(", Token::Role::Suffix)) {
        do production.parameters.push_back(readName(cursor, "a name for the letter's number"));
        while (!cursor.failed() && cursor.accept(","));
        cursor.close(open);
    }
    if (cursor.accept(">")) production.behind = readName(cursor, "a letter");
}

void readProductions(Cursor& cursor, LsystemDecl& lsystem) {
    while (atProduction(cursor) && !cursor.failed()) {
        LsystemDecl::Production production;
        const uint32_t begin = cursor.peek().begin;
        readPattern(cursor, production);
        expectArrow(cursor, "after the letter");
        production.text = readText(cursor, "letters");
        production.modules = readModules(cursor, production.text);
        if (cursor.accept("when")) production.when = readExpr(cursor);
        if (cursor.accept(":")) production.weight = readArgument(cursor);
        production.span = cursor.since(begin);
        if (!cursor.failed()) lsystem.productions.push_back(std::move(production));
    }
}

}  // namespace

void readLsystem(Cursor& cursor, Ast& ast) {
    LsystemDecl lsystem;
    const uint32_t begin = cursor.take().begin;
    lsystem.name = readName(cursor, "an lsystem");
    while (cursor.at(Token::Kind::Word) && !cursor.at("axiom")) {
        Setting setting;
        setting.name = readName(cursor, "a setting");
        setting.value = readArgument(cursor);
        setting.span = join(setting.name.span, setting.value.span);
        lsystem.settings.push_back(std::move(setting));
    }
    if (cursor.expect("axiom", "and a text after the settings")) {
        lsystem.axiom = readText(cursor, "letters");
        lsystem.axiomModules = readModules(cursor, lsystem.axiom);
        readProductions(cursor, lsystem);
    }
    lsystem.span = cursor.since(begin);
    if (!lsystem.name.empty()) ast.lsystems.push_back(std::move(lsystem));
}

}  // namespace sgm::syntax
