#include "grammar/syntax/expressions.h"

#include <algorithm>
#include <charconv>
#include <numbers>

#include "grammar/syntax/foreign_lengths.h"
#include "modeler/core/printable.h"

namespace sgm::syntax {
namespace {

using Kind = Expr::Kind;

constexpr std::string_view reserved[] = {"grammar", "use",     "param",   "map",    "terminal", "start",  "rule",
                                         "derive",  "lsystem", "roads",   "style",  "check",    "for",    "while",
                                         "when",    "choose",  "finally", "repeat", "beside",   "weight", "and",
                                         "or",      "not",     "in",      "expect"};

// An expression's tree is at most this many operators and the levels of nesting deep, whatever the file says: those who
// walk it recurse.
constexpr int mostOperators = 400;

/// A binary operator and how tightly it binds. Where `symbol` isn't what it `means`, another language writes it so.
struct BinaryOperator {
    std::string_view symbol, means;
    int binds;
};
enum : int { rampBinds = 1, rangeBinds, orBinds, andBinds, comparisonBinds, sumBinds, productBinds, signBinds };
constexpr BinaryOperator binaryOperators[] = {
    {"~>", "~>", rampBinds},       {"..", "..", rangeBinds},      {"or", "or", orBinds},
    {"||", "or", orBinds},         {"and", "and", andBinds},      {"&&", "and", andBinds},
    {"==", "==", comparisonBinds}, {"=", "==", comparisonBinds},  {"!=", "!=", comparisonBinds},
    {"<=", "<=", comparisonBinds}, {">=", ">=", comparisonBinds}, {"<", "<", comparisonBinds},
    {">", ">", comparisonBinds},   {"+", "+", sumBinds},          {"-", "-", sumBinds},
    {"*", "*", productBinds},      {"/", "/", productBinds},      {"%", "%", productBinds},
};

/// a < b < c, a .. b .. c and a ~> b ~> c mean nothing.
constexpr bool chains(int binds) { return binds != comparisonBinds && binds != rangeBinds && binds != rampBinds; }

const BinaryOperator* findBinary(std::string_view symbol) {
    const auto row = std::find_if(std::begin(binaryOperators), std::end(binaryOperators),
                                  [&](const BinaryOperator& o) { return o.symbol == symbol; });
    return row == std::end(binaryOperators) ? nullptr : row;
}

constexpr bool isAxisLetter(std::string_view word) { return word == "x" || word == "y" || word == "z"; }

/// +x or -z: one word for a joint or an axis.
bool atAxis(const Cursor& cursor) {
    return (cursor.at("+") || cursor.at("-")) && isAxisLetter(cursor.peekText(1)) && cursor.peek(1).glued;
}

/// A number with six digits at most, for a hint.
std::string plain(double number) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

/// False where a byte belongs to no character.
bool isUtf8(std::string_view text) {
    const std::string shown = printable(text);
    for (size_t i = 0; i < text.size(); ++i)
        if (static_cast<unsigned char>(text[i]) >= 0x80 && shown[i] == '?') return false;
    return true;
}

/// Reads one expression and counts its operators.
class Reader {
public:
    explicit Reader(Cursor& cursor) : cursor_(cursor) {}

    Expr binary(int binds) {
        Expr left = unary(binds);
        while (!cursor_.failed()) {
            const BinaryOperator* row = findBinary(cursor_.peekText());
            if (!row || row->binds < binds || tooLong()) break;
            const Token symbol = cursor_.take();
            if (row->symbol != row->means)
                cursor_.complain(cursor_.span(symbol), quoted(row->symbol) + " is no operator of an expression",
                                 "write " + quoted(row->means) + (row->symbol == "=" ? ", or 'name: …'" : ""));
            left = joined(*row, std::move(left), binary(row->binds + 1));
            const BinaryOperator* again = findBinary(cursor_.peekText());
            if (again && again->binds == row->binds && !chains(row->binds))
                cursor_.fail(quoted(cursor_.peekText()) + " can't follow " + quoted(row->means), "group with ( )");
        }
        return left;
    }

