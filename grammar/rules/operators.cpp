// Functions and operators of expressions: argument counts, kinds and units.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "grammar/syntax/hints.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using Where = Place::Where;

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

/// count(Name), overlaps(Name) …: what is said of all shapes of a name.
Typed checkCount(CheckContext& ctx, Place& place, const Written& e) {
    const Written& arg = e.args[0];
    const Fn fn = findFunction(e.text)->fn;
    if (place.where < Where::Guard) return fail(ctx, e.span, "there are no shapes here to count");
    if (fn != Fn::Count && (place.where != Where::Guard || place.ofMap))
        return fail(ctx, e.span, fmt::format("'{}' tells how things stand when a rule is chosen", e.text),
                    "ask in the rule's 'when', and give the rule a body of its own");
    const auto symbol = arg.kind == Written::Kind::Name ? findReferenced(ctx, arg.text) : std::nullopt;
    if (!symbol)
        return failUnknown(
            ctx, arg.span, arg.text,
            fmt::format("'{}' takes the name of a shape, and there is none called '{}'", e.text, arg.span.text()),
            nearestHint(arg.text, symbolNames(ctx, false)));
    Value word = makeWord(arg.text);
    word.n[0] = *symbol;
    return {makeCall(Expr::Kind::Call, fn, e.span, {makeConstant(arg.span, std::move(word))}),
            fn == Fn::Count ? Type::number(Unit::None, true) : Type::of(Value::boolean(false))};
}

/// outlines("lots.geojson"): a constant.
Typed checkOutlineCount(CheckContext& ctx, const Written& e) {
    if (e.args[0].kind != Written::Kind::Text)
        return fail(ctx, e.args[0].span, "'outlines' takes the name of a file in quotes",
                    "write 'outlines(\"lots.geojson\")'");
    const auto file = ctx.files.readOutlines(e.args[0]);
    if (!file) return {makeUnreadable(e.span), Type::unknown()};
    Value count = Value::number(static_cast<double>(ctx.grammar.outlines[*file]->list.size()));
    count.integer = true;
    return makeTyped(e.span, std::move(count));
}

/// value("height", 8m), word("roof:shape", gabled): what a file says of an outline.
Typed checkProperty(CheckContext& ctx, Place& place, const Written& e, const Function& row) {
    const std::string example =
        row.fn == Fn::FileWord ? "write 'word(\"roof:shape\", gabled)'" : "write 'value(\"height\", 8m)'";
    if (place.where < Where::Guard || place.ofMap || place.where == Where::Expect)
        return fail(ctx, e.span,
                    fmt::format("'{}' asks about the outline of a shape, and there is none here", row.name));
    const Written &name = e.args[0], &otherwise = e.args[1];
    if (name.kind != Written::Kind::Text)
        return fail(ctx, name.span, fmt::format("'{}' takes the name of a property in quotes", row.name), example);
    Typed fallback;
    if (row.fn == Fn::FileWord) {
        if (otherwise.kind != Written::Kind::Name && otherwise.kind != Written::Kind::Text)
            return fail(ctx, otherwise.span, "what 'word' says without a file is a word", example);
        fallback = makeTyped(otherwise.span, makeWord(otherwise.text));
    } else {
        fallback = checkExpression(ctx, place, otherwise);
        if (!expectType(ctx, fallback, Want::Anything, "'value'", &otherwise)) return {{}, Type::unknown()};
        if (fallback.type.known && fallback.type.like.kind != Value::Kind::Number)
            return fail(ctx, otherwise.span, "what 'value' says without a file is a number", example);
        fallback.type.like.integer = false;
        if (fallback.type.known) ctx.outlineValues.push_back({name.text, fallback.type.like.units[0], e.span});
    }
    ctx.grammar.properties.insert(name.text);
    Value text;
    text.kind = Value::Kind::Text;
    text.text = name.text;
    return {makeCall(Expr::Kind::Call, row.fn, e.span,
                     {makeConstant(name.span, std::move(text)), std::move(fallback.expr)}),
            fallback.type};
}

