#include "modeler/tiles/level_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace sgm::tiles {
namespace {

constexpr double rounding_m = 1e-4, tolerance_m = 0.01;

/// A grid of squares of two triangles each, of `side` squares a side, with heights by corner and keys by square.
struct Ground {
    std::vector<Vec3f> positions;
    KeyedTriangles ground;

    template <class Height, class Key>
    Ground(int side, Height&& height, Key&& key, bool up = true) {
        for (int z = 0; z <= side; ++z)
            for (int x = 0; x <= side; ++x) positions.push_back({2 * float(x), height(x, z), 2 * float(z)});
        const auto at = [&](int x, int z) { return uint32_t(z * (side + 1) + x); };
        for (int z = 0; z < side; ++z)
            for (int x = 0; x < side; ++x)
                for (const auto& t : {std::array{at(x, z), at(x, z + 1), at(x + 1, z)},
                                      std::array{at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)}}) {
                    ground.triangles.push_back({t[0], up ? t[1] : t[2], up ? t[2] : t[1]});
                    ground.keys.push_back(key(x, z));
                }
    }
    KeyedTriangles merged(double tolerance = tolerance_m) const {
        return mergeLevelRegions(ground, positions, rounding_m, tolerance);
    }
};

const auto level = [](int, int) { return 1.0f; };
const auto oneKey = [](int, int) { return 0u; };

/// Twice the sum of the triangles' oriented areas, by key.
std::map<uint32_t, Vec3d> areasOf(const KeyedTriangles& ground, const std::vector<Vec3f>& positions) {
    std::map<uint32_t, Vec3d> sums;
    for (size_t t = 0; t < ground.triangles.size(); ++t) {
        const mesh::Triangle& c = ground.triangles[t];
        const Vec3d a = positions[c.x].as<double>();
        sums[ground.keys[t]] += cross(positions[c.y].as<double>() - a, positions[c.z].as<double>() - a);
    }
    return sums;
}

using Place = std::tuple<float, float, float>;
using Border = std::set<std::pair<Place, Place>>;

/// Edges without a triangle of the same key on the other side; those of the list's own border alone, where `open`.
Border borderOf(const KeyedTriangles& ground, const std::vector<Vec3f>& positions, bool open) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> keys;
    for (size_t t = 0; t < ground.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) keys[{ground.triangles[t][k], ground.triangles[t][(k + 1) % 3]}] = ground.keys[t];
    const auto placeOf = [&](uint32_t v) { return Place{positions[v].x, positions[v].y, positions[v].z}; };
    Border border;
    for (const auto& [edge, key] : keys) {
        const auto other = keys.find({edge.second, edge.first});
        if (other == keys.end() || (!open && other->second != key))
            border.insert({placeOf(edge.first), placeOf(edge.second)});
    }
    return border;
}

void expectTheSameSurface(const Ground& ground, size_t triangles) {
    const KeyedTriangles merged = ground.merged();
    EXPECT_EQ(merged.triangles.size(), triangles);
    EXPECT_EQ(areasOf(merged, ground.positions), areasOf(ground.ground, ground.positions));
    EXPECT_EQ(borderOf(merged, ground.positions, true), borderOf(ground.ground, ground.positions, true));
}

TEST(LevelRegions, KeepTheVerticesOfTheirBorderAlone) {
    expectTheSameSurface(Ground(16, level, oneKey), 64 - 2);
    expectTheSameSurface(Ground(16, level, oneKey, false), 64 - 2);
}

TEST(LevelRegions, StraightBordersBetweenThemLoseTheirVertices) {
    const Ground ground(16, level, [](int x, int) { return x < 5 ? 0u : 1u; });
    expectTheSameSurface(ground, (2 * 5 + 16 + 1 - 2) + (2 * 11 + 16 + 1 - 2));
}

TEST(LevelRegions, BentBordersKeepWhatBends) {
    const Ground ground(16, level, [](int x, int z) { return x < (z < 8 ? 5 : 9) ? 0u : 1u; });
    expectTheSameSurface(ground, (5 + 9 + 16 + 3 - 2) + (11 + 7 + 16 + 3 - 2));
}

TEST(LevelRegions, IslandsKeepTheirCorners) {
    const Ground ground(16, level, [](int x, int z) { return x > 3 && x < 8 && z > 4 && z < 10 ? 1u : 0u; });
    expectTheSameSurface(ground, 2 + (64 + 4));
}

TEST(LevelRegions, WhatIsLostIsTakenBackWhereABorderWouldFold) {
    const Ground ground(16, level, [](int x, int z) { return x == 3 && z == 4 ? 1u : 0u; });
    const KeyedTriangles merged = ground.merged(100);
    EXPECT_EQ(areasOf(merged, ground.positions), areasOf(ground.ground, ground.positions));
    EXPECT_EQ(merged.triangles.size(), 2u + (64 + 4));
}

TEST(LevelRegions, OfSeveralHeightsStayApart) {
    // A slope of one row runs between them, whose vertices stay.
    const Ground ground(
        16, [](int x, int) { return x < 9 ? 1.0f : 2.0f; }, oneKey);
    expectTheSameSurface(ground, (2 * 8 + 2 * 16 - 2) + 2 * 16 + (2 * 7 + 2 * 16 - 2));
}

TEST(LevelRegions, LeaveSlopesAlone) {
    const Ground slope(
        16, [](int x, int) { return 0.25f * float(x); }, oneKey);
    const KeyedTriangles merged = slope.merged();
    EXPECT_EQ(merged.triangles, slope.ground.triangles);
    EXPECT_EQ(merged.keys, slope.ground.keys);
}

/// Of the surface over its square, metres.
double meanHeight(const KeyedTriangles& ground, const std::vector<Vec3f>& positions) {
    double volume = 0, area = 0;
    for (const mesh::Triangle& c : ground.triangles) {
        const Vec3d a = positions[c.x].as<double>(), b = positions[c.y].as<double>(), d = positions[c.z].as<double>();
        const double twice = cross(b - a, d - a).y;
        volume += twice * (a.y + b.y + d.y) / 3, area += twice;
    }
    return volume / area;
}

TEST(LevelRegions, GentleSlopesDontCreepIntoARegion) {
    // No triangle of the dome leans by more than the rounding, which its height is twelve times.
    const Ground dome(
        64, [](int x, int z) { return -1.17e-6f * float((x - 32) * (x - 32) + (z - 32) * (z - 32)); }, oneKey);
    EXPECT_NEAR(meanHeight(dome.merged(), dome.positions), meanHeight(dome.ground, dome.positions), rounding_m);
}

TEST(LevelRegions, DontHangOnTheOrderOfTriangles) {
    const auto key = [](int x, int z) { return x * x + z * z < 90 ? 0u : (x + 2 * z > 20 ? 1u : 2u); };
    const Ground ground(16, level, key);
    Ground turned = ground;
    std::reverse(turned.ground.triangles.begin(), turned.ground.triangles.end());
    std::reverse(turned.ground.keys.begin(), turned.ground.keys.end());
    for (const double tolerance : {0.01, 1.0, 3.0})
        EXPECT_EQ(borderOf(ground.merged(tolerance), ground.positions, false),
                  borderOf(turned.merged(tolerance), turned.positions, false));
}

}  // namespace
}  // namespace sgm::tiles
