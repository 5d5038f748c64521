#include "grammar/derive/expressions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grammar/derive/builder.h"
#include "grammar/derive/map_values.h"
#include "grammar/derive/scope_footprint.h"
#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/measure_text.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

using rules::Expr;
using rules::Fn;
using rules::Unit;
using rules::Value;
using Kind = Expr::Kind;

uint64_t drawKey(const Expr& range, const Place& place, uint64_t component) {
    if (place.builder) place.builder->monitor().noteChance();
    return combine(combine(place.key, range.draw), component);
}

/// Who wants to know what is read, or null.
Recording* noting(const Place& place) { return place.builder ? place.builder->recording() : nullptr; }

}  // namespace

std::string propertyName(std::string_view property) { return "file:" + std::string(property); }

namespace {

/// What this shape or the nearest one above it sets by that name; null where none does.
const Value* inherited(std::string_view wanted, const Place& place) {
    for (ShapeId s = place.valuesAt; s != none;) {
        for (const auto& [name, value] : place.tree->extrasOf(s)->values)
            if (name == wanted) return &value;
        const ShapeId parent = place.tree->shapes[s].parent;
        s = parent == none ? none : place.tree->shapes[parent].valuesAt;
    }
    return nullptr;
}

/// The value where it stands already, without a copy; null when it must be computed.
const Value* stored(const Expr& expr, const Place& place) {
    switch (expr.kind) {
        case Kind::Constant:
            return &expr.value;
        case Kind::Param:
            if (Recording* r = noting(place)) r->readsParam(expr.index);
            return &place.params[expr.index];
        case Kind::Local:
            if (Recording* r = noting(place)) r->readsLocal();
            return &place.locals[expr.index];
        case Kind::Inherited:
            if (Recording* r = noting(place)) r->readsValues();
            if (const Value* value = inherited(expr.value.text, place)) return value;
            if (place.builder)
                place.builder->monitor().fail(
                    Error::Kind::Input, "neither this shape nor any above it sets '" + expr.value.text + "' by 'with'",
                    expr.span, "set it where a shape above is made, or declare a 'param'");
            return &expr.value;
        default:
            return nullptr;
    }
}

/// A computed range whose ends are the wrong way round: an error, as written numbers are to the checker; in grammar 1 a
/// warning.
void refuseBackwards(const Expr& range, const Place& place) {
    if (!place.builder) return;
    std::string message = "the range runs backwards: it is " + rules::toText(evaluate(range.args[0], place)) + ".." +
                          rules::toText(evaluate(range.args[1], place)) + " here";
    const std::string a(range.args[0].span.text()), b(range.args[1].span.text());
    std::string hint = "'min(" + a + ", " + b + ")..max(" + a + ", " + b + ")' takes its ends either way round";
    if (rules::versionOf(*place.builder->derivation().grammar, range.span) >= 2)
        place.builder->monitor().fail(Error::Kind::Input, message, range.span, hint.c_str());
    else
        place.builder->warn(range.span, std::move(message), std::move(hint));
}

/// Whether the ends are the wrong way round by more than rounding.
bool runsBackwards(double lo, double hi) { return lo - hi > 1e-9 * std::max(1.0, std::abs(lo)); }

/// A number between the ends, which may be equal.
double drawnBetween(double lo, double hi, const Expr& range, const Place& place, uint64_t component) {
    if (runsBackwards(lo, hi)) refuseBackwards(range, place);
    return uniform(drawKey(range, place, component), lo, hi);
}

/// Numbers of different units, which the checker refuses where it knows them, are an error.
void expectAlike(const Expr& expr, std::span<const Value> args, const Place& place) {
    if (!expr.asksUnits || !place.builder) return;
    if (const auto unlike = rules::findUnlikeNumbers(expr, args))
        place.builder->monitor().fail(Error::Kind::Input, unlike->message, unlike->span, unlike->hint.c_str());
}

Value drawn(const Expr& expr, const Place& place) {
    const Value ends[] = {evaluate(expr.args[0], place), evaluate(expr.args[1], place)};
    const auto& [lo, hi] = ends;
    expectAlike(expr, ends, place);
    Value r = rules::interpolate(lo, hi, 0);
    for (uint8_t i = 0; i < r.count; ++i)
        r.n[i] = drawnBetween(lo.n[lo.count > 1 ? i : 0], hi.n[hi.count > 1 ? i : 0], expr, place, i);
    return r;
}

/// The value along a chain.
Value onRamp(const Expr& expr, const Place& place) {
    const Value ends[] = {evaluate(expr.args[0], place), evaluate(expr.args[1], place)};
    expectAlike(expr, ends, place);
    return rules::interpolate(ends[0], ends[1], place.ramp);
}

/// The value that a `choose` draws.
const Expr& chosen(const Expr& expr, const Place& place) {
    std::vector<double> weights;
    for (size_t i = 0; i < expr.args.size(); i += 2) weights.push_back(number(expr.args[i], place));
    const auto series = static_cast<rules::Series>(expr.index);
    const uint32_t at =
        series == rules::Series::None
            ? drawByWeight(weights, drawKey(expr, place, 0))
            : drawInSeries(weights, series, static_cast<uint32_t>(expr.value.num()), expr.draw, place, expr.span);
    if (at == none && place.builder) place.builder->monitor().fail(Error::Kind::Input, std::string(allZero), expr.span);
    return expr.args[2 * (at == none ? 0 : at) + 1];
}

/// scope.x, or what a share along an axis is of.
double extentOf(const Expr& expr, const Place& place) {
    if (expr.index < 3) return place.scope.size[static_cast<int>(expr.index)];
    const int axis = static_cast<int>(expr.index - rules::Expr::extentIndex);
    return place.extents_m ? (*place.extents_m)[axis] : place.scope.size[axis];
}

/// What stands around the shape; a second run with other numbers would find it as the first one left it.
Value ofSurroundings(Fn fn, const Expr& expr, const Place& place) {
    if (!place.builder || place.host == none) return Value::boolean(false);
    if (Recording* r = noting(place)) r->unfit();
    const Surroundings& around = place.builder->surroundings();
    if (fn == Fn::Covered) return Value::number(around.covered(*place.tree, place.host));
    const auto symbol = static_cast<rules::SymbolId>(expr.args[0].value.num());
    return Value::boolean(fn == Fn::Overlaps  ? around.overlaps(*place.tree, place.host, symbol)
                          : fn == Fn::Touches ? around.touches(*place.tree, place.host, symbol)
                                              : around.inside(*place.tree, place.host, symbol));
}

/// What the file says of the outline on which the shape or one above it stands; the second argument where it says
/// nothing, or no number.
Value ofOutline(Fn fn, const Expr& expr, const Place& place) {
    if (Recording* r = noting(place)) r->readsValues();
    const Value* said = inherited(propertyName(expr.args[0].value.text), place);
    Value otherwise = evaluate(expr.args[1], place);
    if (!said) return otherwise;
    if (fn == Fn::FileWord) return rules::makeWord(said->text);
    double number = said->num();
    if (said->kind == Value::Kind::Word) {  // "12", "12.5 m"
        const auto read = rules::readMeasure(said->text, otherwise.units[0]);
        if (!read) return otherwise;
        number = *read;
    }
    otherwise.n[0] = otherwise.units[0] == rules::Unit::Angle ? number * std::numbers::pi / 180 : number;
    otherwise.integer = false;
    return otherwise;
}

Value called(const Expr& expr, const Place& place) {
    const Fn fn = static_cast<Fn>(expr.index);
    if (fn == Fn::FileNumber || fn == Fn::FileWord) return ofOutline(fn, expr, place);
    if (fn == Fn::Bump || fn == Fn::Fbm) return ofPlace(fn, expr, place);
    if (fn == Fn::Mean) return meanOf(expr.args[0], place);
    if (fn == Fn::Count) {
        if (Recording* r = noting(place)) r->readsWorld();
        const auto symbol = static_cast<size_t>(expr.args[0].value.num());
        return Value::number(symbol < place.counts.size() ? static_cast<double>(place.counts[symbol]) : 0);
    }
    if (fn == Fn::Overlaps || fn == Fn::Touches || fn == Fn::Inside || fn == Fn::Covered)
        return ofSurroundings(fn, expr, place);
    if (fn == Fn::If) return evaluate(expr.args[holds(expr.args[0], place) ? 1 : 2], place);
    std::vector<Value> args;
    args.reserve(expr.args.size());
    for (const Expr& arg : expr.args) args.push_back(evaluate(arg, place));
    expectAlike(expr, args, place);
    if (place.builder)
        if (auto suspect = rules::findArithmeticWarning(expr, args)) {
            const bool divides = fn == Fn::Div || fn == Fn::Rem;
            if (divides && rules::versionOf(*place.builder->derivation().grammar, suspect->span) >= 2)
                place.builder->monitor().fail(Error::Kind::Input, suspect->message, suspect->span);
            else
                place.builder->warn(suspect->span, std::move(suspect->message), std::move(suspect->hint));
        }
    return rules::applyFunction(fn, args);
}

/// Arithmetic on first components, which is what `rules::applyFunction` does to them.
bool arithmetic(Fn fn, const Expr& expr, const Place& place, double& out) {
    if (expr.asksUnits && fn != Fn::Equal && fn != Fn::NotEqual) return false;
    const auto arg = [&](size_t i) { return number(expr.args[i], place); };
    switch (fn) {
        case Fn::Add:
            out = arg(0) + arg(1);
            return true;
        case Fn::Sub:
            out = arg(0) - arg(1);
            return true;
        case Fn::Less:
            out = arg(0) < arg(1);
            return true;
        case Fn::LessEq:
            out = arg(0) <= arg(1);
            return true;
        case Fn::Greater:
            out = arg(0) > arg(1);
            return true;
        case Fn::GreaterEq:
            out = arg(0) >= arg(1);
            return true;
        case Fn::Equal:
        case Fn::NotEqual:
            if (const auto equal = isOfClass(expr, place)) {
                out = *equal == (fn == Fn::Equal);
                return true;
            }
            return false;
        case Fn::And:
            out = arg(0) != 0 && arg(1) != 0;
            return true;
        case Fn::Or:
            out = arg(0) != 0 || arg(1) != 0;
            return true;
        case Fn::Not:
            out = arg(0) == 0;
            return true;
        default:
            return false;
    }
}

}  // namespace

