// faces: plates and core of a block.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "modeler/core/random.h"
#include "modeler/plan/edge_words.h"
#include "tests/lower/lowered.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::Shape;

/// Area times height of the solids of each label.
std::map<std::string, double> volumesOf(const Derivation& d) {
    std::map<std::string, double> volumes;
    for (const Shape& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        const Vec3d size = s.scope.size;
        const double area_m2 = s.scope.footprint == derive::none
                                   ? size.x * size.z
                                   : area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
        volumes[d.tree.labels[s.label]] += area_m2 * size.y;
    }
    return volumes;
}

std::string block(const std::string& plan, const std::string& faces) {
    return "grammar 1\nterminal front, wall, deck, ground, core\nstart A -> footprint " + plan +
           " extrude 4m Mass\nrule Mass -> " + faces + "\n";
}

TEST(Faces, PlatesAndCoreSumToTheBlock) {
    for (const auto& [plan, area_m2] :
         std::initializer_list<std::pair<const char*, double>>{{"rect(10, 6)", 60},
                                                               {"ell(16, 12, 6, 5)", 126},
                                                               {"ring(20, 16, 5)", 320 - 60},
                                                               {"ngon(6, 5m)", 64.9519052838}}) {
        const auto volumes =
            volumesOf(derived(block(plan, "faces .4m { side: wall | top: deck | bottom: ground | rest: core }")));
        double sum = 0;
        for (const auto& [label, volume] : volumes) sum += volume;
        EXPECT_EQ(volumes.size(), 4u) << plan;
        EXPECT_NEAR(sum, area_m2 * 4, 4e-3 * area_m2) << plan;
    }
}

TEST(Faces, PlatesFillTheBlockWithoutOverlap) {
    const Lowered whole(block("ell(16, 12, 6, 5)", "wall")),
        parts(block("ell(16, 12, 6, 5)", "faces .4m { side: wall | rest: core }"));
    for (uint64_t i = 0; i < 3000; ++i) {
        const Vec3f p{static_cast<float>(uniform(combine(1, i), -9, 9)), 1,
                      static_cast<float>(uniform(combine(2, i), -7, 7))};
        const float a = whole.value(p), b = parts.value(p);
        if (std::abs(a) < 1e-3f || std::abs(b) < 1e-3f) continue;
        EXPECT_EQ(a < 0, b < 0) << p.x << ' ' << p.z;
    }
}

/// At concave corners plates reach beyond their scopes: the last part of a split has that too, however lengths add up.
TEST(Faces, PartsOfSplitPlatesSumToThem) {
    const auto volumeOf = [](const std::string& wall) {
        return volumesOf(derived("grammar 1\nterminal wall\nstart A -> footprint ell(18, 14, 7, 6) extrude 4m Mass\n"
                                 "rule Mass -> faces .4m { side: Side | rest: nil }\nrule Side -> " +
                                 wall + "\n"))
            .at("wall");
    };
    const double whole_m3 = volumeOf("wall");
    for (const char* split :
         {"split x { ~.7: wall | { ~2.4m: wall }* | ~.7: wall }", "split x { ~.7: wall | { ~2.4m: wall }* }",
          "split x { 1m: wall | { ~2m: wall }* }", "split x { { ~1.1m: wall }* | ~.3: wall }",
          "split x { ~1: wall | ~.1: wall | ~.7: wall }"})
        EXPECT_NEAR(volumeOf(split), whole_m3, 1e-3) << split;
}

TEST(Faces, TheFirstWordThatFitsAnEdgeWins) {
    const auto volumes =
        volumesOf(derived(block("rect(10, 6)", "faces .5m { front: front | side: wall | rest: nil }")));
    EXPECT_NEAR(volumes.at("front"), (10 + 9) / 2. * .5 * 4, 1e-2) << "a trapezoid along the front";
    EXPECT_NEAR(volumes.at("wall"), ((10 + 9) / 2. + 2 * (6 + 5) / 2.) * .5 * 4, 1e-2);
    EXPECT_FALSE(volumes.contains("core"));
}

