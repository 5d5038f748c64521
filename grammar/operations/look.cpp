// color, rough, metal: the material of a shape, or of a terminal.
#include <algorithm>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::Value;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using syntax::OperationRange;

constexpr OperationArgument colorArguments[] = {
    {"color", ArgumentType::Color, "#rrggbb, or a parameter that holds one"}};
constexpr OperationArgument roughArguments[] = {{"roughness", ArgumentType::Number, "0 is a mirror, 1 is chalk"}};
constexpr OperationArgument metalArguments[] = {{"metalness", ArgumentType::Number, "0 is a dielectric, 1 is a metal"}};
constexpr OperationRange share{0, 1, "0 … 1"};

Vec3f colorOf(const Value& value) { return Vec3d{value.n[0], value.n[1], value.n[2]}.as<float>(); }

float shareOf(AttributeContext& context, const Attribute& attribute) {
    return static_cast<float>(std::clamp(context.number(attribute.args[0]), 0.0, 1.0));
}

void applyColor(AttributeContext& context, const Attribute& attribute) {
    context.out.color = colorOf(context.evaluate(attribute.args[0]));
    context.out.colorBy = &attribute.args[0];
}
void applyRough(AttributeContext& context, const Attribute& attribute) {
    context.out.rough = shareOf(context, attribute);
}
void applyMetal(AttributeContext& context, const Attribute& attribute) {
    context.out.metal = shareOf(context, attribute);
}

void setColor(const Value& value, Material& material) { material.color = colorOf(value); }
void setRough(const Value& value, Material& material) { material.roughness = static_cast<float>(value.num()); }
void setMetal(const Value& value, Material& material) { material.metallic = static_cast<float>(value.num()); }

}  // namespace

constinit const Operation color{
    .name = "color",
    .doc = "Sets the colour of the surface.",
    .example = "cube color #c8b090",
    .arguments = colorArguments,
    .phase = Operation::Phase::Look,
    .apply = applyColor,
    .decorate = setColor,
};

constinit const Operation rough{
    .name = "rough",
    .doc = "Sets the roughness of the surface.",
    .example = "cube rough .8",
    .arguments = roughArguments,
    .phase = Operation::Phase::Look,
    .range = share,
    .apply = applyRough,
    .decorate = setRough,
};

constinit const Operation metal{
    .name = "metal",
    .doc = "Sets the metalness of the surface.",
    .example = "cube metal 1",
    .arguments = metalArguments,
    .phase = Operation::Phase::Look,
    .range = share,
    .apply = applyMetal,
    .decorate = setMetal,
};

}  // namespace sgm::operations
