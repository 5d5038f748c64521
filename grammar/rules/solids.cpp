// Solids: rows of the primitive table, morphs and combinations of them, and terminals that stand for one.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/bodies.h"
#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/plans.h"
#include "grammar/rules/solid_arguments.h"
#include "grammar/rules/words.h"
#include "modeler/core/lower_case.h"
#include "modeler/field/plan_parameters.h"
#include "modeler/plan/edge_words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;
using field::ParameterKind;

Want wantOf(ParameterKind kind) {
    switch (kind) {
        case ParameterKind::Share:
            return Want::Number;
        case ParameterKind::Length:
            return Want::Length;
        case ParameterKind::Angle:
            return Want::Angle;
        case ParameterKind::Count:
            return Want::Count;
        case ParameterKind::Vector:
            return Want::Triple;
        case ParameterKind::Point:
            return Want::Pair;
        case ParameterKind::PerId:
            return Want::PerId;
        case ParameterKind::Rotation:
            return Want::Rotation;
        case ParameterKind::Choice:
        case ParameterKind::File:
            return Want::Anything;
    }
    return Want::Anything;
}

Value plainValue(ParameterKind kind, double v) {
    const Unit unit = kind == ParameterKind::Length || kind == ParameterKind::Point ? Unit::Metre
                      : kind == ParameterKind::Angle                                ? Unit::Angle
                                                                                    : Unit::None;
    Value value = Value::number(v, unit);
    value.integer = kind == ParameterKind::Count;
    return value;
}

Value fallbackOf(const field::PrimitiveParameter& p) {
    Value value = plainValue(p.kind, p.fallback);
    if (p.kind == ParameterKind::Vector) {
        const std::array<Value, 3> same{value, value, value};
        return tuple(same);
    }
    if (p.kind == ParameterKind::Point) {
        const std::array<Value, 2> same{value, value};
        return tuple(same);
    }
    if (p.kind == ParameterKind::Rotation)
        return applyFunction(Fn::RotY, std::array{Value::number(p.fallback, Unit::Angle)});
    return value;
}

