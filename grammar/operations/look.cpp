// color, rough, metal, walk, of: the material of a shape, or of a terminal.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"

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
constexpr OperationArgument ofArguments[] = {
    {"material", ArgumentType::Material,
     "a `material` or terminal by name, or a value that holds one: 'of choose { 2: brick | 1: plaster }'"}};
constexpr OperationArgument walkArguments[] = {{"who", ArgumentType::Name, "none: nobody can stand on it"}};
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

void checkOf(rules::OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty()) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("of");
    out.args.push_back(checker.material(written.args[0]));
    checker.add(std::move(out));
}

/// The look of a material, in place of what was said before.
void applyOf(AttributeContext& context, const Attribute& attribute) {
    const rules::Grammar& grammar = context.grammar();
    const Value value = context.evaluate(attribute.args[0]);
    const bool word = value.kind == Value::Kind::Word;
    const auto hint = static_cast<rules::SymbolId>(word ? value.num() : 0);  // where a material's own name was written
    const bool known = word && hint < grammar.symbols.size() && grammar.symbols[hint].name == value.text;
    const rules::SymbolId symbol = known ? hint : word ? rules::findMaterial(grammar, value.text) : rules::none;
    if (symbol == rules::none)
        return context.fail(
            fmt::format("'{}' is {}, and no material", attribute.args[0].span.text(), rules::toText(value)),
            attribute.span);
    context.out.material = grammar.symbols[symbol].material;
    context.out.color.reset();
    context.out.colorBy = nullptr;
    context.out.rough.reset();
    context.out.metal.reset();
    for (const Attribute& look : grammar.symbols[symbol].look) look.operation->apply(context, look);
    context.out.colorBy = nullptr;  // the material names the look
}

void checkWalk(rules::OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty()) return;
    if (written.args[0].text != "none")
        return checker.error(written.args[0].span,
                             "'walk' takes the word 'none': the surface is no floor, as water isn't",
                             "write 'walk none'");
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    out.args.push_back(rules::makeConstant(written.args[0].span, rules::makeWord("walk none")));
    checker.add(std::move(out));
}

void applyWalk(AttributeContext& context, const Attribute& attribute) {
    context.out.extras.tags.push_back(attribute.args[0].value.text);
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

constinit const Operation of{
    .name = "of",
    .doc = "Makes the shape of a material: what looks so is declared by 'material', or is a terminal.",
    .example = "cylinder of stone",
    .arguments = ofArguments,
    .phase = Operation::Phase::Look,
    .check = checkOf,
    .apply = applyOf,
};

constinit const Operation walk{
    .name = "walk",
    .doc = "Takes the surface out of the floor that `sgm build --cave` finds: water, glass.",
    .example = "cube walk none",
    .arguments = walkArguments,
    .phase = Operation::Phase::Look,
    .check = checkWalk,
    .apply = applyWalk,
};

}  // namespace sgm::operations
