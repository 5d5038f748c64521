// The normals that files get, from grammars whose faces coincide.
#include <gtest/gtest.h>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/corners.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

TEST(Normals, NoCornerLooksIntoTheSolidWherePartsStandOnOneAnother) {
    // Piers stand on a slab beside a clad solid: their feet lie in the plane of its top.
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(
        "grammar 1\n"
        "terminal gothic = ornament(center: (.93, .93, .33), fold: rotZ(30deg), passes: 4, "
        "mirror: (.35, .27, .2), zoom: 3.2, pan: .25)\n"
        "start A -> cube size (13, .7, 13) : F\n"
        "rule F -> + Tier size (10, 5.4, 10) at +y\n"
        "rule Tier -> Core for a in (-1, 1) { for b in (-1, 1) { + cube size (.9m, 100%, .9m) "
        "move (a * (scope.x / 2 - .3m), 0, b * (scope.z / 2 - .3m)) } }\n"
        "rule Core -> cube size (96%, 100%, 96%) clad gothic tile (4m, 5m) thickness (.6m, 0m)\n",
        160, context);
    const float sliver_m2 = crisp.grid.cell_m * crisp.grid.cell_m / 10;
    size_t corners = 0, inward = 0;
    for (const mesh::Chunk& chunk : crisp.mesh.chunks)
        for (const mesh::CornerNormal& corner : chunk.cornerNormals) {
            const mesh::Triangle t = chunk.inMesh(chunk.triangles[corner.corner / 3]);
            Vec3f at[3];
            for (int k = 0; k < 3; ++k) {
                const mesh::Chunk& owner = mesh::ownerOf(crisp.mesh.chunks, t[k]);
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
    Context context{nullptr, 2};
    Model model = modelOf("grammar 2\nstart A -> cube size (40, 9, .3) turn 15deg + cube size (30, 1, 30)\n", context);
    CrispModel crisp = crispModel(acrossGrid(std::move(model)), 100, context, 0);
    const auto mesh = crisp.edit({}, context);
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