Value evaluate(const Expr& expr, const Place& place) {
    if (const Value* v = stored(expr, place)) return *v;
    switch (expr.kind) {
        case Kind::Scope:
            if (expr.index != 3) return Value::number(extentOf(expr, place), Unit::Metre);
            return Value::number(place.tree ? area(footprintOf(place.scope, place.tree->footprints)) : 0,
                                 Unit::SquareMetre);
        case Kind::Here:
            return Value::number(place.scope.centre[static_cast<int>(expr.index)], Unit::Metre);
        case Kind::Map:
            return ofMap(expr, place);
        case Kind::Element:
            return rules::component(evaluate(expr.args[0], place), evaluate(expr.args[1], place));
        case Kind::Tuple: {
            std::vector<Value> parts;
            parts.reserve(expr.args.size());
            for (const Expr& arg : expr.args) parts.push_back(evaluate(arg, place));
            return rules::tuple(parts);
        }
        case Kind::Unary:
        case Kind::Binary:
        case Kind::Call:
            return called(expr, place);
        case Kind::Range:
            return drawn(expr, place);
        case Kind::Choose:
            return evaluate(chosen(expr, place), place);
        case Kind::Ramp:
            return onRamp(expr, place);
        default:
            return {};
    }
}

double number(const Expr& expr, const Place& place) {
    if (const Value* v = stored(expr, place)) return v->num();
    switch (expr.kind) {
        case Kind::Scope:
            if (expr.index != 3) return extentOf(expr, place);
            break;
        case Kind::Here:
            return place.scope.centre[static_cast<int>(expr.index)];
        case Kind::Element:
            if (const Value* v = stored(expr.args[0], place)) {
                Value index;
                index.n[0] = number(expr.args[1], place);
                return rules::component(*v, index).num();
            }
            break;
        case Kind::Ramp: {
            if (expr.asksUnits) break;
            const double a = number(expr.args[0], place), b = number(expr.args[1], place);
            return a + (b - a) * place.ramp;
        }
        case Kind::Range:
            if (expr.asksUnits) break;
            return drawnBetween(number(expr.args[0], place), number(expr.args[1], place), expr, place, 0);
        case Kind::Choose:
            return number(chosen(expr, place), place);
        case Kind::Unary:
        case Kind::Binary: {
            double out = 0;
            if (arithmetic(static_cast<Fn>(expr.index), expr, place, out)) return out;
            break;
        }
        default:
            break;
    }
    return evaluate(expr, place).num();
}

