// Expressions: names found, units checked, constants folded. Functions and operators stand in operators.cpp, what is
// drawn in chance.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "grammar/rules/color.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/figures.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using Where = Place::Where;

constexpr std::array<std::string_view, 7> axisWords{"+x", "-x", "+y", "-y", "+z", "-z", "centre"};

constexpr std::array<std::string_view, 12> colorWords{"red",   "green", "blue", "yellow", "orange", "brown",
                                                      "black", "white", "grey", "gray",   "purple", "pink"};

/// Numbers as their place understands them: bare lengths are metres, and only counts stay whole.
void adapt(Expr& e, Want want) {
    if (want == Want::Anything || want == Want::Count || want == Want::Truth) return;
    if (e.kind == Expr::Kind::Constant &&
        (e.value.kind == Value::Kind::Number || e.value.kind == Value::Kind::Vector)) {
        e.value.integer = false;
        const Unit bare = want == Want::Length || want == Want::Size || want == Want::Extent ? Unit::Metre
                          : want == Want::Frequency                                          ? Unit::PerMetre
                                                                                             : Unit::None;
        for (size_t i = 0; i < std::min<size_t>(e.value.count, e.value.units.size()); ++i)
            if (e.value.units[i] == Unit::None) e.value.units[i] = bare;
    }
    if (e.kind == Expr::Kind::Tuple || e.kind == Expr::Kind::Range || e.kind == Expr::Kind::Ramp)
        for (Expr& arg : e.args) adapt(arg, want);
    if (e.kind == Expr::Kind::Choose)
        for (size_t i = 1; i < e.args.size(); i += 2) adapt(e.args[i], want);
}

bool takesThree(Want want) {
    return want == Want::Size || want == Want::Offset || want == Want::Triple || want == Want::Angles;
}

Typed numberOf(const Written& e) {
    Value value = Value::number(e.number);
    value.integer = e.unit.empty() && e.span.text().find_first_of(".eE") == std::string_view::npos;
    if (e.unit == "m") value.units[0] = Unit::Metre;
    if (e.unit == "km") value = Value::number(e.number * 1000, Unit::Metre);
    if (e.unit == "cm") value = Value::number(e.number / 100, Unit::Metre);
    if (e.unit == "mm") value = Value::number(e.number / 1000, Unit::Metre);
    if (e.unit == "m2" || e.unit == "m²") value.units[0] = Unit::SquareMetre;
    if (e.unit == "m3" || e.unit == "m³") value.units[0] = Unit::CubicMetre;
    if (e.unit == "/m") value.units[0] = Unit::PerMetre;
    if (e.unit == "deg") value = Value::number(radians(e.number), Unit::Angle);
    if (e.unit == "%") value = Value::number(e.number / 100, Unit::Share);
    return makeTyped(e.span, value);
}

Typed unknownName(CheckContext& ctx, const Place& place, const Written& e) {
    std::vector<std::string> known;
    for (const auto& [param, index] : ctx.names.params) known.push_back(param);
    for (const auto& local : place.locals) known.push_back(local.name);
    for (const auto& [let, constant] : ctx.names.lets) known.push_back(let);
    for (const auto& [map, index] : ctx.names.maps) known.push_back(map);
    for (const auto& [value, facts] : ctx.names.inherited) known.push_back(value);
    if (place.where == Where::Expect) known = figureNames(ctx.grammar);
    std::string hint = nearestHint(e.text, known);
    if (e.text == "i" || e.text == "split" || e.text == "repeat")
        hint = "'i' counts the steps of a 'repeat' and of a '{ … }*'; 'with k = i' passes it to other rules";
    if (place.where == Where::Expect && hint.empty())
        hint = fmt::format("a check may ask for {} and count(Name)", fmt::join(figureNames(ctx.grammar), ", "));
    if (std::find(colorWords.begin(), colorWords.end(), e.text) != colorWords.end() && hint.empty())
        hint = "a colour is written #rrggbb, as #c8b090";
    if (e.text == "rest") hint = "write '~1' for what the other parts of a split leave";
    if (ctx.names.symbols.contains(e.text))
        return fail(ctx, e.span, fmt::format("'{}' is a shape, not a value", e.text));
    return failUnknown(ctx, e.span, e.text, fmt::format("unknown name '{}'", e.text), std::move(hint));
}

