// The normals that files get, from grammars whose faces coincide or blend.
#include <gtest/gtest.h>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/simplify.h"
#include "tests/pipeline/crisp_model.h"
#include "tests/pipeline/faces_of.h"

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
    const std::vector<Face> triangles = facesOf(*mesh);
    size_t through = 0;
    for (const Face& t : triangles)
        for (const Vec3f& normal : t.normals) through += dot(t.across(), normal) < 0;
    EXPECT_GT(triangles.size(), 100u);
    EXPECT_EQ(through, 0u);
}

/// Where the pieces of a blend meet they don't bend, and the tangents of their curves in a cell's face cross outside
/// it.
struct Blend {
    const char* name;
    std::string text;
    std::vector<int> resolutions;
};
const Blend blends[] = {
    {"rings",
     "grammar 2\n"
     "start Horn -> cylinder size (.9m, .34m, .9m) : Joint\n"
     "rule Joint repeat 6 -> + cylinder size (.85 ~> .6, .34, .85 ~> .6) at +y overlap .3 blend .1m : Joint\n",
     {32, 96, 128}},
    {"spheres",
     "grammar 2\n"
     "start A -> sphere size 1.6m color #d09a3c + sphere size 1m move (-.8, .5, .2) color #d03c6a blend .3m\n"
     "           - sphere size .7m move (0, .7, .4) blend .15m\n",
     {32, 48, 64}},
};

TEST(Normals, VerticesOfBlendsLieOnTheSurface) {
    for (const Blend& blend : blends)
        for (const int resolution : blend.resolutions) {
            Context context{nullptr, 2};
            CrispModel crisp = crispModel(blend.text, resolution, context, 0);
            eval::Workspace workspace;
            for (mesh::Chunk& c : crisp.mesh.chunks) {
                for (const mesh::ConfinedVertex& v : c.confined) c.positions[v.vertex] = v.place;
                for (const Vec3f& p : c.positions) {
                    float value;
                    eval::evaluate(crisp.model.tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
                    EXPECT_LT(std::abs(value), .05f * crisp.grid.cell_m) << blend.name << ' ' << resolution;
                }
            }
        }
}

struct Heights {
    float low, high;
};
constexpr Heights allHeights{-1e9f, 1e9f};

struct CornerCount {
    size_t all = 0, off = 0;
};

/// Corners of a simplified mesh, those of specks left out, and how many have normals more than 30 degrees off the
/// field's.
CornerCount cornersOffTheField(const std::string& text, int resolution, Heights heights = allHeights) {
    Context context{nullptr, 2};
    CrispModel crisp = crispModel(text, resolution, context, 0);
    const float cell_m = crisp.grid.cell_m, speck_m2 = 1e-4f * cell_m * cell_m;
    const eval::Tape tape = crisp.model.tape;
    const auto mesh = crisp.edit({.tolerance_m = mesh::usualTolerance(cell_m)}, context);
    EXPECT_TRUE(mesh.ok());
    if (!mesh.ok()) return {};
    eval::Workspace workspace;
    CornerCount corners;
    for (const Face& t : facesOf(*mesh)) {
        const float height = t.middle().y;
        if (length(t.across()) < speck_m2 || height < heights.low || height > heights.high) continue;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3f p = t.places[k] * .9f + t.middle() * .1f;  // on this side of a rim
            float value;
            Vec3f slope;
            eval::evaluateGradient(tape, {&p.x, &p.y, &p.z, 1}, &value, &slope.x, &slope.y, &slope.z, workspace);
            ++corners.all, corners.off += dot(normalized(slope), t.normals[k]) < .87f;
        }
    }
    return corners;
}

TEST(Normals, OfBlendsFollowTheField) {
    for (const Blend& blend : blends)
        for (const int resolution : blend.resolutions)
            EXPECT_LE(cornersOffTheField(blend.text, resolution).off, 3u)
                << blend.name << ' ' << resolution;  // a triangle
}

TEST(Normals, FollowTheFieldBesideTies) {
    // The side of a cone comes out of a torus: some breaks lie where both are equally far within the margin of ties,
    // and show with the torus's slope on the cone's side. Lower down the torus touches other solids.
    const CornerCount corners = cornersOffTheField(fileText("examples/figure1.sgm"), 256, {.58f, .65f});
    EXPECT_GT(corners.all, 1000u);
    EXPECT_EQ(corners.off, 0u);
}

}  // namespace
}  // namespace sgm::pipeline
