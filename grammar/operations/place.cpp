// place, variety: objects of their own, which equal places share.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/params.h"
#include "modeler/core/random.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::PlacedObject;
using rules::Attribute;
using rules::Element;
using rules::OperationChecker;
using rules::Parts;
using rules::Placing;
using rules::Value;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using syntax::Operator;
using Phase = Operation::Phase;

constexpr OperationArgument placeArguments[] = {
    {"start", ArgumentType::Start, "a start of this file or of one that it uses: the object is what it derives"}};
constexpr OperationArgument varietyArguments[] = {
    {"count", ArgumentType::Number, "how many objects chance may make of equal parameters"}};

/// What a placed object has of its own: nothing beside `place` reaches into it.
void checkBeside(OperationChecker& checker, const Attribute& attribute) {
    const Phase phase = attribute.operation->phase;
    if (phase == Phase::Scope || attribute.operation == &variety) return;
    if (phase == Phase::Placement && attribute.operation != &blend && attribute.operation != &by) return;
    checker.error(attribute.span, fmt::format("'{}' can't reach into an object of its own", attribute.operation->name),
                  attribute.operation == &with ? "hand values down as parameters: 'place House { storeys = 3 }'"
                                               : "say it in the object's rules");
}

std::shared_ptr<Parts> checkPlace(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    Placing& placing = out->placing;
    if (!written.args.empty() && written.args[0].kind == syntax::Expr::Kind::Name)
        placing.start = checker.names().findStart(written.args[0]).value_or(rules::none);
    const Element& element = checker.element();
    if (element.op != Operator::None && element.op != Operator::Sum)
        checker.error(written.span, "an object of its own can only stand beside what is there: nothing is cut by it",
                      "write '+', or the shapes themselves without 'place'");
    for (const syntax::Setting& setting : written.settings) {
        auto known = checker.setting(setting);
        if (!known) continue;
        const auto isSame = [&](const auto& other) { return other.first == known->first; };
        if (std::any_of(placing.settings.begin(), placing.settings.end(), isSame))
            checker.error(setting.span, fmt::format("'{}' is set twice", setting.name.text), "leave one of them out");
        placing.settings.push_back(std::move(*known));
        placing.spans.push_back(setting.value.span);
    }
    for (const Attribute& attribute : element.attributes) {
        checkBeside(checker, attribute);
        if (attribute.operation == &variety && !attribute.args.empty()) placing.variety = attribute.args[0];
        if (attribute.operation == &on) placing.onLot = !attribute.args.empty();
    }
    return out;
}

/// Only what merely joins the model may hold an object: elsewhere it would have to be cut or blended.
bool standsFree(PartsContext& context, const Parts& parts) {
    const derive::ShapeTree& tree = context.derivation().tree;
    for (derive::ShapeId s = context.shape(); s != derive::none; s = tree.shapes[s].parent) {
        const derive::Shape& shape = tree.shapes[s];
        if ((shape.op == Operator::None || shape.op == Operator::Sum) && shape.blend_m <= 0) continue;
        return context.fail(
            fmt::format("an object of its own can't be cut with, shared, morphed or blended, as '{}' is", tree.path(s)),
            parts.span);
    }
    return true;
}

/// The parameters of an object: what its place says; else what the user changed of the whole model; else the start's
/// defaults.
std::vector<Value> inheritedParams(const derive::Derivation& model, uint32_t start) {
    std::vector<Value> params = rules::valuesOf(*model.grammar, start);
    const std::vector<Value> usual = rules::valuesOf(*model.grammar, model.start);
    for (size_t i = 0; i < params.size(); ++i)
        if (model.isPlaced || model.params[i] != usual[i]) params[i] = model.params[i];
    return params;
}

bool applySettings(PartsContext& context, const Placing& placing, std::vector<Value>& params) {
    for (size_t i = 0; i < placing.settings.size(); ++i) {
        const auto& [index, expr] = placing.settings[i];
        const rules::Param& param = context.grammar().params[index];
        const Value value = context.evaluate(expr, hashText(param.name), param.value.integer);
        const auto fitted = rules::conform(param, value);
        if (!fitted.ok()) {
            const bool fraction = param.value.integer && value.kind == Value::Kind::Number && !value.integer;
            return context.fail(fraction ? fmt::format("'{}' is a whole number, not {}; write 'round(…)'", param.name,
                                                       rules::toText(value))
                                         : fitted.error().message,
                                placing.spans[i]);
        }
        params[index] = *fitted;
    }
    return true;
}

bool runPlace(PartsContext& context, const Parts& parts) {
    context.startsOver();
    if (!standsFree(context, parts)) return false;
    const Placing& placing = parts.placing;
    const rules::Grammar& grammar = context.grammar();
    const auto start = std::find_if(grammar.starts.begin(), grammar.starts.end(),
                                    [&](const rules::Start& s) { return s.symbol == placing.start; });
    PlacedObject object;
    object.start = static_cast<uint32_t>(start - grammar.starts.begin());
    object.params = inheritedParams(context.derivation(), object.start);
    if (!applySettings(context, placing, object.params)) return false;
    uint64_t chance = context.key();
    if (placing.variety) {
        const double count = std::floor(context.evaluate(*placing.variety, hashText("variety")).num());
        if (!(count >= 1 && count <= 1e6))
            return context.fail(fmt::format("'variety' is {:g}, but must be 1 … 1000000", count),
                                placing.variety->span);
        chance = pick(combine(chance, hashText("variety")), static_cast<uint64_t>(count));
        chance = combine(context.derivation().seed, chance);
    }
    object.seed = combine(chance, hashText(grammar.symbols[placing.start].name));
    if (placing.onLot) {
        const derive::Scope& scope = context.scope();
        object.lot = {scope.size, scope.footprint == derive::none ? plan::Footprint{} : context.footprint()};
    }
    context.place(std::move(object));
    return true;
}

void agreeVariety(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    const Parts* parts = element.content.parts();
    if (!parts || parts->operation != &place)
        checker.error(attribute.span, "'variety' is of the objects that 'place' puts, and there is none here",
                      "write 'place House variety 6'");
}

}  // namespace

constinit const Operation place{
    .name = "place",
    .doc =
        "Puts an object of its own: what a start derives with these parameters. Equal ones are derived and meshed once "
        "and instanced in files. It stands with its lowest point on the middle of the scope's foot, turned as the "
        "scope "
        "is; with 'on lot' it grows in the scope itself, over its plan.",
    .example = "size (12, 1, 12) place House { storeys = 3 } variety 6",
    .arguments = placeArguments,
    .phase = Phase::Content,
    .traits = {.takesSettings = true},
    .checkParts = checkPlace,
    .run = runPlace,
};

constinit const Operation variety{
    .name = "variety",
    .doc = "Says how many different objects chance may make of equal parameters; without it every place has its own.",
    .example = "place House variety 6",
    .arguments = varietyArguments,
    .phase = Phase::Detail,
    .range = {1, 1e6, "1 … 1000000"},
    .traits = {.beforeShape = true},
    .agree = agreeVariety,
};

}  // namespace sgm::operations