    /// NAME, or NAME( … ) with the parenthesis glued on. `roads` is a figure of checks as well as a reserved word.
    Expr nameOrCall() {
        const uint32_t begin = cursor_.peek().begin;
        Expr e;
        e.kind = Kind::Name;
        e.text = cursor_.at("roads") ? std::string(cursor_.text(cursor_.take())) : readName(cursor_, "a value").text;
        e.span = cursor_.since(begin);
        if (!cursor_.at("(") || !cursor_.peek().glued) return e;
        e.kind = Kind::Call;
        const Token open = cursor_.take(Token::Role::Suffix);
        if (!cursor_.at(")")) arguments(e);
        cursor_.close(open);
        e.span = cursor_.since(begin);
        return e;
    }

    /// simple [.. simple] [~> simple [.. simple]]
    Expr argument() {
        Expr first = range();
        if (!cursor_.at("~>")) return first;
        cursor_.take();
        return joined(*findBinary("~>"), std::move(first), range());
    }

private:
    /// A literal, a name, a call, or something in parentheses, perhaps with a sign.
    Expr simple() {
        const Cursor::Nest nest(cursor_);
        if (cursor_.at("-") && !atAxis(cursor_)) return prefixed("-", [this] { return simple(); });
        return postfix();
    }

    Expr range() {
        Expr first = simple();
        if (!cursor_.at("..")) return first;
        cursor_.take();
        return joined(*findBinary(".."), std::move(first), simple());
    }

    bool tooLong() {
        if (++operators_ <= mostOperators) return false;
        cursor_.fail("more than " + std::to_string(mostOperators) + " operators in one expression",
                     "name a part of it");
        return true;
    }

    static Expr joined(const BinaryOperator& row, Expr left, Expr right) {
        Expr e;
        e.kind = row.binds == rampBinds ? Kind::Ramp : row.binds == rangeBinds ? Kind::Range : Kind::Binary;
        if (e.kind == Kind::Binary) e.text = std::string(row.means);
        e.span = join(left.span, right.span);
        e.args.push_back(std::move(left));
        e.args.push_back(std::move(right));
        return e;
    }

    template <class Operand>
    Expr prefixed(std::string_view symbol, Operand operand) {
        Expr e;
        e.kind = symbol == "~" ? Kind::Floating : Kind::Unary;
        if (e.kind == Kind::Unary) e.text = std::string(symbol);
        // `- x` negates a value called x, `-x` is a joint: the blank tells them apart.
        const bool joins = symbol != "not" && !isAxisLetter(cursor_.peekText(1));
        const uint32_t begin = cursor_.take(joins ? Token::Role::Prefix : Token::Role::Plain).begin;
        e.args.push_back(operand());
        e.span = cursor_.since(begin);
        return e;
    }

    Expr unary(int binds) {
        const Cursor::Nest nest(cursor_);
        if (cursor_.at("not") && binds <= comparisonBinds)
            return prefixed("not", [this] { return binary(comparisonBinds); });
        if (cursor_.at("!")) {
            cursor_.complain(cursor_.span(cursor_.peek()), "'!' is no operator of an expression", "write 'not'");
            return prefixed("not", [this] { return unary(comparisonBinds); });
        }
        if (cursor_.at("-") && !atAxis(cursor_)) return prefixed("-", [this] { return unary(signBinds); });
        return postfix();
    }

    Expr postfix() {
        const uint32_t begin = cursor_.peek().begin;
        Expr e = primary();
        while (!cursor_.failed() && (cursor_.at("[") || cursor_.at("."))) {
            if (tooLong()) break;
            Expr outer;
            // '92m .x' without its blank is another number.
            if (e.kind == Kind::Number && cursor_.at(".") && cursor_.at(Token::Kind::Word, 1))
                return cursor_.fail("a number has no members", "take the '.' out, or write 'scope.x'"), e;
            const Token symbol = cursor_.take(Token::Role::Tight);
            if (cursor_.text(symbol) == "[") {
                outer.kind = Kind::Index;
                outer.args.push_back(std::move(e));
                outer.args.push_back(binary(rampBinds));
                cursor_.close(symbol);
            } else {
                outer.kind = Kind::Member;
                outer.args.push_back(std::move(e));
                outer.text = readName(cursor_, "a member").text;
            }
            outer.span = cursor_.since(begin);
            e = std::move(outer);
        }
        return e;
    }

