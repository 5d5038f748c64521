// Edges of meshes along curves of their fields.
#include "modeler/mesh/curved_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "modeler/mesh/components.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

/// A wall with a round hole of 1.2 m, and a shaft half sunk in it.
constexpr const char* wall =
    "grammar 2\n"
    "start A -> cube size (6m, 3m, .6m) - cylinder size (1.2m, 1m, 1.2m) turn (90deg, 0, 0) move (-1.1m, .21m, 0)\n"
    "  + cylinder size (.8m, 3m, .8m) move (1.3m, 0, .3m)\n";

/// Simplified with what it is told, but for curves.
mesh::Mesh simplified(const CrispModel& crisp) {
    auto made = mesh::simplify(crisp.mesh, {mesh::usualTolerance(crisp.grid.cell_m), 2}, nullptr);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

/// The share of a mesh's edges, so long at least, whose middles are farther from the surface than that.
double shareOff(const mesh::Mesh& mesh, const Model& model, double distance_m, float length_m = 0) {
    std::vector<float> x, y, z;
    for (const mesh::Chunk& c : mesh.chunks)
        for (const mesh::Triangle& t : c.triangles)
            for (int k = 0; k < 3; ++k) {
                const Vec3f a = c.positions[t[k]], b = c.positions[t[(k + 1) % 3]], p = (a + b) * .5f;
                if (length(b - a) < length_m) continue;
                x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            }
    std::vector<float> values(x.size());
    eval::Workspace workspace;
    eval::evaluate(model.tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    const auto off = std::count_if(values.begin(), values.end(), [&](float v) { return std::abs(v) > distance_m; });
    return static_cast<double>(off) / static_cast<double>(values.size());
}

TEST(CurvedEdges, AreSplitWhereTheyAreOffByMoreThanTheTolerance) {
    Context context{nullptr, 2};
    for (const int cells : {24, 32, 48}) {
        const CrispModel crisp = crispModel(wall, cells, context, 0);
        mesh::Mesh mesh = simplified(crisp);
        const double tolerance_m = mesh::usualTolerance(crisp.grid.cell_m);
        EXPECT_GT(shareOff(mesh, crisp.model, 1.25 * tolerance_m), .2) << cells;
        const auto split = mesh::splitCurvedEdges(mesh, crisp.model.tape, tolerance_m, 2, nullptr);
        ASSERT_TRUE(split.ok());
        EXPECT_GT(*split, 20u) << cells;
        EXPECT_LT(shareOff(mesh, crisp.model, 1.25 * tolerance_m), .01) << cells;
        const auto judged = mesh::validate(mesh);
        ASSERT_TRUE(judged.ok());
        EXPECT_TRUE(judged->closed && judged->outward && !judged->selfIntersects) << cells;
    }
}

TEST(CurvedEdges, AreSplitAlongAColumnInCellsOfTwoSizes) {
    // Cells around a plate are halved; the column's piece has more corners where they meet larger ones than at its
    // ends.
    Context context{nullptr, 2};
    CrispModel crisp = crispModel(
        "grammar 2\n"
        "start A -> cube size (10m, .5m, 4m) + cylinder size (.5m, 5.3m, .5m) at +y\n"
        "  + cube size (1.2m, .04m, 1.2m) move (0, .7m, 0)\n",
        64, context);
    const double tolerance_m = mesh::usualTolerance(crisp.grid.cell_m);
    const auto mesh = crisp.edit({.tolerance_m = tolerance_m}, context);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(shareOff(*mesh, crisp.model, 4 * tolerance_m, 4 * crisp.grid.cell_m), 0);
}

/// As of arches, whose chords are in the hole.
TEST(CurvedEdges, OfRoundHolesLeaveTheirVolume) {
    Context context{nullptr, 2};
    CrispModel crisp = crispModel(
        "grammar 2\nstart A -> cube size (2m, 2m, .6m) - cylinder size (1m, 1m, 1m) turn (90deg, 0, 0)\n", 20, context);
    const double hole_m3 = std::numbers::pi * .25 * .6;
    const auto lacking = [&](const mesh::Mesh& mesh) {
        return (mesh::measure(mesh).volume_m3 - 2.4 + hole_m3) / hole_m3;
    };
    EXPECT_GT(lacking(simplified(crisp)), 5e-3);
    const auto mesh = crisp.edit({}, context);
    ASSERT_TRUE(mesh.ok());
    EXPECT_LT(std::abs(lacking(*mesh)), 2e-3);
}

/// Normals of new vertices are the pieces' own.
TEST(CurvedEdges, HaveTheNormalsOfTheirPieces) {
    Context context{nullptr, 2};
    CrispModel crisp = crispModel("grammar 2\nstart A -> cylinder size (2m, 1m, 2m)\n", 12, context);
    const auto mesh = crisp.edit({}, context);
    ASSERT_TRUE(mesh.ok());
    const mesh::Chunk& c = mesh->chunks[0];
    std::vector<Vec3f> normals;
    for (const mesh::Triangle& t : c.triangles)
        for (int k = 0; k < 3; ++k) normals.push_back(c.normals[t[k]]);
    for (const mesh::CornerNormal& n : c.cornerNormals) normals[n.corner] = n.normal;
    for (uint32_t t = 0; t < c.triangles.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const Vec3f n = normals[3 * t + k], p = c.positions[c.triangles[t][static_cast<int>(k)]];
            if (std::abs(n.y) > .5f)
                EXPECT_GT(std::abs(n.y), .9999f);
            else
                EXPECT_GT(dot(n, normalized(Vec3f{p.x, 0, p.z})), .9999f);
        }
}

TEST(CurvedEdges, OfFlatAndOfRoughThingsStay) {
    Context context{nullptr, 2};
    for (const char* text : {"cube size (4m, 2m, 3m) + cube size (1m, 3m, 1m) turn (0, 30deg, 0)",
                             "sphere size 4m displace fbm(.4m, .8/m, 4)"}) {
        const CrispModel crisp = crispModel("grammar 2\nstart A -> " + std::string(text) + "\n", 32, context);
        mesh::Mesh mesh = simplified(crisp);
        const auto before = mesh::bytesOf(mesh);
        const double tolerance_m = mesh::usualTolerance(crisp.grid.cell_m);
        const auto split = mesh::splitCurvedEdges(mesh, crisp.model.tape, tolerance_m, 2, nullptr);
        ASSERT_TRUE(split.ok());
        EXPECT_EQ(*split, 0u) << text;
        EXPECT_EQ(mesh::bytesOf(mesh), before) << text;
    }
}

TEST(CurvedEdges, AreTheSameAtAnyThreadCount) {
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(fileText("examples/buildings/hall.sgm"), 96, context);
    std::vector<unsigned char> first;
    for (const int threads : {1, 2, 5}) {
        mesh::Mesh mesh = simplified(crisp);
        const double tolerance_m = mesh::usualTolerance(crisp.grid.cell_m);
        ASSERT_TRUE(mesh::splitCurvedEdges(mesh, crisp.model.tape, tolerance_m, threads, nullptr).ok());
        if (first.empty()) first = mesh::bytesOf(mesh);
        EXPECT_TRUE(mesh::bytesOf(mesh) == first) << threads;
    }
}

TEST(CurvedEdges, StayAsTheyWereAfterCancelling) {
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(wall, 32, context);
    mesh::Mesh mesh = simplified(crisp);
    const auto before = mesh::bytesOf(mesh);
    Progress progress;
    progress.cancel();
    EXPECT_FALSE(mesh::splitCurvedEdges(mesh, crisp.model.tape, 1e-4, 2, &progress).ok());
    EXPECT_EQ(mesh::bytesOf(mesh), before);
}

}  // namespace
}  // namespace sgm::pipeline
