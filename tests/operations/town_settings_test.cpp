// Streets of a file, fields, curves, strips of the skeleton, pictures of floats and means: in the language.
#include <gtest/gtest.h>

#include "modeler/core/packages.h"
#include "modeler/town/own_streets.h"
#include "tests/operations/town_grammars.h"

namespace sgm::testing_ {
namespace {

/// A float picture of 2 × 1 pixels, −4 and 120, that says it covers 100 × 100 m.
rules::Checked withRelief(const std::string& text) {
    rules::Checked result;
    result.source = std::make_shared<const syntax::Source>("test.sgm", "grammar 1\n" + text);
    rules::Loader loader;
    loader.picture = [](const std::string&, const syntax::Source&, std::string&) -> town::RasterPtr {
        auto raster = std::make_shared<town::Raster>();
        raster->width = 2, raster->height = 1;
        raster->numbers = {-4, 120};
        raster->extent_m = plan::Vec2{100, 100};
        return raster;
    };
    result.grammar = rules::load(result.source, operations::table(), loader, result.diagnostics);
    return result;
}

/// A network over streets of a file: a highway of 300 m along x, and a street across it.
rules::Checked withStreets(const std::string& settings, double at_m = 0) {
    rules::Checked result;
    result.source = std::make_shared<const syntax::Source>(
        "test.sgm", "grammar 1\nterminal asphalt, wall\nroads Net from \"streets.geojson\" { " + settings +
                        " }\nstart Town -> size (500, 10, 500) network Net { highway: asphalt | block: wall }\n");
    rules::Loader loader;
    loader.streets = [at_m](const std::string& name, const syntax::Source&,
                            std::string&) -> std::shared_ptr<const town::OwnStreets> {
        auto streets = std::make_shared<town::OwnStreets>();
        streets->name = name;
        streets->list = {{{{at_m - 150, 20}, {at_m + 150, 20}}, town::RoadClass::Highway, false},
                         {{{at_m, -120}, {at_m, 140}}, town::RoadClass::Street, false}};
        for (const auto& street : streets->list)
            for (const plan::Vec2 p : street.line) streets->box.add(p);
        return streets;
    };
    result.grammar = rules::load(result.source, operations::table(), loader, result.diagnostics);
    EXPECT_EQ(result.messages(), "");
    return result;
}

TEST(Roads, BeginWithThoseOfAFile) {
    const auto read = withStreets("block = 60m  highway = 14m  step = 60m");
    ASSERT_TRUE(read.grammar);
    const auto d = derive::derive(read.grammar, {}, nullptr);
    ASSERT_TRUE(d.ok()) << d.error().message;
    double highway = 0;
    for (const auto& f : d->plan.features)
        if (f.layer == "highway") highway += area(f.area);
    EXPECT_GT(highway, .8 * 300 * 14);
    EXPECT_LT(highway, 1.1 * 300 * 14);  // the only one there is
    EXPECT_GT(layersOf(*d).at("block"), 4u);
}

TEST(Roads, OfAFileBesideTheScopeAreALocatedError) {
    const auto read = withStreets("block = 60m", 4000);
    ASSERT_TRUE(read.grammar);
    const auto d = derive::derive(read.grammar, {}, nullptr);
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("test.sgm:3:16"), std::string::npos) << d.error().message;
    EXPECT_NE(d.error().message.find("no street of streets.geojson lies in the network's 500 x 500 m: they cover 300 x "
                                     "260 m from (3850, -120)"),
              std::string::npos)
        << d.error().message;
}

TEST(Roads, OfAFileAreCheckedWithALocatedError) {
    const std::string use = "start A -> size 400 network Net { block: cube }\n";
    EXPECT_NE(messagesOf("roads Net from streets.geojson { }\n" + use).find("expected a file's name in quotes"),
              std::string::npos);
    EXPECT_NE(messagesOf("roads Net from \"a.geojson\" { }\n" + use).find("can't use \"a.geojson\""),
              std::string::npos);
}

TEST(Roads, FollowAFieldOfWeightedParts) {
    const std::string town =
        "start Town -> size (500, 10, 500) network Net { street: asphalt | highway: asphalt | block: wall }\n"
        "terminal asphalt, wall\n";
    const Derivation d = derived(
        "grammar 1\nroads Net { pattern = field  grid = if(here.x < 0m, 1, 0)  rings = if(here.x > 0m, 1, 0)  axis = "
        "0deg  centre = (0m, "
        "0m)"
        "  from = (-100m, 20m)  block = 60m  step = 60m }\n" +
        town);
    double square = 0, west = 0, east = 0, slant = 0;
    const auto solids = solidsOf(d);
    for (const Shape& s : solids.at("asphalt")) {
        const Vec3d along = s.scope.axes * Vec3d{0, 0, 1};
        const double off = std::min(std::abs(along.x), std::abs(along.z));
        (s.scope.centre.x < -40 ? west : east) += s.scope.size.z;
        if (s.scope.centre.x < -40 && off < .1) square += s.scope.size.z;
        if (s.scope.centre.x > 40 && off > .2) slant += s.scope.size.z;
    }
    EXPECT_GT(square, .9 * west);
    EXPECT_GT(slant, .2 * east);
    EXPECT_NE(messagesOf("roads Net { pattern = field  rings = 3m }\nstart A -> size 9 network Net { block: cube }\n")
                  .find("'rings'"),
              std::string::npos);
}

TEST(Roads, BendInCurvesOfOnePiece) {
    const std::string settings = "highwayRadius = 40m  streetRadius = 12m  turn = 25deg\n}";
    std::string curved = head;
    curved.replace(curved.find("}\n"), 1, settings);
    const std::string body = "highway: asphalt | street: asphalt | block: lots 300 { lot: wall } }\n";
    const Derivation straight = derived(head + start + body), round = derived(curved + start + body);
    const auto areaOfLayer = [](const Derivation& d, const std::string& layer) {
        double sum = 0;
        for (const auto& f : d.plan.features)
            if (f.layer == layer) sum += area(f.area);
        return sum;
    };
    size_t bands = 0;
    for (const auto& f : round.plan.features)
        bands += (f.layer == "highway" || f.layer == "street") && f.area.polygons[0].outer.size() > 4;
    EXPECT_GT(bands, 5u);
    EXPECT_NEAR(areaOfLayer(round, "street"), areaOfLayer(straight, "street"), .5 * areaOfLayer(straight, "street"));
    EXPECT_GT(layersOf(round).at("lot"), 50u);
}

TEST(Lots, CanBeStripsOfTheSkeleton) {
    if (!isBuiltWith(Package::Cgal)) GTEST_SKIP() << "built without CGAL";
    const std::string body =
        "block: lots skeleton(300, front: 8m, depth: 25m) { lot: wall | corner: wall | inner: yard } }\n";
    const Derivation d = derived(head + start + body);
    double blocks = 0, lots = 0;
    size_t count = 0;
    for (const auto& f : d.plan.features) {
        if (f.layer == "block") blocks += area(f.area);
        if (f.layer == "lot" || f.layer == "corner" || f.layer == "inner") lots += area(f.area);
        if (f.layer != "lot" && f.layer != "corner") continue;
        ++count;
        EXPECT_GT(f.street_m, 0);
    }
    EXPECT_GT(count, 100u);
    EXPECT_NEAR(lots, blocks, 1e-4 * blocks);
    const std::string begin = "start A -> size 60 lots ";
    EXPECT_NE(messagesOf(begin + "skeleton(front: 8m) { lot: cube }\n").find("'skeleton' begins with the area"),
              std::string::npos);
    EXPECT_NE(messagesOf(begin + "skeleton(300, deep: 8m) { lot: cube }\n").find("'skeleton' has no 'deep'"),
              std::string::npos);
    EXPECT_NE(messagesOf(begin + "box(300, depth: 8m) { lot: cube }\n").find("'box' has no 'depth'"),
              std::string::npos);
    EXPECT_NE(messagesOf(begin + "skeleton(300, depth: 9km) { lot: cube }\n").find("'depth' is 0 … 1 km"),
              std::string::npos);
}

TEST(Maps, OfFloatsAreNumbersAndSayTheirExtent) {
    const auto read = withRelief("map m = \"a.tif\" as 0m..1m\nstart A -> cube size (1, m + 10m, 1)\n");
    EXPECT_EQ(read.messages(), "");
    ASSERT_TRUE(read.grammar);
    const auto d = derive::derive(read.grammar, {}, nullptr);
    ASSERT_TRUE(d.ok());
    EXPECT_NEAR(d->tree.shapes.back().scope.size.y, 10 + (120 - 4) / 2., 1e-6);
}

TEST(Maps, HaveAMeanOverThePlan) {
    const auto height = [](const std::string& expression) {
        return derived(
                   "grammar 1\nmap m = here.x\nmap wet = here.x > 0m\nstart A -> size (40, 1, 10) B\n"
                   "rule B -> cube size (1, " +
                   expression + ", 1)\n")
            .tree.shapes.back()
            .scope.size.y;
    };
    // Of a scope from −20 to 20 m: 0 on the mean of x, half of it wet.
    EXPECT_NEAR(height("mean(m) + 5m"), 5, 1e-6);
    EXPECT_NEAR(height("10m * mean(wet)"), 5, 1e-6);
    EXPECT_NEAR(derived("grammar 1\nmap m = here.x * here.x / 1m\nstart A -> size (24, 1, 6) B\n"
                        "rule B -> cube size (1, mean(m), 1)\n")
                    .tree.shapes.back()
                    .scope.size.y,
                24 * 24 / 12., .3);
    const std::string use = "start A -> cube size 1\n";
    EXPECT_NE(messagesOf("map m = 1\nmap n = mean(m)\n" + use).find("'mean' is over the plan of a shape"),
              std::string::npos);
    EXPECT_NE(messagesOf("map m = 1\nparam p = mean(m) in 0..1\n" + use).find("'mean' is over the plan"),
              std::string::npos);
    EXPECT_NE(messagesOf("start A -> cube size mean(+x)\n").find("a mean is one of numbers"), std::string::npos);
}

}  // namespace
}  // namespace sgm::testing_