/// A function whose value hangs on where it is asked.
Typed checkPlaceCall(CheckContext& ctx, Place& place, const Written& e, const Function& row) {
    std::vector<Typed> args;
    for (const Written& arg : e.args) args.push_back(checkExpression(ctx, place, arg));
    if (place.where < Where::Guard || place.where == Where::Expect)
        return fail(ctx, e.span, fmt::format("'{}' depends on the place, and there is none here", row.name));
    const Value& like = args[0].type.like;
    const bool isBump = row.fn == Fn::Bump;
    if (isBump && args[0].type.known && !(like.kind == Value::Kind::Vector && like.count == 2))
        return fail(ctx, e.args[0].span, "the middle of a bump is a place (x, z)", "write 'bump((-120m, 40m), 300m)'");
    const std::string what = fmt::format("'{}'", row.name);
    bool good = true;
    for (size_t i = isBump ? 1 : 0; i < args.size(); ++i)
        good = expectType(ctx, args[i], isBump || i == 0 ? Want::Length : Want::Number, what, &e.args[i]) && good;
    if (!good) return {{}, Type::unknown()};
    Typed result;
    result.expr = makeCall(Expr::Kind::Call, row.fn, e.span, {});
    for (Typed& arg : args) result.expr.args.push_back(std::move(arg.expr));
    result.type = Type::number();
    return result;
}

Typed unknownFunction(CheckContext& ctx, const Written& e) {
    std::vector<std::string> known;
    for (const Function& f : functions()) known.emplace_back(f.name);
    const SourceSpan word{e.span.source, e.span.begin, e.span.begin + static_cast<uint32_t>(e.text.size())};
    std::string hint = syntax::foreignFunctionHint(e.text);
    if (hint.empty()) hint = nearestHint(e.text, known);
    return fail(ctx, word, fmt::format("unknown function '{}'", e.text), hint);
}

/// A bare word beside `==`: one of the words of the parameter it is compared with.
Typed checkComparedWord(CheckContext& ctx, Place& place, const Written& e, const Type& other) {
    // What a file says may be any word.
    const bool isAnyWord = other.known && !other.words && other.like.kind == Value::Kind::Word;
    if (isAnyWord &&
        (e.kind == Written::Kind::Text || (e.kind == Written::Kind::Name && !ctx.names.params.contains(e.text))))
        return makeTyped(e.span, makeWord(e.text));
    if (other.words && e.kind == Written::Kind::Text)
        return fail(ctx, e.span, "a choice is written without quotes", fmt::format("write '{}'", e.text));
    if (!other.words || e.kind != Written::Kind::Name || ctx.names.params.contains(e.text))
        return checkExpression(ctx, place, e);
    if (std::find(other.words->begin(), other.words->end(), e.text) == other.words->end())
        return fail(ctx, e.span, fmt::format("it is never '{}', but one of {}", e.text, fmt::join(*other.words, ", ")),
                    nearestHint(e.text, *other.words));
    return makeTyped(e.span, makeWord(e.text));
}

/// Whether the arguments of a function are of the kinds that its signature asks for.
bool checkSignature(CheckContext& ctx, Place& place, const Written& e, const Function& row, std::vector<Typed>& args) {
    const std::string what = fmt::format("'{}'", row.name);
    bool good = true;
    const auto each = [&](Want want, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) good = expectType(ctx, args[i], want, what, &e.args[i]) && good;
    };
    const auto pair = [&](size_t a, size_t b) {
        const bool sameKind = args[a].type.like.kind == args[b].type.like.kind && !args[a].type.numeric();
        good = good && (sameKind || sameType(ctx, args[a], args[b], "choose between"));
    };
    switch (row.signature) {
        case Signature::Alike:
            for (size_t i = 1; i < args.size(); ++i)
                if (mixShares(place, args[0], args[i])) i = 0;
            for (size_t i = 1; i < args.size(); ++i)  // each with each: a plain number meets all others
                for (size_t j = 0; j < i; ++j) good = good && sameType(ctx, args[j], args[i], "compare");
            good = good && (args.empty() || sameType(ctx, args[0], args[0], "compare"));
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
    return good;
}

}  // namespace

Typed checkCall(CheckContext& ctx, Place& place, const Written& e) {
    const Function* row = findFunction(e.text);
    if (!row) return unknownFunction(ctx, e);
    if (e.args.size() < row->least || e.args.size() > row->most)
        return fail(ctx, e.span,
                    fmt::format("'{}' takes {} argument{}{}, but {} {} given", row->name, row->least,
                                row->least == 1 ? "" : "s", row->most > row->least ? " or more" : "", e.args.size(),
                                e.args.size() == 1 ? "is" : "are"));
    for (size_t i = 0; i < e.argNames.size(); ++i)
        if (!e.argNames[i].empty())
            return fail(ctx, e.args[i].span, fmt::format("the arguments of '{}' have no names", row->name),
                        fmt::format("leave '{}:' out", e.argNames[i]));
    if (row->signature == Signature::Symbol) return checkCount(ctx, place, e);
    if (row->signature == Signature::File) return checkOutlineCount(ctx, e);
    if (row->signature == Signature::Property) return checkProperty(ctx, place, e, *row);
    if (row->signature == Signature::Place) return checkPlaceCall(ctx, place, e, *row);
    if (row->signature == Signature::Mean) return checkMean(ctx, place, e);

    std::vector<Typed> args;
    for (const Written& arg : e.args) args.push_back(checkExpression(ctx, place, arg));
    if (!checkSignature(ctx, place, e, *row, args)) return {{}, Type::unknown()};
    return makeApplied(ctx, Expr::Kind::Call, row->fn, e.span, std::move(args));
}

