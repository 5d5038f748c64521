// What a file says of the outlines on which shapes stand: value, word and outlines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "modeler/plan/shapes.h"
#include "tests/operations/loaded.h"
#include "tests/operations/shapes_called.h"

namespace sgm::testing_ {
namespace {

constexpr const char* town = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"height": 12, "roof:shape": "flat", "turned": 90},
   "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [200, 0], [200, 100], [0, 100], [0, 0]]]}},
  {"type": "Feature", "properties": {"height": "7.5 m"},
   "geometry": {"type": "Polygon", "coordinates": [[[300, 0], [500, 0], [500, 100], [300, 100], [300, 0]]]}},
  {"type": "Feature", "properties": {"height": "high"},
   "geometry": {"type": "Polygon", "coordinates": [[[600, 0], [800, 0], [800, 100], [600, 100], [600, 0]]]}}]})";

std::shared_ptr<const rules::Grammar> overTown(const std::string& text, std::string* errors = nullptr) {
    rules::Loader loader;
    loader.outlines = [](const std::string& name, const syntax::Source&,
                         std::string& why) -> std::shared_ptr<const plan::Features> {
        why = "No such file or directory";
        if (name != "town.geojson") return nullptr;
        auto features = plan::readGeoJson(town);
        EXPECT_TRUE(features.ok()) << (features.ok() ? "" : features.error().message);
        return std::make_shared<const plan::Features>(std::move(*features));
    };
    return loaded(loader, "grammar 2\n" + text, errors);
}

derive::Derivation derivedOver(const std::string& text) {
    auto d = derive::derive(overTown(text), {}, nullptr);
    EXPECT_TRUE(d.ok()) << (d.ok() ? "" : d.error().message);
    return std::move(*d);
}

TEST(OutlineProperties, ReachRulesBelow) {
    const auto d = derivedOver(
        "terminal wall\nstart S -> for k in 1..outlines(\"town.geojson\") { Lot footprint file(\"town.geojson\", k) }\n"
        "rule Lot -> Deep\nrule Deep -> extrude (value(\"height\", 5m)) wall\n");
    std::multiset<double> heights_m;
    for (const derive::Shape& wall : shapesCalled(d, "wall")) heights_m.insert(wall.scope.size.y);
    EXPECT_EQ(heights_m, (std::multiset<double>{5, 7.5, 12}))
        << "texts that begin with a number count, and what is no number is as if nothing was said";
}

TEST(OutlineProperties, AreSaidBeforeAShapeToo) {
    const auto d = derivedOver(
        "terminal wall\nstart S -> footprint file(\"town.geojson\", 1) Lot\nrule Lot -> extrude (value(\"height\", "
        "5m)) wall\n");
    EXPECT_DOUBLE_EQ(shapesCalled(d, "wall")[0].scope.size.y, 12);
}

TEST(OutlineProperties, WordsChooseRules) {
    const auto d = derivedOver(
        "terminal flat = cube\nterminal gable = prism\nstart S -> for k in 1..3 { Lot footprint file(\"town.geojson\", "
        "k) }\n"
        "rule Lot when word(\"roof:shape\", gabled) == flat -> flat\nrule Lot -> gable\n");
    EXPECT_EQ(shapesCalled(d, "flat").size(), 1u);
    EXPECT_EQ(shapesCalled(d, "gable").size(), 2u);
}

TEST(OutlineProperties, NumbersHaveTheUnitOfWhatStandsForThem) {
    const auto d = derivedOver(
        "terminal wall = cube\nstart S -> footprint file(\"town.geojson\", 1) Lot\nrule Lot -> wall turn "
        "(value(\"turned\", 0deg))\n");
    const derive::Shape wall = shapesCalled(d, "wall")[0];
    EXPECT_NEAR(std::abs(wall.scope.axes.x.z), 1, 1e-9) << "a quarter turn, in degrees in the file";
}

/// Heights of blocks over outlines that say these texts, and what the checker warns of.
std::pair<std::vector<double>, std::string> heightsOf(const std::vector<std::string>& said, const std::string& rest) {
    std::string features;
    for (size_t i = 0; i < said.size(); ++i) {
        const std::string x = std::to_string(1000 * (i + 1)), more = std::to_string(1000 * (i + 1) + 10);
        features += fmt::format(
            R"({}{{"type":"Feature","properties":{{"height":"{}"}},"geometry":{{"type":"Polygon","coordinates":)"
            R"([[[{},0],[{},0],[{},10],[{},10]]]}}}})",
            i ? "," : "", said[i], x, more, more, x);
    }
    rules::Loader loader;
    loader.outlines = [&](const std::string&, const syntax::Source&, std::string&) {
        auto read = plan::readGeoJson(R"({"type":"FeatureCollection","features":[)" + features + "]}");
        return std::make_shared<const plan::Features>(std::move(*read));
    };
    const auto source = std::make_shared<const syntax::Source>(
        "test.sgm", "grammar 2\nterminal wall\n" +
                        (rest.empty() ? "start S -> for k in 1..outlines(\"town.geojson\") { Lot footprint "
                                        "file(\"town.geojson\", k) }\n"
                                        "rule Lot -> extrude (value(\"height\", 5m)) wall\n"
                                      : rest));
    syntax::Diagnostics diagnostics;
    const auto grammar = rules::load(source, operations::table(), loader, diagnostics);
    std::string told;
    for (const auto& d : diagnostics.all()) told += syntax::render(d);
    std::vector<double> heights_m;
    if (!grammar) return {heights_m, told};
    const auto d = derive::derive(grammar, {}, nullptr);
    for (const derive::Shape& wall : shapesCalled(*d, "wall")) heights_m.push_back(wall.scope.size.y);
    std::ranges::sort(heights_m);
    return {heights_m, told};
}

