// Functions and operators of expressions: argument counts, kinds and units.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/make.h"
#include "grammar/syntax/hints.h"
#include "modeler/core/random.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using Where = Place::Where;

constexpr std::string_view noChance = "nothing is drawn by chance here: a plain value must stand here";

struct BinaryRow {
    std::string_view text;
    Fn fn;
    std::string_view verb;
};
constexpr std::array<BinaryRow, 13> binaryRows{{{"+", Fn::Add, "add"},
                                                {"-", Fn::Sub, "subtract"},
                                                {"*", Fn::Mul, "multiply"},
                                                {"/", Fn::Div, "divide"},
                                                {"%", Fn::Rem, "divide"},
                                                {"<", Fn::Less, "compare"},
                                                {"<=", Fn::LessEq, "compare"},
                                                {">", Fn::Greater, "compare"},
                                                {">=", Fn::GreaterEq, "compare"},
                                                {"==", Fn::Equal, "compare"},
                                                {"!=", Fn::NotEqual, "compare"},
                                                {"and", Fn::And, "join"},
                                                {"or", Fn::Or, "join"}}};

const BinaryRow& binaryRow(std::string_view text) {
    const auto row =
        std::find_if(binaryRows.begin(), binaryRows.end(), [&](const BinaryRow& r) { return r.text == text; });
    return row == binaryRows.end() ? binaryRows[0] : *row;
}

}  // namespace

/// count(Name), overlaps(Name) …: what is said of all shapes of a name.
Typed Checker::countCall(Place& place, const Written& e) {
    const Written& arg = e.args[0];
    const Fn fn = findFunction(e.text)->fn;
    if (place.where < Where::Guard) return failed(e.span, "there are no shapes here to count");
    if (fn != Fn::Count && (place.where != Where::Guard || place.ofMap))
        return failed(e.span, fmt::format("'{}' tells how things stand when a rule is chosen", e.text),
                      "ask in the rule's 'when', and give the rule a body of its own");
    const auto symbol = symbols_.find(arg.text);
    if (arg.kind != Written::Kind::Name || symbol == symbols_.end())
        return unknown(
            arg.span, arg.text,
            fmt::format("'{}' takes the name of a shape, and there is none called '{}'", e.text, arg.span.text()),
            nearest(arg.text, symbolNames(false)));
    Value word = makeWord(arg.text);
    word.n[0] = symbol->second;
    return {makeCall(Expr::Kind::Call, fn, e.span, {makeConstant(arg.span, std::move(word))}),
            fn == Fn::Count ? Type::number(Unit::None, true) : Type::of(Value::boolean(false))};
}

/// outlines("lots.geojson"): a constant.
Typed Checker::outlineCount(const Written& e) {
    if (e.args[0].kind != Written::Kind::Text)
        return failed(e.args[0].span, "'outlines' takes the name of a file in quotes",
                      "write 'outlines(\"lots.geojson\")'");
    const auto file = outlinesOf(e.args[0]);
    if (!file) return {makeUnreadable(e.span), Type::unknown()};
    Value count = Value::number(static_cast<double>(grammar_.outlines[*file]->list.size()));
    count.integer = true;
    return makeTyped(e.span, std::move(count));
}

/// value("height", 8m), word("roof:shape", gabled): what a file says of an outline.
Typed Checker::propertyCall(Place& place, const Written& e, const Function& row) {
    const std::string example =
        row.fn == Fn::FileWord ? "write 'word(\"roof:shape\", gabled)'" : "write 'value(\"height\", 8m)'";
    if (place.where < Where::Guard || place.ofMap || place.where == Where::Expect)
        return failed(e.span, fmt::format("'{}' asks about the outline of a shape, and there is none here", row.name));
    const Written &name = e.args[0], &otherwise = e.args[1];
    if (name.kind != Written::Kind::Text)
        return failed(name.span, fmt::format("'{}' takes the name of a property in quotes", row.name), example);
    Typed fallback;
    if (row.fn == Fn::FileWord) {
        if (otherwise.kind != Written::Kind::Name && otherwise.kind != Written::Kind::Text)
            return failed(otherwise.span, "what 'word' says without a file is a word", example);
        fallback = makeTyped(otherwise.span, makeWord(otherwise.text));
    } else {
        fallback = expression(place, otherwise);
        if (!expectType(fallback, Want::Anything, "'value'", &otherwise)) return {{}, Type::unknown()};
        if (fallback.type.known && fallback.type.like.kind != Value::Kind::Number)
            return failed(otherwise.span, "what 'value' says without a file is a number", example);
        fallback.type.like.integer = false;
    }
    grammar_.properties.insert(name.text);
    Value text;
    text.kind = Value::Kind::Text;
    text.text = name.text;
    return {makeCall(Expr::Kind::Call, row.fn, e.span,
                     {makeConstant(name.span, std::move(text)), std::move(fallback.expr)}),
            fallback.type};
}

