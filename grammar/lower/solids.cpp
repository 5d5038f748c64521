#include "grammar/lower/solids.h"

#include <algorithm>
#include <array>
#include <string>

#include "modeler/core/random.h"
#include "modeler/field/combine.h"
#include "modeler/field/domain.h"
#include "modeler/field/plan_field.h"
#include "modeler/field/primitives.h"
#include "modeler/field/solids.h"

namespace sgm::lower {
namespace {

using derive::SolidValue;
using field::Argument;
using field::Field;
using field::Graph;
using rules::Operator;

/// The scope as numbers of the graph, made once for all parts of a solid.
struct Frame {
    field::Point p, half;
    derive::Scope scope;
    std::span<const field::SampledGridPtr> meshes;
    const field::PlanField* plan = nullptr;  ///< of the scope's footprint, where the solid asks for it
};

size_t componentsOf(field::ParameterKind kind) {
    if (kind == field::ParameterKind::File) return 0;
    if (kind == field::ParameterKind::Rotation) return 9;
    if (kind == field::ParameterKind::PerId) return 4;
    if (kind == field::ParameterKind::Point) return 2;
    return kind == field::ParameterKind::Vector ? 3 : 1;
}

/// The parameter's numbers, without nodes.
Argument numbersOf(const field::PrimitiveParameter& parameter, const rules::Value& value) {
    Argument a;
    for (size_t i = 0; i < componentsOf(parameter.kind); ++i) {
        const double given = value.n[value.count > 1 ? std::min<size_t>(i, value.count - 1u) : 0];
        const bool bounded = parameter.kind != field::ParameterKind::Rotation;  // what draws and parameters come to
        a.value[i] = bounded ? std::clamp(given, parameter.lo, parameter.hi) : given;
    }
    return a;
}

Argument argumentOf(Graph& graph, const field::PrimitiveParameter& parameter, const rules::Value& value, uint64_t key) {
    Argument a = numbersOf(parameter, value);
    const uint64_t attribute = hashText(parameter.name);
    for (size_t i = 0; i < componentsOf(parameter.kind); ++i)
        a.node[i] = graph.slot({key, combine(attribute, i)}, static_cast<float>(a.value[i]));
    return a;
}

std::vector<Argument> argumentsOf(Graph& graph, const SolidValue& solid, uint64_t key) {
    std::vector<Argument> arguments;
    for (size_t i = 0; i < solid.args.size(); ++i)
        arguments.push_back(argumentOf(graph, solid.primitive->parameters[i], solid.args[i], key));
    return arguments;
}

Field primitive(Graph& graph, const SolidValue& solid, const Frame& frame, uint64_t key) {
    std::vector<Argument> arguments = argumentsOf(graph, solid, key);
    for (size_t i = 0; i < arguments.size(); ++i)
        if (solid.primitive->parameters[i].kind == field::ParameterKind::File)
            arguments[i].grid = frame.meshes[static_cast<size_t>(solid.args[i].num())];
    Field f = solid.primitive->build({frame.p, frame.half, frame.scope.half(), arguments, frame.plan, key});
    f.bounds = field::toWorld(f.bounds, {frame.scope.centre, frame.scope.axes});
    return f;
}

Field combination(Graph& graph, Field a, Field b, Operator op) {
    if (op == Operator::Difference) return field::difference({a, 0}, {b, 0});
    if (op == Operator::Intersection) return field::intersection({a, 0}, {b, 0});
    const field::Owned parts[] = {{a, 0}, {b, 0}};
    return field::sum(graph, parts);
}

/// Recursion follows the solid's text, which nests a few levels at most.
Field build(Graph& graph, const SolidValue& solid, const Frame& frame, uint64_t key) {
    switch (solid.kind) {
        case rules::Solid::Kind::Primitive:
            return primitive(graph, solid, frame, key);
        case rules::Solid::Kind::Morph: {
            const Field a = build(graph, solid.parts[0], frame, combine(key, 0)),
                        b = build(graph, solid.parts[1], frame, combine(key, 1));
            return field::morph(a, b, graph.slot({key, hashText("morph")}, static_cast<float>(solid.amount)),
                                solid.amount, 0);
        }
        case rules::Solid::Kind::Combination: {
            Field f = build(graph, solid.parts[0], frame, combine(key, 0));
            for (size_t i = 1; i < solid.parts.size(); ++i)
                f = combination(graph, f, build(graph, solid.parts[i], frame, combine(key, i)), solid.op);
            return f;
        }
        case rules::Solid::Kind::Nil:
            break;
    }
    return field::nothing(graph);
}

bool uses(const SolidValue& solid, bool (*isUse)(field::PlanUse)) {
    return (solid.primitive && isUse(solid.primitive->plan)) ||
           std::any_of(solid.parts.begin(), solid.parts.end(), [&](const SolidValue& p) { return uses(p, isUse); });
}

Frame frameOf(Graph& graph, const derive::Scope& scope, uint64_t key, uint64_t rotationKey,
              std::span<const field::SampledGridPtr> meshes) {
    constexpr std::array names{hashText("size.x"), hashText("size.y"), hashText("size.z")};
    const field::Point p = field::toLocal(graph.position(), {scope.centre, scope.axes}, key, rotationKey);
    const Vec3f h = scope.half().as<float>();
    const auto [x, y, z] = graph.slots(key, names, std::array{h.x, h.y, h.z});
    return {p, {x, y, z}, scope, meshes, nullptr};
}

}  // namespace

namespace {

/// A box of its own; Graph::addBoxes makes many.
Field lowerBox(Graph& graph, const derive::Scope& scope, uint64_t key, uint64_t rotationKey) {
    const field::Point p = field::turned(graph.position(), scope.axes, rotationKey);
    const auto n = graph.slots(key, Graph::boxAttributes, boxNumbers(scope));
    return boxField(field::solids::boxDistance(p, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}), scope);
}

}  // namespace

