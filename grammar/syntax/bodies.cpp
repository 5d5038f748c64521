#include "grammar/syntax/bodies.h"

#include <algorithm>
#include <utility>

#include "grammar/syntax/arguments.h"
#include "grammar/syntax/expressions.h"
#include "grammar/syntax/hints.h"

namespace sgm::syntax {

namespace {

std::string plain(std::string_view text) { return std::string(text); }

/// `let NAME = …`; elsewhere the word may name something.
bool atLet(const Cursor& cursor) {
    return cursor.at("let") && cursor.at(Token::Kind::Word, 1) && !cursor.peek().columnOne &&
           !cursor.operations().find(cursor.peekText(1)) && !isReserved(cursor.peekText(1));
}

bool atControl(const Cursor& cursor) {
    return cursor.at("for") || cursor.at("while") || cursor.at("when") || cursor.at("choose") || atLet(cursor);
}

/// `morph (…)` is the operator before a group; `morph(a, b, t)` is a solid.
bool atOperator(const Cursor& cursor) {
    if (cursor.at("morph")) return !(cursor.at("(", 1) && cursor.peek(1).glued);
    return cursor.at("+") || cursor.at("-") || cursor.at("&");
}

Operator takeOperator(Cursor& cursor) {
    const std::string_view symbol = cursor.text(cursor.take());
    if (symbol == "+") return Operator::Sum;
    if (symbol == "-") return Operator::Difference;
    if (symbol == "&") return Operator::Intersection;
    return Operator::Morph;
}

Case readCase(Cursor& cursor, std::string_view sample);

bool acceptBar(Cursor& cursor) {
    if (!cursor.at("||")) return cursor.accept("|");
    cursor.complain(cursor.span(cursor.take()), "one bar stands between two parts", "write '|'");
    return true;
}

/// { case {| case} } after `word`; `sample` is a label that fits here, for hints.
std::vector<Case> readBlock(Cursor& cursor, std::string_view word, std::string_view sample) {
    const Token open = cursor.peek();
    std::vector<Case> cases;
    const std::string after = quoted(word);
    const std::string hint = atAttribute(cursor)
                                 ? "write " + quoted(plain(cursor.peekText()) + " …") + " before " + after
                             : cursor.at("(") ? "the parts stand in '{ … }'"
                                              : "";
    if (!cursor.expect("{", "after " + after, hint)) return cases;
    if (cursor.at("}")) cursor.fail("the block is empty", "write " + quoted(plain(sample) + ": …") + " in it");
    const size_t first = cursor.position();
    do {
        cases.push_back(readCase(cursor, sample));
        cursor.resume(first, Cursor::Next::Part);
    } while (acceptBar(cursor));
    cursor.close(open);
    return cases;
}

std::shared_ptr<Body> readBracedBody(Cursor& cursor, std::string_view where, std::string hint = {}) {
    auto body = std::make_shared<Body>();
    const Token open = cursor.peek();
    if (!cursor.expect("{", where, std::move(hint))) return body;
    *body = readBody(cursor);
    cursor.close(open);
    return body;
}

/// Whether ':' comes before the part ends: then a label may be a calculation, 100% - 1m.
bool isLabelled(const Cursor& cursor) {
    int depth = 0;
    for (size_t i = 0; !cursor.at(Token::Kind::End, i); ++i) {
        const std::string_view text = cursor.peekText(i);
        depth += (text == "(" || text == "[") - (text == ")" || text == "]");
        if (depth == 0 && text == ":") return true;
        if (depth < 0 || text == "|" || text == "{" || text == "}") return false;
    }
    return false;
}

/// The label before ':' — a size, a weight, a word, or `tag K`.
void readLabel(Cursor& cursor, Case& part) {
    if (cursor.at("tag") && cursor.at(Token::Kind::Word, 1) && cursor.at(":", 2)) {
        cursor.take();
        part.tag = readName(cursor, "a tag");
    } else if (cursor.at(Token::Kind::Word) && cursor.at(":", 1) && !isReserved(cursor.peekText())) {
        part.label = readSolid(cursor);
    } else if (startsArgument(cursor)) {
        part.label = isLabelled(cursor) ? readExpr(cursor) : readArgument(cursor);
    } else {
        cursor.fail("expected a part 'label: body', found " + cursor.found());
    }
}

bool isSolid(const Expr& e) { return e.kind == Expr::Kind::Name || e.kind == Expr::Kind::Call; }

/// A body that is the one word or call `solid`: what stood where a label was missing.
std::shared_ptr<Body> bodyOf(Expr solid) {
    auto body = std::make_shared<Body>();
    Element element;
    body->span = element.span = solid.span;
    element.solid = std::move(solid);
    body->siblings.push_back({std::move(element)});
    return body;
}

/// How often a block repeats: *, +, 3 or (n + 1).
void readTimes(Cursor& cursor, SourceSpan braces, Case& part) {
    const bool glued = cursor.peek().glued;
    if (cursor.accept("*", Token::Role::Suffix)) {
        if (!cursor.at(Token::Kind::Number) && !cursor.at("(")) return;
        const Token times = cursor.peek();
        part.times = readArgument(cursor);
        const SourceSpan said = cursor.since(times.begin);
        cursor.complain(said, "a number can't follow '}*', which repeats as often as it fits",
                        "write " + quoted("{ … }" + plain(said.text())) + " for so many times");
        return;
    }
    if (cursor.accept("+", Token::Role::Suffix)) {
        part.atLeastOnce = true;
    } else if (glued && (cursor.at(Token::Kind::Number) || cursor.at("("))) {
        cursor.mark(Token::Role::Suffix);
        part.times = readArgument(cursor);
    } else {
        cursor.complain(braces, "a block inside a block repeats, and says how often",
                        "write '{ … }*' for as often as it fits, '{ … }+' for at least once, or '{ … }3'");
    }
}

/// { cases }*, { cases }+, { cases }3 or label: body
Case readCase(Cursor& cursor, std::string_view sample) {
    const Cursor::Nest nest(cursor);
    const Token first = cursor.peek();
    Case part;
    if (cursor.at("{")) {
        part.repeated = true;
        part.cases = readBlock(cursor, "", sample);
        const SourceSpan braces = cursor.since(first.begin);
        readTimes(cursor, braces, part);
    } else {
        readLabel(cursor, part);
        const SourceSpan label = cursor.since(first.begin);
        if (cursor.accept(":", Token::Role::Suffix)) {
            if (cursor.at(Token::Kind::Number) && part.label && isSolid(*part.label))
                cursor.fail("a number stands before the body that it is about",
                            "write " + quoted(plain(cursor.peekText()) + ": " + plain(label.text())));
            part.body = std::make_shared<Body>(readBody(cursor));
        } else if (part.label && isSolid(*part.label) && (cursor.at("|") || cursor.at("}"))) {
            cursor.complain(label, quoted(label.text()) + " has no label before it",
                            "write " + quoted(plain(sample) + ": " + plain(label.text())));
            part.body = bodyOf(*std::exchange(part.label, std::nullopt));
        } else if (cursor.done() || cursor.at("|") || cursor.at("}") || cursor.at(",")) {
            cursor.expect(":", "and a body after " + quoted(label.text()));
        } else {
            const std::string hint = "write " + quoted(plain(label.text()) + ": " + plain(cursor.peekText()));
            cursor.complain(cursor.span(cursor.peek()),
                            "expected ':' after " + quoted(label.text()) + ", found " + cursor.found(), hint);
            part.body = std::make_shared<Body>(readBody(cursor));
        }
    }
    part.span = cursor.since(first.begin);
    return part;
}

std::vector<Attribute> readAttributes(Cursor& cursor) {
    std::vector<Attribute> list;
    while (atAttribute(cursor)) list.push_back(readAttribute(cursor));
    return list;
}

/// Attributes that come after `: Name` are read all the same, and belong before it.
void readLive(Cursor& cursor, Element& element) {
    if (!cursor.accept(":")) return;
    element.live = readName(cursor, "a live shape");
    if (!atAttribute(cursor)) return;
    const Token first = cursor.peek();
    std::vector<Attribute> late = readAttributes(cursor);
    const SourceSpan span = cursor.since(first.begin);
    cursor.complain(span, quoted(span.text()) + " stands after ': " + element.live.text + "'",
                    "attributes come before ':'");
    for (Attribute& attribute : late) element.after.push_back(std::move(attribute));
}

/// prefix attributes, then a name, a call, a group, or nothing; attributes; : Name
void readShape(Cursor& cursor, Element& element) {
    element.before = readAttributes(cursor);
    const Token open = cursor.peek();
    if (cursor.accept("(")) {
        element.kind = Element::Kind::Group;
        element.body = std::make_shared<Body>(readBody(cursor));
        cursor.close(open);
    } else if (cursor.at(Token::Kind::Word) && isLaterOperation(cursor.peekText())) {
        cursor.fail(cursor.found() + " is an operation of a later version of the language");
        return;
    } else if (cursor.at(Token::Kind::Word) && !isReserved(cursor.peekText()) &&
               (element.before.empty() || !atOperator(cursor))) {
        element.solid = readSolid(cursor);
    } else if (element.before.empty()) {
        const bool calculates = element.op != Operator::None && cursor.at(Token::Kind::Number);
        cursor.fail("expected a shape, found " + cursor.found(),
                    calculates       ? "put a calculation in parentheses: 'size (2 + 1)'"
                    : cursor.at("~") ? "the parts of a 'split' are set apart by '|'"
                                     : "");
        return;
    }
    element.after = readAttributes(cursor);
    readLive(cursor, element);
}

void readControl(Cursor& cursor, Element& element) {
    if (element.op != Operator::None) {
        const std::string op = element.op == Operator::Morph ? "morph" : plain(cursor.text(cursor.previous(1)));
        cursor.complain(cursor.span(cursor.peek()), cursor.found() + " takes no operator before it",
                        "write it within the braces, before each shape, as in " + quoted("{ " + op + " cube … }") +
                            ", or group all of it: " + quoted(op + " (" + plain(cursor.peekText()) + " … { … })"));
    }
    const std::string_view word = cursor.text(cursor.take());
    if (word == "let") {
        element.kind = Element::Kind::Let;
        element.variable = readName(cursor, "a value");
        cursor.expect("=", "after the value's name");
        element.over = readArgument(cursor);
        refuseCalculation(cursor, "let");
        return;
    }
    if (word == "choose") {
        element.kind = Element::Kind::Choose;
        if (cursor.at(Token::Kind::Word) && isSeries(cursor.peekText()))
            element.variable = readName(cursor, "a way to choose");
        element.cases = readBlock(cursor, "choose", "1");
        return;
    }
    element.kind = word == "for" ? Element::Kind::For : word == "while" ? Element::Kind::While : Element::Kind::When;
    if (word == "for") {
        element.variable = readName(cursor, "a loop variable");
        if (!cursor.expect("in", "after the loop variable",
                           "write " + quoted("for " + element.variable.text + " in …")))
            return;
        element.over = readExpr(cursor);
        if (cursor.accept("when")) element.guard = readExpr(cursor);
    } else {
        element.over = readExpr(cursor);
    }
    const bool endsRule = element.kind == Element::Kind::When && cursor.at(Token::Kind::End);
    element.body = readBracedBody(cursor, "before the body of '" + plain(word) + "'",
                                  endsRule ? "a rule's condition stands before '->': 'rule B when … -> …'" : "");
}

/// A shape begins the body behind its values.
bool followsLet(const Cursor& cursor, const Element& before) {
    if (before.kind != Element::Kind::Let) return false;
    return cursor.at("(") || (cursor.at(Token::Kind::Word) && !isReserved(cursor.peekText()));
}

Element readElement(Cursor& cursor) {
    const Cursor::Nest nest(cursor);
    const uint32_t begin = cursor.peek().begin;
    Element element;
    if (atOperator(cursor)) element.op = takeOperator(cursor);
    if (atControl(cursor))
        readControl(cursor, element);
    else
        readShape(cursor, element);
    element.span = cursor.since(begin);
    return element;
}

/// element {element}, where every one but the first and what stands behind a `let` has an operator or is control.
std::vector<Element> readChain(Cursor& cursor) {
    std::vector<Element> chain;
    do chain.push_back(readElement(cursor));
    while (!cursor.failed() && (atOperator(cursor) || atControl(cursor) || followsLet(cursor, chain.back())));
    return chain;
}

/// Says what is wrong with a token that can't follow a shape. Words of the language end a body and are judged outside.
void refuseStray(Cursor& cursor) {
    const Token token = cursor.peek();
    if (token.kind == Token::Kind::Word && !isReserved(cursor.text(token)) && !token.columnOne) {
        const std::string word(cursor.text(token));
        const std::string foreign = foreignAttributeHint(word);
        const bool isSymbol = word[0] >= 'A' && word[0] <= 'Z';
        const std::string near = !foreign.empty() ? foreign
                                 : isSymbol       ? "write " + quoted(": " + word) + " to call this shape so, or " +
                                                  quoted(", " + word) + " for one beside it"
                                            : nearestWord(cursor.operations(), word);
        cursor.fail(cursor.found() + " can't follow a shape",
                    near.empty() ? "name an attribute (size, color …), 'of " + plain(word) +
                                       "' for a material, join shapes with + - & morph, or list them with ','"
                                 : near);
    } else if (cursor.at("(")) {
        cursor.fail("'(' can't follow a shape",
                    "write it without a blank before '(' for arguments, or join with an operator");
    } else if (token.kind == Token::Kind::Number || token.kind == Token::Kind::Text ||
               token.kind == Token::Kind::Color) {
        cursor.fail(cursor.found() + " can't follow a shape",
                    "name the attribute: " + quoted("size " + plain(cursor.text(token))));
    }
}

}  // namespace

bool isLaterOperation(std::string_view word) {
    constexpr std::string_view words[] = {"inset", "balcony"};
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

bool atAttribute(const Cursor& cursor) {
    return cursor.at(Token::Kind::Word) && cursor.operations().find(cursor.peekText());
}

Attribute readAttribute(Cursor& cursor) {
    const Token word = cursor.take();
    const Operation* found = cursor.operations().find(cursor.text(word));
    const bool axis = cursor.at("x") || cursor.at("y") || cursor.at("z");
    if (found->block.operation && axis && cursor.at("{", 1)) found = found->block.operation;
    const Operation& row = *found;
    Attribute attribute;
    attribute.name = {plain(row.name), cursor.span(word)};
    attribute.operation = &row;
    readArguments(cursor, row, attribute);
    if (row.block.isBody) {
        Case whole;
        const uint32_t begin = cursor.peek().begin;
        whole.body = readBracedBody(cursor, "after " + quoted(row.name));
        whole.span = cursor.since(begin);
        attribute.cases.push_back(std::move(whole));
    } else if (row.hasBlock()) {
        attribute.cases = readBlock(cursor, row.name, row.block.label);
    }
    if (row.traits.takesSettings && cursor.at("{")) attribute.settings = readSettings(cursor);
    attribute.span = cursor.since(word.begin);
    return attribute;
}

std::string nearestWord(const OperationTable& operations, std::string_view word) {
    std::vector<std::string> words = {"for", "while", "when",  "choose", "finally", "morph",  "in",
                                      "let", "of",    "group", "key",    "joint",   "expect", "axiom"};
    for (const Operation* row : operations.rows()) words.emplace_back(row->name);
    const std::string near = didYouMean(word, words);
    return near.empty() ? near : "did you mean " + quoted(near) + "?";
}

namespace {

/// chain {, chain}
void readSiblings(Cursor& cursor, Body& body) {
    constexpr std::string_view faceWords[] = {"rest", "top",   "bottom", "side",   "front", "back",
                                              "left", "right", "court",  "shared", "inner", "outer"};
    const auto atFaceWord = [&] {
        return cursor.at(":", 1) && cursor.at(Token::Kind::Word, 2) &&
               std::find(std::begin(faceWords), std::end(faceWords), cursor.peekText()) != std::end(faceWords);
    };
    do {
        if (!body.siblings.empty() && atFaceWord())
            cursor.fail("this part stands behind ','", "the parts of a block are set apart by '|'");
        body.siblings.push_back(readChain(cursor));
    } while (cursor.accept(","));
}

}  // namespace

Body readBody(Cursor& cursor) {
    const uint32_t begin = cursor.peek().begin;
    const size_t first = cursor.position();
    Body body;
    bool goesOn = true;
    while (goesOn) {
        readSiblings(cursor, body);
        body.span = cursor.since(begin);
        refuseStray(cursor);
        goesOn = cursor.resume(first, Cursor::Next::Sibling) && (cursor.accept(",") || atOperator(cursor));
    }
    return body;
}

}  // namespace sgm::syntax
