// Expressions: names found, units checked, constants folded.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "grammar/rules/checker.h"
#include "grammar/rules/color.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/conventions.h"
#include "modeler/core/random.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using Where = Place::Where;

constexpr std::array<std::string_view, 7> axisWords{"+x", "-x", "+y", "-y", "+z", "-z", "centre"};
constexpr std::array<std::string_view, 7> figureWords{"bonds", "overlaps", "shapes", "terminals", "classic", "morphic", "floating"};

Typed constantOf(SourceSpan span, Value value) {
    const Type type = Type::of(value);
    return {makeConstant(span, std::move(value)), type};
}

/// Stands for what was refused: it has no number that another check could complain about.
Expr unreadable(SourceSpan span) {
    Expr e;
    e.kind = Expr::Kind::Local;
    e.span = span;
    return e;
}

/// Numbers as their place understands them: bare lengths are metres, and only counts stay whole.
void adapt(Expr& e, Want want) {
    if (want == Want::Anything || want == Want::Count || want == Want::Truth) return;
    if (e.kind == Expr::Kind::Constant && (e.value.kind == Value::Kind::Number || e.value.kind == Value::Kind::Vector)) {
        e.value.integer = false;
        const Unit bare = want == Want::Length || want == Want::Size ? Unit::Metre : want == Want::Frequency ? Unit::PerMetre : Unit::None;
        for (size_t i = 0; i < std::min<size_t>(e.value.count, e.value.units.size()); ++i)
            if (e.value.units[i] == Unit::None) e.value.units[i] = bare;
    }
    if (e.kind == Expr::Kind::Tuple || e.kind == Expr::Kind::Range || e.kind == Expr::Kind::Ramp)
        for (Expr& arg : e.args) adapt(arg, want);
}

bool takesThree(Want want) { return want == Want::Size || want == Want::Offset || want == Want::Triple || want == Want::Angles; }
bool isZero(const Expr& e) { return e.kind == Expr::Kind::Constant && e.value.kind == Value::Kind::Number && e.value.num() == 0 && e.value.units[0] == Unit::None; }

struct BinaryRow {
    std::string_view text;
    Fn fn;
    std::string_view verb;
};
constexpr std::array<BinaryRow, 13> binaryRows{{{"+", Fn::Add, "add"}, {"-", Fn::Sub, "subtract"}, {"*", Fn::Mul, "multiply"},
    {"/", Fn::Div, "divide"}, {"%", Fn::Rem, "divide"}, {"<", Fn::Less, "compare"}, {"<=", Fn::LessEq, "compare"},
    {">", Fn::Greater, "compare"}, {">=", Fn::GreaterEq, "compare"}, {"==", Fn::Equal, "compare"},
    {"!=", Fn::NotEqual, "compare"}, {"and", Fn::And, "join"}, {"or", Fn::Or, "join"}}};

const BinaryRow& binaryRow(std::string_view text) {
    const auto row = std::find_if(binaryRows.begin(), binaryRows.end(), [&](const BinaryRow& r) { return r.text == text; });
    return row == binaryRows.end() ? binaryRows[0] : *row;
}

}  // namespace

int axisNumber(std::string_view word) {
    const auto axis = std::find(axisWords.begin(), axisWords.end(), word == "center" ? "centre" : word);
    return axis == axisWords.end() ? -1 : static_cast<int>(axis - axisWords.begin());
}

Typed Checker::failed(SourceSpan span, std::string message, std::string mend) {
    diagnostics_.error(span, std::move(message), std::move(mend));
    Typed result;
    result.expr.span = span;
    result.type = Type::unknown();
    return result;
}

Typed Checker::unknown(SourceSpan span, const std::string& word, std::string message, std::string mend) {
    if (!anythingExcused_ && !excused_.contains(word)) return failed(span, std::move(message), std::move(mend));
    return {makeConstant(span, {}), Type::unknown()};
}