/// A function whose value hangs on where it is asked.
Typed Checker::placeCall(Place& place, const Written& e, const Function& row) {
    std::vector<Typed> args;
    for (const Written& arg : e.args) args.push_back(expression(place, arg));
    if (place.where < Where::Guard || place.where == Where::Expect)
        return failed(e.span, fmt::format("'{}' depends on the place, and there is none here", row.name));
    const Value& like = args[0].type.like;
    const bool isBump = row.fn == Fn::Bump;
    if (isBump && args[0].type.known && !(like.kind == Value::Kind::Vector && like.count == 2))
        return failed(e.args[0].span, "the middle of a bump is a place (x, z)", "write 'bump((-120m, 40m), 300m)'");
    const std::string what = fmt::format("'{}'", row.name);
    bool good = true;
    for (size_t i = isBump ? 1 : 0; i < args.size(); ++i)
        good = expectType(args[i], isBump || i == 0 ? Want::Length : Want::Number, what, &e.args[i]) && good;
    if (!good) return {{}, Type::unknown()};
    Typed result;
    result.expr = makeCall(Expr::Kind::Call, row.fn, e.span, {});
    for (Typed& arg : args) result.expr.args.push_back(std::move(arg.expr));
    result.type = Type::number();
    return result;
}

Typed Checker::unknownFunction(const Written& e) {
    std::vector<std::string> known;
    for (const Function& f : functions()) known.emplace_back(f.name);
    const SourceSpan word{e.span.source, e.span.begin, e.span.begin + static_cast<uint32_t>(e.text.size())};
    std::string hint = syntax::foreignFunctionHint(e.text);
    if (hint.empty()) hint = nearest(e.text, known);
    return failed(word, fmt::format("unknown function '{}'", e.text), hint);
}

Typed Checker::call(Place& place, const Written& e) {
    const Function* row = findFunction(e.text);
    if (!row) return unknownFunction(e);
    if (e.args.size() < row->least || e.args.size() > row->most)
        return failed(e.span, fmt::format("'{}' takes {} argument{}{}, but {} {} given", row->name, row->least,
                                          row->least == 1 ? "" : "s", row->most > row->least ? " or more" : "",
                                          e.args.size(), e.args.size() == 1 ? "is" : "are"));
    for (size_t i = 0; i < e.argNames.size(); ++i)
        if (!e.argNames[i].empty())
            return failed(e.args[i].span, fmt::format("the arguments of '{}' have no names", row->name),
                          fmt::format("leave '{}:' out", e.argNames[i]));
    if (row->signature == Signature::Symbol) return countCall(place, e);
    if (row->signature == Signature::File) return outlineCount(e);
    if (row->signature == Signature::Property) return propertyCall(place, e, *row);
    if (row->signature == Signature::Place) return placeCall(place, e, *row);
    if (row->signature == Signature::Mean) return meanCall(place, e);

    const std::string what = fmt::format("'{}'", row->name);
    std::vector<Typed> args;
    for (const Written& arg : e.args) args.push_back(expression(place, arg));
    bool good = true;
    const auto each = [&](Want want, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) good = expectType(args[i], want, what, &e.args[i]) && good;
    };
    const auto pair = [&](size_t a, size_t b) {
        const bool sameKind = args[a].type.like.kind == args[b].type.like.kind && !args[a].type.numeric();
        good = good && (sameKind || sameType(args[a], args[b], "choose between"));
    };
    switch (row->signature) {
        case Signature::Alike:
            for (size_t i = 1; i < args.size(); ++i)
                if (mix(place, args[0], args[i])) i = 0;
            for (size_t i = 0; i < args.size(); ++i) good = good && sameType(args[0], args[i], "compare");
            break;
        case Signature::Plain:
            each(Want::Number, 0, args.size());
            break;
        case Signature::Root: {
            const bool isArea = args[0].type.known && args[0].type.like.units[0] == Unit::SquareMetre;
            each(isArea ? Want::Area : Want::Number, 0, 1);
            break;
        }
        case Signature::Angle:
            each(Want::Angle, 0, args.size());
            break;
        case Signature::Lerp:
            each(Want::Number, 2, 3);
            pair(0, 1);
            break;
        case Signature::If:
            each(Want::Truth, 0, 1);
            pair(1, 2);
            break;
        case Signature::Symbol:
        case Signature::File:
        case Signature::Property:
        case Signature::Place:
        case Signature::Mean:
            break;
    }
    if (!good) return {{}, Type::unknown()};
    return applied(Expr::Kind::Call, row->fn, e.span, std::move(args));
}

