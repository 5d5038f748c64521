// Fields to polygonize in tests, and the way from a field to a mesh.
// Enters: sizes and keys. Leaves: fields, meshes. Assumes gtest only in callers.
#pragma once

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/combine.h"
#include "modeler/field/domain.h"
#include "modeler/field/ops.h"
#include "modeler/field/primitives.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

/// A field with the graph it lives in.
struct Scene {
    field::Graph graph;
    field::Field field;
    eval::Tape tape() const { return eval::compile(graph, field, graph.constants()); }
};

inline field::Point shifted(field::Graph& g, Vec3f by) { return {g.x() - by.x, g.y() - by.y, g.z() - by.z}; }

inline field::Field ball(field::Graph& g, Vec3f centre, float radius) {
    const Vec3f r{radius, radius, radius};
    return {field::length(shifted(g, centre)) - radius, {centre - r, centre + r}, 1, 1};
}

inline field::Field box(field::Graph& g, Vec3f centre, Vec3f half) {
    const field::Point p = shifted(g, centre);
    const field::NodeRef qx = abs(p.x) - half.x, qy = abs(p.y) - half.y, qz = abs(p.z) - half.z;
    return {max(qx, max(qy, qz)), {centre - half, centre + half}, 1, 0.5f};
}

inline field::Field torus(field::Graph& g, float ring, float tube) {
    const field::NodeRef around = sqrt(square(g.x()) + square(g.z())) - ring;
    const float reach = ring + tube;
    return {sqrt(square(around) + square(g.y())) - tube, {{-reach, -tube, -reach}, {reach, tube, reach}}, 1, 1};
}

/// Everything between a tape and its mesh.
struct BuiltMesh {
    Result<Mesh> mesh = Mesh{};
    Grid grid;
    Counts counts;
};

inline BuiltMesh meshOf(const eval::Tape& tape, const Grid& grid, int threads = 2, PolygonizeOptions options = {}) {
    BuiltMesh result;
    result.grid = grid;
    options.threads = threads;
    auto blocks = subdivide(tape, grid, threads, nullptr, result.counts);
    if (!blocks) return result.mesh = blocks.error(), result;
    result.mesh = polygonize(*blocks, grid, options, nullptr, result.counts);
    return result;
}

inline BuiltMesh meshOf(const Scene& scene, int resolution, int threads = 2, PolygonizeOptions options = {}) {
    return meshOf(scene.tape(), gridFor(scene.field.bounds, cellFor(scene.field.bounds, resolution)), threads, options);
}

inline Scene ballScene(float radius = 1) {
    Scene s;
    s.field = ball(s.graph, {0.1f, -0.2f, 0.3f}, radius);
    return s;
}

/// Balls at random places of the unit cube, number i owned by origin i + 1.
inline Scene cloudScene(int count, float radius, uint64_t key) {
    Scene s;
    std::vector<field::Owned> parts;
    for (int i = 0; i < count; ++i) {
        const uint64_t k = combine(key, static_cast<uint64_t>(i));
        const Vec3f at{static_cast<float>(uniform(combine(k, 1))), static_cast<float>(uniform(combine(k, 2))),
                       static_cast<float>(uniform(combine(k, 3)))};
        parts.push_back({ball(s.graph, at, radius * static_cast<float>(uniform(combine(k, 4), 0.5, 1.5))),
                         static_cast<OriginId>(i + 1)});
    }
    s.field = field::sum(s.graph, parts);
    return s;
}

/// The benchmark's fractal of six folds: its values are expensive, and the surface is near to everything.
inline Scene fractal() {
    using field::ops::Kifs;
    Scene s;
    const float cosine = 0.9238795f, sine = 0.3826834f;
    const float numbers[] = {.93f, .93f, .33f, 3.5f, cosine, 0, -sine, 0, 1, 0, sine, 0, cosine,
                             1,    0,    0,    0,    1,      0, 0,     0, 1, 4, 1,    1, 1};
    std::vector<field::Operand> operands{{s.graph.x().id(), 0}, {s.graph.y().id(), 0}, {s.graph.z().id(), 0}};
    for (const float n : numbers) operands.push_back({s.graph.slot(n).id(), 0});
    const field::NodeRef value =
        s.graph.apply(field::codeOf<Kifs>, operands, Kifs::pack({.passes = 6, .folds = true, .turns = false}));
    s.field = {max(value, box(s.graph, {}, {1, 1, 1}).value), {{-1, -1, -1}, {1, 1, 1}}, 1, 1};
    return s;
}

}  // namespace sgm::mesh