/// `kind` over `args`, folded where everything is constant; its type is that of the samples.
Typed Checker::applied(Expr::Kind kind, Fn fn, SourceSpan span, std::vector<Typed> args) {
    Typed result;
    result.expr.kind = kind;
    result.expr.span = span;
    result.expr.index = static_cast<uint32_t>(fn);
    std::vector<Value> samples;
    for (Typed& arg : args) {
        result.type.known = result.type.known && arg.type.known;
        samples.push_back(arg.type.like);
        result.expr.args.push_back(std::move(arg.expr));
    }
    if (!result.type.known) return {std::move(result.expr), Type::unknown()};
    result.type = Type::of(applyFunction(fn, samples));
    if (auto value = fold(result.expr, {})) return constantOf(span, std::move(*value));
    return result;
}

bool Checker::asks(const Typed& value, Want want, std::string_view what, const Written* written) {
    if (fits(value.type, want)) return true;
    const bool angle = want == Want::Angle || want == Want::Angles;
    if (angle && isZero(value.expr)) return true;
    std::string mend;
    if (written && written->kind == Written::Kind::Number) {
        const std::string digits = fmt::format("{:.12g}", written->number);
        if (angle) mend = fmt::format("write '{}deg'", digits);
        if (want == Want::Length && value.type.like.units[0] == Unit::Share) mend = fmt::format("write a length such as '{}m'", digits);
    }
    if (want == Want::Count && value.type.like.kind == Value::Kind::Number && value.type.like.units[0] == Unit::None)
        mend = "write 'round(…)' around it";
    const std::string got = want == Want::Count && !mend.empty() ? "may have a fraction" : "is " + describe(value.type);
    diagnostics_.error(value.expr.span, fmt::format("{} takes {}, but this {}", what, describe(want), got), std::move(mend));
    return false;
}

bool Checker::alike(const Typed& a, const Typed& b, std::string_view verb) {
    if (!a.type.known || !b.type.known) return true;
    const auto say = [&](const Typed& at, std::string message) {
        diagnostics_.error(at.expr.span, std::move(message));
        return false;
    };
    if (!a.type.numeric()) return say(a, fmt::format("can't {} {}", verb, describe(a.type)));
    if (!b.type.numeric()) return say(b, fmt::format("can't {} {}", verb, describe(b.type)));
    if (compatible(a.type, b.type)) return true;
    diagnostics_.error(syntax::join(a.expr.span, b.expr.span), fmt::format("can't {} {} and {}", verb, describe(a.type), describe(b.type)));
    return false;
}

Typed Checker::number(const Written& e) {
    Value value = Value::number(e.number);
    value.integer = e.unit.empty() && e.span.text().find_first_of(".eE") == std::string_view::npos;
    if (e.unit == "m") value.units[0] = Unit::Metre;
    if (e.unit == "/m") value.units[0] = Unit::PerMetre;
    if (e.unit == "deg") value = Value::number(radians(e.number), Unit::Angle);
    if (e.unit == "%") value = Value::number(e.number / 100, Unit::Share);
    return constantOf(e.span, value);
}

Typed Checker::unknownName(const Place& place, const Written& e) {
    std::vector<std::string> known;
    for (const auto& [param, index] : params_) known.push_back(param);
    for (const auto& local : place.locals) known.push_back(local.name);
    known.insert(known.end(), withNames_.begin(), withNames_.end());
    if (place.where == Where::Expect) known.assign(figureWords.begin(), figureWords.end());
    std::string mend = nearest(e.text, known);
    if (e.text == "i") mend = "'i' counts the steps inside a rule with 'repeat'";
    if (symbols_.contains(e.text)) return failed(e.span, fmt::format("'{}' is a shape, not a value", e.text));
    return unknown(e.span, e.text, fmt::format("unknown name '{}'", e.text), std::move(mend));
}

