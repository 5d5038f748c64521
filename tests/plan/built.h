// Footprints as fields and as crisp meshes, for tests.
// Enters: plans. Leaves: scenes, meshes and their figures. Assumes gtest.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "modeler/field/footprint.h"
#include "modeler/field/roofs.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"
#include "modeler/plan/shapes.h"
#include "tests/mesh/scenes.h"

namespace sgm::plan::test {

/// A plan in a graph of its own; the field is set by whoever builds one.
struct Built {
    explicit Built(Footprint f, uint64_t path = 1)
        : footprint(std::move(f)),
          formula(*monotoneFormula(footprint)),
          plan(footprint, formula, scene.graph.position(), path) {}
    Built(const Built&) = delete;

    field::Quantity number(double v) { return {scene.graph.slot({77, ++slots}, static_cast<float>(v)), v}; }
    field::RoofFoot foot(double eaves = 0, double overhang = 0, double fascia = 0) {
        return {number(eaves), number(overhang), number(fascia), 99};
    }
    field::Field& field() { return scene.field; }

    mesh::Scene scene;
    Footprint footprint;
    Formula formula;
    field::PlanField plan;
    uint64_t slots = 0;
};

inline std::unique_ptr<Built> built(Footprint f) { return std::make_unique<Built>(std::move(f)); }

/// The crisp mesh, simplified; closed, or the test fails. `judged`: also by CGAL.
inline mesh::Mesh crispMesh(const mesh::Scene& scene, int resolution, bool judged = true) {
    const mesh::BuiltMesh m = mesh::meshOf(scene, resolution, 2, {.surface = mesh::Surface::Crisp});
    EXPECT_TRUE(m.mesh.ok());
    if (!m.mesh.ok()) return {};
    auto simple =
        mesh::simplify(*m.mesh, {mesh::usualTolerance(mesh::cellFor(scene.field.bounds, resolution)), 2}, nullptr);
    EXPECT_TRUE(simple.ok()) << simple.error().message;
    if (!simple.ok()) return {};
    const mesh::MeshFigures f = mesh::measure(*simple);
    EXPECT_EQ(f.boundaryEdges, 0u);
    EXPECT_EQ(f.nonmanifoldEdges, 0u);
    if (judged) {
        const auto word = mesh::validate(*simple);
        EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects);
    }
    return *simple;
}

/// Tunnels through a closed surface, summed over its components.
inline int64_t genus(const mesh::MeshFigures& f) { return static_cast<int64_t>(f.components) - f.euler / 2; }

}  // namespace sgm::plan::test
