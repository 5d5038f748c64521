// Walls in pieces that touch: inside, the field is 0 in their seams, and the surface isn't there.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "grammar/lower/mesh_positions.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/meshing.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

/// How many vertices of the crisp mesh lie over a hundredth of a cell off the field's surface, those kept in their
/// cells aside.
size_t verticesOff(const char* text, int resolution, double (*distance)(Vec3d)) {
    syntax::Diagnostics problems;
    const auto grammar = load("seams.sgm", std::string("grammar 2\n") + text, problems);
    EXPECT_TRUE(grammar);
    Context context{nullptr, 2};
    const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    EXPECT_TRUE(model.ok());
    const mesh::Grid grid = gridOf(*model, resolution);
    const auto meshed = makeMesh(*model, grid, {.surface = mesh::Surface::Crisp}, context);
    EXPECT_TRUE(meshed.ok());
    size_t off = 0;
    for (const mesh::Chunk& chunk : meshed->mesh.chunks) {
        std::set<uint32_t> confined;
        for (const mesh::ConfinedVertex& c : chunk.confined) confined.insert(c.vertex);
        for (uint32_t v = 0; v < chunk.positions.size(); ++v)
            off += !confined.contains(v) &&
                   std::abs(distance(chunk.positions[v].as<double>())) > .01 * static_cast<double>(grid.cell_m);
    }
    return off;
}

/// The last part of a model.
OriginId floorOf(const Model& model) { return static_cast<OriginId>(model.lowered->provenance.parts.size() - 1); }

/// Of a box turned by 15 degrees about y, in whose frame it lies from `low` to `high`.
double fromBox(Vec3d p, Vec3d low, Vec3d high) {
    const double c = std::cos(M_PI / 12), s = std::sin(M_PI / 12);
    const Vec3d q{p.x * c - p.z * s, p.y, p.x * s + p.z * c};
    double most = low.x - q.x;
    for (int axis = 0; axis < 3; ++axis) most = std::max({most, low[axis] - q[axis], q[axis] - high[axis]});
    return most;
}

TEST(Seams, OfTurnedWallsAreNoSurface) {
    const auto wall = [](Vec3d p) { return fromBox(p, {-3, -4, -.2}, {3, 4, .2}); };
    for (const int resolution : {128, 160, 200})
        EXPECT_EQ(verticesOff("start A -> size (6, 8, .4) turn 15deg split x { { ~1.3m: cube }* }\n", resolution, wall),
                  0u)
            << resolution;
}

TEST(Seams, OfCuttersAreNoSurface) {
    const auto back = [](Vec3d p) { return fromBox(p, {-3, -4, -1}, {3, 4, 0}); };
    for (const int resolution : {144, 200})
        EXPECT_EQ(verticesOff("start A -> size (6m, 8m, 2m) turn 15deg B\n"
                              "rule B -> cube for k in 0..4 { - cube size (1.2m, 10m, 2m) "
                              "move (1.2m * k - 2.4m, 0, 1m) }\n",
                              resolution, back),
                  0u)
            << resolution;
}

/// A doorway that ends where its wall does left a threshold of the wall's look on the floor.
TEST(Seams, OfCutsThatEndAtTheFootHaveTheLookOfTheFloor) {
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(
        "grammar 2\nstart S -> (cube size (10, 4, .4) - cube size (4, 3, 2) move (0, -.5m, 0)) + cube size (14, .4, 8) "
        "move (0, -2.2m, 0)\n",
        128, context);
    const std::vector<const Vec3f*> positions = lower::positionsOf(crisp.mesh);
    double floor_m2 = 0;
    for (const mesh::Chunk& chunk : crisp.mesh.chunks)
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            const mesh::Triangle corners = chunk.inMesh(chunk.triangles[t]);
            std::array<Vec3d, 3> p;
            for (int k = 0; k < 3; ++k) p[static_cast<size_t>(k)] = positions[corners[k]]->as<double>();
            const Vec3d twice = cross(p[1] - p[0], p[2] - p[0]);
            if (std::abs(p[0].y + 2) > 1e-3 || !(twice.y > .99 * length(twice))) continue;
            floor_m2 += chunk.origins[t] == floorOf(crisp.model) ? twice.y / 2 : 0;
        }
    EXPECT_NEAR(floor_m2, 14 * 8 - 6 * .4, .01);
}

}  // namespace
}  // namespace sgm::pipeline