Typed Checker::name(Place& place, const Written& e) {
    for (auto local = place.locals.rbegin(); local != place.locals.rend(); ++local)
        if (local->name == e.text) {
            Typed result;
            result.expr.kind = Expr::Kind::Local;
            result.expr.span = e.span;
            result.expr.index = local->index;
            result.type = local->type;
            return result;
        }
    if (const int axis = axisNumber(e.text); axis >= 0) return constantOf(e.span, makeAxis(axis));
    if (e.text == "true" || e.text == "false") return constantOf(e.span, Value::boolean(e.text == "true"));
    Typed result;
    result.expr.span = e.span;
    if (place.where == Where::Expect) {
        const auto figure = std::find(figureWords.begin(), figureWords.end(), e.text);
        if (figure != figureWords.end()) {
            result.expr.kind = Expr::Kind::Figure;
            result.expr.index = static_cast<uint32_t>(figure - figureWords.begin());
            result.type = Type::number(Unit::None, true);
            return result;
        }
    }
    if (const auto param = params_.find(e.text); param != params_.end()) {
        if (place.where == Where::Constant)
            return failed(e.span, fmt::format("'{}' is a parameter, but a plain value must stand here", e.text));
        usedParams_.insert(param->second);
        const Param& p = grammar_.params[param->second];
        result.expr.kind = Expr::Kind::Param;
        result.expr.index = param->second;
        result.type = Type::of(p.value);
        if (!p.choices.empty()) result.type.words = &p.choices;
        if (brokenParams_.contains(param->second)) return {unreadable(e.span), Type::unknown()};
        return result;
    }
    if (withNames_.contains(e.text) && place.where >= Where::Guard && place.where != Where::Expect) {
        result.expr.kind = Expr::Kind::Inherited;
        result.expr.value = makeWord(e.text);
        result.type = Type::unknown();
        return result;
    }
    if (unbuilt_.contains(e.text)) {
        result.type = Type::unknown();
        return result;
    }
    return unknownName(place, e);
}

Typed Checker::member(Place& place, const Written& e) {
    const int axis = e.text == "x" ? 0 : e.text == "y" ? 1 : e.text == "z" ? 2 : -1;
    if (axis < 0) return failed(e.span, fmt::format("there is no '.{}'", e.text), "write .x, .y or .z");
    Typed result;
    result.expr.span = e.span;
    if (e.args[0].kind == Written::Kind::Name && e.args[0].text == "scope") {
        if (place.where < Where::Guard || place.where == Where::Expect) return failed(e.span, "there is no shape here whose scope could be asked");
        result.expr.kind = Expr::Kind::Scope;
        result.expr.index = static_cast<uint32_t>(axis);
        result.type = Type::number(Unit::Metre);
        return result;
    }
    Typed vector = expression(place, e.args[0]);
    if (!vector.type.known) return vector;
    if (vector.type.like.kind != Value::Kind::Vector || axis >= vector.type.like.count)
        return failed(e.span, fmt::format("'.{}' asks for a vector, but this is {}", e.text, describe(vector.type)));
    Value number = Value::number(axis);
    result.type = Type::of(component(vector.type.like, number));
    result.expr.kind = Expr::Kind::Element;
    result.expr.args.push_back(std::move(vector.expr));
    result.expr.args.push_back(constantOf(e.span, number).expr);
    return result;
}

Typed Checker::index(Place& place, const Written& e) {
    Typed vector = expression(place, e.args[0]);
    Typed at = expression(place, e.args[1]);
    if (!vector.type.known || !at.type.known) return {std::move(vector.expr), Type::unknown()};
    const uint8_t count = vector.type.like.count;
    if (vector.type.like.kind != Value::Kind::Vector) return failed(e.args[0].span, fmt::format("[ ] asks for a vector, but this is {}", describe(vector.type)));
    const bool axis = at.type.like.kind == Value::Kind::Axis;
    if (axis && count != 6) return failed(e.span, fmt::format("a direction chooses among 6 values, +x -x +y -y +z -z, but this is a vector of {}", count));
    if (!axis && !asks(at, Want::Count, "[ ]", nullptr)) return {std::move(vector.expr), Type::unknown()};
    if (const auto value = fold(at.expr, {}); value && (value->num() < 0 || value->num() >= count))
        return failed(e.args[1].span, fmt::format("there is no value number {:.12g}: the vector's are 0 … {}", value->num(), count - 1));
    Typed result;
    result.expr.kind = Expr::Kind::Element;
    result.expr.span = e.span;
    result.type = Type::of(component(vector.type.like, Value::number(0)));
    result.expr.args.push_back(std::move(vector.expr));
    result.expr.args.push_back(std::move(at.expr));
    return result;
}