Typed checkName(CheckContext& ctx, Place& place, const Written& e) {
    for (auto local = place.locals.rbegin(); local != place.locals.rend(); ++local)
        if (local->name == e.text) {
            Typed result;
            result.expr.kind = Expr::Kind::Local;
            result.expr.span = e.span;
            result.expr.index = local->index;
            result.type = local->type;
            return result;
        }
    if (const int axis = axisNumber(e.text); axis >= 0) return makeTyped(e.span, makeAxis(axis));
    if (e.text == "true" || e.text == "false") return makeTyped(e.span, Value::boolean(e.text == "true"));
    Typed result;
    result.expr.span = e.span;
    if (place.where == Where::Expect)
        if (auto figure = findFigure(ctx.grammar, e)) return std::move(*figure);
    if (e.text == "covered" && place.where == Where::Guard && !place.ofMap) {
        result.expr = makeCall(Expr::Kind::Call, Fn::Covered, e.span, {});
        result.type = Type::number();
        return result;
    }
    if (const auto let = ctx.names.lets.find(e.text); let != ctx.names.lets.end())
        return checkConstant(ctx, place, e, let->second);
    if (const auto map = ctx.names.maps.find(e.text); map != ctx.names.maps.end())
        return checkMapName(ctx, place, e, map->second);
    if (const auto param = ctx.names.params.find(e.text); param != ctx.names.params.end()) {
        if (place.where == Where::Constant)
            return fail(ctx, e.span, fmt::format("'{}' is a parameter, but a plain value must stand here", e.text));
        ctx.params.used.insert(param->second);
        const Param& p = ctx.grammar.params[param->second];
        result.expr.kind = Expr::Kind::Param;
        result.expr.index = param->second;
        result.type = Type::of(p.value);
        if (!p.choices.empty()) result.type.words = &p.choices;
        if (ctx.params.broken.contains(param->second)) return {makeUnreadable(e.span), Type::unknown()};
        return result;
    }
    const auto inherited = ctx.names.inherited.find(e.text);
    if (inherited != ctx.names.inherited.end() && !place.ofMap && place.where >= Where::Guard &&
        place.where != Where::Expect) {
        inherited->second.used = true;
        result.expr.kind = Expr::Kind::Inherited;
        result.expr.value = makeWord(e.text);
        result.type = Type::unknown();
        return result;
    }
    if (const auto symbol = ctx.names.symbols.find(e.text); symbol != ctx.names.symbols.end()) {
        const Symbol& s = ctx.grammar.symbols[symbol->second];
        if (s.isMaterial || (place.material && s.terminal)) {
            Value word = makeWord(e.text);
            word.n[0] = symbol->second;
            return makeTyped(e.span, std::move(word));
        }
    }
    if (e.text == "pi") return makeTyped(e.span, Value::number(std::numbers::pi));
    return unknownName(ctx, place, e);
}