uint32_t drawByWeight(std::span<const double> weights, uint64_t key) {
    double total = 0;
    for (const double w : weights) total += std::max(0.0, w);
    double drawn = uniform(key) * total;
    uint32_t last = none;
    for (uint32_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        if (drawn < weights[i]) return i;
        drawn -= weights[i];
        last = i;  // where rounding leaves a rest
    }
    return last;
}

double wholeNumber(const Expr& expr, const Place& place) {
    if (expr.kind == Kind::Choose) return wholeNumber(chosen(expr, place), place);
    if (expr.kind != Kind::Range) return std::floor(number(expr, place) + 1e-9);
    const double from = number(expr.args[0], place), to = number(expr.args[1], place);
    if (runsBackwards(from, to)) refuseBackwards(expr, place);
    const double lo = std::ceil(from), hi = std::floor(to);
    if (hi <= lo) return lo;
    return lo + std::floor(uniform(drawKey(expr, place, 0)) * (hi - lo + 1));
}

Vector vector(const Expr& expr, const Place& place, bool eachDraws) {
    if (expr.kind == Kind::Choose) return vector(chosen(expr, place), place, eachDraws);
    const Value v = evaluate(expr, place);
    Vector r;
    for (size_t i = 0; i < 3; ++i) {
        const size_t from = v.count > 1 ? std::min<size_t>(i, v.count - 1u) : 0;
        r.n[static_cast<int>(i)] = v.n[from];
        r.unit[i] = v.units[from];
    }
    if (eachDraws && v.count == 1 && expr.kind == Kind::Range) {
        const double lo = number(expr.args[0], place), hi = number(expr.args[1], place);
        for (int i = 1; i < 3; ++i) r.n[i] = uniform(drawKey(expr, place, static_cast<uint64_t>(i)), lo, hi);
    }
    return r;
}

