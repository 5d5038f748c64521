// Maps, network and lots: what a town's grammar makes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/operations/town_grammars.h"

namespace sgm::testing_ {
namespace {

TEST(Network, PutsABodyInEveryPart) {
    const Derivation d = derived(head + start +
                                 "ground: lawn | highway: asphalt | street: asphalt | crossing: asphalt | bridge: deck "
                                 "| water: sea | park: grove | block: wall }\n");
    const auto solids = solidsOf(d);
    const auto layers = layersOf(d);
    ASSERT_GT(layers.at("block"), 12u);
    EXPECT_EQ(solids.at("wall").size(), layers.at("block"));
    EXPECT_EQ(solids.at("asphalt").size(), layers.at("highway") + layers.at("street") + layers.at("crossing"));
    EXPECT_EQ(solids.at("deck").size(), layers.at("bridge"));
    EXPECT_EQ(solids.at("sea").size(), 1u);
    EXPECT_NEAR(areaOf(d, solids.at("grove")[0]), 3.14159 * 2500, 150);
    EXPECT_EQ(areaOf(d, solids.at("lawn")[0]), 250000);
    double whole = 0, drawn = 0;
    for (const Shape& s : solids.at("wall")) whole += areaOf(d, s);
    for (const auto& f : d.plan.features)
        if (f.layer == "block") drawn += area(f.area);
    EXPECT_NEAR(whole, drawn, .5);
    // A stretch of street lies along its z.
    for (const Shape& s : solids.at("asphalt")) EXPECT_LT(s.scope.size.x, 60);
}

TEST(Network, PartsThatAreNotNamedStayEmpty) {
    const Derivation d = derived(head + start + "block: nil }\n");
    EXPECT_TRUE(solidsOf(d).empty());
    EXPECT_GT(d.plan.features.size(), 50u);
}

TEST(Network, RoadsEndAtTheBorderOfTheScope) {
    const Derivation d = derived(
        "grammar 2\nroads Net { block = 60m  step = 60m  highway = 14m  street = 9m }\nterminal asphalt\n"
        "start Town -> size (246, 10, 246) network Net { highway: asphalt | street: asphalt | crossing: asphalt }\n");
    double farthest = 0;
    for (const auto& f : d.plan.features)
        if (f.layer == "highway" || f.layer == "street" || f.layer == "crossing")
            for (const auto& polygon : f.area.polygons)
                for (const plan::Vec2 p : polygon.outer.points)
                    farthest = std::max({farthest, std::abs(p.x), std::abs(p.z)});
    EXPECT_NEAR(farthest, 123, 1e-6) << "they come to it, and no further";
}

TEST(Network, ThePlanAloneIsThatOfTheWholeTown) {
    const std::string text = head + start +
                             "ground: lawn | highway: asphalt | street: asphalt | water: sea | park: grove | block: "
                             "Block }\nrule Block -> lots box(300) { lot: setback 2m wall | inner: yard }\n";
    const Derivation whole = derived(text);
    derive::Options options;
    options.planAlone = true;
    const Derivation alone = derived(text, options);
    ASSERT_EQ(alone.plan.features.size(), whole.plan.features.size());
    for (size_t i = 0; i < alone.plan.features.size(); ++i) {
        const auto &a = alone.plan.features[i], &b = whole.plan.features[i];
        EXPECT_EQ(a.layer, b.layer);
        EXPECT_EQ(a.key, b.key);
        EXPECT_TRUE(a.area == b.area);
    }
    EXPECT_TRUE(solidsOf(alone).empty()) << "nothing stands on it";
    EXPECT_GT(solidsOf(whole).at("wall").size(), 100u);
}

TEST(Lots, StandAlongTheirStreets) {
    const Derivation d =
        derived(head + start + "block: lots box(300, front: 8m) { lot: wall | corner: asphalt | inner: yard } }\n");
    const auto solids = solidsOf(d);
    const auto layers = layersOf(d);
    EXPECT_EQ(solids.at("wall").size(), layers.at("lot"));
    EXPECT_EQ(solids.at("asphalt").size(), layers.at("corner"));
    EXPECT_GT(layers.at("lot") + layers.at("corner"), 100u);
    size_t facing = 0;
    for (const Shape& s : solids.at("wall")) {
        const plan::Footprint f = d.tree.footprints.inMetres(s.scope.footprint, s.scope.half());
        double front = 0;
        for (const plan::PlacedEdge& e : plan::edgesOf(f))
            if (f.tags[e.edge.tag].starts_with("street") && e.normal().z > .9) front += e.length();
        facing += front > 6;
    }
    EXPECT_GT(facing, solids.at("wall").size() * 95 / 100);
}

TEST(Lots, OfSquareBlocksHaveTheirStreets) {
    std::string raster = head;
    raster.replace(raster.find("highway = "), 0, "pattern = raster  axis = 0deg  ");
    const Derivation d = derived(raster + start + "block: lots 300 { lot: wall | inner: yard } }\n");
    const auto solids = solidsOf(d);
    double built = 0, behind = 0;
    for (const Shape& s : solids.at("wall")) built += areaOf(d, s);
    if (solids.contains("yard"))
        for (const Shape& s : solids.at("yard")) behind += areaOf(d, s);
    EXPECT_LT(behind, .1 * built);
}

TEST(Lots, TakeSetbacksBySide) {
    const Derivation d = derived(
        head + start + "block: lots 300 { lot: Lot } }\nrule Lot -> setback edges(street: 4m, rest: 1m) wall\n");
    const auto solids = solidsOf(d);
    double built = 0, lots = 0;
    for (const Shape& s : solids.at("wall")) built += areaOf(d, s);
    for (const auto& f : d.plan.features)
        if (f.layer == "lot" || f.layer == "corner") lots += area(f.area);
    EXPECT_LT(built, .8 * lots);
    EXPECT_GT(built, .4 * lots);
}

TEST(Lots, RulesReadMapsAndAreasWhereTheyStand) {
    const Derivation d = derived(head + start +
                                 "block: lots 300 { lot: Lot | corner: Lot } }\n"
                                 "rule Lot when people > .6 -> extrude (5m + 40m * people) wall\n"
                                 "rule Lot when scope.area > 300 -> lawn\nrule Lot -> yard\n");
    const auto solids = solidsOf(d);
    for (const Shape& s : solids.at("wall")) {
        const double x = s.scope.centre.x + 40, z = s.scope.centre.z + 30;
        const double t = 1 - (x * x + z * z) / 160000, people = t * t;
        EXPECT_GT(people, .6);
        EXPECT_NEAR(s.scope.size.y, 5 + 40 * people, 1e-9);
    }
    for (const Shape& s : solids.at("lawn")) EXPECT_GT(areaOf(d, s), 300);
    for (const Shape& s : solids.at("yard")) EXPECT_LE(areaOf(d, s), 300 + 1e-6);
    EXPECT_GT(solids.at("wall").size(), 10u);
}

TEST(Lots, AreTheSameEverywhereButAtTheRuleThatChanged) {
    const std::string body = "block: lots 300 { lot: Lot | corner: Lot } }\nrule Lot -> extrude 5m..20m wall\n";
    const Derivation a = derived(head + start + body), b = derived(head + start + body);
    ASSERT_EQ(a.tree.shapes.size(), b.tree.shapes.size());
    for (size_t i = 0; i < a.tree.shapes.size(); ++i) EXPECT_EQ(a.tree.shapes[i].scope, b.tree.shapes[i].scope);
    const Derivation other = derived(head + start + body, withSeed(2));
    EXPECT_NE(a.plan.features.size(), other.plan.features.size());
    // A body of another part takes nothing away from the draws of the lots.
    const Derivation c = derived(head + start + "street: asphalt | " + body);
    std::multiset<double> heights, again;
    const auto solidsOfA = solidsOf(a), solidsOfC = solidsOf(c);
    for (const Shape& s : solidsOfA.at("wall")) heights.insert(s.scope.size.y);
    for (const Shape& s : solidsOfC.at("wall")) again.insert(s.scope.size.y);
    EXPECT_EQ(heights, again);
}

TEST(Network, SaysWhyNothingGrows) {
    const auto error = [](const std::string& text) {
        const auto d =
            tryDerive("grammar 1\nterminal wall\n" + text + "start A -> size 400 network Net { block: wall }\n");
        return d.ok() ? std::string() : d.error().message;
    };
    EXPECT_NE(error("roads Net { water = true }\n").find("all of the scope is water or park"), std::string::npos);
    EXPECT_NE(error("roads Net { from = (900m, 0m) }\n").find("no road can begin at (900, 0)"), std::string::npos);
    EXPECT_NE(error("roads Net { limit = 20 }\n").find("more than 20 pieces"), std::string::npos);
    derive::Options wide;
    wide.params = {rules::Value::number(9, rules::Unit::Metre)};
    const auto d = tryDerive(
        "grammar 1\nparam w = .5m in .1m..9m\nroads Net { street = w * 100 }\nstart A -> size 400 network Net { block: "
        "cube }\n",
        wide);
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("'street' is 900, but must be 2 … 200 m"), std::string::npos) << d.error().message;
}

TEST(Roads, AreCheckedWithALocatedError) {
    const std::string use = "start A -> size 400 network Net { block: cube }\n";
    EXPECT_NE(messagesOf("roads Net { pul = 1 }\n" + use).find("roads have no 'pul'"), std::string::npos);
    EXPECT_NE(messagesOf("roads Net { pull = 3m }\n" + use).find("'pull' takes"), std::string::npos);
    EXPECT_NE(messagesOf("roads Net { street = 900m }\n" + use).find("'street' is 900m, but must be 2 … 200 m"),
              std::string::npos);
    EXPECT_NE(
        messagesOf("roads Net { pattern = square }\n" + use).find("'pattern' is one of grown, raster, radial, field"),
        std::string::npos);
    EXPECT_NE(messagesOf("roads Net { turn = 7 }\n" + use).find("'turn' takes an angle"), std::string::npos);
    EXPECT_NE(messagesOf("roads Net { }\nroads Net { }\n" + use).find("there is already a roads 'Net'"),
              std::string::npos);
    EXPECT_NE(messagesOf("start A -> network Nett { block: cube }\nroads Net { }\n").find("no roads called 'Nett'"),
              std::string::npos);
    EXPECT_NE(messagesOf("roads Net { }\nstart A -> network Net { blocks: cube }\n")
                  .find("a part of 'network' is called by one of"),
              std::string::npos);
    EXPECT_NE(messagesOf("start A -> size 9 lots box(front: 8m) { lot: cube }\n").find("'box' begins with the area"),
              std::string::npos);
    EXPECT_NE(messagesOf("start A -> size 9 lots box(40, fronts: 8m) { lot: cube }\n").find("'box' has no 'fronts'"),
              std::string::npos);
    EXPECT_NE(messagesOf("start A -> size 9 lots 1 { lot: cube }\n").find("4 … 10⁸"), std::string::npos);
}

TEST(Maps, AreCheckedWithALocatedError) {
    const std::string use = "start A -> cube size (m + 1)\n";
    EXPECT_EQ(messagesOf("map m = bump((0m, 0m), 4m)\n" + use), "");
    EXPECT_NE(messagesOf("map m = n + 1\nmap n = 2\n" + use).find("'n' is declared further down"), std::string::npos);
    EXPECT_NE(messagesOf("map m = scope.x\n" + use).find("no shape here whose scope"), std::string::npos);
    EXPECT_NE(messagesOf("map m = 1..2\n" + use).find("nothing is drawn by chance"), std::string::npos);
    EXPECT_NE(messagesOf("map m = \"a.png\" as 0..1\n" + use).find("how much ground it covers"), std::string::npos);
    EXPECT_NE(messagesOf("map m = \"a.png\" as 3 over (1km, 1km)\n" + use).find("two numbers"), std::string::npos);
    EXPECT_NE(messagesOf("map m = \"a.png\" as 0..1 over (1km, 1km)\n" + use).find("can't use \"a.png\""),
              std::string::npos);
    EXPECT_NE(messagesOf("map m = 1\nparam p = m in 0..1\nstart A -> cube size p\n").find("no place here"),
              std::string::npos);
    std::string doubling = "map m0 = 1\n";
    for (int i = 1; i < 40; ++i)
        doubling +=
            "map m" + std::to_string(i) + " = m" + std::to_string(i - 1) + " + m" + std::to_string(i - 1) + "\n";
    EXPECT_NE(messagesOf(doubling + "start A -> cube size m39\n").find("asks others too often"), std::string::npos);
}

/// A picture of 2 × 1 pixels: a black one of water's colour, and a white one.
rules::Checked withPicture(const std::string& text, const std::string& told = "") {
    rules::Checked result;
    result.source = std::make_shared<const syntax::Source>("test.sgm", "grammar 1\n" + text);
    rules::Loader loader;
    loader.picture = [](const std::string&, const syntax::Source&, std::string&) -> town::RasterPtr {
        auto raster = std::make_shared<town::Raster>();
        raster->width = 2, raster->height = 1;
        raster->grey = {0, 65535};
        raster->color = {{0x7f, 0xb2, 0xd9}, {255, 255, 255}};
        return raster;
    };
    result.grammar = rules::load(result.source, operations::table(), loader, result.diagnostics);
    EXPECT_EQ(result.messages(), told);
    return result;
}

double heightAt(const std::string& map, const std::string& expression, double x) {
    const auto read =
        withPicture(fmt::format("{}\nstart A -> cube size .01 : Base\nrule Base -> + Tower size 1 move ({}m, 0, 0)\n"
                                "rule Tower -> cube size (1, {}, 1)\n",
                                map, x, expression));
    if (!read.grammar) return -1;
    const auto d = derive::derive(read.grammar, {}, nullptr);
    EXPECT_TRUE(d.ok()) << d.error().message;
    double height = 0;
    for (const Shape& s : d->tree.shapes)
        if (s.solid != derive::none) height = std::max(height, s.scope.size.y);
    return height;
}

TEST(Towns, ChecksMayCountRoads) {
    const auto grammar = grammarOf("grammar 2\nstart A -> cube\ncheck A expect roads == 0 and 1 + roads > 0\n");
    ASSERT_TRUE(grammar);
    EXPECT_EQ(grammar->checks.size(), 1u);
}

TEST(Maps, APictureWithoutItsHeightsIsTold) {
    const auto town = [](const std::string& as, const std::string& height) {
        return "map m = \"a.png\"" + as + " over (1km, 1km)\nroads Net { pull = m height = " + height +
               " }\nstart Town -> size (500, 10, 500) network Net { street: cube }\n";
    };
    withPicture(town("", "m"), "warning: the picture's heights are 0m where it is black and 1m where it is white\n");
    withPicture(town(" as 0..80", "m"));
    withPicture(town("", "80m * m"));
}

TEST(Maps, PicturesGiveNumbersAndWords) {
    const std::string grey = "map m = \"a.png\" as 10m..30m over (100m, 100m)";
    EXPECT_NEAR(heightAt(grey, "m", -40), 10, 1e-6);
    EXPECT_NEAR(heightAt(grey, "m", 0), 20, 1e-6);
    EXPECT_NEAR(heightAt(grey, "m", 12.5), 25, 1e-6);
    EXPECT_NEAR(heightAt(grey, "m", 500), 30, 1e-6);
    const std::string land = "map m = \"a.png\" of #7fb2d9: river, else: dry over (100m, 100m)";
    EXPECT_NEAR(heightAt(land, "if(m == river, 2, 3)", -1), 2, 1e-6);
    EXPECT_NEAR(heightAt(land, "if(m == river, 2, 3)", 1), 3, 1e-6);
}

}  // namespace
}  // namespace sgm::testing_
