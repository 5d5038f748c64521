#include "modeler/town/own_streets.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "modeler/core/random.h"
#include "modeler/town/faces.h"
#include "tests/town/arrangement.h"
#include "tests/town/maps.h"

namespace sgm::town {
namespace {

std::string lineOf(const std::string& coordinates, const std::string& properties = "") {
    return "{\"type\":\"Feature\",\"properties\":{" + properties +
           "},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[" + coordinates + "]}}";
}
std::string fileOf(const std::string& features) {
    return "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:25832\"}},"
           "\"features\":[" +
           features + "]}";
}

RoadParameters around(double half_m) {
    RoadParameters p;
    p.lo = {-half_m, -half_m}, p.hi = {half_m, half_m};
    p.ends = Ends::Keep;
    return p;
}

TEST(OwnStreets, AreReadWithTheirClasses) {
    const auto streets = readStreetsBytes(fileOf(
        lineOf("[0,0],[100,50]", "\"highway\":\"primary\"") + "," + lineOf("[0,0],[9,9]", "\"highway\":\"footway\"") +
        "," + lineOf("[0,0],[0,80]", "\"highway\":\"residential\",\"bridge\":\"yes\"") + "," +
        lineOf("[0,0],[0,-80]", "\"class\":\"highway\",\"bridge\":\"no\",\"lanes\":3") + "," +
        "{\"type\":\"Feature\",\"properties\":null,\"geometry\":{\"type\":\"MultiLineString\",\"coordinates\":[[[1,1],"
        "[2,2]],[[3,3],[4,4]]]}}," +
        "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"Point\",\"coordinates\":[1,1]}}"));
    ASSERT_TRUE(streets.ok()) << streets.error().message;
    ASSERT_EQ(streets->list.size(), 5u);
    EXPECT_FALSE(streets->fromDegrees);
    EXPECT_EQ(streets->list[0].kind, RoadClass::Highway);
    EXPECT_EQ(streets->list[0].line[1], (Vec2{100, -50}));  // north is -z
    EXPECT_EQ(streets->list[1].kind, RoadClass::Street);
    EXPECT_TRUE(streets->list[1].bridge);
    EXPECT_EQ(streets->list[2].kind, RoadClass::Highway);
    EXPECT_FALSE(streets->list[2].bridge);
}

TEST(OwnStreets, InDegreesLieInMetresAboutTheirMiddle) {
    const auto streets = readStreetsBytes(lineOf("[11.50,48.10],[11.52,48.10],[11.52,48.12]"));
    ASSERT_TRUE(streets.ok());
    EXPECT_TRUE(streets->fromDegrees);
    EXPECT_NEAR(streets->box.size().x, 1489, 3);
    EXPECT_NEAR(streets->box.size().z, 2224, 3);
    EXPECT_NEAR(length(streets->box.centre()), 0, 1e-6);
}

TEST(OwnStreets, SayWhatIsWrongWithAFile) {
    const auto error = [](const std::string& bytes) {
        const auto read = readStreetsBytes(bytes);
        return read.ok() ? std::string() : read.error().message;
    };
    EXPECT_NE(error("[").find("line 1: this is no JSON"), std::string::npos);
    EXPECT_NE(error("{}").find("it has no lines"), std::string::npos);
    EXPECT_NE(error(fileOf(lineOf("[0,0],[1,1]") + "," + lineOf("[0,0]"))).find("feature 2: a line has fewer than two"),
              std::string::npos);
    EXPECT_NE(error(fileOf(lineOf("[0,0],[1,\"x\"]"))).find("feature 1: position 2 of a line is not a list of two"),
              std::string::npos);
    EXPECT_NE(error(fileOf(lineOf("[0,0],[1,1]", "\"class\":\"road\"")))
                  .find("feature 1: its class is \"road\": write \"highway\" or \"street\""),
              std::string::npos);
    EXPECT_NE(error(fileOf(lineOf("[0,0],[1,1]", "\"class\":3"))).find("its class is no text"), std::string::npos);
    EXPECT_NE(error(fileOf(lineOf("[0,0],[1,1]", "\"highway\":\"path\""))).find("ways for walkers"), std::string::npos);
    EXPECT_NE(error("{\"type\":\"LineString\",\"coordinates\":[[0,0],[1e400,0]]}").find("number is too large"),
              std::string::npos);
    EXPECT_NE(error(std::string(100, '[')).find("nest deeper"), std::string::npos);
    // Metres about 0 that a file doesn't call so.
    EXPECT_NE(error(lineOf("[-120,10],[120,15]")).find("read as longitude and latitude, which makes"),
              std::string::npos);
    // Any one byte changed: read or refused, never a crash.
    const std::string good = fileOf(lineOf("[0,0],[100,50]", "\"highway\":\"primary\",\"bridge\":true"));
    for (size_t i = 0; i < good.size(); ++i)
        for (const int change : {1, 4, 32, 128}) {
            std::string bad = good;
            bad[i] = static_cast<char>(bad[i] ^ change);
            (void)readStreetsBytes(bad);
        }
}

TEST(OwnStreets, MeetWhereTheyCross) {
    OwnStreets own;
    own.list = {{{{-200, 0}, {200, 0}}, RoadClass::Highway, false},
                {{{0, -200}, {0, 200}}, RoadClass::Street, false},
                {{{-200, 0}, {200, 0}}, RoadClass::Street, false},      // the first one again
                {{{-300, 100}, {900, 100}}, RoadClass::Street, false},  // reaches out of the area
                {{{10, 200.4}, {0, 199.6}}, RoadClass::Street, false}};
    RoadGraph graph;
    OwnStreetsReport report;
    RoadParameters p = around(400);
    p.block_m = 1000;
    layStreets(graph, own, p, {}, report);
    graph.compact();
    EXPECT_EQ(report.refused, 0u);
    double whole = 0;
    size_t crossings = 0;
    for (const RoadEdge& e : graph.edges()) {
        EXPECT_TRUE(e.own);
        whole += length(graph.metresAt(e.b) - graph.metresAt(e.a));
    }
    for (uint32_t n = 0; n < graph.nodes().size(); ++n) crossings += graph.degree(n) == 4;
    EXPECT_NEAR(whole, 400 + 400 + 700 + 10, 1);
    EXPECT_EQ(crossings, 2u);
    for (const RoadNode& n : graph.nodes()) EXPECT_LE(n.at.x, 400'000);
}

TEST(OwnStreets, AreTheStartOfTheNet) {
    OwnStreets own;
    own.list = {{{{-250, -180}, {-60, -120}, {120, -160}, {260, -60}}, RoadClass::Highway, false},
                {{{-60, -120}, {-80, 20}}, RoadClass::Street, false}};
    Land land = test::valley();
    land.streets = &own;
    RoadParameters p = around(500);
    p.ends = Ends::Prune;
    OwnStreetsReport report;
    const auto graph = growRoads(p, land, nullptr, &report);
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    EXPECT_GT(report.laid, 6u);
    EXPECT_EQ(report.refused, 0u);
    EXPECT_EQ(report.apart, 0u);
    double kept = 0;
    size_t grown = 0, open = 0;
    for (const RoadEdge& e : graph->edges()) {
        if (e.own) kept += length(graph->metresAt(e.b) - graph->metresAt(e.a));
        grown += !e.own;
    }
    for (uint32_t n = 0; n < graph->nodes().size(); ++n)
        open += graph->degree(n) == 1 && !graph->edge(graph->nodes()[n].edges[0]).own;
    EXPECT_NEAR(kept, 199.2 + 184.4 + 172 + 141.4, 2);
    EXPECT_GT(grown, 100u);
    EXPECT_EQ(open, 0u);
    land.streets = nullptr;
    const auto without = growRoads(p, land);
    ASSERT_TRUE(without.ok());
    EXPECT_NE(without->edges().size(), graph->edges().size());
}

TEST(OwnStreets, OverWaterAreBridges) {
    OwnStreets own;
    own.list = {{{{0, -300}, {0, 300}}, RoadClass::Street, false}};
    Land land;
    land.water = [](Vec2 q) { return std::abs(q.z) < 40; };
    RoadGraph graph;
    OwnStreetsReport report;
    layStreets(graph, own, around(500), land, report);
    size_t wet = 0;
    for (const RoadEdge& e : graph.edges()) {
        const double a = graph.metresAt(e.a).z, b = graph.metresAt(e.b).z;
        wet += e.bridge;
        EXPECT_EQ(e.bridge, std::min(std::abs(a), std::abs(b)) < 40 || a * b < 0) << a << " to " << b;
    }
    EXPECT_GE(wet, 1u);
    EXPECT_LT(wet, graph.edges().size());
}

TEST(OwnStreets, OfAnyKindMakeAPlanarGraph) {
    size_t edges = 0, refused = 0;
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        OwnStreets own;
        for (uint64_t i = 0; i < 14; ++i) {
            OwnStreet& street = own.list.emplace_back();
            street.kind = i % 3 ? RoadClass::Street : RoadClass::Highway;
            const auto draw = [&](uint64_t k) { return uniform(combine(combine(seed, i), k), -260, 260); };
            // Some on whole metres of a coarse lattice: shared points, collinear pieces and repetitions.
            const double grid = i % 2 ? 40 : 1e-3;
            const uint64_t points = 2 + pick(combine(seed, i), 4);
            for (uint64_t k = 0; k < points; ++k)
                street.line.push_back(
                    {std::round(draw(2 * k) / grid) * grid, std::round(draw(2 * k + 1) / grid) * grid});
        }
        Land land = seed % 2 ? test::valley() : Land{};
        land.streets = &own;
        RoadParameters p = around(240);
        p.random = seed;
        p.ends = static_cast<Ends>(seed % 3);
        p.block_m = 60;
        OwnStreetsReport report;
        const auto graph = growRoads(p, land, nullptr, &report);
        ASSERT_TRUE(graph.ok()) << graph.error().message;
        std::vector<std::array<int32_t, 4>> segments;
        for (const RoadEdge& e : graph->edges())
            segments.push_back({graph->at(e.a).x, graph->at(e.a).z, graph->at(e.b).x, graph->at(e.b).z});
        const test::ArrangementCounts judge = test::arrangementOf(segments);
        EXPECT_EQ(judge.vertices, graph->nodes().size()) << "seed " << seed;
        EXPECT_EQ(judge.edges, graph->edges().size()) << "seed " << seed;
        EXPECT_EQ(judge.boundedFaces, facesOf(*graph).size()) << "seed " << seed;
        edges += segments.size(), refused += report.refused;
    }
    EXPECT_GT(edges, 10'000u);
    EXPECT_LT(refused, edges / 100);
}

}  // namespace
}  // namespace sgm::town
