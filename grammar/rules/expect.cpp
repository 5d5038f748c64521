// What is expected of expressions: kinds and units, and what is said where they aren't met.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {

using Written = syntax::Expr;

namespace {

bool isZero(const Expr& e) {
    return e.kind == Expr::Kind::Constant && e.value.kind == Value::Kind::Number && e.value.num() == 0 &&
           e.value.units[0] == Unit::None;
}

/// Whether the function takes numbers of one unit, or plain ones beside them.
bool takesOneUnit(Fn fn) {
    return fn == Fn::Add || fn == Fn::Sub || (fn >= Fn::Rem && fn <= Fn::NotEqual) || fn == Fn::Min || fn == Fn::Max ||
           fn == Fn::Clamp || fn == Fn::Lerp;
}

}  // namespace

/// Whether units of these may differ while deriving: one isn't known, and another isn't a plain number, which meets
/// all.
bool mayDiffer(std::span<const Type> types) {
    const auto isKnown = [](const Type& t) { return t.known; };
    const auto isPlain = [](const Type& t) {
        return t.known && (!t.numeric() || (t.like.count == 1 && t.like.units[0] == Unit::None));
    };
    return !std::ranges::all_of(types, isKnown) && std::ranges::count_if(types, std::not_fn(isPlain)) > 1;
}

Typed fail(CheckContext& ctx, SourceSpan span, std::string message, std::string hint) {
    ctx.diagnostics.error(span, std::move(message), std::move(hint));
    Typed result;
    result.expr.span = span;
    result.type = Type::unknown();
    return result;
}

Typed failUnknown(CheckContext& ctx, SourceSpan span, const std::string& word, std::string message, std::string hint) {
    if (!ctx.suppressed.covers(word)) return fail(ctx, span, std::move(message), std::move(hint));
    return {makeConstant(span, {}), Type::unknown()};
}

/// `kind` over `args`, folded where everything is constant; its type is that of the samples.
Typed makeApplied(CheckContext& ctx, Expr::Kind kind, Fn fn, SourceSpan span, std::vector<Typed> args) {
    Typed result;
    result.expr.kind = kind;
    result.expr.span = span;
    result.expr.index = static_cast<uint32_t>(fn);
    std::vector<Value> samples;
    std::vector<Type> types;
    for (Typed& arg : args) {
        types.push_back(arg.type);
        result.type.known = result.type.known && arg.type.known;
        samples.push_back(arg.type.like);
        result.expr.args.push_back(std::move(arg.expr));
    }
    if (!result.type.known) {
        result.expr.asksUnits = takesOneUnit(fn) && mayDiffer(types);
        return {std::move(result.expr), Type::unknown()};
    }
    result.type = Type::of(applyFunction(fn, samples));
    if (auto value = fold(result.expr, {})) {
        if (auto suspect = findDoubtWithin(result.expr, {})) {
            if ((fn == Fn::Div || fn == Fn::Rem) && versionOf(ctx.grammar, span) >= 2)
                return fail(ctx, suspect->span, std::move(suspect->message), "divide by another number");
            ctx.diagnostics.warning(suspect->span, std::move(suspect->message), std::move(suspect->hint));
        }
        return makeTyped(span, std::move(*value));
    }
    return result;
}

/// Whether the text is ".3" of "1...3", a number behind the dots of a range.
static bool followsTwoDots(syntax::SourceSpan span) {
    return span.source && span.begin >= 2 && span.text().starts_with('.') &&
           span.source->text().substr(span.begin - 2, 2) == "..";
}

/// How to say a number without a unit as an angle; a small fraction is hardly meant in degrees.
static std::string angleHint(double number, Unit unit) {
    if (unit != Unit::None || number <= 0 || number >= 2 || number == std::floor(number))
        return fmt::format("write '{:.12g}deg'", number);
    return fmt::format("write degrees: {0:.12g} in radians is '{1:.0f}deg', as a slope '{2:.0f}deg'", number,
                       degrees(number), degrees(std::atan(number)));
}