TEST(Faces, WhereNoPlateStandsTheCoreGoesToTheEdge) {
    const auto volumes = volumesOf(derived(block("rect(10, 6)", "faces .5m { front: front | rest: core }")));
    EXPECT_NEAR(volumes.at("front"), (10 + 9) / 2. * .5 * 4, 1e-2);
    EXPECT_NEAR(volumes.at("core"), 10 * 6 * 4 - (10 + 9) / 2. * .5 * 4, 1e-2);
}

TEST(Faces, SmoothSidesAreOneFace) {
    const Derivation d =
        derived(block("arc(20m, 32m, 20deg, 160deg, 24)",
                      "faces .5m smooth 20deg { outer: front | inner: wall | side: ground | rest: core }"));
    std::map<std::string, int> count;
    for (const Shape& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        ++count[d.tree.labels[s.label]];
        if (d.tree.labels[s.label] != "front") continue;
        const plan::Footprint face = d.tree.footprints.inMetres(s.scope.footprint, s.scope.half());
        double outer_m = 0;
        for (const plan::PlacedEdge& edge : plan::edgesOf(face)) {
            if (plan::isEdgeCalled(face, edge, "outer")) outer_m += edge.length();
        }
        EXPECT_NEAR(outer_m, 24 * 2 * 32 * std::sin(140. / 24 / 2 * std::numbers::pi / 180), 1e-3);
        EXPECT_NEAR(s.scope.size.x, 2 * 32 * std::cos(20 * std::numbers::pi / 180), 1e-3) << "along the chord";
    }
    EXPECT_EQ(count, (std::map<std::string, int>{{"front", 1}, {"wall", 1}, {"ground", 2}, {"core", 1}}));
}

TEST(Faces, SmoothSidesAllAroundAreARing) {
    const Derivation d = derived(block("ngon(24, 10m)", "faces .5m smooth 20deg { side: wall | rest: core }"));
    const auto volumes = volumesOf(d);
    EXPECT_EQ(std::count_if(d.tree.shapes.begin(), d.tree.shapes.end(),
                            [](const Shape& s) { return s.solid != derive::none; }),
              2);
    const double area_m2 = 12 * 100 * std::sin(2 * std::numbers::pi / 24);
    EXPECT_NEAR(volumes.at("wall") + volumes.at("core"), area_m2 * 4, .2);
    const double inner_m = 10 * std::cos(std::numbers::pi / 24) - .5;  // from the middle to a side of the core
    const double core_m2 = 24 * inner_m * inner_m * std::tan(std::numbers::pi / 24);
    EXPECT_NEAR(volumes.at("wall"), (area_m2 - core_m2) * 4, .2);
}

TEST(Faces, CornersAndOtherPartsEndASmoothFace) {
    // Sides bend by 60 degrees.
    const auto pieces = [](const std::string& faces) {
        const Derivation d = derived(block("ngon(6, 5m)", faces));
        return std::count_if(d.tree.shapes.begin(), d.tree.shapes.end(),
                             [](const Shape& s) { return s.solid != derive::none; });
    };
    EXPECT_EQ(pieces("faces .3m smooth 59deg { side: wall | rest: nil }"), 6);
    EXPECT_EQ(pieces("faces .3m smooth 61deg { side: wall | rest: nil }"), 1);
    EXPECT_EQ(pieces("faces .3m smooth 61deg { front: front | side: wall | rest: nil }"), 2);
}

TEST(Faces, BaysFollowASmoothFace) {
    const Derivation d = derived(
        block("ngon(48, 10m)", "faces .5m smooth 20deg { side: split along outer { { ~3m: wall }* } | rest: nil }"));
    int bays = 0;
    for (const Shape& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        ++bays;
        const Vec3d out = s.scope.axes * Vec3d{0, 0, 1}, to = s.scope.centre;
        EXPECT_GT(out.x * to.x + out.z * to.z, .999 * std::hypot(to.x, to.z)) << "z looks outward";
        EXPECT_NEAR(s.scope.size.x, 3, .1);
    }
    EXPECT_EQ(bays, 21);
}

TEST(Faces, BaysStandOnSidesThatNoCurveJoinsToo) {
    // The flat ends of a stretched circle bend by less than 25 degrees, its tight ends by more.
    const Derivation d = derived(
        "grammar 2\nterminal wall\nstart T -> size (40, 6, 20) footprint round(16) Ring\n"
        "rule Ring -> faces .5m smooth 25deg { side: split along outer { { ~2m: wall }* } | rest: nil }\n");
    EXPECT_TRUE(derive::warnings(d).all().empty());
    double length_m = 0;
    for (const Shape& s : d.tree.shapes)
        if (s.solid != derive::none) length_m += s.scope.size.x;
    EXPECT_NEAR(length_m, 97, 3) << "all around the ellipse";
}

