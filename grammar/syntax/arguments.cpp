#include "grammar/syntax/arguments.h"

#include "grammar/syntax/bodies.h"
#include "grammar/syntax/expressions.h"

namespace sgm::syntax {

namespace {

std::string plain(std::string_view text) { return std::string(text); }

/// The word of an operation is the argument of the one before (a parameter may be called `blend`), unless it goes on as
/// an operation does, with an argument of its own.
bool beginsOperation(const Cursor& cursor) {
    if (!atAttribute(cursor)) return false;
    switch (cursor.peek(1).kind) {
        case Token::Kind::Number:
        case Token::Kind::Text:
        case Token::Kind::Color:
            return true;
        case Token::Kind::Word:
            return !cursor.operations().find(cursor.peekText(1)) && !isReserved(cursor.peekText(1));
        default:
            return cursor.at("(", 1) || cursor.at("{", 1) ||
                   (cursor.peek(2).glued && !cursor.peek(1).glued && (cursor.at("-", 1) || cursor.at("+", 1)));
    }
}

/// The word of an operation that takes no argument.
bool isWholeOperation(const Cursor& cursor) {
    const Operation* row = cursor.at(Token::Kind::Word) ? cursor.operations().find(cursor.peekText()) : nullptr;
    return row && row->arguments.empty() && row->block.label.empty();
}

/// x; along street; area x
Expr readCut(Cursor& cursor) {
    const Token first = cursor.peek();
    const bool isAlong = cursor.at("along"), isArea = cursor.at("area");
    if (isAlong || isArea) cursor.take();
    const Name name = readName(cursor, isAlong ? "a word for edges" : "x, y or z");
    Expr word;
    word.kind = name.empty() ? Expr::Kind::Error : Expr::Kind::Name;
    word.text = name.text;
    word.span = name.span;
    if (!isAlong && !isArea) return word;
    Expr call;
    call.kind = Expr::Kind::Call;
    call.text = isAlong ? "along" : "area";
    call.args.push_back(std::move(word));
    call.argNames.emplace_back();
    call.span = cursor.since(first.begin);
    return call;
}

bool atAxisName(const Cursor& cursor, size_t ahead = 0) {
    return cursor.at("x", ahead) || cursor.at("y", ahead) || cursor.at("z", ahead);
}

Expr readTyped(Cursor& cursor, ArgumentType type) {
    if (type == ArgumentType::Cut) return readCut(cursor);
    if (type == ArgumentType::Solid) return readSolid(cursor);
    const bool word = type == ArgumentType::Name || type == ArgumentType::Start || type == ArgumentType::Symbol;
    if (word || type == ArgumentType::Axis) {
        Expr e;
        const Name name = readName(cursor, describe(type));
        e.kind = name.empty() ? Expr::Kind::Error : Expr::Kind::Name;
        e.text = name.text;
        e.span = name.span;
        return e;
    }
    return readArgument(cursor);
}

bool fits(const Cursor& cursor, ArgumentType type) {
    const bool word = cursor.at(Token::Kind::Word);
    if (type == ArgumentType::Axis) return atAxisName(cursor);
    if (type == ArgumentType::Cut)
        return atAxisName(cursor) || (cursor.at("area") && atAxisName(cursor, 1)) ||
               (cursor.at("along") && cursor.at(Token::Kind::Word, 1));
    if (type == ArgumentType::Name || type == ArgumentType::Solid || type == ArgumentType::Start ||
        type == ArgumentType::Symbol)
        return word && !isReserved(cursor.peekText()) && !beginsOperation(cursor);
    if (type == ArgumentType::File) return cursor.at(Token::Kind::Text);
    return startsArgument(cursor) && !beginsOperation(cursor);
}

/// The argument behind `argument` whose word stands at the cursor, where that is one: arguments are told by their
/// order.
const OperationArgument* argumentAt(const Cursor& cursor, const Operation& row, const OperationArgument& argument) {
    for (const OperationArgument& later : row.arguments)
        if (&later > &argument && !later.word.empty() && cursor.at(later.word)) return &later;
    return nullptr;
}

}  // namespace

void refuseCalculation(Cursor& cursor, std::string_view word) {
    if (cursor.at("*") || cursor.at("/") || cursor.at("%"))
        cursor.fail(cursor.found() + " can't follow the argument of '" + plain(word) + "'",
                    "put a calculation in parentheses");
}

void readArguments(Cursor& cursor, const Operation& row, Attribute& attribute) {
    for (const OperationArgument& argument : row.arguments) {
        if (!argument.word.empty()) {
            if (argument.optional && !cursor.at(argument.word)) return;
            if (!cursor.expect(argument.word, "in '" + plain(row.name) + "'", "as in '" + plain(row.example) + "'"))
                return;
        }
        // Behind its own word a name is a name, though an operation may be called so: `along court`.
        if (!argument.word.empty() && argument.type == ArgumentType::Name && cursor.at(Token::Kind::Word)) {
            attribute.args.push_back(readTyped(cursor, argument.type));
            continue;
        }
        if (argument.optional && isWholeOperation(cursor)) continue;
        if (const OperationArgument* later = argumentAt(cursor, row, argument)) {
            cursor.fail("'" + plain(row.name) + "' needs " + plain(describe(argument.type)) + " before '" +
                            plain(later->word) + "'",
                        "as in '" + plain(row.example) + "'");
            return;
        }
        if (!fits(cursor, argument.type)) {
            if (argument.optional) continue;
            if (row.traits.namesValue && isReserved(cursor.peekText())) {
                cursor.fail(cursor.found() + " is a word of the language and can't name a value",
                            "give the value another name");
                return;
            }
            cursor.fail(
                "'" + plain(row.name) + "' needs " + plain(describe(argument.type)) + ", found " + cursor.found(),
                "as in '" + plain(row.example) + "'");
            return;
        }
        attribute.args.push_back(readTyped(cursor, argument.type));
        if (row.traits.namesValue && attribute.args.size() == 1) cursor.expect("=", "after the value's name");
    }
    refuseCalculation(cursor, row.name);
}

}  // namespace sgm::syntax
