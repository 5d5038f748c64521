#include "modeler/tiles/level_squares.h"

#include <gtest/gtest.h>

#include <map>

namespace sgm::tiles {
namespace {

constexpr double pitch_m = 2;

/// A grid of squares of two triangles each, of `side` squares a side, at heights by place.
struct Ground {
    std::vector<Vec3f> positions;
    std::vector<uint32_t> corners;

    template <class Height>
    Ground(int side, Height&& height, bool up = true) {
        for (int z = 0; z <= side; ++z)
            for (int x = 0; x <= side; ++x) positions.push_back({float(pitch_m * x), height(x, z), float(pitch_m * z)});
        const auto at = [&](int x, int z) { return uint32_t(z * (side + 1) + x); };
        for (int z = 0; z < side; ++z)
            for (int x = 0; x < side; ++x)
                for (const auto& t : {std::array{at(x, z), at(x, z + 1), at(x + 1, z)},
                                      std::array{at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)}})
                    corners.insert(corners.end(), {t[0], up ? t[1] : t[2], up ? t[2] : t[1]});
    }
    std::vector<uint32_t> merged() const { return mergedSquares(corners, positions, {0, 0, 0}, pitch_m); }
};

/// Twice the sum of the triangles' oriented areas.
Vec3d areaOf(const std::vector<uint32_t>& corners, const std::vector<Vec3f>& positions) {
    Vec3d sum{};
    for (size_t t = 0; t < corners.size(); t += 3) {
        const Vec3d a = positions[corners[t]].as<double>();
        sum += cross(positions[corners[t + 1]].as<double>() - a, positions[corners[t + 2]].as<double>() - a);
    }
    return sum;
}

/// Edges with triangles on one side alone.
std::map<std::pair<uint32_t, uint32_t>, int> borderOf(const std::vector<uint32_t>& corners) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t t = 0; t < corners.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = corners[t + k], b = corners[t + (k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    std::erase_if(edges, [](const auto& edge) { return edge.second == 0; });
    return edges;
}

void expectTheSameSurface(const Ground& ground, size_t triangles) {
    const auto merged = ground.merged();
    EXPECT_EQ(merged.size() / 3, triangles);
    EXPECT_EQ(areaOf(merged, ground.positions), areaOf(ground.corners, ground.positions));
    EXPECT_EQ(borderOf(merged), borderOf(ground.corners));
}

TEST(LevelSquares, BecomeFansThatKeepTheirSides) {
    expectTheSameSurface(Ground(16, [](int, int) { return 1.0f; }), 64);
    expectTheSameSurface(Ground(
                             16, [](int, int) { return 1.0f; }, false),
                         64);
    expectTheSameSurface(Ground(24, [](int, int) { return 1.0f; }), 64 + 5 * 32);
}

TEST(LevelSquares, AreHalvedWhereTheGroundIsNotLevel) {
    // One corner is raised: four squares of the grid lean, in one square of eight a side.
    expectTheSameSurface(Ground(16, [](int x, int z) { return x == 2 && z == 2 ? 1.5f : 1.0f; }), 3 * 32 + 3 * 16 + 32);
}

TEST(LevelSquares, OfSeveralHeightsStayApart) {
    expectTheSameSurface(Ground(16, [](int x, int) { return x < 9 ? 1.0f : 2.0f; }),
                         2 * 32 + 2 * 2 * 8 + 4 * 16 + 2 * 3 * 16);
}

TEST(LevelSquares, LeaveSlopesAlone) {
    const Ground slope(16, [](int x, int) { return 0.25f * float(x); });
    EXPECT_EQ(slope.merged(), slope.corners);
}

TEST(LevelSquares, LeaveAloneWhatIsNotOnTheGrid) {
    Ground moved(16, [](int, int) { return 1.0f; });
    for (Vec3f& p : moved.positions) p.x += 0.5f;
    EXPECT_EQ(moved.merged(), moved.corners);
}

}  // namespace
}  // namespace sgm::tiles
