// Fields for the viewer's tests: solids of the primitive table placed in a scene, with materials.
#pragma once

#include <string_view>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/eval/tape.h"
#include "modeler/field/combine.h"
#include "modeler/field/domain.h"
#include "modeler/field/primitives.h"
#include "tests/field/sampled.h"

namespace sgm::render::test {

/// A scene under construction: parts, each with its own material.
struct Scene {
    field::Graph graph;
    std::vector<field::Owned> parts;
    Provenance provenance;
    uint64_t path = 0;  ///< of the latest solid

    /// The solid of a row, its parameters at their defaults (vectors and turns too), about `centre` with half-sizes
    /// `half`.
    field::Field solid(const field::Primitive& row, Vec3d centre, Vec3d half) {
        field::PrimitiveInput in;
        in.p = field::toLocal(graph.position(), {centre, {}}, ++path);
        in.half = {graph.slot(static_cast<float>(half.x)), graph.slot(static_cast<float>(half.y)),
                   graph.slot(static_cast<float>(half.z))};
        in.halfValue = half;
        std::vector<field::Argument> arguments;
        for (const field::PrimitiveParameter& parameter : row.parameters) {
            field::Argument argument;
            if (parameter.kind == field::ParameterKind::File) argument.grid = field::test::sampledTorus();
            for (int i = 0; i < 9; ++i) {
                const bool turn = parameter.kind == field::ParameterKind::Rotation;
                argument.value[i] = turn ? (i % 4 == 0 ? 1.0 : 0.0) : parameter.fallback;
                argument.node[i] = graph.slot(static_cast<float>(argument.value[i]));
            }
            arguments.push_back(argument);
        }
        in.arguments = arguments;
        field::Field field = row.build(in);
        field.bounds = field::toWorld(field.bounds, {centre, {}});
        return field;
    }
    field::Field solid(std::string_view name, Vec3d centre, Vec3d half) {
        return solid(*field::findPrimitive(name), centre, half);
    }

    /// A new origin with a material of its own.
    OriginId origin(Vec3f color, float roughness = 0.8f, float metallic = 0) {
        provenance.materials.push_back({"", color, roughness, metallic, nullptr});
        Part part;
        part.material = static_cast<uint32_t>(provenance.materials.size() - 1);
        provenance.parts.push_back(part);
        return static_cast<OriginId>(provenance.parts.size() - 1);
    }
    void add(std::string_view name, Vec3d centre, Vec3d half, Vec3f color, float roughness = 0.8f) {
        parts.push_back({solid(name, centre, half), origin(color, roughness)});
    }
    field::Field sum() { return field::sum(graph, parts); }
    eval::Tape compile(const field::Field& field) const { return eval::compile(graph, field, graph.constants()); }
};

}  // namespace sgm::render::test
