// The cave report on caves whose figures are known.
#include "modeler/volume/cave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "modeler/field/combine.h"
#include "modeler/mesh/polygonize.h"

namespace sgm::volume {
namespace {

using field::Field;
using field::Graph;

Field box(Graph& g, Vec3f centre, Vec3f half) {
    const field::NodeRef qx = abs(g.x() - centre.x) - half.x, qy = abs(g.y() - centre.y) - half.y,
                         qz = abs(g.z() - centre.z) - half.z;
    return {max(qx, max(qy, qz)), {centre - half, centre + half}, 1, 0.5f};
}

/// A block of rock, the boxes of air cut from it, and its survey.
struct Dig {
    Graph graph;
    Field field;
    mesh::Mesh mesh;
    Cave cave;

    Dig(std::vector<std::pair<Vec3f, Vec3f>> boxes, float cell_m, Agent agent = {}, bool hollow = false,
        Vec3f half = {12, 4, 6}, FloorFilter isFloor = {})
        : isFloor_(std::move(isFloor)) {
        std::vector<field::Owned> parts;
        for (const auto& [centre, size] : boxes) parts.push_back({box(graph, centre, size), 0});
        cut(field::sum(graph, parts), cell_m, agent, hollow, half);
    }
    /// The air that `airIn` makes of a graph, cut from the block.
    Dig(Field (*airIn)(Graph&), float cell_m, Agent agent = {}) { cut(airIn(graph), cell_m, agent, false, {12, 6, 6}); }

private:
    FloorFilter isFloor_;

    void cut(const Field& air, float cell_m, Agent agent, bool hollow, Vec3f half) {
        field = hollow ? air : field::difference({box(graph, {0, 0, 0}, half), 0}, {air, 0});
        survey(cell_m, agent, hollow);
    }

