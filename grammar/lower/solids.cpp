#include "grammar/lower/solids.h"

#include <string>

#include "modeler/core/random.h"
#include "modeler/field/combine.h"
#include "modeler/field/domain.h"
#include "modeler/field/primitives.h"

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
};

size_t componentsOf(field::ParameterKind kind) {
    if (kind == field::ParameterKind::File) return 0;
    if (kind == field::ParameterKind::Rotation) return 9;
    return kind == field::ParameterKind::Vector ? 3 : 1;
}

Argument argumentOf(Graph& graph, const field::PrimitiveParameter& parameter, const rules::Value& value, uint64_t key) {
    Argument a;
    const uint64_t attribute = hashText(parameter.name);
    for (size_t i = 0; i < componentsOf(parameter.kind); ++i) {
        a.value[i] = value.n[value.count > 1 ? std::min<size_t>(i, value.count - 1u) : 0];
        a.node[i] = graph.slot({key, combine(attribute, i)}, static_cast<float>(a.value[i]));
    }
    return a;
}

Field primitive(Graph& graph, const SolidValue& solid, const Frame& frame, uint64_t key) {
    std::vector<Argument> arguments;
    for (size_t i = 0; i < solid.args.size(); ++i) {
        arguments.push_back(argumentOf(graph, solid.primitive->parameters[i], solid.args[i], key));
        if (solid.primitive->parameters[i].kind == field::ParameterKind::File)
            arguments.back().grid = frame.meshes[static_cast<size_t>(solid.args[i].num())];
    }
    Field f = solid.primitive->build({frame.p, frame.half, frame.scope.half(), arguments});
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
        case rules::Solid::Kind::Primitive: return primitive(graph, solid, frame, key);
        case rules::Solid::Kind::Morph: {
            const Field a = build(graph, solid.parts[0], frame, combine(key, 0)), b = build(graph, solid.parts[1], frame, combine(key, 1));
            return field::morph(a, b, graph.slot({key, hashText("morph")}, static_cast<float>(solid.amount)), solid.amount, 0);
        }
        case rules::Solid::Kind::Combination: {
            Field f = build(graph, solid.parts[0], frame, combine(key, 0));
            for (size_t i = 1; i < solid.parts.size(); ++i) f = combination(graph, f, build(graph, solid.parts[i], frame, combine(key, i)), solid.op);
            return f;
        }
        case rules::Solid::Kind::Nil: break;
    }
    return field::nothing(graph);
}

}  // namespace

Field lowerSolid(Graph& graph, const SolidValue& solid, const derive::Scope& scope, uint64_t key,
                 std::span<const field::SampledGridPtr> meshes) {
    const Vec3d h = scope.half();
    const auto half = [&](std::string_view name, double value) { return graph.slot({key, hashText(name)}, static_cast<float>(value)); };
    const Frame frame{field::toLocal(graph.position(), {scope.centre, scope.axes}, key), {half("size.x", h.x), half("size.y", h.y), half("size.z", h.z)}, scope, meshes};
    return build(graph, solid, frame, key);
}

}  // namespace sgm::lower
