// Meshes from files, and the distances to them.
#include "modeler/mesh/distances.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sgm::mesh {
namespace {

using field::SampledGrid;

/// A sample and where it is; `middle` is that of the mesh, about which the grid lies.
template <class Fn>
void eachSample(const SampledGrid& grid, Vec3f middle, Fn&& fn) {
    const std::vector<float>& w = grid.words();
    const auto count = [&](size_t axis) { return static_cast<int>(w[SampledGrid::cells + axis]) + 1; };
    size_t at = SampledGrid::firstSample;
    for (int k = 0; k < count(2); ++k)
        for (int j = 0; j < count(1); ++j)
            for (int i = 0; i < count(0); ++i, ++at)
                fn(middle + Vec3f{w[0], w[1], w[2]} + Vec3i{i, j, k}.as<float>() * w[SampledGrid::cell], w[at]);
    EXPECT_EQ(at, w.size());
}

/// Adds a box; inside out where `inverted`.
void addBox(Chunk& c, Vec3f lo, Vec3f hi, bool inverted = false) {
    const auto base = static_cast<uint32_t>(c.positions.size());
    for (uint32_t i = 0; i < 8; ++i)
        c.positions.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
    for (const Vec3<uint32_t> t : {Vec3<uint32_t>{0, 2, 1},
                                   {1, 2, 3},
                                   {4, 5, 6},
                                   {5, 7, 6},
                                   {0, 1, 4},
                                   {1, 5, 4},
                                   {2, 6, 3},
                                   {3, 6, 7},
                                   {0, 4, 2},
                                   {2, 4, 6},
                                   {1, 3, 5},
                                   {3, 7, 5}}) {
        const Vec3<uint32_t> from{base + t.x, base + t.y, base + t.z};
        c.triangles.push_back(inverted ? Vec3<uint32_t>{from.x, from.z, from.y} : from);
        c.origins.push_back(0);
    }
}

float boxDistance(Vec3f p, Vec3f lo, Vec3f hi) {
    const Vec3f q = max(lo - p, p - hi);
    return length(max(q, Vec3f{})) + std::min(maxComponent(q), 0.0f);
}

TEST(Distances, OfABoxAreExactEverywhere) {
    Mesh mesh;
    addBox(mesh.chunks.emplace_back(), {-1, 2, 0}, {3, 3, 1.5f});
    const auto grid = toDistances(mesh, 48);
    ASSERT_TRUE(grid.ok());
    EXPECT_EQ((*grid)->bounds().size(), mesh.bounds().size());
    eachSample(**grid, mesh.bounds().centre(), [](Vec3f p, float d) {
        ASSERT_NEAR(d, boxDistance(p, {-1, 2, 0}, {3, 3, 1.5f}), 1e-5) << p.x << ' ' << p.y << ' ' << p.z;
    });
}

/// A shell turned inside out is a hollow; one that overlaps adds to the solid.
TEST(Distances, CountHowOftenTheMeshWindsAround) {
    Mesh mesh;
    Chunk& chunk = mesh.chunks.emplace_back();
    addBox(chunk, {0, 0, 0}, {4, 4, 4});
    addBox(chunk, {1, 1, 1}, {2, 3, 3}, true);
    addBox(chunk, {3, 3, 3}, {6, 5, 5});
    const auto grid = toDistances(mesh, 40);
    ASSERT_TRUE(grid.ok());
    eachSample(**grid, mesh.bounds().centre(), [](Vec3f p, float d) {
        const bool hollow = boxDistance(p, {1, 1, 1}, {2, 3, 3}) < 0;
        const bool inside =
            (boxDistance(p, {0, 0, 0}, {4, 4, 4}) < 0 && !hollow) || boxDistance(p, {3, 3, 3}, {6, 5, 5}) < 0;
        ASSERT_EQ(d < 0, inside) << p.x << ' ' << p.y << ' ' << p.z;
    });
}

/// Rows of samples that run along edges and through corners.
TEST(Distances, OfAnOctahedronAcrossTheRows) {
    Mesh mesh;
    Chunk& c = mesh.chunks.emplace_back();
    c.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (uint32_t i = 0; i < 8; ++i) {
        const uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
        const bool odd = (i ^ i >> 1 ^ i >> 2) & 1;
        c.triangles.push_back(odd ? Triangle{x, z, y} : Triangle{x, y, z});
    }
    const auto grid = toDistances(mesh, 50);
    ASSERT_TRUE(grid.ok());
    eachSample(**grid, {}, [](Vec3f p, float d) {
        const float planes = (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) - 1) / std::sqrt(3.0f);
        if (planes < 0) {
            ASSERT_NEAR(d, planes, 1e-5);
        }
        ASSERT_EQ(d < 0, planes < 0);
        ASSERT_GE(d, planes - 1e-5);
    });
}