    void survey(float cell_m, Agent agent, bool hollow) {
        const eval::Tape tape = eval::compile(graph, field, graph.constants());
        const mesh::Grid grid = mesh::gridFor(field.bounds, cell_m);
        mesh::Counts counts;
        const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
        ASSERT_TRUE(blocks.ok());
        mesh = *mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
        const auto level = sample(*blocks, tape, grid, 3, 2, nullptr);
        ASSERT_TRUE(level.ok());
        auto result = surveyCave(*level, agent, hollow, nullptr, isFloor_);
        ASSERT_TRUE(result.ok());
        cave = *result;
    }
};

// Three rooms in a row, 4 m wide and 3 m high; the passage between the first two is 2 m wide and 2.4 m high, that
// between the last two .5 m wide.
const std::vector<std::pair<Vec3f, Vec3f>> threeRooms = {{{-8, 0, 0}, {2, 1.5f, 2}},
                                                         {{0, 0, 0}, {2, 1.5f, 2}},
                                                         {{8, 0, 0}, {2, 1.5f, 2}},
                                                         {{-4, -0.3f, 0}, {3, 1.2f, 1}},
                                                         {{4, -0.3f, 0}, {3, 1.2f, 0.25f}}};

TEST(CaveReport, ThreeRoomsAndTwoPassagesOneTooNarrow) {
    for (const float cell : {0.2f, 0.11f}) {
        SCOPED_TRACE(cell);
        const Cave cave = Dig(threeRooms, cell, {.radius_m = 0.5, .height_m = 1.8}).cave;
        EXPECT_EQ(cave.spaces.size(), 1u);
        EXPECT_EQ(cave.pockets, 0u);
        EXPECT_TRUE(cave.entrances.empty());
        ASSERT_EQ(cave.rooms.size(), 3u);
        for (const Room& r : cave.rooms) EXPECT_NEAR(r.radius_m, 1.5, cell);
        ASSERT_EQ(cave.passages.size(), 2u);
        const bool first = cave.passages[0].at.x < 0;
        const Passage &wide = cave.passages[first ? 0 : 1], &narrow = cave.passages[first ? 1 : 0];
        EXPECT_NEAR(wide.radius_m, 1, cell);
        EXPECT_NEAR(narrow.radius_m, 0.25, cell);
        EXPECT_TRUE(wide.passable);
        EXPECT_FALSE(narrow.passable);
        EXPECT_NEAR(narrow.at.x, 4, 2.5);
        EXPECT_LT(cave.rooms[wide.rooms[0]].at.x + cave.rooms[wide.rooms[1]].at.x, 0);
        EXPECT_EQ(cave.narrowest_m(), narrow.radius_m);
        // 3 rooms of 4 · 3 · 4 m, passages of 4 m between them.
        EXPECT_NEAR(cave.air_m3, 144 + 4 * 2.4 * 2 + 4 * 2.4 * 0.5, 144 * cell);
        // All floor is level; that of the passages and rooms is one height.
        EXPECT_NEAR(cave.floor_m2[0], 48 + 8 + 2, 58 * cell);
        EXPECT_LT(cave.floor_m2[1] + cave.floor_m2[2] + cave.floor_m2[3], 0.2);
        EXPECT_NEAR(cave.headroom.least_m, 2.4, cell);
        EXPECT_NEAR(cave.headroom.greatest_m, 3, cell);
        // Two parts: the first two rooms with their passage, and the third. An agent keeps its radius from the walls.
        EXPECT_EQ(cave.walkParts, 2u);
        EXPECT_NEAR(cave.reachable_m2, 9 + 9 + 5 * 1, 5);
        // From corner to corner of the first two rooms: 8 + 3 m along, bent round the passage.
        EXPECT_NEAR(cave.longestWalk_m, 11 + 1, 1.5);
    }
}

/// Fronts from all sides meet in the middle of a ball.
TEST(CaveReport, ABallsRadiusIsGoodToAVoxel) {
    const auto ball = [](Graph& g) {
        return Field{sqrt(g.x() * g.x() + g.y() * g.y() + g.z() * g.z()) - 4.0f, {{-4, -4, -4}, {4, 4, 4}}, 1, 1};
    };
    for (const float cell : {0.31f, 0.16f, 0.08f}) {
        const Cave cave = Dig(ball, cell).cave;
        ASSERT_EQ(cave.rooms.size(), 1u);
        EXPECT_NEAR(cave.rooms[0].radius_m, 4, cell) << cell;
        EXPECT_LE(cave.rooms[0].radius_m + length(cave.rooms[0].at), 4 + 0.25 * static_cast<double>(cell)) << cell;
    }
}

/// A hall 4 m wide under a roof that rises by seven tenths, 1.1 to 3.9 m high; beside walls the agent's ball has no
/// room.
TEST(CaveReport, HeadroomUnderASlantIsMeasuredUpright) {
    const auto hall = [](Graph& g) {
        const Field whole = box(g, {0, 1, 0}, {2, 2.5f, 2});
        return Field{
            max(whole.value, (g.y() - 1.0f + g.x() * 0.7f) * 0.819232f), {{-2, -1.5f, -2}, {2, 3.5f, 2}}, 1, 1};
    };
    for (const float cell : {0.2f, 0.1f}) {
        const auto headroom = Dig(hall, cell, {.radius_m = 0.3, .height_m = 1.8}).cave.headroom;
        EXPECT_NEAR(headroom.greatest_m, 2.5 + 0.7 * 1.7, 0.7 * static_cast<double>(cell)) << cell;
        EXPECT_NEAR(headroom.median_m, 2.5, 0.5 * static_cast<double>(cell)) << cell;
    }
}

TEST(CaveReport, AThinnerAgentPassesEverywhere) {
    const Cave cave = Dig(threeRooms, 0.11f, {.radius_m = 0.2, .height_m = 1.8}).cave;
    EXPECT_TRUE(cave.passages[0].passable && cave.passages[1].passable);
    EXPECT_EQ(cave.walkParts, 1u);
    EXPECT_GT(cave.longestWalk_m, 18);
    EXPECT_GT(cave.longestPath_m, 18);
}

TEST(CaveReport, ATallAgentIsStoppedByALowPassage) {
    const Cave low = Dig(threeRooms, 0.11f, {.radius_m = 0.2, .height_m = 2.7}).cave;
    EXPECT_EQ(low.walkParts, 3u);
    EXPECT_TRUE(low.passages[0].passable) << "a passage is judged by the agent's radius";
}

/// A tunnel through the block, lower than the agent by less than the cells show of clearances.
TEST(CaveReport, FloorUnderARoofLowerThanTheAgentIsntWalkable) {
    const auto walkable = [](float height_m, float cell_m) {
        return Dig({{{0, 0, 0}, {13, height_m / 2, 2}}}, cell_m, {.radius_m = 0.3, .height_m = 1.8}).cave.walkable_m2;
    };
    for (const float cell_m : {0.2f, 0.11f}) {
        for (const float height_m : {1.5f, 1.7f, 1.77f}) EXPECT_EQ(walkable(height_m, cell_m), 0) << height_m;
        for (const float height_m : {1.8f, 1.83f, 2.0f}) EXPECT_GT(walkable(height_m, cell_m), 70) << height_m;
    }
}

TEST(CaveReport, SpacesPocketsAndEntrances) {
    // A room with a tunnel out of the block at +x, a closed room, and a hole too small for the agent.
    const Cave cave = Dig({{{6, 0, 0}, {3, 1.5f, 2}},
                           {{10, -0.5f, 0}, {3, 1, 0.7f}},
                           {{-7, 0, 0}, {2, 1.5f, 2}},
                           {{0, 0, 0}, {0.2f, 0.2f, 0.2f}}},
                          0.12f)
                          .cave;
    ASSERT_EQ(cave.spaces.size(), 2u);
    EXPECT_EQ(cave.pockets, 1u);
    EXPECT_NEAR(cave.spaces[1].volume_m3, 48, 6);
    ASSERT_EQ(cave.entrances.size(), 1u);
    const Entrance& e = cave.entrances[0];
    EXPECT_EQ(e.face, 0u);
    EXPECT_NEAR(e.area_m2, 2 * 1.4, 0.4);
    EXPECT_NEAR(e.at.x, 12, 0.2);
    EXPECT_NEAR(e.at.y, -0.5, 0.1);
    EXPECT_NEAR(e.radius_m, 0.7, 0.12);
    EXPECT_NEAR(e.bottleneck_m, 0.7, 0.12);
    EXPECT_EQ(e.space, 0u);
    EXPECT_EQ(cave.spaces[0].entrances, 1u);
    EXPECT_EQ(cave.spaces[1].entrances, 0u);
    // What can be reached from the entrance leaves the closed room out.
    EXPECT_EQ(cave.walkParts, 2u);
    EXPECT_LT(cave.reachable_m2, cave.walkable_m2 - 8);
}

TEST(CaveReport, TheHollowAloneGivesTheSameFigures) {
    const Agent agent{.radius_m = 0.5, .height_m = 1.8};
    const Cave rock = Dig(threeRooms, 0.12f, agent).cave, hollow = Dig(threeRooms, 0.12f, agent, true).cave;
    EXPECT_NEAR(hollow.air_m3, rock.air_m3, 0.05 * rock.air_m3);
    ASSERT_EQ(hollow.rooms.size(), 3u);
    EXPECT_NEAR(hollow.narrowest_m(), rock.narrowest_m(), 0.12);
    EXPECT_NEAR(hollow.floor_m2[0], rock.floor_m2[0], 3);
    EXPECT_EQ(hollow.walkParts, rock.walkParts);
}

TEST(CaveReport, SlopesAreSortedByTheirAngle) {
    // A ramp of 20° between two walls: a wedge of rock along x in a room 8 m long.
    Dig dig({{{0, 0, 0}, {4, 3, 2}}}, 0.12f);
    Graph& g = dig.graph;
    const double a = radians(20.0);
    const field::NodeRef under =
        (g.y() + 1.0f) * static_cast<float>(std::cos(a)) - g.x() * static_cast<float>(std::sin(a));
    const Field ramp{max(under, max(abs(g.x()) - 4.0f, max(abs(g.z()) - 2.0f, abs(g.y()) - 3.0f))),
                     {{-4, -3, -2}, {4, 3, 2}},
                     1,
                     0.5f};
    const field::Owned parts[] = {{dig.field, 0}, {ramp, 0}};
    const Field whole = field::sum(g, parts);
    const eval::Tape tape = eval::compile(g, whole, g.constants());
    const mesh::Grid grid = mesh::gridFor(whole.bounds, 0.12f);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    const auto level = sample(*blocks, tape, grid, 3, 2, nullptr);
    const Cave cave = *surveyCave(*level, {}, false, nullptr);
    EXPECT_NEAR(cave.floor_m2[1], 32 / std::cos(a), 3);
    EXPECT_LT(cave.floor_m2[0] + cave.floor_m2[2], 3);
    const Cave careful = *surveyCave(*level, {.slope_rad = radians(15.0)}, false, nullptr);
    EXPECT_LT(careful.walkable_m2, 2);
    EXPECT_GT(cave.walkable_m2, 20);
}

TEST(CaveReport, StepsAreClimbedAtAnyResolution) {
    const auto parts = [](float step_m, float cell_m) {
        const float half = (3 - step_m) / 2;
        return Dig({{{-2, 0, 0}, {2.01f, 1.5f, 2}}, {{2, 1.5f - half, 0}, {2, half, 2}}}, cell_m, {}, false, {5, 2, 3})
            .cave.walkParts;
    };
    for (const float cell_m : {0.2f, 0.11f, 0.06f})
        for (const float step_m : {0.1f, 0.25f, 0.4f})
            EXPECT_EQ(parts(step_m, cell_m), 1u) << "a step of " << step_m << " m in cells of " << cell_m;
    for (const float cell_m : {0.11f, 0.06f}) EXPECT_EQ(parts(0.6f, cell_m), 2u) << "too high, in cells of " << cell_m;
}

TEST(CaveReport, TheFloorMeshIsTheWalkableFloor) {
    const Dig dig(threeRooms, 0.12f, {.radius_m = 0.5, .height_m = 1.8});
    const mesh::Mesh floor = walkableFloor(dig.mesh, dig.cave);
    double area = 0;
    std::vector<Vec3f> points;
    for (const mesh::Chunk& c : floor.chunks) {
        ASSERT_EQ(c.firstVertex, points.size());
        ASSERT_EQ(c.origins.size(), c.triangles.size());
        points.insert(points.end(), c.positions.begin(), c.positions.end());
    }
    for (const mesh::Chunk& c : floor.chunks)
        for (const mesh::Triangle& t : c.triangles) {
            const Vec3f n = cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
            EXPECT_GT(n.y, 0);
            area += static_cast<double>(length(n)) / 2;
        }
    EXPECT_NEAR(area, dig.cave.walkable_m2, 0.1 * area);
    for (const Vec3f& p : points) EXPECT_NEAR(p.y, -1.5f, 0.01f);
}

/// Area in m², of a mesh in one chunk; each edge between two triangles is run through once a way.
double areaOfSheet(const mesh::Chunk& c) {
    double area = 0;
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (const mesh::Triangle& t : c.triangles) {
        area += static_cast<double>(
                    length(cross(c.positions[t.y] - c.positions[t.x], c.positions[t.z] - c.positions[t.x]))) /
                2;
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(edges.emplace(t[k], t[(k + 1) % 3]).second);
    }
    return area;
}

TEST(CaveReport, LargeTrianglesOfTheFloorAreCutToWhatIsWalkable) {
    const Dig dig(threeRooms, 0.12f, {.radius_m = 0.5, .height_m = 1.8});
    mesh::Chunk quad;
    for (const Vec3f p : {Vec3f{-12, -1.5f, -6}, {12, -1.5f, -6}, {12, -1.5f, 6}, {-12, -1.5f, 6}})
        quad.positions.push_back(p);
    quad.triangles.push_back({0, 2, 1});
    quad.triangles.push_back({0, 3, 2});
    mesh::Mesh whole;
    whole.chunks.push_back(std::move(quad));
    const mesh::Mesh floor = walkableFloor(whole, dig.cave);
    ASSERT_EQ(floor.chunks.size(), 1u);
    EXPECT_NEAR(areaOfSheet(floor.chunks[0]), dig.cave.walkable_m2, 0.03 * dig.cave.walkable_m2);
    EXPECT_LT(floor.triangleCount(), 4000u);
    for (const mesh::Triangle& t : floor.chunks[0].triangles)
        EXPECT_GT(cross(floor.chunks[0].positions[t.y] - floor.chunks[0].positions[t.x],
                        floor.chunks[0].positions[t.z] - floor.chunks[0].positions[t.x])
                      .y,
                  0);
}

TEST(CaveReport, AnAgentThatCantBeIsRefused) {
    Graph g;
    const Field f = box(g, {0, 0, 0}, {1, 1, 1});
    const eval::Tape tape = eval::compile(g, f, g.constants());
    const mesh::Grid grid = mesh::gridFor(f.bounds, 0.2f);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 1, nullptr, counts);
    const auto level = sample(*blocks, tape, grid, 3, 1, nullptr);
    for (const Agent agent : {Agent{.radius_m = 0}, Agent{.radius_m = 1, .height_m = 1.5}, Agent{.slope_rad = 2}}) {
        const auto cave = surveyCave(*level, agent, false, nullptr);
        ASSERT_FALSE(cave.ok());
        EXPECT_EQ(cave.error().kind, Error::Kind::Usage);
    }
    const auto solid = surveyCave(*level, {}, false, nullptr);
    ASSERT_TRUE(solid.ok());
    EXPECT_TRUE(solid->spaces.empty() && solid->entrances.empty() && solid->walkable.empty());
}

TEST(CaveReport, WhatIsNoFloorIsntWalkedOn) {
    const FloorFilter dry = [](std::span<const Vec3f> places) {
        std::vector<bool> kept;
        for (const Vec3f p : places) kept.push_back(p.x < 0);
        return kept;
    };
    const std::vector<std::pair<Vec3f, Vec3f>> room{{{0, 0, 0}, {4, 1.5f, 3}}};
    const Cave all = Dig(room, 0.2f).cave, half = Dig(room, 0.2f, {}, false, {12, 4, 6}, dry).cave;
    EXPECT_NEAR(all.floor_m2[0], 48, 3);
    EXPECT_NEAR(half.floor_m2[0], 24, 2);
    EXPECT_NEAR(half.walkable_m2 / all.walkable_m2, 0.5, 0.08);
    EXPECT_NEAR(half.air_m3, all.air_m3, 1e-6);
}

}  // namespace
}  // namespace sgm::volume