double numberWithin(const Expr& expr, const Place& place, double lo, double hi, std::string_view name) {
    const double n = number(expr, place);
    if (n >= lo && n <= hi) return n;
    if (place.builder) {
        const auto text = [&](double v) { return rules::toText(Value::number(v, evaluate(expr, place).units[0])); };
        place.builder->warn(expr.span,
                            std::isinf(hi)
                                ? fmt::format("{} is {}, but must be no less than {}", name, text(n), text(lo))
                                : fmt::format("{} is {}, but must be {} … {}", name, text(n), text(lo), text(hi)),
                            std::isinf(hi) ? fmt::format("it counts as {}", text(lo)) : rules::countsAsNearestEnd);
    }
    return std::clamp(n, lo, hi);
}

Mat3 rotation(const Value& v) {
    if (v.kind == Value::Kind::Rotation)
        return {{v.n[0], v.n[1], v.n[2]}, {v.n[3], v.n[4], v.n[5]}, {v.n[6], v.n[7], v.n[8]}};
    if (v.count == 1) return Mat3::rotation({0, 1, 0}, v.n[0]);
    return Mat3::rotation({0, 0, 1}, v.n[2]) * Mat3::rotation({0, 1, 0}, v.n[1]) * Mat3::rotation({1, 0, 0}, v.n[0]);
}

}  // namespace sgm::derive