std::vector<std::string> split(std::string_view list, char separator) {
    std::vector<std::string> parts;
    while (!list.empty()) {
        const size_t end = std::min(list.find(separator), list.size());
        parts.emplace_back(list.substr(0, end));
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return parts;
}

size_t partsOf(const Solid& solid) {
    size_t count = 1;
    for (const Solid& part : solid.parts) count += partsOf(part);
    return count;
}

Operator operatorOf(std::string_view text) {
    return text == "-" ? Operator::Difference : text == "&" ? Operator::Intersection : Operator::Sum;
}

/// What other programs call our solids and operators.
constexpr std::pair<std::string_view, std::string_view> elsewhere[] = {
    {"box", "did you mean 'cube'?"},
    {"ball", "did you mean 'sphere'?"},
    {"tube", "did you mean 'cylinder'?"},
    {"ring", "did you mean 'torus'?"},
    {"union", "join shapes with '+'"},
    {"difference", "cut with '-'"},
    {"subtract", "cut with '-'"},
    {"intersection", "keep with '&' what both share"},
    {"circle", "write 'cylinder size (x, y, z)', or 'footprint round(48, 5m) extrude 3m block'"},
    {"ellipse", "write 'cylinder size (x, y, z)', or 'size (9, 3, 5) footprint round(48) block'"},
    {"polygon", "write 'footprint outline((0, 0), (8, 0), (8, 6)) extrude 3m block'"},
    {"square", "write 'footprint rect(8, 6) extrude 3m block'"},
    {"i", "write 'mesh(\"file.obj\")'"},
    {"s", "write 'size (x, y, z)' behind a shape"},
    {"t", "write 'move (x, y, z)'"},
    {"r", "write 'turn (x, y, z)'"}};

/// What other programs give a solid: here its scope has it.
constexpr std::string_view extents[] = {"radius", "r", "diameter", "d", "width", "height", "h", "depth", "length"};

/// One word of a choice becomes its index; a parameter that offers the same words is asked at every derivation.
Expr checkChoiceArgument(CheckContext& ctx, Place& place, const Written& e,
                         const field::PrimitiveParameter& parameter) {
    const std::vector<std::string> words = split(parameter.choices, '|');
    const auto indexOf = [&](size_t i) {
        return makeConstant(e.span, plainValue(parameter.kind, static_cast<double>(i)));
    };
    const auto word = std::find(words.begin(), words.end(), e.text);
    if (e.kind == Written::Kind::Name && word != words.end()) return indexOf(static_cast<size_t>(word - words.begin()));
    Typed chosen;
    if (e.kind == Written::Kind::Name && ctx.names.params.contains(e.text)) chosen = checkExpression(ctx, place, e);
    if (!chosen.type.words || *chosen.type.words != words) {
        ctx.diagnostics.error(e.span, fmt::format("'{}' is one of {}", parameter.name, fmt::join(words, ", ")),
                              nearestHint(e.text, words));
        return indexOf(0);
    }
    Expr result = indexOf(0);
    for (size_t i = words.size(); i-- > 1;) {
        Expr equal =
            makeCall(Expr::Kind::Binary, Fn::Equal, e.span, {chosen.expr, makeConstant(e.span, makeWord(words[i]))});
        result = makeCall(Expr::Kind::Call, Fn::If, e.span, {std::move(equal), indexOf(i), std::move(result)});
    }
    return result;
}

/// The name of a file, read here; each file once.
Expr checkFileArgument(CheckContext& ctx, const Written& e, const field::Primitive& row) {
    Value file;
    file.kind = Value::Kind::Text;
    file.text = e.text;
    if (e.kind != Written::Kind::Text) {
        ctx.diagnostics.error(e.span,
                              fmt::format("'{}' takes the name of a file in quotes, not '{}'", row.name, e.span.text()),
                              fmt::format("write '{}(\"statue.obj\")'", row.name));
        return makeConstant(e.span, file);
    }
    file.n[0] = static_cast<double>(ctx.files.readMesh(e));
    return makeConstant(e.span, file);
}

Expr checkPrimitiveArgument(CheckContext& ctx, Place& place, const Written& e, const field::Primitive& row,
                            size_t index) {
    const field::PrimitiveParameter& parameter = row.parameters[index];
    const std::string what = fmt::format("'{}' of '{}'", parameter.name, row.name);
    place.enter(fmt::format("{}.{}", row.name, parameter.name));
    if (parameter.kind == ParameterKind::File) return checkFileArgument(ctx, e, row);
    if (parameter.kind == ParameterKind::Choice) return checkChoiceArgument(ctx, place, e, parameter);
    Expr expr = checkExpression(ctx, place, e, wantOf(parameter.kind), what);
    checkParameterRange(ctx, expr, row, index);
    return expr;
}

/// The eaves of curved roofs are as thick as the board there.
void warnOfThinEaves(CheckContext& ctx, const Solid& solid) {
    if (solid.primitive->parameters.data() != field::plan_parameters::curvedRoofParameters) return;
    const auto overhang = fold(solid.args[0], ctx.params.defaults), fascia = fold(solid.args[1], ctx.params.defaults);
    if (overhang && fascia && overhang->num() > 0 && fascia->num() <= 0)
        ctx.diagnostics.warning(
            solid.args[0].span,
            fmt::format("this overhang does nothing: the eaves of a {} have no thickness", solid.primitive->name),
            "give them a board, such as 'fascia: .2m'");
}

Solid checkPrimitive(CheckContext& ctx, Place& place, const Written& e, const field::Primitive& row) {
    Solid solid = solidOfRow(e.span, row);
    if (refuseExchanged(ctx, e, row) || refuseUnnamedBehindNamed(ctx, e, row)) return solid;
    std::vector<bool> given(row.parameters.size(), false);
    for (size_t i = 0; i < e.args.size(); ++i) {
        size_t index = i;
        const std::string name = i < e.argNames.size() ? e.argNames[i] : std::string();
        if (!name.empty()) {
            const auto named = std::find_if(row.parameters.begin(), row.parameters.end(),
                                            [&](const auto& p) { return p.name == name; });
            index = static_cast<size_t>(named - row.parameters.begin());
        }
        if (index >= row.parameters.size()) {
            std::vector<std::string> known;
            for (const auto& p : row.parameters) known.emplace_back(p.name);
            const std::string message = !name.empty()   ? fmt::format("'{}' has no parameter '{}'", row.name, name)
                                        : known.empty() ? fmt::format("'{}' takes no parameters", row.name)
                                                        : fmt::format("'{}' takes no more than {} parameters: {}",
                                                                      row.name, known.size(), fmt::join(known, ", "));
            const std::string near = nearestHint(name, known);
            const bool isExtent = name.empty() ? known.empty() : std::ranges::count(extents, name) > 0;
            ctx.diagnostics.error(
                e.args[i].span, message,
                isExtent ? fmt::format("its extents are those of its scope: write '{} size (x, y, z)'", row.name)
                : near.empty() && !name.empty() && !known.empty()
                    ? fmt::format("its parameters are {}", fmt::join(known, ", "))
                    : near);
            break;
        }
        if (given[index])
            ctx.diagnostics.error(e.args[i].span, fmt::format("'{}' is given twice", row.parameters[index].name));
        given[index] = true;
        solid.args[index] = checkPrimitiveArgument(ctx, place, e.args[i], row, index);
    }
    for (size_t i = 0; i < given.size() && e.args.empty(); ++i)
        if (row.parameters[i].kind == ParameterKind::File)
            ctx.diagnostics.error(e.span, fmt::format("'{}' takes the name of a file", row.name),
                                  fmt::format("write '{}(\"statue.obj\")'", row.name));
    warnOfThinEaves(ctx, solid);
    return solid;
}

/// A solid of parts looks like the first that has a look. Terminals made of terminals can double at every step.
Solid compose(CheckContext& ctx, Solid solid) {
    for (const Solid& part : solid.parts)
        if (solid.material == none) solid.material = part.material;
    constexpr size_t most = 1000;
    if (partsOf(solid) <= most) return solid;
    ctx.diagnostics.error(solid.span, fmt::format("a solid has at most {} parts", most), "build it with rules");
    return {};
}

Solid checkMorphSolid(CheckContext& ctx, Place& place, const Written& e) {
    Solid result;
    result.kind = Solid::Kind::Morph;
    result.span = e.span;
    if (e.args.size() != 3) {
        ctx.diagnostics.error(e.span,
                              fmt::format("'morph' takes two solids and a share, but {} {} given", e.args.size(),
                                          e.args.size() == 1 ? "is" : "are"),
                              "write 'morph(sphere, cube, .5)'");
        return {};
    }
    for (size_t i = 0; i < 2; ++i) {
        result.parts.push_back(checkSolid(ctx, place, e.args[i]));
        expectBounded(ctx, result.parts.back(), "morphed");
    }
    place.enter("morph");
    result.amount = checkExpression(ctx, place, e.args[2], Want::Number, "the share of a morph");
    if (const auto value = fold(result.amount, ctx.params.defaults); value && (value->num() < 0 || value->num() > 1))
        ctx.diagnostics.error(e.args[2].span,
                              fmt::format("the share of a morph is {}, but must be 0 … 1", toText(*value)));
    place.morphs = true;
    return compose(ctx, std::move(result));
}

Solid checkCombination(CheckContext& ctx, Place& place, const Written& e) {
    Solid result;
    result.kind = Solid::Kind::Combination;
    result.span = e.span;
    result.op = operatorOf(e.text);
    for (const Written& part : e.args) result.parts.push_back(checkSolid(ctx, place, part));
    expectBounded(ctx, result.parts[0], "cut or added to");
    if (result.op == Operator::Sum) expectBounded(ctx, result.parts[1], "added");
    return compose(ctx, std::move(result));
}

Solid checkNamedSolid(CheckContext& ctx, Place& place, const Written& e) {
    Solid nil;
    nil.span = e.span;
    if (e.text == "nil") return nil;
    if (const field::Primitive* row = field::findPrimitive(e.text)) return checkPrimitive(ctx, place, e, *row);
    const auto symbol = ctx.names.symbols.find(e.text);
    if (symbol != ctx.names.symbols.end() && ctx.grammar.symbols[symbol->second].isMaterial) {
        ctx.diagnostics.error(
            e.span, fmt::format("'{}' is a material, not a solid", e.text),
            fmt::format("write 'cube of {0}' where the shape stands, or 'block of {0}' over its plan", e.text));
        return nil;
    }
    if (symbol != ctx.names.symbols.end() && ctx.grammar.symbols[symbol->second].terminal) {
        if (e.kind == Written::Kind::Call)
            ctx.diagnostics.error(e.span, fmt::format("the terminal '{}' takes no parameters", e.text));
        Solid result = terminalSolid(ctx, {e.text, e.span});
        if (const uint32_t own = ctx.grammar.symbols[symbol->second].material; own != none) result.material = own;
        return result;
    }
    if (isNonTerminal(e.text))
        ctx.diagnostics.error(e.span,
                              fmt::format("'{}' may still be rewritten: a solid is a primitive or a terminal", e.text));
    else
        failUnknown(ctx, e.span, e.text, fmt::format("unknown solid '{}'", e.text), hintForSolid(ctx, e.text));
    return nil;
}

/// 'roofHip' and 'roofGable' of other programs; "" where no roof is meant.
std::string hintForRoof(std::string_view word) {
    constexpr std::string_view roof = "roof";
    if (!word.starts_with(roof) || word.size() == roof.size()) return {};
    std::string name(word.substr(roof.size()));
    name = lowerCase(name.substr(0, 1)) + name.substr(1) + "Roof";
    return field::findPrimitive(name) ? fmt::format("did you mean '{}'?", name) : std::string();
}

}  // namespace