Typed Checker::countCall(Place& place, const Written& e) {
    const Written& arg = e.args[0];
    if (place.where < Where::Guard) return failed(e.span, "there are no shapes here to count");
    const auto symbol = symbols_.find(arg.text);
    if (arg.kind != Written::Kind::Name || symbol == symbols_.end())
        return unknown(arg.span, arg.text, fmt::format("'count' takes the name of a shape, and there is none called '{}'", arg.span.text()), nearest(arg.text, symbolNames(false)));
    Value word = makeWord(arg.text);
    word.n[0] = symbol->second;
    return {makeCall(Expr::Kind::Call, Fn::Count, e.span, {makeConstant(arg.span, std::move(word))}), Type::number(Unit::None, true)};
}

Typed Checker::call(Place& place, const Written& e) {
    const Function* row = findFunction(e.text);
    if (e.text == "overlaps") return failed(e.span, "'overlaps(…)' is not supported yet");
    if (!row) {
        std::vector<std::string> known;
        for (const Function& f : functions()) known.emplace_back(f.name);
        const SourceSpan word{e.span.source, e.span.begin, e.span.begin + static_cast<uint32_t>(e.text.size())};
        return failed(word, fmt::format("unknown function '{}'", e.text), nearest(e.text, known));
    }
    if (e.args.size() < row->least || e.args.size() > row->most)
        return failed(e.span, fmt::format("'{}' takes {} argument{}{}, but {} {} given", row->name, row->least, row->least == 1 ? "" : "s",
                                          row->most > row->least ? " or more" : "", e.args.size(), e.args.size() == 1 ? "is" : "are"));
    for (size_t i = 0; i < e.argNames.size(); ++i)
        if (!e.argNames[i].empty()) return failed(e.args[i].span, fmt::format("the arguments of '{}' have no names", row->name), fmt::format("leave '{}:' out", e.argNames[i]));
    if (row->signature == Signature::Symbol) return countCall(place, e);

    const std::string what = fmt::format("'{}'", row->name);
    std::vector<Typed> args;
    for (const Written& arg : e.args) args.push_back(expression(place, arg));
    bool good = true;
    const auto each = [&](Want want, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) good = asks(args[i], want, what, &e.args[i]) && good;
    };
    const auto pair = [&](size_t a, size_t b) {
        const bool sameKind = args[a].type.like.kind == args[b].type.like.kind && !args[a].type.numeric();
        good = good && (sameKind || alike(args[a], args[b], "choose between"));
    };
    switch (row->signature) {
        case Signature::Alike:
            for (size_t i = 0; i < args.size(); ++i) good = good && alike(args[0], args[i], "compare");
            break;
        case Signature::Plain: each(Want::Number, 0, args.size()); break;
        case Signature::Angle: each(Want::Angle, 0, args.size()); break;
        case Signature::Lerp: each(Want::Number, 2, 3); pair(0, 1); break;
        case Signature::If: each(Want::Truth, 0, 1); pair(1, 2); break;
        case Signature::Symbol: break;
    }
    if (!good) return {{}, Type::unknown()};
    return applied(Expr::Kind::Call, row->fn, e.span, std::move(args));
}

Typed Checker::tuple(Place& place, const Written& e) {
    Typed result;
    result.expr.kind = Expr::Kind::Tuple;
    result.expr.span = e.span;
    std::vector<Value> samples;
    bool known = true;
    for (const Written& arg : e.args) {
        Typed part = expression(place, arg);
        if (part.type.known && part.type.like.kind != Value::Kind::Number)
            part = failed(arg.span, fmt::format("a vector is made of numbers, but this is {}", describe(part.type)));
        known = known && part.type.known;
        samples.push_back(part.type.like);
        result.expr.args.push_back(std::move(part.expr));
    }
    if (e.args.size() > 6) return failed(e.span, fmt::format("a vector has at most 6 numbers, but this has {}", e.args.size()));
    if (!known) return {std::move(result.expr), Type::unknown()};
    result.type = Type::of(rules::tuple(samples));
    if (auto value = fold(result.expr, {})) return constantOf(e.span, std::move(*value));
    return result;
}

