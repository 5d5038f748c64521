// Expressions whose value is drawn or goes along a chain: ranges, choices, ramps.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "modeler/core/random.h"

namespace sgm::rules {

using Written = syntax::Expr;
using Where = Place::Where;

namespace {

constexpr std::string_view noChance = "nothing is drawn by chance here: a plain value must stand here";

}  // namespace

/// A draw of this attribute's own, without its arguments.
Expr makeDraw(Place& place, const Written& e) {
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
const Place::Local* findCounter(CheckContext& ctx, const Place& place, SourceSpan span, std::string_view word,
                                size_t alternatives) {
    const auto found =
        std::find_if(place.locals.rbegin(), place.locals.rend(), [](const Place::Local& l) { return l.counts; });
    if (found == place.locals.rend())
        ctx.diagnostics.error(
            span, fmt::format("'choose {}' draws along a repetition, and there is none here", word),
            "say it in '{ … }*', 'row', 'around', 'for k in 1..n' or a rule with 'repeat', and hand the "
            "value down by 'with'");
    else if (alternatives < 2)
        ctx.diagnostics.error(span, fmt::format("'choose {}' needs two alternatives or more", word));
    return found == place.locals.rend() ? nullptr : &*found;
}

Expr checkWeight(CheckContext& ctx, Place& place, const Written& e) {
    Expr result = checkExpression(ctx, place, e, Want::Number, "the weight of a choice");
    if (const auto value = fold(result, ctx.params.defaults); value && value->num() < 0)
        ctx.diagnostics.error(result.span, fmt::format("a weight is no less than 0, not {}", toText(*value)));
    return result;
}

/// Refuses weights that are 0 whatever the parameters are.
void checkWeights(CheckContext& ctx, const std::vector<const Expr*>& weights, SourceSpan span) {
    const auto never = [](const Expr* e) {
        const auto value = fold(*e, {});
        return value && value->num() == 0;
    };
    if (!weights.empty() && std::all_of(weights.begin(), weights.end(), never))
        ctx.diagnostics.error(span, "all weights are 0, so nothing could be chosen");
}

Typed checkChoice(CheckContext& ctx, Place& place, const Written& e) {
    if (place.where < Where::Guard || place.where == Where::Expect || place.ofMap)
        return fail(ctx, e.span, std::string(noChance));
    Typed result;
    result.expr = makeDraw(place, e);
    if (!e.text.empty())
        if (const auto* local = findCounter(ctx, place, e.span, e.text, e.args.size() / 2)) {
            result.expr.index = static_cast<uint32_t>(e.text == "distinct" ? Series::Distinct : Series::Shuffled);
            result.expr.value = Value::number(local->index);
        }
    std::vector<Typed> values;
    std::vector<const Expr*> weights;
    for (size_t i = 0; i + 1 < e.args.size(); i += 2) {
        result.expr.args.push_back(checkWeight(ctx, place, e.args[i]));
        values.push_back(checkExpression(ctx, place, e.args[i + 1]));
        result.expr.args.push_back(values.back().expr);
        result.type.known = result.type.known && values.back().type.known;
    }
    for (size_t i = 0; i < result.expr.args.size(); i += 2) weights.push_back(&result.expr.args[i]);
    checkWeights(ctx, weights, e.span);
    if (!result.type.known || values.empty()) return {std::move(result.expr), Type::unknown()};
    result.type = values[0].type;
    for (const Typed& value : values) {
        const Value& like = value.type.like;
        if (like.kind == result.type.like.kind && !value.type.numeric()) continue;
        if (!sameType(ctx, values[0], value, "choose between")) return {{}, Type::unknown()};
        const Value sample[] = {result.type.like, like};
        result.type = Type::of(applyFunction(Fn::Add, sample));
    }
    return result;
}

Typed checkRange(CheckContext& ctx, Place& place, const Written& e) {
    if (place.where < Where::Guard || place.where == Where::Expect || place.ofMap)
        return fail(ctx, e.span, std::string(noChance));
    Expr drawn = makeDraw(place, e);
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(checkExpression(ctx, place, end));
    mixShares(place, ends[0], ends[1]);
    if (!sameType(ctx, ends[0], ends[1], "draw between")) return {{}, Type::unknown()};
    const auto lo = fold(ends[0].expr, {}), hi = fold(ends[1].expr, {});
    if (lo && hi && lo->kind == Value::Kind::Number && hi->kind == Value::Kind::Number && lo->num() > hi->num())
        return fail(ctx, e.span, "the range runs backwards",
                    fmt::format("write '{}..{}'", e.args[1].span.text(), e.args[0].span.text()));
    Typed result = makeApplied(ctx, Expr::Kind::Binary, Fn::Add, e.span, ends);
    drawn.asksUnits = result.expr.asksUnits;
    result.expr = std::move(drawn);
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

Typed checkRamp(CheckContext& ctx, Place& place, const Written& e) {
    if (place.where != Where::Chain)
        return fail(ctx, e.span, "'~>' runs along a chain, and there is none here", "give the rule a 'repeat'");
    std::vector<Typed> ends;
    for (const Written& end : e.args) ends.push_back(checkExpression(ctx, place, end));
    const bool colors = ends[0].type.like.kind == Value::Kind::Color && ends[1].type.like.kind == Value::Kind::Color;
    mixShares(place, ends[0], ends[1]);
    if (!colors && !sameType(ctx, ends[0], ends[1], "go between")) return {{}, Type::unknown()};
    Typed result;
    result.type.known = ends[0].type.known && ends[1].type.known;
    result.type.like = interpolate(ends[0].type.like, ends[1].type.like, 0);
    result.expr.kind = Expr::Kind::Ramp;
    const Type types[] = {ends[0].type, ends[1].type};
    result.expr.asksUnits = mayDiffer(types);
    result.expr.span = e.span;
    for (Typed& end : ends) result.expr.args.push_back(std::move(end.expr));
    return result;
}

}  // namespace sgm::rules
