#include "grammar/syntax/hints.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/syntax/foreign_lengths.h"
#include "modeler/core/decimal.h"

namespace sgm::syntax {

namespace {

/// What the user most likely meant by bytes that are no token.
struct Lookalike {
    std::string_view bytes, hint;
};
constexpr Lookalike lookalikes[] = {
    {"\u2212", "write '-'"},
    {"\u2013", "write '-'"},
    {"\u00d7", "write '*'"},
    {"\u2192", "write '->'"},
    {"\u201c", "write '\"'"},
    {"\u201d", "write '\"'"},
    {"\u00b0", "write 'deg'"},
    {"\u2026", "write '..'"},
    {"\u2265", "write '>='"},
    {"\u2264", "write '<='"},
    {"'", "text stands in \"…\""},
    {"^", "write a power as 'pow(x, y)'"},
    {"?", "write 'if(condition, a, b)'"},
};

constexpr std::string_view ifHint = "bodies choose by 'when condition { … }', values by 'if(condition, a, b)'";

/// A token as other languages have it, where the reader refuses it, and what is written instead.
struct ForeignForm {
    std::string_view before;   ///< the token before it; "" for any
    std::string_view token;    ///< at the cursor
    std::string_view refusal;  ///< how the message begins that the reader would give
    std::string_view instead;  ///< the message; "" for that one
    std::string_view hint;
};
constexpr ForeignForm foreignForms[] = {
    {"", "{", "expected a shape", "", "'(a + b)' groups shapes"},
    {"", "[", "expected a value", "", "a vector stands in parentheses: write '(x, y, z)'"},
    {"", "[", "unexpected", "",
     "there are no brackets: '(a + b)' groups shapes, and ',' sets those apart that stand side by side"},
    {"", "is", "expected '->'", "there is no 'is'", "write '=='"},
    {"", "else", "", "there is no 'else'", "write 'when not condition { … }' for the other case"},
    {"for", "(", "expected the name of a loop variable", "", "write 'for i in 0..5 { … }'"},
    {"", ":", "expected '{'", "", "a body stands in braces: '{ … }'"},
    {"}", "*", "unexpected", "", "what repeats stands in braces of its own, within the block: '{ { ~2m: Part }* }'"},
    {"", "*", "unexpected", "", "what two shapes share is 'a & b'; a calculation stands in parentheses"},
};

constexpr std::string_view roofForms[] = {"hip",  "gable",     "halfHip", "mansard", "gambrel", "saltbox",
                                          "shed", "butterfly", "flat",    "pyramid", "dome",    "bell"};

/// How many tokens back the word is before the parenthesis that the token before the cursor closes; 0 without one.
size_t calleeBefore(const Cursor& cursor) {
    int depth = 0;
    for (size_t back = 1;; ++back) {
        const std::string_view text = cursor.text(cursor.previous(back));
        if (text.empty()) return 0;
        depth += (text == ")") - (text == "(");
        if (depth == 0) return text == "(" ? back + 1 : 0;
    }
}

std::string_view calledBefore(const Cursor& cursor) {
    const size_t back = calleeBefore(cursor);
    return back == 0 ? std::string_view() : cursor.text(cursor.previous(back));
}

/// 2,5 where nothing of a vector could stand; the cursor is at the comma or behind it.
std::optional<Hint> decimalComma(const Cursor& cursor) {
    const bool behind = cursor.text(cursor.previous(1)) == ",";
    const Token whole = cursor.previous(behind ? 2 : 1), comma = behind ? cursor.previous(1) : cursor.peek();
    const Token fraction = cursor.peek(behind ? 0 : 1);
    if (whole.kind != Token::Kind::Number || cursor.text(comma) != "," || fraction.kind != Token::Kind::Number)
        return {};
    if (!comma.glued || !fraction.glued) return {};
    const std::string written = std::string(cursor.text(whole)) + "." + std::string(cursor.text(fraction));
    const SourceSpan span = join(cursor.span(whole), cursor.span(fraction));
    return Hint{span, quoted(span.text()) + " is no number", "a decimal point is '.': write " + quoted(written)};
}

/// A number and a word for feet, inches, yards or metres.
std::optional<Hint> foreignUnit(const Cursor& cursor, const Token& number, const Token& word) {
    struct Unit {
        std::string_view name;
        double length_m;
    };
    constexpr Unit units[] = {{"feet", foot_m},   {"foot", foot_m}, {"ft", foot_m},    {"inch", inch_m},
                              {"inches", inch_m}, {"yard", yard_m}, {"yards", yard_m}, {"meter", 1},
                              {"meters", 1},      {"metre", 1},     {"metres", 1}};
    const auto unit = std::ranges::find(units, cursor.text(word), &Unit::name);
    if (unit == std::end(units)) return {};
    const double length_m = decimalOf(cursor.text(number)) * unit->length_m;
    return Hint{join(cursor.span(number), cursor.span(word)), quoted(cursor.text(word)) + " is no unit",
                "write " + quoted(fmt::format("{:.4g}m", length_m))};
}

/// What stands behind the argument of an operation and begins none: `extrude 5 feet House`, `extrude House 5`.
std::optional<Hint> behindOperation(const Cursor& cursor, std::string_view message) {
    const Token token = cursor.peek(), last = cursor.previous(1), first = cursor.previous(2);
    if (!message.ends_with("can't follow a shape") || last.kind != Token::Kind::Word) return {};
    if (first.kind == Token::Kind::Number) return foreignUnit(cursor, first, last);
    const Operation* operation = cursor.operations().find(cursor.text(first));
    const bool takesLength =
        operation && !operation->arguments.empty() && operation->arguments[0].type == ArgumentType::Length;
    const char initial = cursor.text(last)[0];
    if (!takesLength || token.kind != Token::Kind::Number || initial < 'A' || initial > 'Z') return {};
    const std::string name(cursor.text(first)), shape(cursor.text(last)), number(cursor.text(token));
    return Hint{join(cursor.span(first), cursor.span(token)), quoted(name) + " says its length before the shape",
                "write " + quoted(name + " " + number + " " + shape)};
}

/// A direction in capitals, or with a blank behind its sign, where a joint stands: `at +Y`, `at + y`.
std::optional<Hint> misspeltAxis(const Cursor& cursor, std::string_view message) {
    if (!cursor.at("+") && !cursor.at("-")) return {};
    const std::string_view axis = cursor.peekText(1);
    const bool isAxis = axis.size() == 1 && std::string_view("xyzXYZ").find(axis) != std::string_view::npos;
    const bool isJoint = message.find(" needs a joint, found") != std::string_view::npos;
    if (!isAxis || !(isJoint || message.starts_with("a number has no '+'"))) return {};
    const SourceSpan span = join(cursor.span(cursor.peek()), cursor.span(cursor.peek(1)));
    const char small = static_cast<char>(axis[0] >= 'a' ? axis[0] : axis[0] - 'A' + 'a');
    return Hint{span, "unknown joint " + quoted(span.text()),
                "write " + quoted(std::string(cursor.peekText()) + small)};
}

/// What stands between or behind numbers and doesn't belong there: `2,5`, `10 m`, `(20; 12; 6)`, `1 to 5`.
std::optional<Hint> besideNumber(const Cursor& cursor, std::string_view message) {
    if (auto comma = decimalComma(cursor)) return comma;
    const Token token = cursor.peek(), number = cursor.previous(1);
    const std::string_view text = cursor.text(token);
    if (number.kind != Token::Kind::Number) return {};
    const std::string written(cursor.text(number));
    constexpr std::string_view units[] = {"m", "cm", "mm", "km", "deg"};
    const bool isPlain = written.find_first_not_of("0123456789.") == std::string::npos;
    if (isPlain && !token.glued && std::ranges::find(units, text) != std::end(units))
        return Hint{join(cursor.span(number), cursor.span(token)), "a unit stands behind its number without a space",
                    "write " + quoted(written + std::string(text))};
    if (isPlain && token.kind == Token::Kind::Word)
        if (auto foreign = foreignUnit(cursor, number, token)) return foreign;
    if (isPlain && token.kind == Token::Kind::Text && token.glued && text.starts_with('"')) {
        const double length_m = decimalOf(written) * inch_m;
        SourceSpan mark = cursor.span(token);
        mark.end = mark.begin + 1;
        return Hint{join(cursor.span(number), mark), "'\"' is no unit",
                    "write " + quoted(fmt::format("{:.4g}m", length_m))};
    }
    if (text == ";" && message.starts_with("expected ')'"))
        return Hint{cursor.span(token), "';' doesn't stand between numbers", "write ','"};
    if (token.kind == Token::Kind::Word && !token.glued && message.starts_with("expected ')'") &&
        (cursor.at(",", 1) || cursor.at(")", 1)))
        return Hint{join(cursor.span(number), cursor.span(token)), "a number and a name stand side by side",
                    "put '*' between them: " + quoted(written + " * " + std::string(text))};
    if (text == "to" && message.starts_with("unexpected") && cursor.at(Token::Kind::Number, 1))
        return Hint{cursor.span(token), "a range has '..' between its ends",
                    "write " + quoted(written + ".." + std::string(cursor.peekText(1)))};
    return {};
}

/// A part of a block behind another one without '|', or a range of a parameter without 'in'.
std::optional<Hint> withoutWord(const Cursor& cursor, std::string_view message) {
    const Token token = cursor.peek();
    const std::string found = quoted(cursor.text(token));
    const bool isLabel = token.kind == Token::Kind::Word || token.kind == Token::Kind::Number;
    if (isLabel && cursor.at(":", 1) &&
        (message.ends_with("can't follow a shape") || message.starts_with("expected a shape")))
        return Hint{cursor.span(token),
                    found + (cursor.text(cursor.previous(1)) == "," ? " stands behind ','" : " can't follow a shape"),
                    "the parts of a block are set apart by '|': write " +
                        quoted("| " + std::string(cursor.text(token)) + ": …")};
    if (token.kind == Token::Kind::Word && cursor.text(cursor.previous(2)) == ".." && message.starts_with("unexpected"))
        return Hint{cursor.span(token), "unexpected " + found,
                    "a label stands in quotes: write " + quoted("\"" + std::string(cursor.text(token)) + "\"")};
    if (token.kind == Token::Kind::Number && cursor.at("..", 1) && cursor.at(Token::Kind::Number, 2) &&
        message.starts_with("unexpected"))
        return Hint{
            cursor.span(token), "unexpected " + found,
            "write " + quoted("in " + std::string(cursor.text(token)) + ".." + std::string(cursor.peekText(2)))};
    return {};
}

/// A call of what other programs have: `translate (1, 2, 3) cube`, `translate([1, 2, 3]) cube`, `union() { … }`.
std::optional<Hint> foreignCall(const Cursor& cursor, std::string_view message) {
    const Token last = cursor.previous(1);
    const std::string_view before = cursor.text(last);
    const bool isBehind = before == ")" && (cursor.at("{") || message.ends_with("can't follow a shape"));
    const bool isWithin = cursor.at("[") && before == "(";
    const bool isName = last.kind == Token::Kind::Word && (cursor.at("{") || cursor.at("("));
    if (!isBehind && !isWithin && !isName) return {};
    const Token word = cursor.previous(isBehind ? std::max<size_t>(calleeBefore(cursor), 1) : isWithin ? 2 : 1);
    const std::string fix = foreignAttributeHint(cursor.text(word));
    if (fix.empty()) return {};
    const bool isAttribute = fix == "write 'move'" || fix == "write 'turn'" || fix == "write 'size'";
    return Hint{cursor.span(word), "there is no " + quoted(cursor.text(word)),
                fix + (isAttribute ? " behind a shape" : "")};
}

/// Extents as arguments: `cube (10, 10, 10)`.
std::optional<Hint> extentsBehindName(const Cursor& cursor, std::string_view message) {
    const Token name = cursor.previous(1);
    if (!cursor.at("(") || !message.ends_with("can't follow a shape") || name.kind != Token::Kind::Word) return {};
    constexpr std::string_view shape[] = {",", ",", ")"};
    for (size_t i = 0; i < std::size(shape); ++i)
        if (!cursor.at(Token::Kind::Number, 1 + 2 * i) || !cursor.at(shape[i], 2 + 2 * i)) return {};
    const SourceSpan extents = join(cursor.span(cursor.peek()), cursor.span(cursor.peek(6)));
    if (extents.text().find("deg") != std::string_view::npos) return {};
    return Hint{extents, std::string(message),
                "write " + quoted(std::string(cursor.text(name)) + " size " + std::string(extents.text()))};
}

/// A row of the table of forms.
std::optional<Hint> foreignForm(const Cursor& cursor, std::string_view message) {
    const std::string_view before = cursor.text(cursor.previous(1));
    for (const ForeignForm& row : foreignForms)
        if (cursor.at(row.token) && message.starts_with(row.refusal) && (row.before.empty() || row.before == before))
            return Hint{cursor.span(cursor.peek()), std::string(row.instead.empty() ? message : row.instead),
                        std::string(row.hint)};
    return {};
}

/// Words and forms of other shape grammars: `comp(f) { … }`, `case x > 5: …`, `30%: …` as a body,
/// `size 10 10 10`.
std::optional<Hint> ofOtherGrammars(const Cursor& cursor, std::string_view message) {
    const Token token = cursor.peek(), last = cursor.previous(1);
    const std::string found = quoted(cursor.text(token));
    if (cursor.at("{") && cursor.text(last) == ")" && calledBefore(cursor) == "comp")
        return Hint{cursor.span(token), "there is no 'comp'", foreignAttributeHint("comp")};
    if (cursor.text(last) == "case" && message.ends_with("can't follow a shape"))
        return Hint{cursor.span(last), "there is no 'case'",
                    "a rule's condition stands before '->': 'rule B when … -> …'; " + std::string(ifHint)};
    if (auto call = foreignCall(cursor, message)) return call;
    if (cursor.at("weight") && message.starts_with("unexpected") && cursor.at(Token::Kind::Number, 1))
        return Hint{cursor.span(token), "unexpected 'weight'",
                    "a rule's weight stands before '->': write " +
                        quoted("weight " + std::string(cursor.peekText(1)) + " -> …")};
    if (cursor.text(last) == "->" && token.kind == Token::Kind::Number && cursor.at(":", 1))
        return Hint{cursor.span(token), "expected a shape, found " + found,
                    "write 'choose { 3: this | 7: that }', or two rules with 'weight 3' and 'weight 7'"};
    const std::string_view attribute = cursor.text(cursor.previous(2));
    if (token.kind == Token::Kind::Number && last.kind == Token::Kind::Number && !cursor.at(":", 1) &&
        (attribute == "size" || attribute == "move" || attribute == "turn")) {
        const std::string third(cursor.at(Token::Kind::Number, 1) ? cursor.peekText(1) : "…");
        return Hint{cursor.span(token), found + " can't follow a shape",
                    "a vector stands in parentheses: write " +
                        quoted(std::string(attribute) + " (" + std::string(cursor.text(last)) + ", " +
                               std::string(cursor.text(token)) + ", " + third + ")")};
    }
    if (auto extents = extentsBehindName(cursor, message)) return extents;
    if (auto form = foreignForm(cursor, message)) return form;
    return behindOperation(cursor, message);
}

Hint unknownCharacter(const Cursor& cursor) {
    const std::string_view bytes = cursor.peekText();
    Hint hint{cursor.span(cursor.peek()), "unexpected character " + quoted(bytes), {}};
    for (const Lookalike& row : lookalikes)
        if (bytes.substr(0, row.bytes.size()) == row.bytes) hint.hint = std::string(row.hint);
    if (bytes == "'" && cursor.at(Token::Kind::Number, 1) && cursor.peek(1).glued) {
        const double share = decimalOf(cursor.peekText(1));
        hint.hint = "a share is written in percent: write " + quoted(fmt::format("{:.6g}%", share * 100));
    }
    const Token last = cursor.previous(1);
    if (bytes == "'" && last.kind == Token::Kind::Number && cursor.peek().glued) {
        const double feet = decimalOf(cursor.text(last));
        return {join(cursor.span(last), cursor.span(cursor.peek())),
                quoted(std::string(cursor.text(last)) + "'") + " is no length",
                "write " + quoted(fmt::format("{:.4g}m", feet * foot_m))};
    }
    const bool beyondAscii = static_cast<unsigned char>(bytes.front()) >= 0x80;
    if (hint.hint.empty() && beyondAscii)
        hint.hint = "names are made of a-z, A-Z, 0-9 and _; text in quotes may hold anything";
    return hint;
}

}  // namespace

std::optional<Hint> findHint(const Cursor& cursor, std::string_view message) {
    const Token token = cursor.peek();
    const std::string_view text = cursor.text(token), before = cursor.text(cursor.previous(1));
    if (token.kind == Token::Kind::Unknown) return unknownCharacter(cursor);
    if (auto beside = besideNumber(cursor, message)) return beside;
    if (auto other = ofOtherGrammars(cursor, message)) return other;
    if (auto without = withoutWord(cursor, message)) return without;
    if (auto axis = misspeltAxis(cursor, message)) return axis;
    if (text == "+" && message.starts_with("a number has no '+'") && cursor.peekText(1).size() == 1 &&
        cursor.at(Token::Kind::Word, 1))
        return Hint{cursor.span(token), "unknown joint " + quoted("+" + std::string(cursor.peekText(1))),
                    "faces are '+x', '-x', '+y', '-y', '+z' and '-z'"};
    if (token.kind == Token::Kind::Color && (text == "#" || token.columnOne))
        return Hint{cursor.span(token), "a comment doesn't begin with '#'",
                    "a comment begins with '//' and ends with its line"};
    if (text == "if" && !(cursor.at("(", 1) && cursor.peek(1).glued))
        return Hint{cursor.span(token), "there is no 'if' here", std::string(ifHint)};
    if (before == "if") return Hint{cursor.span(cursor.previous(1)), "there is no 'if' here", std::string(ifHint)};
    if (text == "{" && before == ")" && calledBefore(cursor) == "if")
        return Hint{cursor.span(token), "there is no 'if' here", std::string(ifHint)};
    if (before == "roof" && std::find(std::begin(roofForms), std::end(roofForms), text) != std::end(roofForms))
        return Hint{cursor.span(token), "'roof' has no form " + quoted(text),
                    "write " + quoted(std::string(text) + "Roof")};
    if (cursor.text(cursor.previous(3)) == "at" && (before == "+" || before == "-")) {
        const Token axis = cursor.previous(2);
        const std::string_view name = cursor.text(axis);
        if (name == "x" || name == "y" || name == "z")
            return Hint{cursor.span(axis), quoted(std::string(name) + std::string(before)) + " is no direction",
                        "write " + quoted(std::string(before) + std::string(name))};
    }
    if (text == "or" && cursor.text(cursor.previous(3)) == "at")
        return Hint{cursor.span(token), "'at' takes one joint",
                    "write " +
                        quoted("choose { 1: " + std::string(cursor.text(cursor.previous(2))) + std::string(before) +
                               " | 1: " + std::string(cursor.peekText(1)) + std::string(cursor.peekText(2)) + " }") +
                        " for either of them"};
    const bool isShare = text.starts_with('.') || text.starts_with("0.");
    if (token.kind == Token::Kind::Number && isShare && cursor.text(cursor.previous(2)) == "morph")
        return Hint{cursor.span(token), quoted(text) + " can't follow a shape",
                    "write " + quoted("by " + std::string(text))};
    if (token.kind == Token::Kind::Number && before == "," && cursor.previous(2).kind == Token::Kind::Number &&
        (cursor.text(cursor.previous(3)) == "size" || cursor.text(cursor.previous(3)) == "move") && !cursor.at(":", 1))
        return Hint{cursor.span(token), "expected a shape, found " + quoted(text),
                    "a vector stands in parentheses, as in " +
                        quoted(std::string(cursor.text(cursor.previous(3))) + " (" +
                               std::string(cursor.text(cursor.previous(2))) + ", " + std::string(text) + ", " +
                               (cursor.at(",", 1) && cursor.at(Token::Kind::Number, 2) ? std::string(cursor.peekText(2))
                                                                                       : "1") +
                               ")")};
    if (text == ":" && before == "}" && message.starts_with("unexpected"))
        return Hint{cursor.span(token), "unexpected ':'",
                    "a name for rules stands behind a shape, within the braces or behind parentheses: "
                    "'{ cube : Part }', '(a + b) : Part'"};
    return std::nullopt;
}

}  // namespace sgm::syntax