    Expr primary() {
        const Token token = cursor_.peek();
        Expr e;
        if (atAxis(cursor_)) {
            e.kind = Kind::Name;
            cursor_.take(Token::Role::Prefix);
            cursor_.take();
            e.span = cursor_.since(token.begin);
            e.text = e.span.text();
            return e;
        }
        switch (token.kind) {
            case Token::Kind::Number:
                return number();
            case Token::Kind::Text:
                return text();
            case Token::Kind::Color:
                return color();
            case Token::Kind::Word:
                return cursor_.at("choose") ? choice() : nameOrCall();
            default:
                break;
        }
        if (cursor_.at("~")) return prefixed("~", [this] { return floatingSize(); });
        if (cursor_.at("(")) return parenthesised();
        e.span = cursor_.span(token);
        if (cursor_.at("+"))
            cursor_.fail("a number has no '+' before it", "leave '+' out");
        else
            cursor_.fail("expected a value, found " + cursor_.found());
        return e;
    }

    /// What follows '~': a calculation without parentheses is reported, and read as it was meant.
    Expr floatingSize() {
        const uint32_t begin = cursor_.peek().begin;
        Expr e = simple();
        if (!cursor_.at("*") && !cursor_.at("/") && !cursor_.at("+") && !cursor_.at("-")) return e;
        const Token symbol = cursor_.take();
        e = joined(*findBinary(cursor_.text(symbol)), std::move(e), binary(sumBinds));
        const SourceSpan span = cursor_.since(begin);
        cursor_.complain(span, "a calculated size stands in parentheses",
                         "write " + quoted("~(" + std::string(span.text()) + ")"));
        return e;
    }

    Expr number() {
        const Token token = cursor_.take();
        const std::string_view written = cursor_.text(token);
        Expr e;
        e.kind = Kind::Number;
        e.span = cursor_.span(token);
        const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), e.number);
        if (error != std::errc()) cursor_.complain(e.span, "the number " + quoted(written) + " can't be held");
        e.unit = written.substr(static_cast<size_t>(end - written.data()));
        checkUnit(e);
        if (cursor_.at(".") && cursor_.peek().glued)
            cursor_.fail("a number doesn't end with a dot", "write " + quoted(std::string(written) + ".0"));
        return e;
    }

    void checkUnit(Expr& number) {
        constexpr std::string_view units[] = {"", "m", "km", "cm", "mm", "m2", "m²", "m3", "m³", "deg", "%", "/m"};
        if (std::find(std::begin(units), std::end(units), number.unit) != std::end(units)) return;
        std::string hint = "a number is plain or has m, km, cm, mm, m2, m3, deg, % or /m";
        if (const bool feet = number.unit == "ft"; feet || number.unit == "in")
            hint = "write " + quoted(plain(number.number * (feet ? foot_m : inch_m)) + "m");
        if (number.unit == "rad")
            hint = "angles are in degrees: write " + quoted(plain(number.number * 180 / std::numbers::pi) + "deg");
        cursor_.complain(number.span, "there is no unit " + quoted(number.unit), hint);
        number.unit.clear();
    }

    Expr text() {
        const Token token = cursor_.take();
        std::string_view written = cursor_.text(token).substr(1);
        Expr e;
        e.kind = Kind::Text;
        e.span = cursor_.span(token);
        if (!isUtf8(written)) cursor_.warn(e.span, "this text is no UTF-8", "save the file as UTF-8");
        for (size_t i = 0; i < written.size(); ++i) {
            const bool escape = written[i] == '\\' && i + 1 < written.size();
            if (!escape && written[i] == '"') return e;
            if (escape && (written[i + 1] == '"' || written[i + 1] == '\\'))
                ++i;
            else if (escape)
                cursor_.complain(e.span, "unknown escape " + quoted(written.substr(i, 2)) + " in a text",
                                 "only \\\" and \\\\ are escapes");
            e.text += written[i];
        }
        cursor_.complain(e.span, "the text has no end", "close it with '\"' on the same line");
        return e;
    }

