// size, move, turn, from: the scope of a newcomer, or before a shape that of the matched one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::OperationChecker;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;

constexpr double most_m = 1e6;

constexpr OperationArgument sizeArguments[] = {
    {"size", ArgumentType::Size,
     "metres, shares of the scope, or (x, y, z) of them; one number serves all three axes"}};
constexpr OperationArgument moveArguments[] = {
    {"offset", ArgumentType::Vector, "along x, y, z of the matched scope; bare numbers are metres"}};
constexpr OperationArgument turnArguments[] = {
    {"angle", ArgumentType::Rotation, "about y; (a, b, c) turns about x, then y, then z, through the centre"}};

constexpr OperationArgument fromArguments[] = {
    {"start", ArgumentType::Point,
     "a point about the scope's centre, in metres or shares, or a joint of the shape that `at` would speak of"},
    {"end", ArgumentType::Point, "the same", false, "to"}};

/// A point of the scope: a joint by its name, or three measures.
rules::Expr checkPoint(OperationChecker& checker, const syntax::Expr& e) {
    if (e.kind == syntax::Expr::Kind::Name && (rules::axisNumber(e.text) >= 0 || checker.names().isJoint(e.text)))
        return checker.joint(e);
    rules::Expr point = checker.point(e, "an end of 'from … to …'");
    return point;
}

void checkFrom(OperationChecker& checker, const syntax::Attribute& written) {
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("from");
    for (const syntax::Expr& e : written.args) out.args.push_back(checkPoint(checker, e));
    if (out.args.size() == 2) checker.add(std::move(out));
}

void agreeFrom(OperationChecker& checker, const rules::Element& element, const Attribute& attribute) {
    if (element.at || element.to)
        checker.error(attribute.span, "'from … to …' says where the shape stands, so no joint places it",
                      "leave 'at' and 'to' out");
}

/// Metres about the scope's centre, in its axes.
Vec3d pointOf(AttributeContext& context, const rules::Expr& e) {
    const rules::Value value = context.evaluate(e);
    const derive::Place& place = context.place;
    const bool known = place.host != derive::none;
    const auto local = [&](Vec3d point) { return place.scope.axes.transposed() * (point - place.scope.centre); };
    if (value.kind == rules::Value::Kind::Axis) {
        const derive::Scope& named = known ? place.tree->shapes[place.host].scope : place.scope;
        return local(named.point(derive::faceDirection(static_cast<uint32_t>(value.num()))));
    }
    if (value.kind != rules::Value::Kind::Word) return context.metres(e, false);
    const uint32_t joint = known ? place.tree->findJoint(place.host, value.text) : derive::none;
    if (joint == derive::none) {
        context.fail(fmt::format("there is no joint '{}' here", value.text), e.span);
        return {};
    }
    return local(place.tree->joint(place.host, joint).point);
}

void applyFrom(AttributeContext& context, const Attribute& attribute) {
    const Vec3d from_m = pointOf(context, attribute.args[0]), to_m = pointOf(context, attribute.args[1]);
    context.out.span = {from_m, to_m, attribute.span};
    context.out.scope.footprint = derive::none;
}

/// What shares of a size are of: the scope along its axes, or for a shape that is turned along those nearest to its
/// own.
Vec3d extentsOf(const AttributeContext& context, const Attribute& attribute) {
    const derive::Scope& whole = context.place.scope;
    if (context.out.scope.axes == whole.axes || rules::versionOf(context.grammar(), attribute.span) < 2)
        return whole.size;
    const Mat3 own = whole.axes.transposed() * context.out.scope.axes;
    Vec3d extents;
    for (int i = 0; i < 3; ++i) {
        const Vec3d direction = i == 0 ? own.x : i == 1 ? own.y : own.z;
        int nearest = 0;
        for (int k = 1; k < 3; ++k)
            if (std::abs(direction[k]) > std::abs(direction[nearest]) + 1e-9) nearest = k;
        extents[i] = whole.size[nearest];
    }
    return extents;
}