Typed Checker::unary(Place& place, const Written& e) {
    Typed arg = expression(place, e.args[0]);
    std::vector<Typed> args;
    if (e.text == "not") {
        if (!asks(arg, Want::Truth, "'not'", nullptr)) return {{}, Type::unknown()};
        args.push_back(std::move(arg));
        return applied(Expr::Kind::Unary, Fn::Not, e.span, std::move(args));
    }
    if (arg.type.known && !arg.type.numeric() && arg.type.like.kind != Value::Kind::Axis)
        return failed(e.span, fmt::format("'-' takes a number, but this is {}", describe(arg.type)));
    args.push_back(std::move(arg));
    return applied(Expr::Kind::Unary, Fn::Neg, e.span, std::move(args));
}

/// A bare word beside `==`: one of the words of the parameter it is compared with.
Typed Checker::comparedWord(Place& place, const Written& e, const Type& other) {
    if (!other.words || e.kind != Written::Kind::Name || params_.contains(e.text)) return expression(place, e);
    if (std::find(other.words->begin(), other.words->end(), e.text) == other.words->end())
        return failed(e.span, fmt::format("it is never '{}', but one of {}", e.text, fmt::join(*other.words, ", ")), nearest(e.text, *other.words));
    return constantOf(e.span, makeWord(e.text));
}

Typed Checker::binary(Place& place, const Written& e) {
    const BinaryRow& row = binaryRow(e.text);
    const bool equality = row.fn == Fn::Equal || row.fn == Fn::NotEqual;
    const auto isWordParam = [&](const Written& side) {
        const auto param = side.kind == Written::Kind::Name ? params_.find(side.text) : params_.end();
        return param != params_.end() && !grammar_.params[param->second].choices.empty();
    };
    std::vector<Typed> args(2);
    const size_t first = equality && isWordParam(e.args[1]) ? 1 : 0;
    args[first] = expression(place, e.args[first]);
    args[1 - first] = equality ? comparedWord(place, e.args[1 - first], args[first].type) : expression(place, e.args[1 - first]);
    const Typed &a = args[0], &b = args[1];
    const Value::Kind ka = a.type.like.kind, kb = b.type.like.kind;
    bool good = true;
    if (row.fn == Fn::And || row.fn == Fn::Or) {
        for (size_t i = 0; i < 2; ++i) good = asks(args[i], Want::Truth, fmt::format("'{}'", row.text), nullptr) && good;
    } else if (row.fn == Fn::Mul && ka == Value::Kind::Rotation && kb == ka) {
        good = true;
    } else if (row.fn == Fn::Mul || row.fn == Fn::Div) {
        Typed plainB = b;  // any unit may multiply any other number; what comes of it is judged where it is used
        plainB.type.like.units.fill(Unit::None);
        good = alike(a, plainB, row.verb);
        const Unit ua = a.type.like.units[0], ub = b.type.like.units[0];
        if (good && a.type.known && b.type.known && row.fn == Fn::Mul && ua == ub && (ua == Unit::Metre || ua == Unit::Angle || ua == Unit::PerMetre))
            good = failed(e.span, fmt::format("{} times {} is nothing a grammar can measure", describe(a.type), describe(b.type))).type.known;
    } else if (!(equality && ka == kb && !a.type.numeric())) {
        good = alike(a, b, row.verb);
    }
    if (!good) return {{}, Type::unknown()};
    return applied(Expr::Kind::Binary, row.fn, e.span, std::move(args));
}

