// Solids as a shape evaluates them: values of their arguments, told where they lie beyond a range (expressions.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"
#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/value.h"

namespace sgm::derive {

using rules::Value;

/// What is said of values that count as others.
static constexpr const char* nearestEnd = "it counts as the nearest of both ends";

double numberWithin(const rules::Expr& expr, const Place& place, double lo, double hi, std::string_view name) {
    const double n = number(expr, place);
    if (n >= lo && n <= hi) return n;
    if (place.builder) {
        const auto text = [&](double v) { return rules::toText(Value::number(v, evaluate(expr, place).units[0])); };
        place.builder->warn(expr.span,
                            std::isinf(hi)
                                ? fmt::format("{} is {}, but must be no less than {}", name, text(n), text(lo))
                                : fmt::format("{} is {}, but must be {} … {}", name, text(n), text(lo), text(hi)),
                            std::isinf(hi) ? fmt::format("it counts as {}", text(lo)) : nearestEnd);
    }
    return std::clamp(n, lo, hi);
}

std::vector<field::Argument> argumentNumbers(const SolidValue& solid) {
    std::vector<field::Argument> arguments;
    for (size_t i = 0; i < solid.args.size(); ++i) {
        const field::PrimitiveParameter& parameter = solid.primitive->parameters[i];
        const Value& value = solid.args[i];
        field::Argument& argument = arguments.emplace_back();
        for (size_t k = 0; k < 2; ++k)  // points have two numbers, all others are told by their first
            argument.value[k] = std::clamp(value.n[std::min<size_t>(k, value.count - 1u)], parameter.lo, parameter.hi);
    }
    return arguments;
}

SolidValue evaluateSolid(const rules::Solid& solid, const Place& place) {
    SolidValue v;
    v.kind = solid.kind;
    v.primitive = solid.primitive;
    v.op = solid.op;
    for (size_t i = 0; i < solid.args.size(); ++i) {
        v.args.push_back(evaluate(solid.args[i], place));
        if (!place.builder || solid.args[i].kind == rules::Expr::Kind::Constant) continue;
        if (auto why = rules::findOutOfRange(*solid.primitive, i, v.args.back()))
            place.builder->warn(solid.args[i].span, std::move(*why), nearestEnd);
    }
    for (const rules::Solid& part : solid.parts) v.parts.push_back(evaluateSolid(part, place));
    if (solid.kind == rules::Solid::Kind::Morph)
        v.amount = numberWithin(solid.amount, place, 0, 1, "the morph's share");
    return v;
}

}  // namespace sgm::derive
