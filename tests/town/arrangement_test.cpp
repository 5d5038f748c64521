// Random nets against CGAL's exact arrangement.
#include "tests/town/arrangement.h"

#include <gtest/gtest.h>

#include "modeler/core/random.h"
#include "modeler/town/faces.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

RoadParameters drawn(uint64_t seed) {
    const auto draw = [&](uint64_t what, double lo, double hi) { return uniform(combine(seed, what), lo, hi); };
    RoadParameters p;
    p.lo = {-400, -400}, p.hi = {400, 400};
    p.random = seed;
    p.turn = draw(1, 0, .4);
    p.junction = 2 + static_cast<double>(pick(combine(seed, 2), 8));
    p.delay = static_cast<double>(pick(combine(seed, 3), 90));
    p.step_m = draw(4, 40, 90), p.block_m = draw(5, 40, 110);
    p.snap_m = draw(6, 4, 38), p.angle = draw(7, .15, 1);
    p.axis = draw(8, 0, 3);
    p.turns = static_cast<Turns>(pick(combine(seed, 9), 3));
    p.pattern = static_cast<Pattern>(pick(combine(seed, 10), 4));
    p.ends = static_cast<Ends>(pick(combine(seed, 11), 3));
    if (seed % 3 == 0) p.highwayRadius_m = draw(12, 1, 120), p.streetRadius_m = draw(13, 1, 40);
    return p;
}

/// A valley whose field follows its river, rings about the centre and a raster, each by chance.
Land drawnLand(uint64_t seed) {
    Land land = test::valley();
    const auto weight = [&](uint64_t what) { return [w = uniform(combine(seed, what), -.5, 1)](Vec2) { return w; }; };
    land.grid = weight(20), land.rings = weight(21), land.shore = weight(22);
    return land;
}

TEST(RoadNets, AreWhatAnExactArrangementMakesOfThem) {
    size_t edges = 0;
    for (uint64_t seed = 1; seed <= 1200; ++seed) {
        const Land land = seed % 4 ? drawnLand(seed) : Land{};
        const auto graph = growRoads(drawn(seed), land);
        ASSERT_TRUE(graph.ok()) << graph.error().message;
        std::vector<std::array<int32_t, 4>> segments;
        for (const RoadEdge& e : graph->edges())
            segments.push_back({graph->at(e.a).x, graph->at(e.a).z, graph->at(e.b).x, graph->at(e.b).z});
        const test::ArrangementCounts judge = test::arrangementOf(segments);
        EXPECT_EQ(judge.vertices, graph->nodes().size()) << "seed " << seed;
        EXPECT_EQ(judge.edges, graph->edges().size()) << "seed " << seed;
        EXPECT_EQ(judge.boundedFaces, facesOf(*graph).size()) << "seed " << seed;
        edges += segments.size();
    }
    EXPECT_GT(edges, 200'000u);
}

}  // namespace
}  // namespace sgm::town