Typed Checker::range(Place& place, const Written& e) {
    if (place.where < Where::Guard || place.where == Where::Expect) return failed(e.span, "nothing is drawn by chance here: a plain value must stand here");
    const uint32_t ordinal = place.ranges++;
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(expression(place, end));
    if (!alike(ends[0], ends[1], "draw between")) return {{}, Type::unknown()};
    const auto lo = fold(ends[0].expr, {}), hi = fold(ends[1].expr, {});
    if (lo && hi && lo->kind == Value::Kind::Number && hi->kind == Value::Kind::Number && lo->num() > hi->num())
        return failed(e.span, "the range runs backwards", fmt::format("write '{}..{}'", e.args[1].span.text(), e.args[0].span.text()));
    Typed result = applied(Expr::Kind::Binary, Fn::Add, e.span, ends);
    result.expr = {};
    result.expr.kind = Expr::Kind::Range;
    result.expr.span = e.span;
    const uint64_t key = hashText(place.attribute);
    result.expr.draw = ordinal == 0 ? key : combine(key, ordinal);
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

Typed Checker::ramp(Place& place, const Written& e) {
    if (place.where != Where::Chain) return failed(e.span, "'~>' runs along a chain, and there is none here", "give the rule a 'repeat'");
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(expression(place, end));
    const bool colors = ends[0].type.like.kind == Value::Kind::Color && ends[1].type.like.kind == Value::Kind::Color;
    if (!colors && !alike(ends[0], ends[1], "go between")) return {{}, Type::unknown()};
    Typed result;
    result.type.known = ends[0].type.known && ends[1].type.known;
    result.type.like = interpolate(ends[0].type.like, ends[1].type.like, 0);
    result.expr.kind = Expr::Kind::Ramp;
    result.expr.span = e.span;
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

Typed Checker::infer(Place& place, const Written& e) {
    switch (e.kind) {
        case Written::Kind::Number: return number(e);
        case Written::Kind::Floating: return failed(e.span, "'~' is a size in a split, not a value");
        case Written::Kind::Text: {
            Value text;
            text.kind = Value::Kind::Text;
            text.text = e.text;
            return constantOf(e.span, std::move(text));
        }
        case Written::Kind::Color: {
            const Vec3d linear = linearFromHex(static_cast<uint32_t>(e.number));
            Value color;
            color.kind = Value::Kind::Color;
            color.count = 3;
            for (int i = 0; i < 3; ++i) color.n[static_cast<size_t>(i)] = linear[i];
            return constantOf(e.span, color);
        }
        case Written::Kind::Name: return name(place, e);
        case Written::Kind::Member: return member(place, e);
        case Written::Kind::Index: return index(place, e);
        case Written::Kind::Call: return call(place, e);
        case Written::Kind::Tuple: return tuple(place, e);
        case Written::Kind::Unary: return unary(place, e);
        case Written::Kind::Binary: return binary(place, e);
        case Written::Kind::Range: return range(place, e);
        case Written::Kind::Ramp: return ramp(place, e);
        case Written::Kind::Error: break;
    }
    return {{}, Type::unknown()};
}

Typed Checker::expression(Place& place, const Written& e) {
    Typed result = infer(place, e);
    result.expr.span = e.span;
    if (!result.type.known && result.expr.kind == Expr::Kind::Constant) result.expr = unreadable(e.span);
    return result;
}

Expr Checker::expression(Place& place, const Written& e, Want want, std::string_view what) {
    Typed result = expression(place, e);
    const bool byComponent = e.kind == Written::Kind::Tuple && e.args.size() == 3 && takesThree(want) && !fits(result.type, want);
    bool good = byComponent || asks(result, want, what, &e);
    for (size_t i = 0; byComponent && i < 3; ++i) {
        const SourceSpan span = e.args[i].span;
        const Value index = makeWhole(static_cast<double>(i));
        Expr part = result.expr.kind == Expr::Kind::Tuple ? result.expr.args[i] : makeConstant(span, component(result.expr.value, index));
        part.span = span;
        good = asks({std::move(part), Type::of(component(result.type.like, index))}, want, what, &e.args[i]) && good;
    }
    if (!good) return unreadable(e.span);
    adapt(result.expr, want);
    return std::move(result.expr);
}

}  // namespace sgm::rules