Typed checkMember(CheckContext& ctx, Place& place, const Written& e) {
    const int axis = e.text == "x" ? 0 : e.text == "y" ? 1 : e.text == "z" ? 2 : -1;
    const bool named = e.args[0].kind == Written::Kind::Name;
    const bool ofScope = named && e.args[0].text == "scope", isArea = ofScope && e.text == "area";
    const bool ofPlace = named && e.args[0].text == "here";
    if (axis < 0 && !ofScope && !ofPlace)
        if (Typed whole = checkExpression(ctx, place, e.args[0]); !whole.type.known) return whole;
    if (axis < 0 && !isArea)
        return fail(ctx, e.span, fmt::format("there is no '.{}'", e.text),
                    ofScope ? "write .x, .y, .z or .area" : "write .x, .y or .z");
    Typed result;
    result.expr.span = e.span;
    if (ofScope || ofPlace) {
        if (place.where < Where::Guard || place.where == Where::Expect || (ofScope && place.ofMap))
            return fail(ctx, e.span,
                        fmt::format("there is no shape here whose {} could be asked", ofScope ? "scope" : "place"),
                        place.ofMap ? "a map asks 'here.x' and 'here.z', and maps above it" : "");
        result.expr.kind = ofScope ? Expr::Kind::Scope : Expr::Kind::Here;
        result.expr.index = isArea ? 3u : static_cast<uint32_t>(axis);
        result.type = Type::number(isArea ? Unit::SquareMetre : Unit::Metre);
        return result;
    }
    Typed vector = checkExpression(ctx, place, e.args[0]);
    if (!vector.type.known) return vector;
    if (vector.type.like.kind != Value::Kind::Vector || axis >= vector.type.like.count)
        return fail(ctx, e.span, fmt::format("'.{}' asks for a vector, but this is {}", e.text, describe(vector.type)));
    Value number = Value::number(axis);
    result.type = Type::of(component(vector.type.like, number));
    result.expr.kind = Expr::Kind::Element;
    result.expr.args.push_back(std::move(vector.expr));
    result.expr.args.push_back(makeTyped(e.span, number).expr);
    return result;
}

Typed checkIndex(CheckContext& ctx, Place& place, const Written& e) {
    Typed vector = checkExpression(ctx, place, e.args[0]);
    Typed at = checkExpression(ctx, place, e.args[1]);
    const auto element = [&](Type type) {
        Typed result{{}, type};
        result.expr.kind = Expr::Kind::Element;
        result.expr.span = e.span;
        result.expr.args.push_back(std::move(vector.expr));
        result.expr.args.push_back(std::move(at.expr));
        return result;
    };
    // What `with` sets has its type only while deriving.
    if (!vector.type.known || !at.type.known) return element(Type::unknown());
    const uint8_t count = vector.type.like.count;
    if (vector.type.like.kind != Value::Kind::Vector)
        return fail(ctx, e.args[0].span, fmt::format("[ ] asks for a vector, but this is {}", describe(vector.type)));
    const bool axis = at.type.like.kind == Value::Kind::Axis;
    if (axis && count != 6)
        return fail(
            ctx, e.span,
            fmt::format("a direction chooses among 6 values, +x -x +y -y +z -z, but this is a vector of {}", count));
    if (!axis && !expectType(ctx, at, Want::Count, "[ ]", nullptr)) return {std::move(vector.expr), Type::unknown()};
    if (const auto value = fold(at.expr, {}); value && (value->num() < 0 || value->num() >= count))
        return fail(ctx, e.args[1].span,
                    fmt::format("there is no value number {:.12g}: the vector's are 0 … {}", value->num(), count - 1));
    return element(Type::of(component(vector.type.like, Value::number(0))));
}

Typed checkTuple(CheckContext& ctx, Place& place, const Written& e) {
    Typed result;
    result.expr.kind = Expr::Kind::Tuple;
    result.expr.span = e.span;
    std::vector<Value> samples;
    bool known = true;
    const int axis = place.axis;
    for (size_t i = 0; i < e.args.size(); ++i) {
        const Written& arg = e.args[i];
        if (axis >= 0) place.axis = e.args.size() == 3 ? static_cast<int>(i) : -1;
        Typed part = checkExpression(ctx, place, arg);
        if (part.type.known && part.type.like.kind != Value::Kind::Number)
            part = fail(ctx, arg.span, fmt::format("a vector is made of numbers, but this is {}", describe(part.type)));
        known = known && part.type.known;
        samples.push_back(part.type.like);
        result.expr.args.push_back(std::move(part.expr));
    }
    place.axis = axis;
    if (e.args.size() > 6)
        return fail(ctx, e.span, fmt::format("a vector has at most 6 numbers, but this has {}", e.args.size()));
    if (!known) return {std::move(result.expr), Type::unknown()};
    result.type = Type::of(rules::tuple(samples));
    if (auto value = fold(result.expr, {})) return makeTyped(e.span, std::move(*value));
    return result;
}

