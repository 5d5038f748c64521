// Constants of a file, and measures of the scope in which shares and lengths meet.
#include <fmt/format.h>

#include "grammar/rules/expressions.h"
#include "grammar/rules/make.h"

namespace sgm::rules {

using Written = syntax::Expr;
using Where = Place::Where;

/// A constant of the file, in its place.
Typed checkConstant(CheckContext& ctx, Place& place, const Written& e, Constant& constant) {
    constant.used = true;
    if (place.where == Where::Constant) {  // before parameters are known: those it asks are no plain value
        if (constant.inWork) return fail(ctx, e.span, fmt::format("the value '{}' is made of itself", e.text));
        constant.inWork = true;
        Place own(Where::Constant);
        Typed value = checkExpression(ctx, own, constant.decl->value);
        constant.inWork = false;
        return value;
    }
    if (constant.value) return *constant.value;
    return fail(ctx, e.span, fmt::format("the value '{}' isn't known here", e.text),
                "a 'let' may ask parameters and the values above it");
}

/// One of two numbers becomes metres where it is a share of the scope and the other a length: 100% - 1m. What another
/// shape set by `with` is found to be one or the other where it is read.
bool mixShares(Place& place, Typed& a, Typed& b) {
    const auto isOf = [](const Typed& t, Unit unit) {
        return t.type.known && t.type.like.kind == Value::Kind::Number && t.type.like.units[0] == unit;
    };
    const auto mayBeLength = [&](const Typed& t) { return !t.type.known || isOf(t, Unit::Metre); };
    if (place.axis < 0) return false;
    Typed* share = isOf(a, Unit::Share) && mayBeLength(b) ? &a : isOf(b, Unit::Share) && mayBeLength(a) ? &b : nullptr;
    if (!share) return false;
    Typed& other = share == &a ? b : a;
    const auto extent = [&](SourceSpan span) {
        Expr e;
        e.kind = Expr::Kind::Scope;
        e.span = span;
        e.index = Expr::extentIndex + static_cast<uint32_t>(place.axis);
        return e;
    };
    const SourceSpan span = share->expr.span;
    share->expr = makeCall(Expr::Kind::Binary, Fn::Mul, span, {extent(span), std::move(share->expr)});
    share->type = Type::number(Unit::Metre);
    if (!other.type.known) {
        const SourceSpan at = other.expr.span;
        other.expr = makeCall(Expr::Kind::Call, Fn::Metres, at, {std::move(other.expr), extent(at)});
        other.type = Type::number(Unit::Metre);
    }
    place.mixes = true;
    return true;
}

/// A measure of the scope, one number or three. One that mixes shares and lengths is another along each axis.
Expr checkMeasure(CheckContext& ctx, Place& place, const Written& e, Want want, std::string_view what) {
    const uint32_t ranges = place.ranges;
    place.axis = 0;
    place.mixes = false;
    Expr first = checkExpression(ctx, place, e, want, what);
    const bool eachAxis = place.mixes && e.kind != Written::Kind::Tuple;
    if (eachAxis) {
        Expr all;
        all.kind = Expr::Kind::Tuple;
        all.span = e.span;
        all.args.push_back(std::move(first));
        for (place.axis = 1; place.axis < 3; ++place.axis) {
            place.ranges = ranges;  // the same draw along every axis
            all.args.push_back(checkExpression(ctx, place, e, want, what));
        }
        first = std::move(all);
    }
    place.axis = -1;
    return first;
}

}  // namespace sgm::rules
