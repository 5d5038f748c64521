#include "grammar/rules/arithmetic_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/evaluate.h"

namespace sgm::rules {
namespace {

bool hasZero(const Value& v) {
    return v.kind != Value::Kind::Rotation &&
           std::any_of(v.n.begin(), v.n.begin() + v.count, [](double n) { return n == 0; });
}

/// What a function of numbers of one unit does, as in "can't add".
std::string_view verbOf(Fn fn) {
    switch (fn) {
        case Fn::Add:
            return "add";
        case Fn::Sub:
            return "subtract";
        case Fn::Rem:
            return "divide";
        case Fn::Lerp:
            return "choose between";
        default:
            return "compare";
    }
}

ArithmeticWarning divisionByZero(const Expr& call) {
    const Expr& divisor = call.args[1];
    const bool literal = divisor.kind == Expr::Kind::Constant;
    return {call.span, literal ? "divided by 0" : fmt::format("divided by 0: '{}' is 0", divisor.span.text()),
            literal ? "the result counts as 0"
                    : fmt::format("the result counts as 0: keep '{0}' from 0, or write 'max({0}, …)'",
                                  divisor.span.text())};
}

std::optional<ArithmeticWarning> rgbDoubt(const Expr& call, std::span<const Value> args) {
    constexpr double slack = 1e-9;
    for (size_t i = 0; i < args.size(); ++i) {
        const double share = args[i].num();
        if (share >= -slack && share <= 1 + slack) continue;
        const bool bytes = share > 1 && share <= 255;
        return ArithmeticWarning{
            call.args[i].span, fmt::format("'rgb' takes shares 0 … 1, but this is {:.6g}", share),
            bytes ? fmt::format("write '{} / 255', or the colour as #rrggbb", call.args[i].span.text())
                  : countsAsNearestEnd};
    }
    return {};
}

}  // namespace

std::optional<ArithmeticWarning> findArithmeticWarning(const Expr& call, std::span<const Value> args) {
    switch (static_cast<Fn>(call.index)) {
        case Fn::Div:
        case Fn::Rem:
            if (args.size() == 2 && hasZero(args[1])) return divisionByZero(call);
            return {};
        case Fn::Sqrt:
            if (args.empty() || !(args[0].num() < 0)) return {};
            return ArithmeticWarning{call.span, fmt::format("square root of a negative number: {:.6g}", args[0].num()),
                                     "the root counts as 0: write 'sqrt(max(0, …))' where that is meant"};
        case Fn::Rgb:
            return rgbDoubt(call, args);
        default:
            return {};
    }
}

ArithmeticWarning unlikeNumbers(const Type& a, const Type& b, std::string_view verb) {
    const Unit ua = a.like.units[0], ub = b.like.units[0];
    const bool measures = (ua == Unit::Share && ub == Unit::Metre) || (ua == Unit::Metre && ub == Unit::Share);
    return {{},
            fmt::format("can't {} {} and {}", verb, describe(a), describe(b)),
            measures ? "they meet in 'size', 'move' and the sizes of a 'split'; elsewhere write 'scope.x', "
                       "'scope.y' or 'scope.z' for 100%"
                     : ""};
}

std::optional<ArithmeticWarning> findUnlikeNumbers(const Expr& expr, std::span<const Value> args) {
    const bool calls = expr.kind == Expr::Kind::Binary || expr.kind == Expr::Kind::Call;
    const std::string_view verb = expr.kind == Expr::Kind::Range  ? "draw between"
                                  : expr.kind == Expr::Kind::Ramp ? "go between"
                                  : calls                         ? verbOf(static_cast<Fn>(expr.index))
                                                                  : "";
    const size_t count = static_cast<Fn>(expr.index) == Fn::Lerp && calls ? 2 : args.size();
    for (size_t i = 1; i < count; ++i)
        for (size_t j = 0; j < i; ++j) {
            const Type a = Type::of(args[j]), b = Type::of(args[i]);
            if (!a.numeric() || !b.numeric() || compatible(a, b)) continue;
            ArithmeticWarning found = unlikeNumbers(a, b, verb);
            found.span = syntax::join(expr.args[j].span, expr.args[i].span);
            return found;
        }
    return {};
}

std::optional<std::string> findOutOfRange(const field::Primitive& row, size_t parameter, const Value& value) {
    const field::PrimitiveParameter& p = row.parameters[parameter];
    const bool isFree = p.kind == field::ParameterKind::Rotation || p.kind == field::ParameterKind::File;
    if (isFree || value.kind == Value::Kind::Word || value.kind == Value::Kind::Text) return {};
    for (size_t i = 0; i < value.count; ++i) {
        if (value.n[i] >= p.lo && value.n[i] <= p.hi) continue;
        const auto bound = [&](double n) {
            Value b = Value::number(n, value.units[std::min(i, value.units.size() - 1)]);
            b.integer = p.kind == field::ParameterKind::Count;
            return toText(b);
        };
        return fmt::format("'{}' of '{}' is {}, but must be {} … {}", p.name, row.name, toText(value), bound(p.lo),
                           bound(p.hi));
    }
    return {};
}

std::optional<ArithmeticWarning> findDoubtWithin(const Expr& e, std::span<const Value> params) {
    const bool calls = e.kind == Expr::Kind::Unary || e.kind == Expr::Kind::Binary || e.kind == Expr::Kind::Call;
    if (calls && static_cast<Fn>(e.index) == Fn::If) {
        const auto holds = fold(e.args[0], params);
        return holds ? findDoubtWithin(e.args[holds->truth() ? 1 : 2], params) : std::nullopt;
    }
    std::vector<Value> values;
    for (const Expr& arg : e.args) {
        if (auto suspect = findDoubtWithin(arg, params)) return suspect;
        if (auto value = fold(arg, params)) values.push_back(std::move(*value));
    }
    return calls && values.size() == e.args.size() ? findArithmeticWarning(e, values) : std::nullopt;
}

}  // namespace sgm::rules