Typed Checker::unary(Place& place, const Written& e) {
    Typed arg = expression(place, e.args[0]);
    std::vector<Typed> args;
    if (e.text == "not") {
        if (!expectType(arg, Want::Truth, "'not'", nullptr)) return {{}, Type::unknown()};
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
    // What a file says may be any word.
    const bool isAnyWord = other.known && !other.words && other.like.kind == Value::Kind::Word;
    if (isAnyWord && (e.kind == Written::Kind::Text || (e.kind == Written::Kind::Name && !params_.contains(e.text))))
        return makeTyped(e.span, makeWord(e.text));
    if (!other.words || e.kind != Written::Kind::Name || params_.contains(e.text)) return expression(place, e);
    if (std::find(other.words->begin(), other.words->end(), e.text) == other.words->end())
        return failed(e.span, fmt::format("it is never '{}', but one of {}", e.text, fmt::join(*other.words, ", ")),
                      nearest(e.text, *other.words));
    return makeTyped(e.span, makeWord(e.text));
}

Typed Checker::binary(Place& place, const Written& e) {
    const BinaryRow& row = binaryRow(e.text);
    const bool equality = row.fn == Fn::Equal || row.fn == Fn::NotEqual;
    const auto isWordParam = [&](const Written& side) {
        if (side.kind == Written::Kind::Name && maps_.contains(side.text)) return true;
        const auto param = side.kind == Written::Kind::Name ? params_.find(side.text) : params_.end();
        return param != params_.end() && !grammar_.params[param->second].choices.empty();
    };
    std::vector<Typed> args(2);
    const size_t first = equality && isWordParam(e.args[1]) ? 1 : 0;
    args[first] = expression(place, e.args[first]);
    args[1 - first] =
        equality ? comparedWord(place, e.args[1 - first], args[first].type) : expression(place, e.args[1 - first]);
    const Typed &a = args[0], &b = args[1];
    const Value::Kind ka = a.type.like.kind, kb = b.type.like.kind;
    bool good = true;
    if (row.fn == Fn::And || row.fn == Fn::Or) {
        for (size_t i = 0; i < 2; ++i)
            good = expectType(args[i], Want::Truth, fmt::format("'{}'", row.text), nullptr) && good;
    } else if (row.fn == Fn::Mul && ka == Value::Kind::Rotation && kb == ka) {
        good = true;
    } else if (row.fn == Fn::Mul || row.fn == Fn::Div) {
        Typed plainB = b;  // any unit may multiply any other number; what comes of it is judged where it is used
        plainB.type.like.units.fill(Unit::None);
        good = sameType(a, plainB, row.verb);
        const Unit ua = a.type.like.units[0], ub = b.type.like.units[0];
        if (good && a.type.known && b.type.known && row.fn == Fn::Mul && !productHasUnit(ua, ub))
            good = failed(e.span, fmt::format("{} times {} is nothing a grammar can measure", describe(a.type),
                                              describe(b.type)))
                       .type.known;
    } else if (!(equality && ka == kb && !a.type.numeric())) {
        if (row.fn != Fn::Rem) mix(place, args[0], args[1]);
        good = sameType(a, b, row.verb);
    }
    if (!good) return {{}, Type::unknown()};
    return applied(Expr::Kind::Binary, row.fn, e.span, std::move(args));
}

/// A draw of this attribute's own, without its arguments.
Expr Checker::chance(Place& place, const Written& e) {
    Expr drawn;
    drawn.kind = e.kind == Written::Kind::Range ? Expr::Kind::Range : Expr::Kind::Choose;
    drawn.span = e.span;
    const uint64_t key = hashText(place.attribute);
    const uint32_t ordinal = place.ranges++;
    drawn.draw = ordinal == 0 ? key : combine(key, ordinal);
    return drawn;
}

/// The number that counts the turns of the repetition around a `choose distinct` or `choose shuffled`; null, with a
/// message, where there is none.
const Place::Local* Checker::counter(const Place& place, SourceSpan span, std::string_view word, size_t alternatives) {
    const auto found =
        std::find_if(place.locals.rbegin(), place.locals.rend(), [](const Place::Local& l) { return l.counts; });
    if (found == place.locals.rend())
        diagnostics_.error(span, fmt::format("'choose {}' draws along a repetition, and there is none here", word),
                           "say it in '{ … }*', 'row', 'around', 'for k in 1..n' or a rule with 'repeat', and hand the "
                           "value down by 'with'");
    else if (alternatives < 2)
        diagnostics_.error(span, fmt::format("'choose {}' needs two alternatives or more", word));
    return found == place.locals.rend() ? nullptr : &*found;
}

Expr Checker::weight(Place& place, const Written& e) {
    Expr result = expression(place, e, Want::Number, "the weight of a choice");
    if (const auto value = fold(result, defaults_); value && value->num() < 0)
        diagnostics_.error(result.span, fmt::format("a weight is no less than 0, not {}", toText(*value)));
    return result;
}

/// Refuses weights that are 0 whatever the parameters are.
void Checker::checkWeights(const std::vector<const Expr*>& weights, SourceSpan span) {
    const auto never = [](const Expr* e) {
        const auto value = fold(*e, {});
        return value && value->num() == 0;
    };
    if (!weights.empty() && std::all_of(weights.begin(), weights.end(), never))
        diagnostics_.error(span, "all weights are 0, so nothing could be chosen");
}

Typed Checker::choice(Place& place, const Written& e) {
    if (place.where < Where::Guard || place.where == Where::Expect || place.ofMap)
        return failed(e.span, std::string(noChance));
    Typed result;
    result.expr = chance(place, e);
    if (!e.text.empty())
        if (const auto* local = counter(place, e.span, e.text, e.args.size() / 2)) {
            result.expr.index = static_cast<uint32_t>(e.text == "distinct" ? Series::Distinct : Series::Shuffled);
            result.expr.value = Value::number(local->index);
        }
    std::vector<Typed> values;
    std::vector<const Expr*> weights;
    for (size_t i = 0; i + 1 < e.args.size(); i += 2) {
        result.expr.args.push_back(weight(place, e.args[i]));
        values.push_back(expression(place, e.args[i + 1]));
        result.expr.args.push_back(values.back().expr);
        result.type.known = result.type.known && values.back().type.known;
    }
    for (size_t i = 0; i < result.expr.args.size(); i += 2) weights.push_back(&result.expr.args[i]);
    checkWeights(weights, e.span);
    if (!result.type.known || values.empty()) return {std::move(result.expr), Type::unknown()};
    result.type = values[0].type;
    for (const Typed& value : values) {
        const Value& like = value.type.like;
        if (like.kind == result.type.like.kind && !value.type.numeric()) continue;
        if (!sameType(values[0], value, "choose between")) return {{}, Type::unknown()};
        const Value sample[] = {result.type.like, like};
        result.type = Type::of(applyFunction(Fn::Add, sample));
    }
    return result;
}

Typed Checker::range(Place& place, const Written& e) {
    if (place.where < Where::Guard || place.where == Where::Expect || place.ofMap)
        return failed(e.span, std::string(noChance));
    Expr drawn = chance(place, e);
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(expression(place, end));
    mix(place, ends[0], ends[1]);
    if (!sameType(ends[0], ends[1], "draw between")) return {{}, Type::unknown()};
    const auto lo = fold(ends[0].expr, {}), hi = fold(ends[1].expr, {});
    if (lo && hi && lo->kind == Value::Kind::Number && hi->kind == Value::Kind::Number && lo->num() > hi->num())
        return failed(e.span, "the range runs backwards",
                      fmt::format("write '{}..{}'", e.args[1].span.text(), e.args[0].span.text()));
    Typed result = applied(Expr::Kind::Binary, Fn::Add, e.span, ends);
    result.expr = std::move(drawn);
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

Typed Checker::ramp(Place& place, const Written& e) {
    if (place.where != Where::Chain)
        return failed(e.span, "'~>' runs along a chain, and there is none here", "give the rule a 'repeat'");
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(expression(place, end));
    const bool colors = ends[0].type.like.kind == Value::Kind::Color && ends[1].type.like.kind == Value::Kind::Color;
    mix(place, ends[0], ends[1]);
    if (!colors && !sameType(ends[0], ends[1], "go between")) return {{}, Type::unknown()};
    Typed result;
    result.type.known = ends[0].type.known && ends[1].type.known;
    result.type.like = interpolate(ends[0].type.like, ends[1].type.like, 0);
    result.expr.kind = Expr::Kind::Ramp;
    result.expr.span = e.span;
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

}  // namespace sgm::rules