std::string hintForSolid(CheckContext& ctx, std::string_view word) {
    for (const auto& [theirs, hint] : elsewhere)
        if (theirs == word) return std::string(hint);
    if (const PlanRow* plan = findPlan(word))
        return fmt::format("'{}' is a plan for 'footprint', which a solid stands on: write '{} extrude 3m block'", word,
                           plan->example);
    const std::string file = ctx.files.declaring(std::string(word));
    if (!file.empty() && isNonTerminal(word))
        return fmt::format("write 'rule {0} -> …', or 'use \"{1}\"' for the '{0}' that it declares", word, file);
    if (!file.empty()) return fmt::format("it is declared in {0}: write 'use \"{0}\"'", file);
    std::vector<std::string> known = symbolNames(ctx, true);
    for (const field::Primitive& row : field::primitives()) known.emplace_back(row.name);
    std::string near = nearestHint(word, known);
    if (near.empty()) near = hintForRoof(word);
    if (near.empty() && plan::isCommonEdgeWord(word)) return "the parts of a block are set apart by '|'";
    return near.empty() && isNonTerminal(word) ? fmt::format("write 'rule {} -> …'", word) : near;
}

/// Numbers that are known already and outside the parameter's range.
void checkParameterRange(CheckContext& ctx, const Expr& expr, const field::Primitive& row, size_t index) {
    if (const auto value = fold(expr, ctx.params.defaults))
        if (auto why = findOutOfRange(row, index, *value)) ctx.diagnostics.error(expr.span, std::move(*why));
}