TEST(Faces, APlateLooksOutwardAndCanBeSplit) {
    const Derivation d =
        derived(block("rect(10, 6)", "faces .5m { left: split x { 2m: front | ~1: wall } | rest: nil }"));
    for (const Shape& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        expectNear(s.scope.axes.z, {-1, 0, 0});  // outward
        expectNear(s.scope.axes.x, {0, 0, 1});   // left to right, seen from outside
        if (d.tree.labels[s.label] == "front") {
            EXPECT_NEAR(s.scope.centre.z, -3 + 1, 1e-9);
        }
    }
}

TEST(Faces, EdgesOfACourtAreCalledSo) {
    const auto volumes =
        volumesOf(derived(block("rect(20, 16) court 5m", "faces .5m { court: front | side: wall | rest: core }")));
    EXPECT_GT(volumes.at("wall"), volumes.at("front"));
    EXPECT_NEAR(volumes.at("front"), ((10.5) * 2 + 6.5 * 2) * .5 * 4, .1);
}

TEST(Faces, SharedSidesAreThoseThatAnotherShapeStandsBefore) {
    const auto count = [](const Derivation& d, const std::string& label) {
        return std::count_if(d.tree.shapes.begin(), d.tree.shapes.end(), [&](const Shape& s) {
            return s.solid != derive::none && d.tree.labels[s.label] == label;
        });
    };
    const std::string house =
        "rule House -> faces .3m { shared: party | front: street | side: wall | rest: nil }\n"
        "terminal party, street, wall, shed\n";
    const Derivation row =
        derived("grammar 1\n" + house + "start A -> size (18m, 6m, 9m) split x { { ~6m: House }* }\n");
    EXPECT_EQ(count(row, "party"), 4) << "two of the middle house, one of either end";
    EXPECT_EQ(count(row, "street"), 3);
    EXPECT_EQ(count(row, "wall"), 5);
    const Derivation alone = derived("grammar 1\n" + house + "start A -> size (6m, 6m, 9m) House\n");
    EXPECT_EQ(count(alone, "party"), 0);
    const std::string beside = "start A -> size (6m, 6m, 9m) House + shed size (2m, 100%, ";
    EXPECT_EQ(count(derived("grammar 1\n" + house + beside + "2m) at +x\n"), "party"), 0) << "most of it is free";
    EXPECT_EQ(count(derived("grammar 1\n" + house + beside + "7m) at +x\n"), "party"), 1);
}

TEST(Faces, ACoreThatGoesUnsaidIsTold) {
    const auto told = [](const std::string& parts) {
        return warningsOf(derived(block("rect(10, 6)", "faces .4m { " + parts + " }")), true);
    };
    EXPECT_EQ(told("front: front"),
              "4:14 no part for back, right, left, nor for rest: all goes but the parts that are written; write 'rest: "
              "nil' if that is meant, or give 'rest' a shape of its own, which reaches to the sides without a part\n");
    EXPECT_NE(told("top: deck"), "");
    for (const char* parts : {"front: front | rest: nil", "front: front | rest: core", "side: wall",
                              "front: front | back: wall | left: wall | right: wall"})
        EXPECT_EQ(told(parts), "") << parts;
}

TEST(Faces, MessagesNameTheirPlace) {
    syntax::Diagnostics diagnostics;
    const auto source = std::make_shared<const syntax::Source>(
        "f.sgm", "grammar 1\nterminal wall\nstart A -> faces 0m { 2m: wall | side: + wall }\n");
    EXPECT_FALSE(rules::load(source, operations::table(), {}, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 3u);
    EXPECT_EQ(diagnostics.all()[0].message, "the plates of 'faces' are thicker than 0");
    EXPECT_EQ(diagnostics.all()[1].message, "a part of 'faces' begins with a word for its edges");
    EXPECT_EQ(diagnostics.all()[2].message, "a part begins with a shape: nothing stands in it yet that could grow");
}

}  // namespace
}  // namespace sgm::testing_
