// Solids as a shape evaluates them (expressions.h), with a warning for arguments beyond their range.
#include <algorithm>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"
#include "grammar/rules/arithmetic_warnings.h"

namespace sgm::derive {

using rules::Value;

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
            place.builder->warn(solid.args[i].span, std::move(*why), rules::countsAsNearestEnd);
    }
    for (const rules::Solid& part : solid.parts) v.parts.push_back(evaluateSolid(part, place));
    if (solid.kind == rules::Solid::Kind::Morph)
        v.amount = numberWithin(solid.amount, place, 0, 1, "the morph's share");
    return v;
}

}  // namespace sgm::derive
