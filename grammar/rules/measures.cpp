// Constants of a file, and measures of the scope in which shares and lengths meet.
#include <fmt/format.h>

#include "grammar/rules/checker.h"
#include "grammar/rules/make.h"

namespace sgm::rules {

using Written = syntax::Expr;
using Where = Place::Where;

/// A constant of the file, in its place.
Typed Checker::constant(Place& place, const Written& e, Constant& constant) {
    constant.used = true;
    if (place.where == Where::Constant) {  // before parameters are known: those it asks are no plain value
        if (constant.inWork) return failed(e.span, fmt::format("the value '{}' is made of itself", e.text));
        constant.inWork = true;
        Place own(Where::Constant);
        Typed value = expression(own, constant.decl->value);
        constant.inWork = false;
        return value;
    }
    if (constant.value) return *constant.value;
    return failed(e.span, fmt::format("the value '{}' isn't known here", e.text),
                  "a 'let' may ask parameters and the values above it");
}

/// One of two numbers becomes metres where it is a share of the scope and the other a length: 100% - 1m.
bool Checker::mix(Place& place, Typed& a, Typed& b) const {
    const auto isOf = [](const Typed& t, Unit unit) {
        return t.type.known && t.type.like.kind == Value::Kind::Number && t.type.like.units[0] == unit;
    };
    if (place.axis < 0) return false;
    Typed* share = isOf(a, Unit::Share) && isOf(b, Unit::Metre)   ? &a
                   : isOf(b, Unit::Share) && isOf(a, Unit::Metre) ? &b
                                                                  : nullptr;
    if (!share) return false;
    const SourceSpan span = share->expr.span;
    Expr extent;
    extent.kind = Expr::Kind::Scope;
    extent.span = span;
    extent.index = 4 + static_cast<uint32_t>(place.axis);
    share->expr = makeCall(Expr::Kind::Binary, Fn::Mul, span, {std::move(extent), std::move(share->expr)});
    share->type = Type::number(Unit::Metre);
    place.mixes = true;
    return true;
}

/// A measure of the scope, one number or three. One that mixes shares and lengths is another along each axis.
Expr Checker::measured(Place& place, const Written& e, Want want, std::string_view what) {
    const uint32_t ranges = place.ranges;
    place.axis = 0;
    place.mixes = false;
    Expr first = expression(place, e, want, what);
    const bool eachAxis = place.mixes && e.kind != Written::Kind::Tuple;
    if (eachAxis) {
        Expr all;
        all.kind = Expr::Kind::Tuple;
        all.span = e.span;
        all.args.push_back(std::move(first));
        for (place.axis = 1; place.axis < 3; ++place.axis) {
            place.ranges = ranges;  // the same draw along every axis
            all.args.push_back(expression(place, e, want, what));
        }
        first = std::move(all);
    }
    place.axis = -1;
    return first;
}

}  // namespace sgm::rules
