// The normals that files get, from grammars whose faces coincide.
#include <gtest/gtest.h>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "modeler/mesh/chunk.h"
#include "modeler/mesh/corners.h"

namespace sgm::pipeline {
namespace {

TEST(Normals, NoCornerLooksIntoTheSolidWherePartsStandOnOneAnother) {
    // Piers stand on a slab beside a clad solid: their feet lie in the plane of its top.
    syntax::Diagnostics problems;
    const auto grammar = load("piers.sgm",
                              "grammar 1\n"
                              "terminal gothic = ornament(center: (.93, .93, .33), fold: rotZ(30deg), passes: 4, "
                              "mirror: (.35, .27, .2), zoom: 3.2, pan: .25)\n"
                              "start A -> cube size (13, .7, 13) : F\n"
                              "rule F -> + Tier size (10, 5.4, 10) at +y\n"
                              "rule Tier -> Core for a in (-1, 1) { for b in (-1, 1) { + cube size (.9m, 100%, .9m) "
                              "move (a * (scope.x / 2 - .3m), 0, b * (scope.z / 2 - .3m)) } }\n"
                              "rule Core -> cube size (96%, 100%, 96%) clad gothic tile (4m, 5m) thickness (.6m, 0m)\n",
                              problems);
    ASSERT_TRUE(grammar);
    Context context{nullptr, 2};
    const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    ASSERT_TRUE(model.ok());
    const mesh::Grid grid = gridOf(*model, 160);
    const float sliver_m2 = grid.cell_m * grid.cell_m / 10;
    const auto meshed = makeMesh(*model, grid, {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(meshed.ok());
    size_t corners = 0, inward = 0;
    for (const mesh::Chunk& chunk : meshed->mesh.chunks)
        for (const mesh::CornerNormal& corner : chunk.cornerNormals) {
            const mesh::Triangle t = chunk.inMesh(chunk.triangles[corner.corner / 3]);
            Vec3f at[3];
            for (int k = 0; k < 3; ++k) {
                const mesh::Chunk& owner = mesh::ownerOf(meshed->mesh.chunks, t[k]);
                at[k] = owner.positions[t[k] - owner.firstVertex];
            }
            const Vec3f across = cross(at[1] - at[0], at[2] - at[0]), face = normalized(across);
            if (face.y < .99f || length(across) < sliver_m2) continue;  // the slab's top, less slivers
            inward += dot(face, corner.normal) < -0.9f;
            ++corners;
        }
    EXPECT_GT(corners, 100u);
    EXPECT_EQ(inward, 0u);
}

TEST(Normals, NoCornerOfAFileLooksThroughItsTriangle) {
    // Walls thinner than a cell, turned: vertices of either face are a cell apart at most.
    syntax::Diagnostics problems;
    const auto grammar =
        load("walls.sgm", "grammar 2\nstart A -> cube size (40, 9, .3) turn 15deg + cube size (30, 1, 30)\n", problems);
    ASSERT_TRUE(grammar);
    Context context{nullptr, 2};
    const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    ASSERT_TRUE(model.ok());
    const mesh::Grid grid = gridOf(*model, 100);
    auto meshed = makeMesh(*model, grid, {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(meshed.ok());
    const auto mesh = edited(std::move(meshed->mesh), {}, {model->tape, mesh::Surface::Crisp, grid.cell_m}, context);
    ASSERT_TRUE(mesh.ok());
    const std::vector<mesh::Triangle> triangles = mesh::gatherTriangles(*mesh);
    const mesh::CornerNormalTable corners = mesh::collectCornerNormals(*mesh);
    std::vector<Vec3f> positions, normals;
    for (const mesh::Chunk& c : mesh->chunks) {
        positions.insert(positions.end(), c.positions.begin(), c.positions.end());
        normals.insert(normals.end(), c.normals.begin(), c.normals.end());
    }
    size_t through = 0;
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Vec3f p = positions[triangles[t][0]];
            const Vec3f face = cross(positions[triangles[t][1]] - p, positions[triangles[t][2]] - p);
            const uint32_t own = corners.empty() ? mesh::noIndex : corners.of[t][k];
            through += dot(face, own == mesh::noIndex ? normals[triangles[t][k]] : corners.normals[own]) < 0;
        }
    EXPECT_GT(triangles.size(), 100u);
    EXPECT_EQ(through, 0u);
}

}  // namespace
}  // namespace sgm::pipeline
