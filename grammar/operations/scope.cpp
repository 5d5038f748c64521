// size, move, turn: the scope of a newcomer, or before a shape that of the matched one.
#include <cmath>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
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

void applySize(AttributeContext& context, const Attribute& attribute) {
    const derive::Vector v = context.vector(attribute.args[0], false);
    // An absolute size asks for a box: what is inherited of the plan stretches by shares alone.
    const bool isAbsolute = v.unit[0] != rules::Unit::Share || v.unit[2] != rules::Unit::Share;
    if (isAbsolute && !context.out.ownsFootprint) context.out.scope.footprint = derive::none;
    context.out.scope.size = context.metres(v);
    context.out.sizeSpan = attribute.span;
}

void applyMove(AttributeContext& context, const Attribute& attribute) {
    context.out.moved_m += context.place.scope.axes * context.metres(attribute.args[0], true);
}

void applyTurn(AttributeContext& context, const Attribute& attribute) {
    context.out.scope.axes = context.place.scope.axes * derive::rotation(context.evaluate(attribute.args[0]));
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
    .range = {1e-6, most_m, "at least 0.000001m, and at most 1000 km"},
    .beforeShape = true,
    .apply = applySize,
};

constinit const Operation move{
    .name = "move",
    .doc = "Moves the shape after it was placed.",
    .example = "sphere move (0, 1.5, 0)",
    .arguments = moveArguments,
    .range = {-most_m, most_m, "at most 1000 km"},
    .beforeShape = true,
    .apply = applyMove,
};

constinit const Operation turn{
    .name = "turn",
    .doc = "Turns the shape about its own centre.",
    .example = "cube turn 30deg",
    .arguments = turnArguments,
    .beforeShape = true,
    .turnsShape = true,
    .apply = applyTurn,
};

}  // namespace sgm::operations
