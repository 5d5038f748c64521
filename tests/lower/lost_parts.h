// Which parts of a model a mesh shows nothing of.
// Enters: a lowered grammar and its mesh. Leaves: origins, and words for them. Assumes parts no thinner than a 24th of
// their own shape's scope.
#pragma once

#include <fmt/format.h>

#include <map>
#include <set>

#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"
#include "tests/lower/lowered.h"

namespace sgm::testing_ {

/// As it comes from polygonising, unsimplified.
inline mesh::Mesh meshedWith(const Lowered& model, float cell_m, mesh::Surface surface) {
    const mesh::Grid grid = mesh::gridFor(model.model->field.bounds, cell_m);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(model.tape(), grid, 2, nullptr, counts);
    return *mesh::polygonize(*blocks, grid, {.surface = surface, .threads = 2}, nullptr, counts);
}

/// Points as the evaluation takes them.
struct PointRows {
    std::vector<float> x, y, z;
    void add(Vec3f p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    eval::Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

inline std::vector<float> valuesAt(const Lowered& model, const PointRows& rows, eval::Workspace& workspace) {
    std::vector<float> values(rows.x.size());
    eval::evaluate(model.tape(), rows.points(), values.data(), workspace);
    return values;
}

/// Where lines through a scope, 12 by 12 along each of its axes, cross the field's surface.
inline PointRows crossingsIn(const derive::Scope& scope, const Lowered& model, eval::Workspace& workspace) {
    constexpr int lines = 3 * 12 * 12, steps = 48;
    // Off the middle, so that no line lies in a plane of symmetry.
    const auto at = [&](int line, double along) {
        Vec3d share;
        share[line % 3] = 1.02 * along;
        share[(line + 1) % 3] = (2.0 * (line / 3 % 12) + 1.07) / 12 - 1;
        share[(line + 2) % 3] = (2.0 * (line / 36) + 1.07) / 12 - 1;
        return scope.point(share).as<float>();
    };
    PointRows grid;
    for (int line = 0; line < lines; ++line)
        for (int s = 0; s <= steps; ++s) grid.add(at(line, 2.0 * s / steps - 1));
    const std::vector<float> values = valuesAt(model, grid, workspace);

    struct Span {
        Vec3f inside, outside;
    };
    std::vector<Span> spans;
    for (size_t i = 0; i + 1 < values.size(); ++i) {
        if (static_cast<int>(i % (steps + 1)) == steps || (values[i] < 0) == (values[i + 1] < 0)) continue;
        const Vec3f p{grid.x[i], grid.y[i], grid.z[i]}, q{grid.x[i + 1], grid.y[i + 1], grid.z[i + 1]};
        spans.push_back(values[i] < 0 ? Span{p, q} : Span{q, p});
    }
    PointRows middles;
    for (int halving = 0; halving < 24; ++halving) {
        middles = {};
        for (const Span& s : spans) middles.add((s.inside + s.outside) * 0.5f);
        const std::vector<float> between = valuesAt(model, middles, workspace);
        for (size_t i = 0; i < spans.size(); ++i)
            (between[i] < 0 ? spans[i].inside : spans[i].outside) = {middles.x[i], middles.y[i], middles.z[i]};
    }
    return middles;
}

/// The parts that own some of the field's surface: those that own three crossings at least in the scopes of all shapes
/// with a solid.
inline std::set<OriginId> exposedParts(const Lowered& model) {
    std::map<OriginId, int> met;
    eval::Workspace workspace;
    for (OriginId part = 1; part < model.model->shapeOf.size(); ++part) {
        const derive::Shape& shape = model.derivation.tree.shapes[model.model->shapeOf[part]];
        if (shape.solid == derive::none) continue;
        const PointRows crossings = crossingsIn(shape.scope, model, workspace);
        std::vector<OriginId> owners(crossings.x.size());
        eval::evaluateOrigin(model.tape(), crossings.points(), owners.data(), workspace);
        for (const OriginId owner : owners) ++met[owner];
    }
    std::set<OriginId> exposed;
    for (const auto& [part, times] : met)
        if (times >= 3) exposed.insert(part);
    return exposed;
}

/// Those of the exposed parts that own no triangle of the mesh, in the order of their numbers.
inline std::vector<OriginId> lostParts(const Lowered& model, const mesh::Mesh& mesh) {
    std::set<OriginId> lost = exposedParts(model);
    for (const mesh::Chunk& c : mesh.chunks)
        for (const OriginId origin : c.origins) lost.erase(origin);
    return {lost.begin(), lost.end()};
}

/// "path (line n)".
inline std::string partText(const Lowered& model, OriginId part) {
    const Part& p = model.model->provenance.parts[part];
    return fmt::format("{} (line {})", p.path.text(), p.line());
}

}  // namespace sgm::testing_