bool isScopesBox(const SolidValue& solid) {
    static const field::Primitive* const cube = field::findPrimitive("cube");
    return solid.primitive == cube && solid.kind == rules::Solid::Kind::Primitive;
}

std::array<float, 6> boxNumbers(const derive::Scope& scope) {
    const Vec3f c = (scope.axes.transposed() * scope.centre).as<float>(), h = scope.half().as<float>();
    return {c.x, c.y, c.z, h.x, h.y, h.z};
}

Field boxField(field::NodeRef value, const derive::Scope& scope) {
    const Vec3f half = scope.half().as<float>();
    return {value, field::toWorld({-half, half}, {scope.centre, scope.axes}), 1, field::solids::growth(1)};
}

std::optional<PlacedPlan> planUnder(const SolidValue& solid, const derive::Scope& scope) {
    using field::PlanUse;
    if (scope.footprint == derive::none || !uses(solid, [](PlanUse use) { return use != PlanUse::None; })) return {};
    return PlacedPlan{scope.footprint, scope.half(),
                      uses(solid, [](PlanUse use) { return use == PlanUse::OwnHeight; })};
}

Field lowerSolid(Graph& graph, const SolidValue& solid, const derive::Scope& scope, uint64_t key, uint64_t rotationKey,
                 SharedPlans& plans, std::span<const field::SampledGridPtr> meshes) {
    if (isScopesBox(solid)) return lowerBox(graph, scope, key, rotationKey);
    Frame frame = frameOf(graph, scope, key, rotationKey, meshes);
    if (!planUnder(solid, scope)) return build(graph, solid, frame, key);
    const field::PlanField plan(plans.numbersOf(scope.footprint, scope.half()), frame.p,
                                combine(key, hashText("plan")));
    frame.plan = &plan;
    return build(graph, solid, frame, key);
}

Field lowerClad(Graph& graph, const field::Clad& what, const SolidValue& ornament, const derive::Scope& scope,
                uint64_t key) {
    const Frame frame = frameOf(graph, scope, key, key, {});
    const std::vector<Argument> arguments = argumentsOf(graph, ornament, key);
    return field::clad({frame.p, frame.half, scope.half(), arguments}, what, scope.axes.y);
}

namespace {

/// The numbers of an ornament.
std::vector<Argument> numbersOf(const SolidValue& ornament) {
    std::vector<Argument> arguments;
    for (size_t i = 0; i < ornament.args.size(); ++i)
        arguments.push_back(numbersOf(ornament.primitive->parameters[i], ornament.args[i]));
    return arguments;
}

}  // namespace

std::optional<field::FacadeDetail> facadeDetailOf(const derive::ShapeTree& tree, derive::ShapeId shape) {
    const derive::Extras* extras = tree.extrasOf(shape);
    if (!extras || extras->clad.empty()) return std::nullopt;
    return field::facadeDetail(numbersOf(extras->clad[0].ornament), tree.contentBox(shape).half());
}

std::optional<field::FacadeCell> facadeCellAt(const derive::ShapeTree& tree, derive::ShapeId shape, Vec3d p) {
    for (; shape != derive::none; shape = tree.shapes[shape].parent) {
        const auto* x = tree.extrasOf(shape);
        if (!x || x->clad.empty()) continue;
        const std::vector<Argument> arguments = numbersOf(x->clad[0].ornament);
        const derive::Scope box = tree.contentBox(shape);
        return field::facadeCell(arguments, box.half(), box.axes.transposed() * (p - box.centre));
    }
    return std::nullopt;
}

}  // namespace sgm::lower
