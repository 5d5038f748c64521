// The nouns of grammar/std/cave.sgm, each measured on the volume of a cave that has it.
#include "modeler/volume/cave.h"

#include "grammar/lower/lower.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/polygonize.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

struct Surveyed {
    size_t floating = 0;  ///< pieces of the mesh
    double volume_m3 = 0, largest_m3 = 0;
    volume::Cave cave;
};

/// A cave of the standard library with other values for some parameters, cut from its block or `hollow` alone.
Surveyed survey(const std::string& settings, uint64_t seed = 1, float cell_m = 0.4f, bool hollow = false) {
    Surveyed result;
    const auto d = derived(
        "grammar 1\nuse \"std/cave.sgm\" { " + settings + " }\nstart Maze -> " + (hollow ? "Cave" : "Rock") + "\n",
        withSeed(seed));
    const auto model = lower::lower(d, nullptr);
    if (!model.ok()) return ADD_FAILURE() << model.error().message, result;
    const eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
    const mesh::Grid grid = mesh::gridFor((*model)->field.bounds, cell_m);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    const auto mesh = mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
    for (const mesh::ConnectedComponent& piece : mesh::connectedComponents(*mesh, cell_m)) {
        result.floating += piece.floats;
        result.volume_m3 += piece.volume_m3;
        result.largest_m3 = std::max(result.largest_m3, piece.volume_m3);
    }
    const auto level = volume::sample(*blocks, tape, grid, 3, 2, nullptr);
    auto cave = volume::surveyCave(*level, {}, hollow, nullptr);
    if (!cave.ok()) return ADD_FAILURE() << cave.error().message, result;
    result.cave = *cave;
    return result;
}

const std::string branching =
    "cells = 10 ways = (5, 0, 0, 0, 1, 1) sway = either swayed = .4 cubehi = .6 fork = .4 twigs = 4 hall = .2 duct = "
    ".3 ";

TEST(Caves, EverySeedIsOneConnectedVoid) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const Surveyed s = survey(branching, seed, 0.45f, true);
        EXPECT_EQ(s.cave.spaces.size(), 1u) << "seed " << seed;
        EXPECT_GT(s.largest_m3, 0.998 * s.volume_m3)
            << "seed " << seed << ": noise and floors part off specks, no more";
    }
}

TEST(Caves, ShaftsStayOpen) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const Surveyed s = survey("cells = 8 ways = (2, 0, 1, 1, 0, 0) sway = none", seed, 0.45f, true);
        EXPECT_EQ(s.cave.spaces.size(), 1u) << "seed " << seed;
    }
}

const std::string straight =
    "cells = 5 ways = (1, 0, 0, 0, 0, 0) roomlo = 5m roomhi = 7m hall = 0 open = none block = (36, 14, 14) place = "
    "(-11, 0, 0) ";
const std::string line = straight + "sway = y swayed = .2 ";

TEST(Caves, AFlattenedFloorIsFlat) {
    const volume::Cave flat = survey(straight + "sway = none floored = .3", 1, 0.25f).cave,
                       round = survey(straight + "sway = none floored = 0", 1, 0.25f).cave;
    const auto share = [](const volume::Cave& c) {
        return c.floor_m2[0] / (c.floor_m2[0] + c.floor_m2[1] + c.floor_m2[2] + c.floor_m2[3]);
    };
    EXPECT_GT(share(flat), 0.7);
    EXPECT_GT(share(flat), share(round) + 0.2);
    // Level, not only gentle: each chamber's floor lies at one height.
    std::vector<float> heights;
    for (const volume::FloorCell& f : flat.walkable) heights.push_back(f.y_m);
    ASSERT_GT(heights.size(), 500u);
    std::sort(heights.begin(), heights.end());
    EXPECT_LT(heights[heights.size() * 9 / 10] - heights[heights.size() / 10], 1.0f);
}

TEST(Caves, EntrancesAreOpen) {
    EXPECT_TRUE(survey(line).cave.entrances.empty());
    const volume::Cave one = survey(line + "mouths = first gate = 3m").cave,
                       two = survey(line + "mouths = both gate = 3m").cave;
    ASSERT_EQ(one.entrances.size(), 1u);
    EXPECT_EQ(one.entrances[0].face, 1u);  // -x
    EXPECT_GT(one.entrances[0].area_m2, 6);
    EXPECT_GT(one.entrances[0].bottleneck_m, 1);
    ASSERT_EQ(two.entrances.size(), 2u);
    EXPECT_NE(two.entrances[0].face, two.entrances[1].face);
    EXPECT_EQ(two.spaces.size(), 1u);
}

TEST(Caves, DripstoneHangsTogetherWithTheRock) {
    const volume::Cave bare = survey(line).cave;
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const Surveyed hung = survey(line + "drips = 6 hang = .8 stand = .5 stout = .2 pillar = .5", seed, 0.2f);
        EXPECT_EQ(hung.floating, 0u) << "seed " << seed;
        EXPECT_EQ(hung.cave.spaces.size(), 1u);
    }
    // Stalactites come down from the roof, stalagmites up from the floor, columns from one to the other.
    const auto air = [&](const std::string& more) { return survey(line + more, 1, 0.2f).cave.air_m3; };
    const double none = air("");
    EXPECT_LT(air("drips = 6 hang = .8 stand = 0 stout = .2"), none - 1);
    EXPECT_LT(air("drips = 6 hang = 0 stand = .6 stout = .2"), none - 1);
    EXPECT_LT(air("pillar = 1 column = 1.5m"), none - 10);
    EXPECT_GT(bare.air_m3, 100);
}

TEST(Caves, PassagesAreNarrowerThanRooms) {
    const volume::Cave halls = survey(line + "duct = 0").cave, ducts = survey(line + "duct = .6 slim = .45", 3).cave;
    EXPECT_LT(ducts.narrowest_m(), 2);
    EXPECT_GT(ducts.rooms.size(), halls.rooms.size());
}

}  // namespace
}  // namespace sgm
