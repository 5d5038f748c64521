// clad, thickness, tile, mirror: an ornament on whatever a shape holds (McGraw's KIFS facades).
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/attribute_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/bodies.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/field/facade.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::Expr;
using rules::OperationChecker;
using rules::Solid;
using rules::Unit;
using rules::Value;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using Parameter = field::FacadeParameter;
using Phase = Operation::Phase;

constexpr OperationArgument cladArguments[] = {
    {"pattern", ArgumentType::Solid, "an ornament, a kifs, or a terminal that is one; its colour is the terminal's"}};
constexpr OperationArgument thicknessArguments[] = {
    {"thickness", ArgumentType::Vector,
     "metres of the walls' cladding outside the inner solid, or two: of the walls and below the top"}};
constexpr OperationArgument tileArguments[] = {
    {"period", ArgumentType::Vector, "metres after which the pattern repeats, along and up (bay and storey)"}};
constexpr OperationArgument mirrorArguments[] = {
    {"r", ArgumentType::Vector, "three shares of half a bay, at which the pattern is folded one after the other"}};

const field::Primitive& ornamentRow() { return *field::findPrimitive("ornament"); }

/// May the kifs become an ornament: the same fractal, mapped by the defaults? Its last fold and bailout must keep it a
/// distance.
bool isDistance(const OperationChecker& checker, const Solid& kifs) {
    for (size_t i = static_cast<size_t>(Parameter::Bay); i < kifs.args.size(); ++i) {
        const auto value = checker.atDefaults(kifs.args[i]);
        if (!value || value->num() != 0) return false;
    }
    return true;
}

void checkClad(OperationChecker& checker, const syntax::Attribute& written) {
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    if (written.args.empty()) return;
    const syntax::Expr& e = written.args[0];
    checker.beginDraws("clad");
    const size_t before = checker.problemCount();
    const Solid given = checker.solid(e);
    const bool good = checker.problemCount() == before && !checker.names().areErrorsSuppressed(e.text);
    const bool fractal = given.primitive && given.primitive->name == "kifs";
    if (good && e.kind == syntax::Expr::Kind::Name)
        out.symbol = checker.names().findSymbol(e.text).value_or(rules::none);
    if (good && !fractal && given.primitive != &ornamentRow()) {
        checker.error(e.span, fmt::format("'clad' takes an ornament or a kifs, not '{}'", e.span.text()),
                      "write 'clad ornament(…)', or name a terminal that is one");
    } else if (good && fractal && !isDistance(checker, given)) {
        checker.error(e.span, "a kifs with a jump or a bailout has no distance to clad with",
                      "leave 'form' and 'bailout' out");
    } else if (good) {
        out.pattern = std::make_shared<Solid>(fractal ? rules::solidOfRow(e.span, ornamentRow()) : given);
        if (fractal) std::copy_n(given.args.begin(), static_cast<size_t>(Parameter::Bay), out.pattern->args.begin());
    }
    checker.add(std::move(out));
}

void applyClad(AttributeContext& context, const Attribute& attribute) {
    const rules::Symbol* named =
        attribute.symbol == rules::none ? nullptr : &context.grammar().symbols[attribute.symbol];
    context.out.extras.clad = {
        {context.solid(*attribute.pattern), named ? named->name : "", named ? named->material : rules::none}};
}

Expr component(const Expr& vector, size_t i) {
    Expr e;
    e.kind = Expr::Kind::Element;
    e.span = vector.span;
    e.args = {vector, rules::makeConstant(vector.span, rules::makeWhole(static_cast<double>(i)))};
    return e;
}

/// What a detail of `clad` sets: `count` parameters from `first` on, one a component; 0: the whole vector is one
/// parameter.
struct Detail {
    Parameter first;
    size_t count;
    bool one;  ///< one number alone is allowed too
    std::string_view wants, fix;
};

void checkDetail(OperationChecker& checker, const syntax::Attribute& written, const Detail& detail) {
    Attribute* const cladding = checker.find(clad);
    if (!cladding) {
        checker.error(written.span, fmt::format("'{}' says how a cladding lies, but there is none", written.name.text),
                      "put 'clad ornament(…)' before it");
        return;
    }
    if (written.args.empty()) return;
    checker.beginDraws(written.name.text);
    const rules::Typed value = checker.value(written.args[0]);
    const rules::Type& t = value.type;
    const bool one = t.like.kind == Value::Kind::Number;
    const size_t given = one ? 1 : t.like.count;
    bool good = !t.known || (t.numeric() && given == (detail.count == 0 ? 3 : 2)) || (t.known && one && detail.one);
    for (size_t i = 0; t.known && i < given; ++i)
        good = good &&
               (t.like.units[i] == Unit::None || t.like.units[i] == (detail.count == 0 ? Unit::Share : Unit::Metre));
    if (!good) {
        checker.error(written.args[0].span,
                      fmt::format("'{}' takes {}, not {}", written.name.text, detail.wants, describe(t)),
                      std::string(detail.fix));
        return;
    }
    if (!cladding->pattern) return;
    const auto set = [&](size_t index, Expr e) {
        checker.checkRange(e, ornamentRow(), index);
        cladding->pattern->args[index] = std::move(e);
    };
    const auto first = static_cast<size_t>(detail.first);
    if (detail.count == 0 || one)
        set(first, value.expr);
    else
        for (size_t i = 0; i < detail.count; ++i) set(first + i, component(value.expr, i));
}

void checkThickness(OperationChecker& checker, const syntax::Attribute& written) {
    checkDetail(checker, written,
                {Parameter::Wall, 2, true, "a length, or two: of walls and below the top",
                 "write 'thickness .4m' or 'thickness (.4m, .1m)'"});
}
void checkTile(OperationChecker& checker, const syntax::Attribute& written) {
    checkDetail(checker, written, {Parameter::Bay, 2, false, "two lengths: along and up", "write 'tile (6m, 3m)'"});
}
void checkMirror(OperationChecker& checker, const syntax::Attribute& written) {
    checkDetail(checker, written,
                {Parameter::Mirror, 0, false, "three plain numbers", "write 'mirror (.25, .125, .4)'"});
}

}  // namespace

constinit const Operation clad{
    .name = "clad",
    .doc =
        "Dresses all that a shape holds: inner + (outer & pattern), where outer is what it holds and inner is that "
        "less the thickness.",
    .example = "cube clad ornate thickness .4m",
    .arguments = cladArguments,
    .phase = Phase::Whole,
    .check = checkClad,
    .apply = applyClad,
};

constinit const Operation thickness{
    .name = "thickness",
    .doc = "How thick a cladding is.",
    .example = "cube clad ornate thickness (.4m, .1m)",
    .arguments = thicknessArguments,
    .phase = Phase::Detail,
    .check = checkThickness,
};

constinit const Operation tile{
    .name = "tile",
    .doc = "Repeats a cladding.",
    .example = "cube clad ornate tile (6m, 3m)",
    .arguments = tileArguments,
    .phase = Phase::Detail,
    .check = checkTile,
};

constinit const Operation mirror{
    .name = "mirror",
    .doc =
        "Mirrors a cladding inside its tile. Behind an axis, `mirror x { body }`, it runs a body in the scope and in "
        "its mirror image about the scope's middle; what is drawn by chance differs.",
    .example = "cube clad ornate mirror (.25, .125, .4)",
    .arguments = mirrorArguments,
    .phase = Phase::Detail,
    .block = {.operation = &mirrored},
    .check = checkMirror,
};

}  // namespace sgm::operations