Typed textOf(const Written& e) {
    Value text;
    text.kind = Value::Kind::Text;
    text.text = e.text;
    return makeTyped(e.span, std::move(text));
}

Typed colorOf(const Written& e) {
    const Vec3d linear = linearFromHex(static_cast<uint32_t>(e.number));
    Value color;
    color.kind = Value::Kind::Color;
    color.count = 3;
    for (int i = 0; i < 3; ++i) color.n[static_cast<size_t>(i)] = linear[i];
    return makeTyped(e.span, color);
}

Typed infer(CheckContext& ctx, Place& place, const Written& e) {
    switch (e.kind) {
        case Written::Kind::Number:
            return numberOf(e);
        case Written::Kind::Floating:
            return fail(ctx, e.span, "'~' is a size in a split, not a value");
        case Written::Kind::Text:
            return textOf(e);
        case Written::Kind::Color:
            return colorOf(e);
        case Written::Kind::Name:
            return checkName(ctx, place, e);
        case Written::Kind::Member:
            return checkMember(ctx, place, e);
        case Written::Kind::Index:
            return checkIndex(ctx, place, e);
        case Written::Kind::Call:
            return checkCall(ctx, place, e);
        case Written::Kind::Tuple:
            return checkTuple(ctx, place, e);
        case Written::Kind::Unary:
            return checkUnary(ctx, place, e);
        case Written::Kind::Binary:
            return checkBinary(ctx, place, e);
        case Written::Kind::Range:
            return checkRange(ctx, place, e);
        case Written::Kind::Ramp:
            return checkRamp(ctx, place, e);
        case Written::Kind::Choose:
            return checkChoice(ctx, place, e);
        case Written::Kind::Error:
            break;
    }
    return {{}, Type::unknown()};
}

}  // namespace

int axisNumber(std::string_view word) {
    const auto axis = std::find(axisWords.begin(), axisWords.end(), word == "center" ? "centre" : word);
    return axis == axisWords.end() ? -1 : static_cast<int>(axis - axisWords.begin());
}

Typed checkExpression(CheckContext& ctx, Place& place, const Written& e) {
    Typed result = infer(ctx, place, e);
    result.expr.span = e.span;
    if (!result.type.known && result.expr.kind == Expr::Kind::Constant) result.expr = makeUnreadable(e.span);
    return result;
}

Expr checkExpression(CheckContext& ctx, Place& place, const Written& e, Want want, std::string_view what) {
    const bool outer = std::exchange(place.material, place.material || want == Want::Anything);
    Typed result = checkExpression(ctx, place, e);
    place.material = outer;
    const bool byComponent =
        e.kind == Written::Kind::Tuple && e.args.size() == 3 && takesThree(want) && !fits(result.type, want);
    bool good = byComponent || expectType(ctx, result, want, what, &e);
    for (size_t i = 0; byComponent && i < 3; ++i) {
        const SourceSpan span = e.args[i].span;
        const Value index = makeWhole(static_cast<double>(i));
        Expr part = result.expr.kind == Expr::Kind::Tuple ? result.expr.args[i]
                                                          : makeConstant(span, component(result.expr.value, index));
        part.span = span;
        good =
            expectType(ctx, {std::move(part), Type::of(component(result.type.like, index))}, want, what, &e.args[i]) &&
            good;
    }
    if (!good) return makeUnreadable(e.span);
    adapt(result.expr, want);
    return std::move(result.expr);
}

}  // namespace sgm::rules