Typed checkUnary(CheckContext& ctx, Place& place, const Written& e) {
    Typed arg = checkExpression(ctx, place, e.args[0]);
    std::vector<Typed> args;
    if (e.text == "not") {
        if (!expectType(ctx, arg, Want::Truth, "'not'", nullptr)) return {{}, Type::unknown()};
        args.push_back(std::move(arg));
        return makeApplied(ctx, Expr::Kind::Unary, Fn::Not, e.span, std::move(args));
    }
    if (arg.type.known && !arg.type.numeric() && arg.type.like.kind != Value::Kind::Axis)
        return fail(ctx, e.span, fmt::format("'-' takes a number, but this is {}", describe(arg.type)));
    args.push_back(std::move(arg));
    return makeApplied(ctx, Expr::Kind::Unary, Fn::Neg, e.span, std::move(args));
}

namespace {

bool isEquality(Fn fn) { return fn == Fn::Equal || fn == Fn::NotEqual; }

bool isWordParam(const CheckContext& ctx, const Written& side) {
    if (side.kind == Written::Kind::Name && ctx.names.maps.contains(side.text)) return true;
    const auto param = side.kind == Written::Kind::Name ? ctx.names.params.find(side.text) : ctx.names.params.end();
    return param != ctx.names.params.end() && !ctx.grammar.params[param->second].choices.empty();
}

/// The operator over what was made of its operands.
Typed applyBinary(CheckContext& ctx, Place& place, const Written& e, const BinaryRow& row, std::vector<Typed> args) {
    const Typed &a = args[0], &b = args[1];
    const Value::Kind ka = a.type.like.kind, kb = b.type.like.kind;
    bool good = true;
    if (row.fn == Fn::And || row.fn == Fn::Or) {
        for (size_t i = 0; i < 2; ++i)
            good = expectType(ctx, args[i], Want::Truth, fmt::format("'{}'", row.text), nullptr) && good;
    } else if (row.fn == Fn::Mul && ka == Value::Kind::Rotation && kb == ka) {
        good = true;
    } else if (row.fn == Fn::Mul || row.fn == Fn::Div) {
        Typed plainB = b;  // any unit may multiply any other number; what comes of it is judged where it is used
        plainB.type.like.units.fill(Unit::None);
        good = sameType(ctx, a, plainB, row.verb);
        const Unit ua = a.type.like.units[0], ub = b.type.like.units[0];
        if (good && a.type.known && b.type.known && row.fn == Fn::Mul && !productHasUnit(ua, ub))
            good = fail(ctx, e.span,
                        fmt::format("{} times {} is nothing a grammar can measure", describe(a.type), describe(b.type)))
                       .type.known;
    } else if (!(isEquality(row.fn) && ka == kb && !a.type.numeric())) {
        if (row.fn != Fn::Rem) mixShares(place, args[0], args[1]);
        good = sameType(ctx, a, b, row.verb);
    }
    if (!good) return {{}, Type::unknown()};
    return makeApplied(ctx, Expr::Kind::Binary, row.fn, e.span, std::move(args));
}

}  // namespace

// As little as possible stays on the stack while operands are checked: there are up to 400 one in the other.
Typed checkBinary(CheckContext& ctx, Place& place, const Written& e) {
    const BinaryRow& row = binaryRow(e.text);
    std::vector<Typed> args(2);
    const size_t first = isEquality(row.fn) && isWordParam(ctx, e.args[1]) ? 1 : 0;
    args[first] = checkExpression(ctx, place, e.args[first]);
    args[1 - first] = isEquality(row.fn) ? checkComparedWord(ctx, place, e.args[1 - first], args[first].type)
                                         : checkExpression(ctx, place, e.args[1 - first]);
    return applyBinary(ctx, place, e, row, std::move(args));
}

}  // namespace sgm::rules