TEST(OutlineProperties, UnitsOfFilesAreRead) {
    const auto [heights_m, told] = heightsOf({"500 cm", "20 ft", "0.5km", "6'4\\\"", "+3", "7.5 m", "12", "900mm"}, "");
    const std::vector<double> wanted{.9, 1.9304, 3, 5, 6.096, 7.5, 12, 500};
    ASSERT_EQ(heights_m.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(heights_m[i], wanted[i], 1e-9) << i;
    EXPECT_EQ(told, "");
}

TEST(OutlineProperties, TextsThatAreNoNumberAreTold) {
    for (const char* said : {"6,5", "2 storeys", "tall", "5 deg", "12 m high", "inf"}) {
        const auto [heights_m, told] = heightsOf({"3", said, said}, "");
        EXPECT_EQ(heights_m, (std::vector<double>{3, 5, 5})) << said;
        EXPECT_NE(
            told.find(fmt::format("feature 2 of \"town.geojson\" (and 1 more) says \"height\": \"{}\", which is no "
                                  "length, so the default holds",
                                  said)),
            std::string::npos)
            << told;
    }
    EXPECT_EQ(heightsOf({""}, "").second, "") << "nothing is said there";
}

TEST(OutlineProperties, OfAnOutlineThatTheSameShapeBringsAreNone) {
    const std::string warning = "and not the shape that brings the outline: this is always the default";
    const auto toldOf = [](const std::string& rest) { return heightsOf({"12"}, rest + "\n").second; };
    const std::string own = "footprint file(\"town.geojson\", 1) extrude (value(\"height\", 5m)) wall";
    EXPECT_NE(toldOf("start S -> " + own).find(warning), std::string::npos);
    EXPECT_NE(toldOf("start S -> size 4 A\nrule A -> " + own).find(warning), std::string::npos);
    EXPECT_EQ(toldOf("start S -> footprint file(\"town.geojson\", 1) A\nrule A -> " + own), "")
        << "another outline above may say it";
    EXPECT_EQ(
        toldOf("start S -> footprint file(\"town.geojson\", 1) A\nrule A -> extrude (value(\"height\", 5m)) wall"), "");
}

TEST(OutlineProperties, WhatIsWrongIsTold) {
    const auto told = [](const std::string& text) {
        std::string errors;
        overTown(text + "\n", &errors);
        return errors;
    };
    EXPECT_NE(told("start S -> cube size (value(height, 3m), 1, 1)").find("the name of a property in quotes"),
              std::string::npos);
    EXPECT_NE(told("start S -> cube size (value(\"height\", true), 1, 1)").find("is a number"), std::string::npos);
    EXPECT_NE(told("param a = value(\"height\", 3m)\nstart S -> cube size a").find("there is none here"),
              std::string::npos);
    EXPECT_NE(told("start S -> for k in 1..outlines(\"no.svg\") { cube }").find("can't use \"no.svg\""),
              std::string::npos);
    EXPECT_NE(told("start S -> for k in 1..outlines(3) { cube }").find("write 'outlines("), std::string::npos);
}

TEST(OutlineProperties, OutlinesThatBecomeOthersAreTold) {
    rules::Loader loader;
    loader.outlines = [](const std::string&, const syntax::Source&, std::string&) {
        auto read =
            plan::readGeoJson(R"({"type":"Polygon","coordinates":[[[1000,0],[1010,10],[1010,0],[1000,10],[1000,0]]]})");
        return std::make_shared<const plan::Features>(std::move(*read));
    };
    syntax::Diagnostics diagnostics;
    const auto source = std::make_shared<const syntax::Source>(
        "test.sgm", "grammar 2\nstart S -> footprint file(\"bow.geojson\", 1) extrude 3m block\n");
    ASSERT_TRUE(rules::load(source, operations::table(), loader, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.all()[0].message, "\"bow.geojson\", feature 1: its outline crosses itself near (1005, 5)");
}

}  // namespace
}  // namespace sgm::testing_
