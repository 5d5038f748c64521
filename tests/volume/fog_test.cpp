// Fog made from level sets of known solids, and read back from files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "modeler/volume/dense.h"
#include "modeler/volume/fog.h"
#include "tests/scratch.h"
#include "tests/volume/shapes.h"

namespace sgm::volume {
namespace {

constexpr float voxel_m = 0.03f;

Volume ballLevelSet() { return std::move(levelSetOf(oneBall(1), voxel_m)).value(); }

Volume fogOf(const Volume& levelSet, const FogOptions& options) {
    auto made = fog(levelSet, options);
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
}

/// The integral over a ball of radius 1 of min(1, depth/edge): 4π ∫ r² min(1, (1 − r)/e) dr.
double rampOverBall(double e) {
    const double inner = 1 - e;
    return 4 * pi * (std::pow(inner, 3) / 3 + ((1 - std::pow(inner, 3)) / 3 - (1 - std::pow(inner, 4)) / 4) / e);
}

TEST(Fog, HoldsAsMuchAsTheClosedForm) {
    const Volume level = ballLevelSet();
    // Within the level set's band, and far beyond it.
    for (const double edge_m : {2.5 * static_cast<double>(voxel_m), 0.3, 0.9}) {
        const Volume f = fogOf(level, {.density = 2.5, .edge_m = edge_m});
        EXPECT_NEAR(f.integral_m3() / (2.5 * rampOverBall(edge_m)), 1, 0.015) << edge_m;
    }
}

TEST(Fog, ThickensWithDepthAndEndsAtTheSurface) {
    const Volume f = fogOf(ballLevelSet(), {.edge_m = 0.5});
    for (const float depth : {0.05f, 0.2f, 0.4f})
        EXPECT_NEAR(f.at(somewhere + Vec3f{0, 1 - depth, 0}), depth / 0.5f, 1.5f * voxel_m / 0.5f);
    EXPECT_FLOAT_EQ(f.at(somewhere), 1);
    EXPECT_FLOAT_EQ(f.at(somewhere + Vec3f{1.2f, 0, 0}), 0);
    const Box3f box = f.bounds(), ball = oneBall(1).field.bounds;
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(box.lo[i], ball.lo[i], 1.5f * voxel_m);
        EXPECT_NEAR(box.hi[i], ball.hi[i], 1.5f * voxel_m);
    }
}

/// A ball of radius 1 with a plate .24 m thick over it, as a cloud has its anvil.
KnownSolid anvil() {
    KnownSolid s = oneBall(1);
    field::Graph& g = *s.graph;
    const Vec3f half{1.8f, 0.12f, 1.2f}, middle = somewhere + Vec3f{0, 1, 0};
    const field::NodeRef x = abs(g.x() - middle.x) - half.x, y = abs(g.y() - middle.y) - half.y,
                         z = abs(g.z() - middle.z) - half.z;
    s.field.value = min(s.field.value, max(x, max(y, z)));
    s.field.bounds = hull(s.field.bounds, Box3f{middle - half, middle + half});
    return s;
}

TEST(Fog, KeepsTheCoreOfWhatIsThinnerThanItsEdge) {
    const Volume level = std::move(levelSetOf(anvil(), voxel_m)).value();
    for (const double edge_m : {0.3, 0.8}) {
        const Volume f = fogOf(level, {.edge_m = edge_m, .wisps = 0.6});
        for (const Vec3f at : {Vec3f{1.4f, 1, 0}, Vec3f{-1.3f, 1, 0.6f}, Vec3f{1.5f, 1, -0.9f}})
            EXPECT_GT(f.at(somewhere + at), 0.7f) << edge_m;  // half of the plate's thickness is .12 m
        EXPECT_FLOAT_EQ(f.at(somewhere), 1);
        // The ball's own edge is as deep as before, below the plate.
        const Volume plain = fogOf(ballLevelSet(), {.edge_m = edge_m, .lump_m = 0.3});
        const Volume both = fogOf(level, {.edge_m = edge_m, .lump_m = 0.3});
        for (const float depth : {0.1f, 0.2f})
            EXPECT_NEAR(both.at(somewhere + Vec3f{0, depth - 1, 0}), plain.at(somewhere + Vec3f{0, depth - 1, 0}), 0.06)
                << edge_m;
    }
}

TEST(Fog, WispsEatTheEdgeAndBillowsThinTheInside) {
    const Volume level = ballLevelSet();
    const Volume plain = fogOf(level, {.edge_m = 0.4});
    const Volume wispy = fogOf(level, {.edge_m = 0.4, .wisps = 0.8});
    const Volume billowy = fogOf(level, {.edge_m = 0.4, .billow = 0.6, .lump_m = 0.3});
    EXPECT_LT(wispy.integral_m3(), 0.95 * plain.integral_m3());
    EXPECT_GT(wispy.integral_m3(), 0.5 * plain.integral_m3());
    EXPECT_FLOAT_EQ(wispy.at(somewhere), 1);  // wisps leave the inside alone
    EXPECT_LT(wispy.activeVoxels(), plain.activeVoxels());
    EXPECT_LT(billowy.integral_m3(), plain.integral_m3());
    float least = 1, most = 0;
    for (float x = -0.4f; x <= 0.4f; x += voxel_m) {
        const float v = billowy.at(somewhere + Vec3f{x, 0, 0});
        least = std::min(least, v), most = std::max(most, v);
        EXPECT_GE(v, 0.4f - 1e-6f);
        EXPECT_LE(v, 1);
    }
    EXPECT_GT(most - least, 0.1f);  // it varies inside
}

TEST(Fog, LiesBesideTheLevelSetInOneFile) {
    const Scratch folder;
    const Volume level = ballLevelSet();
    const Volume f = fogOf(level, {.edge_m = 0.2});
    for (const bool half : {false, true}) {
        const auto file = folder / "both.vdb";
        ASSERT_TRUE(fillVdb({{level, "level_set"}, {f, "density"}}, file, file, {half, {}}).ok());
        const std::string bytes = contentOf(file);
        EXPECT_NE(bytes.find("fog volume"), std::string::npos);
        EXPECT_NE(bytes.find("level set"), std::string::npos);
        const auto read = readVdb(file, "density");
        ASSERT_TRUE(read.ok());
        EXPECT_FLOAT_EQ(read->voxel_m(), voxel_m);
        EXPECT_EQ(read->activeVoxels(), f.activeVoxels());
        EXPECT_NEAR(read->integral_m3(), f.integral_m3(), half ? 1e-3 : 0);
        for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(read->bounds().hi[i], f.bounds().hi[i]);
        EXPECT_EQ(readVdb(file, "smoke").error().message.find("cannot read"), 0u);
        EXPECT_GT(readVdb(file, "level_set")->enclosed_m3(), 4);
    }
}

TEST(Fog, OpensInOpenVdbsOwnTool) {
    if (std::system("command -v vdb_print > /dev/null") != 0)
        GTEST_SKIP() << "vdb_print isn't installed (libopenvdb-tools)";
    const Scratch folder;
    ASSERT_TRUE(writeVdb(fogOf(ballLevelSet(), {}), folder / "a.vdb", "density").ok());
    ASSERT_EQ(std::system(("vdb_print -l " + (folder / "a.vdb").string() + " > " + (folder / "said").string()).c_str()),
              0);
    const std::string said = contentOf(folder / "said");
    for (const char* text : {"density", "float", "fog volume", "voxel size: 0.03"})
        EXPECT_NE(said.find(text), std::string::npos) << text << " in\n" << said;
}

TEST(Fog, HasTheSameBytesEveryTime) {
    const Scratch folder;
    std::string first;
    for (int run = 0; run < 3; ++run) {
        const Volume f = fogOf(ballLevelSet(), {.edge_m = 0.5, .wisps = 0.5, .billow = 0.5});
        ASSERT_TRUE(writeVdb(f, folder / "a.vdb", "density").ok());
        if (first.empty()) first = contentOf(folder / "a.vdb");
        EXPECT_TRUE(contentOf(folder / "a.vdb") == first);
    }
}

TEST(Fog, IsReadAsAnArrayThatHoldsAllOfIt) {
    const Volume f = fogOf(ballLevelSet(), {.edge_m = 0.3});
    const auto array = dense(f, 2);
    ASSERT_TRUE(array.ok());
    EXPECT_FLOAT_EQ(array->voxel_m, voxel_m);
    double sum = 0;
    for (const float value : array->values) sum += static_cast<double>(value);
    EXPECT_NEAR(sum * std::pow(double(voxel_m), 3), f.integral_m3(), 1e-4 * f.integral_m3());
    for (const Vec3i at : {Vec3i{20, 36, 30}, Vec3i{5, 33, 40}, Vec3i{0, 0, 0}})
        EXPECT_EQ(array->values[array->index(at.x, at.y, at.z)], f.at(array->low + at.as<float>() * voxel_m));
    EXPECT_EQ(array->values[0], 0) << "the border";
}

TEST(Fog, RefusesWhatMakesNone) {
    const Volume level = ballLevelSet();
    EXPECT_EQ(fog(level, {.density = 0}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(fog(level, {.edge_m = -1}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(fog(level, {.wisps = 1}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(fog(level, {.billow = 2}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(fog(fogOf(level, {}), {}).error().kind, Error::Kind::Usage);  // fog of fog
    Progress progress;
    progress.cancel();
    EXPECT_EQ(fog(level, {}, &progress).error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sgm::volume