bool expectType(CheckContext& ctx, const Typed& value, Want want, std::string_view what, const Written* written) {
    if (fits(value.type, want)) return true;
    const bool angle = want == Want::Angle || want == Want::Angles;
    if (angle && isZero(value.expr)) return true;
    std::string hint;
    if (written && written->kind == Written::Kind::Number) {
        const std::string digits = fmt::format("{:.12g}", written->number);
        if (angle) hint = angleHint(written->number, value.type.like.units[0]);
        if (want == Want::Length && value.type.like.units[0] == Unit::Share)
            hint = what == "what follows '~'"
                       ? fmt::format("write '{}%' for that share, or '~1' for a share of what the others leave", digits)
                       : fmt::format("write a length such as '{:.12g}m'", written->number / 100);
    }
    const bool isSize = want == Want::Size || want == Want::Extent || want == Want::Length;
    if (isSize && written && written->kind == Written::Kind::Number && value.type.like.units[0] == Unit::Angle)
        hint = what.find("' of '") != what.npos  // of a roof, where the angle is a pitch that it doesn't have
                   ? "write a length, such as '.6m'"
                   : fmt::format("write a length such as '{:.12g}m'", written->number);
    if ((isSize || want == Want::Offset) && value.type.like.kind == Value::Kind::Vector && value.type.like.count > 3)
        hint = "write x, y and z; the decimal point is '.', as in '3.5'";
    const bool isPair = value.type.like.kind == Value::Kind::Vector && value.type.like.count == 2;
    if (isPair && (want == Want::Size || want == Want::Offset || want == Want::Angles))
        hint = fmt::format("write all three, x, y and z, as in '{}'",
                           want == Want::Angles ? "(0deg, 90deg, 0deg)" : "(10, 1, 3)");
    const bool isTriple = written && written->kind == Written::Kind::Tuple && written->args.size() == 3;
    if (isTriple && want == Want::Axis) hint = fmt::format("write 'move {}' to place it freely", written->span.text());
    if (isTriple && want == Want::Color) hint = "write 'rgb(…)' with three shares from 0 to 1, or '#rrggbb'";
    if (want == Want::Color && written && written->kind == Written::Kind::Text && written->text.starts_with('#'))
        hint = "leave the quotes out";
    if (want == Want::Count && value.type.like.kind == Value::Kind::Number && value.type.like.units[0] == Unit::None)
        hint = followsTwoDots(value.expr.span) ? "a range has two dots, as in '1..3'" : "write 'round(…)' around it";
    if (want == Want::Number && value.type.numeric() && value.type.like.kind == Value::Kind::Number)
        hint = "write a number without a unit, or divide by one of the same unit";
    const std::string got = want == Want::Count && !hint.empty() ? "may have a fraction" : "is " + describe(value.type);
    ctx.diagnostics.error(value.expr.span, fmt::format("{} takes {}, but this {}", what, describe(want), got),
                          std::move(hint));
    return false;
}

bool sameType(CheckContext& ctx, const Typed& a, const Typed& b, std::string_view verb) {
    if (!a.type.known || !b.type.known) return true;
    const auto say = [&](const Typed& at, std::string message) {
        ctx.diagnostics.error(at.expr.span, std::move(message));
        return false;
    };
    if (!a.type.numeric()) return say(a, fmt::format("can't {} {}", verb, describe(a.type)));
    if (!b.type.numeric()) return say(b, fmt::format("can't {} {}", verb, describe(b.type)));
    if (compatible(a.type, b.type)) return true;
    ArithmeticWarning unlike = unlikeNumbers(a.type, b.type, verb);
    ctx.diagnostics.error(syntax::join(a.expr.span, b.expr.span), std::move(unlike.message), std::move(unlike.hint));
    return false;
}

}  // namespace sgm::rules