    Expr color() {
        const Token token = cursor_.take();
        const std::string_view digits = cursor_.text(token).substr(1);
        Expr e;
        e.kind = Kind::Color;
        e.span = cursor_.span(token);
        uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
        if (digits.size() != 6 || error != std::errc() || end != digits.data() + digits.size())
            cursor_.complain(e.span, quoted(cursor_.text(token)) + " is no colour", "write '#' and six hex digits");
        else
            e.number = value;
        return e;
    }

    /// [name:] expr {, [name:] expr}
    void arguments(Expr& call) {
        do {
            std::string name;
            if (cursor_.at(Token::Kind::Word) && cursor_.at(":", 1)) {
                name = cursor_.text(cursor_.take());
                cursor_.take(Token::Role::Suffix);
            }
            call.argNames.push_back(std::move(name));
            call.args.push_back(binary(rampBinds));
        } while (cursor_.accept(","));
    }

    /// choose { weight: value {| weight: value} }
    Expr choice() {
        Expr e;
        e.kind = Kind::Choose;
        const uint32_t begin = cursor_.take().begin;
        if (cursor_.at(Token::Kind::Word) && isSeries(cursor_.peekText())) e.text = cursor_.text(cursor_.take());
        const Token open = cursor_.peek();
        e.span = cursor_.since(begin);
        if (!cursor_.expect("{", "after 'choose'", "as in 'choose { 3: +x | 1: -z }'")) return e;
        do {
            e.args.push_back(binary(rampBinds));
            if (!cursor_.accept(":", Token::Role::Suffix)) cursor_.expect(":", "and a value after the weight");
            e.args.push_back(binary(rampBinds));
        } while (cursor_.accept("|"));
        cursor_.close(open);
        e.span = cursor_.since(begin);
        return e;
    }

    /// ( expr ) is that expression, ( a, b ) a tuple; either spans its parentheses.
    Expr parenthesised() {
        const Token open = cursor_.take();
        Expr tuple;
        tuple.kind = Kind::Tuple;
        do tuple.args.push_back(binary(rampBinds));
        while (cursor_.accept(","));
        cursor_.close(open);
        Expr e = tuple.args.size() == 1 ? Expr(std::move(tuple.args[0])) : std::move(tuple);
        e.span = cursor_.since(open.begin);
        return e;
    }

    Cursor& cursor_;
    int operators_ = 0;
};

}  // namespace

Expr readExpr(Cursor& cursor) { return Reader(cursor).binary(rampBinds); }

Expr readArgument(Cursor& cursor) { return Reader(cursor).argument(); }

Expr readSolid(Cursor& cursor) {
    if (cursor.at(Token::Kind::Word)) return Reader(cursor).nameOrCall();
    cursor.fail("expected a solid or a symbol, found " + cursor.found());
    return {};
}

bool startsArgument(const Cursor& cursor) {
    switch (cursor.peek().kind) {
        case Token::Kind::Number:
        case Token::Kind::Text:
        case Token::Kind::Color:
            return true;
        case Token::Kind::Word:
            return !isReserved(cursor.peekText()) || cursor.at("choose");
        default:
            return cursor.at("(") || cursor.at("~") || cursor.at("-") || atAxis(cursor);
    }
}

Name readName(Cursor& cursor, std::string_view what) {
    if (!cursor.at(Token::Kind::Word)) {
        cursor.fail("expected the name of " + std::string(what) + ", found " + cursor.found());
        return {};
    }
    if (isReserved(cursor.peekText())) {
        cursor.fail(cursor.found() + " is a word of the language and can't name " + std::string(what));
        return {};
    }
    const Token token = cursor.take();
    return {std::string(cursor.text(token)), cursor.span(token)};
}

bool isSeries(std::string_view word) { return word == "distinct" || word == "shuffled"; }

bool isReserved(std::string_view word) {
    return std::find(std::begin(reserved), std::end(reserved), word) != std::end(reserved);
}

}  // namespace sgm::syntax