TEST(Distances, RefuseWhatHasNoInside) {
    Mesh open;
    addBox(open.chunks.emplace_back(), {0, 0, 0}, {1, 1, 1});
    open.chunks[0].triangles.pop_back();
    const auto hole = toDistances(open);
    ASSERT_FALSE(hole.ok());
    EXPECT_NE(hole.error().message.find("is open near (1, "), std::string::npos) << hole.error().message;
    Mesh turned;
    addBox(turned.chunks.emplace_back(), {0, 0, 0}, {1, 1, 1});
    std::swap(turned.chunks[0].triangles[3].x, turned.chunks[0].triangles[3].y);
    EXPECT_FALSE(toDistances(turned).ok()) << "a face that looks inward";
    Mesh flat;
    addBox(flat.chunks.emplace_back(), {0, 0, 0}, {1, 1, 0});
    EXPECT_FALSE(toDistances(flat).ok());
    Mesh thin;
    addBox(thin.chunks.emplace_back(), {0, 0, 0}, {1, 1, 0.0005f});
    EXPECT_NE(toDistances(thin, 16).error().message.find("too thin"), std::string::npos);
    EXPECT_FALSE(toDistances(Mesh{}).ok());
}

/// The words of a grid of a box that stands somewhere, in some unit.
std::vector<float> gridOf(Vec3d lo, double unit) {
    Mesh box;
    addBox(box.chunks.emplace_back(), {0, 0, 0}, {1, 1, 1});
    TriangleSoup soup;
    for (const Vec3f& p : box.chunks[0].positions) soup.positions.push_back(lo + p.as<double>() * unit);
    soup.triangles.assign(box.chunks[0].triangles.begin(), box.chunks[0].triangles.end());
    const auto grid = toDistances(std::move(soup), 32);
    return grid.ok() ? (*grid)->words() : std::vector<float>();
}

TEST(Distances, AreTheSameWhereverTheMeshStands) {
    const std::vector<float> near = gridOf({0, 0, 0}, 1);
    ASSERT_FALSE(near.empty());
    // A surveyor's coordinates, single precision's last whole numbers and far beyond them.
    for (const Vec3d lo : {Vec3d{500000, 5400000, 200}, {0, 0, 16777216}, {-1e12, 3e9, 7}})
        EXPECT_EQ(gridOf(lo, 1), near) << lo.x;
}

TEST(Distances, AreFoundOfMeshesOfAnySize) {
    const std::vector<float> one = gridOf({0, 0, 0}, 1);
    for (const double unit : {std::ldexp(1, -1060), std::ldexp(1, -149), std::ldexp(1, 120), std::ldexp(1, 1020)}) {
        const std::vector<float> words = gridOf({0, 0, 0}, unit);
        ASSERT_EQ(words.size(), one.size()) << unit;
        for (size_t i = SampledGrid::firstSample; i < one.size(); ++i)
            ASSERT_FLOAT_EQ(words[i] / words[SampledGrid::cell], one[i] / one[SampledGrid::cell]) << unit;
    }
}

TEST(Distances, StopWhenTheyAreCancelled) {
    Progress progress;
    progress.cancel();
    TriangleSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    const auto grid = toDistances(std::move(soup), 32, &progress);
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.error().kind, Error::Kind::Cancelled);
}

/// Overlapping shells are one solid, but each large triangle costs as much as the box's side has nodes.
TEST(Distances, RefuseMoreLargeTrianglesThanMinutesAllow) {
    Mesh mesh;
    Chunk& chunk = mesh.chunks.emplace_back();
    for (int i = 0; i < 3000; ++i) {
        const float o = 1e-5f * static_cast<float>(i);
        addBox(chunk, {o, o, o}, {1 + o, 1 + o, 1 + o});
    }
    Mesh few;
    for (int i = 0; i < 20; ++i)
        addBox(few.chunks.empty() ? few.chunks.emplace_back() : few.chunks[0], {0, 0, 0},
               {1, 1, 1 + 0.01f * static_cast<float>(i)});
    EXPECT_TRUE(toDistances(few).ok());
    const auto grid = toDistances(mesh);
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.error().kind, Error::Kind::Budget);
}

}  // namespace
}  // namespace sgm::mesh
