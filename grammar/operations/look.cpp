// color, rough, metal, texture, normals, lay, fitted, walk, of: the material of a shape, or of a terminal.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/file_tables.h"
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
constexpr OperationArgument roughArguments[] = {
    {"roughness", ArgumentType::Number, "0 is a mirror, 1 is chalk; or a .png or .jpg in quotes"}};
constexpr OperationArgument metalArguments[] = {{"metalness", ArgumentType::Number, "0 is a dielectric, 1 is a metal"}};
constexpr OperationArgument ofArguments[] = {
    {"material", ArgumentType::Material,
     "a `material` or terminal by name, or a value that holds one: 'of choose { 2: brick | 1: plaster }'"}};
constexpr OperationArgument walkArguments[] = {{"who", ArgumentType::Name, "none: nobody can stand on it"}};
constexpr OperationArgument textureArguments[] = {
    {"file", ArgumentType::File, "a .png or .jpg beside the grammar"},
    {"tile", ArgumentType::Size, "(width, height) of one tile; one length is its width", true}};
constexpr OperationArgument pictureArguments[] = {{"file", ArgumentType::File, "a .png or .jpg beside the grammar"}};
constexpr OperationRange share{0, 1, "0 … 1"};

Vec3f colorOf(const Value& value) { return Vec3d{value.n[0], value.n[1], value.n[2]}.as<float>(); }

float shareOf(AttributeContext& context, const Attribute& attribute) {
    return static_cast<float>(
        context.numberWithin(attribute.args[0], 0, 1, fmt::format("'{}'", attribute.operation->name)));
}

void applyColor(AttributeContext& context, const Attribute& attribute) {
    context.out.color = colorOf(context.evaluate(attribute.args[0]));
    context.out.colorBy = &attribute.args[0];
}
void applyMetal(AttributeContext& context, const Attribute& attribute) {
    context.out.metal = shareOf(context, attribute);
}

/// The picture's file as a constant: its name, and its place in Grammar::images.
std::optional<rules::Expr> fileOf(rules::OperationChecker& checker, const syntax::Expr& written) {
    const auto image = checker.files().readImage(written);
    if (!image) return std::nullopt;
    Value file;
    file.kind = Value::Kind::Text;
    file.text = written.text;
    file.n[0] = static_cast<double>(*image);
    return rules::makeConstant(written.span, file);
}

constexpr const char *notATile = "the tile of a texture is one or two lengths",
                     *tileHint = "write 'texture \"brick.png\" (1m, .5m)'";

bool isTile(const Value& v) {
    const auto isLength = [&](size_t i) { return v.units[i] == rules::Unit::None || v.units[i] == rules::Unit::Metre; };
    if (v.kind == Value::Kind::Vector) return v.count == 2 && isLength(0) && isLength(1);
    return v.kind == Value::Kind::Number && isLength(0);
}

void checkPictures(rules::OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty() || written.args[0].kind != syntax::Expr::Kind::Text) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("texture");
    auto file = fileOf(checker, written.args[0]);
    if (!file) return;
    out.args.push_back(std::move(*file));
    if (written.args.size() > 1) {
        rules::Typed tile = checker.value(written.args[1]);
        if (tile.type.known && !isTile(tile.type.like)) return checker.error(written.args[1].span, notATile, tileHint);
        out.args.push_back(std::move(tile.expr));
    }
    checker.add(std::move(out));
}

uint32_t imageOf(const Attribute& attribute) { return static_cast<uint32_t>(attribute.args[0].value.n[0]) + 1; }

derive::PlacedTexture& textureOf(AttributeContext& context) {
    if (!context.out.texture) context.out.texture.emplace();
    return *context.out.texture;
}

void applyTexture(AttributeContext& context, const Attribute& attribute) {
    derive::PlacedTexture& texture = textureOf(context);
    texture.color = imageOf(attribute);
    const image::ImageFile& file = *context.grammar().images[texture.color - 1];
    const double shape = static_cast<double>(file.height) / static_cast<double>(file.width);
    double width_m = 1, height_m = shape;
    if (attribute.args.size() > 1) {
        const Value tile = context.evaluate(attribute.args[1]);
        if (!isTile(tile)) return context.fail(fmt::format("{}; {}", notATile, tileHint), attribute.args[1].span);
        width_m = tile.n[0];
        height_m = tile.kind == Value::Kind::Vector ? tile.n[1] : width_m * shape;
    }
    if (!(width_m >= 1e-4 && height_m >= 1e-4 && width_m <= 1e6 && height_m <= 1e6))
        return context.fail("the tile of a texture is .1mm … 1000km wide and high", attribute.span);
    texture.width_m = static_cast<float>(width_m);
    texture.height_m = static_cast<float>(height_m);
}
/// A number, or a picture of the texture.
void checkRough(rules::OperationChecker& checker, const syntax::Attribute& written) {
    const bool picture = !written.args.empty() && written.args[0].kind == syntax::Expr::Kind::Text;
    picture ? checkPictures(checker, written) : checker.checkArguments(written);
}

void applyRough(AttributeContext& context, const Attribute& attribute) {
    if (attribute.args[0].kind == rules::Expr::Kind::Constant && attribute.args[0].value.kind == Value::Kind::Text)
        textureOf(context).roughness = imageOf(attribute);
    else
        context.out.rough = shareOf(context, attribute);
}

void applyNormals(AttributeContext& context, const Attribute& attribute) {
    textureOf(context).normals = imageOf(attribute);
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
    context.out.texture.reset();
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

void applyFitted(AttributeContext& context, const Attribute&) { textureOf(context).fits = true; }

void applyLay(AttributeContext& context, const Attribute&) { context.out.extras.laid = true; }

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
    .doc = "Sets the roughness of the surface: a number, or a picture beside a texture, whose green it is.",
    .example = "cube rough .8",
    .arguments = roughArguments,
    .phase = Operation::Phase::Look,
    .range = share,
    .check = checkRough,
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

constinit const Operation texture{
    .name = "texture",
    .doc =
        "Covers the surface with a picture, upright as its shape: tiles of that size in metres, in place of the "
        "colour. "
        "Without a size a tile is 1 m wide.",
    .example = "cube texture \"brick.png\" (1m, .5m)",
    .arguments = textureArguments,
    .phase = Operation::Phase::Look,
    .check = checkPictures,
    .apply = applyTexture,
};

constinit const Operation normals{
    .name = "normals",
    .doc = "Gives the tiles of a texture a relief of light: a normal map, y up as glTF has it.",
    .example = "cube texture \"brick.png\" normals \"brick_normal.png\"",
    .arguments = pictureArguments,
    .phase = Operation::Phase::Look,
    .check = checkPictures,
    .apply = applyNormals,
};

constinit const Operation lay{
    .name = "lay",
    .doc =
        "Lets the textures of the shape and of all it becomes begin at its lower left corner: on its sides they run "
        "on around its outline, corners included.",
    .example = "cube lay texture \"brick.png\"",
    .phase = Operation::Phase::Whole,
    .apply = applyLay,
};

constinit const Operation fitted{
    .name = "fitted",
    .doc =
        "Stretches the tiles of a texture so that whole numbers of them go round and up the shape that is laid, or "
        "fill the faces of its own scope.",
    .example = "cube texture \"brick.png\" fitted",
    .phase = Operation::Phase::Look,
    .apply = applyFitted,
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