/// Every parameter at its default.
Solid solidOfRow(SourceSpan span, const field::Primitive& row) {
    Solid solid;
    solid.kind = Solid::Kind::Primitive;
    solid.span = span;
    solid.primitive = &row;
    for (const auto& parameter : row.parameters) solid.args.push_back(makeConstant(span, fallbackOf(parameter)));
    return solid;
}

void expectBounded(CheckContext& ctx, const Solid& solid, std::string_view verb) {
    if (solid.kind == Solid::Kind::Primitive && solid.primitive && !solid.primitive->bounded)
        ctx.diagnostics.error(
            solid.span, fmt::format("a {} has no end and can't be {}: it may only cut", solid.primitive->name, verb),
            fmt::format("write '- {0}' or '& {0}' after a solid", solid.primitive->name));
}

Solid terminalSolid(CheckContext& ctx, const syntax::Name& name) {
    const syntax::TerminalDecl& decl = *ctx.names.terminals.at(name.text);
    Place place(Place::Where::Look);
    Solid result;
    result.kind = Solid::Kind::Primitive;
    result.span = name.span;
    result.primitive = field::findPrimitive("cube");
    if (!decl.solid) return result;
    if (const auto known = ctx.solids.known.find(name.text); known != ctx.solids.known.end()) return known->second;
    if (std::find(ctx.solids.inWork.begin(), ctx.solids.inWork.end(), name.text) != ctx.solids.inWork.end()) {
        ctx.diagnostics.error(name.span, fmt::format("the solid of '{}' is made of itself", name.text));
        return result;
    }
    ctx.solids.inWork.push_back(name.text);
    result = checkSolid(ctx, place, *decl.solid);
    ctx.solids.inWork.pop_back();
    ctx.solids.known.emplace(name.text, result);
    return result;
}

Solid checkSolid(CheckContext& ctx, Place& place, const Written& e) {
    Solid nil;
    nil.span = e.span;
    switch (e.kind) {
        case Written::Kind::Call:
            if (e.text == "morph") return checkMorphSolid(ctx, place, e);
            return checkNamedSolid(ctx, place, e);
        case Written::Kind::Name:
            return checkNamedSolid(ctx, place, e);
        case Written::Kind::Binary:
            if (e.text == "+" || e.text == "-" || e.text == "&") return checkCombination(ctx, place, e);
            break;
        case Written::Kind::Error:
            return nil;
        default:
            break;
    }
    ctx.diagnostics.error(e.span,
                          fmt::format("a solid is a primitive, a terminal or 'morph(…)', not '{}'", e.span.text()));
    return nil;
}

}  // namespace sgm::rules