/// Whether a measure has a share of the scope in it, as 100% - 1m has, which is metres by now.
bool hasShare(const rules::Expr& e) {
    return (e.kind == rules::Expr::Kind::Scope && e.index >= rules::Expr::extentIndex) ||
           std::ranges::any_of(e.args, hasShare);
}

/// Whether a size along an axis goes with the scope, whose plan is stretched then.
bool goesWithScope(const AttributeContext& context, const Attribute& attribute, int axis, rules::Unit unit) {
    if (unit == rules::Unit::Share) return true;
    if (rules::versionOf(context.grammar(), attribute.span) < 2) return false;
    return hasShare(rules::sizeAlong(attribute.args[0], static_cast<size_t>(axis)));
}

void applySize(AttributeContext& context, const Attribute& attribute) {
    const Vec3d extents_m = extentsOf(context, attribute);
    derive::Place place = context.place;
    place.extents_m = &extents_m;
    const derive::Vector v = derive::vector(attribute.args[0], place, false);
    // An absolute size asks for a box: what is inherited of the plan stretches by shares alone.
    const bool inherits = context.out.scope.footprint != derive::none && !context.out.ownsFootprint;
    if (inherits &&
        !(goesWithScope(context, attribute, 0, v.unit[0]) && goesWithScope(context, attribute, 2, v.unit[2])))
        context.out.scope.footprint = derive::none;
    for (int i = 0; i < 3; ++i)
        context.out.scope.size[i] = v.unit[i] == rules::Unit::Share ? v.n[i] * extents_m[i] : v.n[i];
    context.out.sizeSpan = attribute.span;
}

void applyMove(AttributeContext& context, const Attribute& attribute) {
    context.out.moved_m += context.place.scope.axes * context.metres(attribute.args[0], true);
}

void applyTurn(AttributeContext& context, const Attribute& attribute) {
    context.out.scope.axes = context.out.scope.axes * derive::rotation(context.evaluate(attribute.args[0]));
    const Mat3& m = context.out.scope.axes;
    if (!std::isfinite(length(m.x) + length(m.y) + length(m.z)))
        context.fail("the angle of the turn is no finite number", attribute.span);
}

}  // namespace

constinit const Operation size{
    .name = "size",
    .doc = "Sets the size of the scope about its centre.",
    .example = "cube size (12, 3.5, 9)",
    .arguments = sizeArguments,
    .range = {1e-6, most_m, "at least 0.000001m, and at most 1000 km", "a solid has some thickness: write '.1m' for 0"},
    .traits = {.beforeShape = true},
    .apply = applySize,
};

constinit const Operation move{
    .name = "move",
    .doc = "Moves the shape after it was placed.",
    .example = "sphere move (0, 1.5, 0)",
    .arguments = moveArguments,
    .range = {-most_m, most_m, "at most 1000 km"},
    .traits = {.stacks = true, .beforeShape = true},
    .apply = applyMove,
};

constinit const Operation turn{
    .name = "turn",
    .doc =
        "Turns the shape about its own centre. Sizes are along its own axes, which turn with it: 'cylinder turn "
        "(90deg, "
        "0deg, 0deg) size (3m, 8m, 3m)' lies along z, 8 m long.",
    .example = "cube turn 30deg",
    .arguments = turnArguments,
    .traits = {.stacks = true, .beforeShape = true, .turnsShape = true},
    .apply = applyTurn,
};

constinit const Operation from{
    .name = "from",
    .doc =
        "Lets the newcomer span from one point to another: its y runs from the first to the second, and is as long as "
        "they are apart; 'size' says how thick it is along its x and z.",
    .example = "+ cylinder size .2m from (-2m, 0, 0) to +y",
    .arguments = fromArguments,
    .check = checkFrom,
    .agree = agreeFrom,
    .apply = applyFrom,
};

}  // namespace sgm::operations
