// Outlines from files: what is read, and that damaged files are errors with a place.
#include "modeler/plan/read.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "modeler/plan/formula.h"
#include "tests/cpu_time.h"
#include "tests/plan/random_plans.h"
#include "tests/scratch.h"

namespace sgm::plan {
namespace {

using testing::HasSubstr;

std::string polygonText(const std::string& coordinates) {
    return R"({"type":"Polygon","coordinates":)" + coordinates + "}";
}
std::string featureText(const std::string& coordinates, const std::string& properties = "{}") {
    return R"({"type":"Feature","id":"a7","properties":)" + properties + R"(,"geometry":)" + polygonText(coordinates) +
           "}";
}
std::string collection(const std::string& features) {
    return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

constexpr const char* square = "[[[1000,0],[1010,0],[1010,20],[1000,20],[1000,0]]]";

TEST(GeoJson, MetresEastAndNorthBecomeXAndMinusZ) {
    const auto f =
        readGeoJson(collection(featureText(square, R"({"height":9.5,"roof:shape":"gabled","flat":true,"x":null,
        "tags":["street","side"]})")));
    ASSERT_TRUE(f.ok()) << f.error().message;
    ASSERT_EQ(f->list.size(), 1u);
    const Feature& one = f->list[0];
    EXPECT_EQ(one.name, "a7");
    EXPECT_DOUBLE_EQ(area(one.footprint), 200);
    EXPECT_DOUBLE_EQ(std::get<double>(*one.find("height")), 9.5);
    EXPECT_EQ(std::get<std::string>(*one.find("roof:shape")), "gabled");
    EXPECT_EQ(std::get<std::string>(*one.find("flat")), "true");
    EXPECT_EQ(one.find("x"), nullptr);
    EXPECT_FALSE(f->fromDegrees);
    for (const PlacedEdge& e : edgesOf(one.footprint)) {
        const std::string tag = one.footprint.tags[e.edge.tag];
        EXPECT_EQ(tag, e.from.z == 0 && e.to.z == 0 ? "street" : e.from.x == 1010 && e.to.x == 1010 ? "side" : "");
    }
}

TEST(GeoJson, DegreesAreLaidOnAPlane) {
    // A hundredth of a degree square at 52° N.
    const auto f = readGeoJson(polygonText("[[[13.40,52.00],[13.41,52.00],[13.41,52.01],[13.40,52.01]]]"));
    ASSERT_TRUE(f.ok()) << f.error().message;
    EXPECT_TRUE(f->fromDegrees);
    EXPECT_NEAR(f->east, 13.405, 1e-9);
    EXPECT_NEAR(f->north, 52.005, 1e-9);
    const Vec2 size = bounds(f->list[0].footprint).size();
    EXPECT_NEAR(size.x, 686.6, .5);
    EXPECT_NEAR(size.z, 1112.7, .5);
}

TEST(GeoJson, LargeCoordinatesAreMovedAndCourtsAndSeveralPolygonsKept) {
    const auto f = readGeoJson(R"({"type":"MultiPolygon","coordinates":[
        [[[390000,5820000],[390040,5820000],[390040,5820030],[390000,5820030]],
         [[390010,5820010],[390030,5820010],[390030,5820020],[390010,5820020]]],
        [[[390100,5820000],[390110,5820000],[390110,5820010]]]]})");
    ASSERT_TRUE(f.ok()) << f.error().message;
    EXPECT_EQ(f->list[0].footprint.polygons.size(), 2u);
    EXPECT_NEAR(area(f->list[0].footprint), 1200 - 200 + 50, 1e-6);
    EXPECT_GT(f->north, 5.8e6);
    EXPECT_LT(std::abs(bounds(f->list[0].footprint).lo.x), 100);
}

TEST(GeoJson, LinesAndPolygonsOfAFileFitTogether) {
    // A street from west to east, and a house 10 m north of its eastern end, by degrees and by large metres.
    for (const auto& [east, north, metre] : {std::tuple(13.4, 52.0, 1 / 111229.0), std::tuple(5e5, 5.8e6, 1.0)}) {
        const auto at = [&, e = east, n = north, m = metre](double x, double y) {
            return fmt::format("[{:.9f},{:.9f}]", e + x * m, n + y * m);
        };
        const std::string line = at(0, 0) + "," + at(100, 0);
        const std::string ring = at(90, 10) + "," + at(100, 10) + "," + at(100, 20) + "," + at(90, 20);
        const std::string text =
            R"({"type":"FeatureCollection","features":[
            {"type":"Feature","geometry":{"type":"LineString","coordinates":[)" +
            line + R"(]}},
            {"type":"Feature","geometry":{"type":"GeometryCollection","geometries":[
             {"type":"Polygon","coordinates":[[)" +
            ring + "]]}]}}]}";
        const auto polygons = readGeoJson(text);
        const auto lines = readGeoJsonLines(text);
        ASSERT_TRUE(polygons.ok() && lines.ok());
        const Vec2 end = lines->list[0].lines[0][1];
        Box2 house;
        for (const Vec2 p : polygons->list[0].footprint.polygons[0].outer.points) house.add(p);
        EXPECT_NEAR(house.hi.z - end.z, -10, .02) << east;
        EXPECT_NEAR(house.hi.x, end.x, .02) << east;
    }
}

TEST(GeoJson, CrossingOutlinesAreResolvedAndOtherFaultsLocated) {
    const auto bow = readGeoJson(collection(featureText("[[[1000,0],[1010,10],[1010,0],[1000,10]]]")));
    ASSERT_TRUE(bow.ok());
    EXPECT_NEAR(area(bow->list[0].footprint), 50, .1);
    const auto messageOf = [](const std::string& text) {
        const auto f = readGeoJson(text);
        return f.ok() ? std::string("no error") : f.error().message;
    };
    EXPECT_THAT(messageOf("{\"type\":\n\n oops"), HasSubstr("line 3: this is no JSON"));
    EXPECT_THAT(messageOf(collection(featureText(square) + "," + featureText("[[[0,0],[1000,1]]]"))),
                HasSubstr("feature 2: a ring has fewer than three points"));
    EXPECT_THAT(messageOf(collection(featureText("[[[0,0],[1000,1],[\"a\",2]]]"))), HasSubstr("feature 1: position 3"));
    EXPECT_THAT(messageOf(collection(featureText("[[[0,0],[1000,0],[2000,0]]]"))), HasSubstr("feature 1: "));
    EXPECT_THAT(messageOf(polygonText("[[[0,0],[1e999,0],[2,2]]]")), HasSubstr("too large"));
    EXPECT_THAT(messageOf(R"({"type":"Point","coordinates":[1,2]})"), HasSubstr("no polygons"));
    EXPECT_THAT(messageOf("[]"), HasSubstr("no polygons"));
    EXPECT_THAT(messageOf(std::string(100'000, '[')), HasSubstr("nest deeper"));
    EXPECT_THAT(messageOf(""), HasSubstr("line 1"));
}

TEST(GeoJson, OutlinesThatBecomeOthersAreTold) {
    const auto faultOf = [](const std::string& rings) {
        const auto f = readGeoJson(polygonText(rings));
        return f.ok() ? f->list[0].fault : f.error().message;
    };
    const std::string outline = "[[1000,0],[1020,0],[1020,20],[1000,20],[1000,0]]";
    const auto withHole = [&](const std::string& hole) { return faultOf("[" + outline + ",[" + hole + "]]"); };
    EXPECT_EQ(withHole("[1005,5],[1010,5],[1010,10],[1005,10]"), "");
    EXPECT_EQ(withHole("[1015,5],[1030,5],[1030,10],[1015,10]"), "a hole crosses the outline near (1020, 5)");
    EXPECT_EQ(withHole("[1030,5],[1040,5],[1040,10],[1030,10]").substr(0, 31), "a hole lies outside its outline");
    EXPECT_EQ(withHole("[1020,5],[1010,4],[1010,10]"), "") << "a hole may touch its outline at a point";
    EXPECT_EQ(faultOf("[[[1000,0],[1010,10],[1010,0],[1000,10]]]"), "its outline crosses itself near (1005, 5)");
    const auto degrees = readGeoJson(polygonText("[[[13.40,52.00],[13.41,52.01],[13.41,52.00],[13.40,52.01]]]"));
    ASSERT_TRUE(degrees.ok());
    EXPECT_EQ(degrees->list[0].fault, "its outline crosses itself near (13.405, 52.005)") << "as the file has it";
}

TEST(GeoJson, BoundsHold) {
    ReadLimits few;
    few.mostFeatures = 1;
    EXPECT_FALSE(readGeoJson(collection(featureText(square) + "," + featureText(square)), few).ok());
    few = {};
    few.mostPoints = 4;
    EXPECT_FALSE(readGeoJson(polygonText(square), few).ok());
    Progress stop;
    stop.cancel();
    EXPECT_EQ(readGeoJson(collection(featureText(square)), {}, &stop).error().kind, Error::Kind::Cancelled);
}

/// Features are read by themselves: brackets, quotes and lists of that name elsewhere mislead nobody.
TEST(GeoJson, FeaturesOfAListAreReadOneByOne) {
    const auto squareAt = [](int x) {
        return fmt::format("[[[{0},0],[{1},0],[{1},20],[{0},20]]]", 1000 + 20 * x, 1010 + 20 * x);
    };
    std::string features;
    for (int i = 0; i < 200; ++i)
        features += (i ? " ,\n" : "\n") +
                    featureText(squareAt(i), R"({"name\\":"]}, \"features\":[","features":[{"a":[1,2]},3],"n":)" +
                                                 std::to_string(i) + "}");
    const std::string crs = R"("crs":{"type":"name","properties":{"name":"metres"}})";
    const std::string texts[] = {
        R"({"type":"FeatureCollection",)" + crs + R"(,"features" : [)" + features + "]}",
        R"({"features":[)" + features + R"(], "type":"FeatureCollection","more":{"features":[7]},)" + crs + "}",
        R"({"features":[1],"features":[)" + features + R"(],"type":"FeatureCollection",)" + crs + "}"};
    for (const std::string& text : texts) {
        const auto f = readGeoJson(text);
        ASSERT_TRUE(f.ok()) << f.error().message;
        ASSERT_EQ(f->list.size(), 200u);
        EXPECT_FALSE(f->fromDegrees);
        for (size_t i = 0; i < 200; ++i) {
            EXPECT_EQ(f->list[i].place, i + 1);
            EXPECT_EQ(std::get<double>(*f->list[i].find("n")), static_cast<double>(i));
            EXPECT_EQ(bounds(f->list[i].footprint).lo.x, bounds(f->list[0].footprint).lo.x + 20. * double(i));
        }
    }
}

/// What is wrong is told as of the whole file: its line, or the first feature at fault.
TEST(GeoJson, FaultsOfAListAreThoseOfTheFile) {
    const auto messageOf = [](const std::string& text, const ReadLimits& limits = {}) {
        const auto f = readGeoJson(text, limits);
        return f.ok() ? std::string("no error") : f.error().message;
    };
    const std::string good = featureText(square), lame = featureText("[[[0,0],[1000,1]]]");
    const auto list = [&](const std::string& between) { return collection(good + ",\n" + between + ",\n" + good); };
    EXPECT_EQ(messageOf(list("{]")), "line 2: this is no JSON");
    EXPECT_EQ(messageOf(list("")), "line 2: this is no JSON");
    EXPECT_EQ(messageOf(list(good + " " + good)), "line 2: this is no JSON");
    EXPECT_EQ(messageOf(list(good) + "}"), "line 3: this is no JSON");
    EXPECT_EQ(messageOf(list("1e999")), "a number is too large");
    EXPECT_EQ(messageOf(R"({"type":"FeatureCollection","features":[)" + good + ",\n" + good + "}}"),
              "line 2: this is no JSON");
    EXPECT_EQ(messageOf(R"({"type":"FeatureCollection","features":[ ]})"),
              "it has no polygons; GeoJSON's Polygon and MultiPolygon are read");
    EXPECT_EQ(messageOf(list(lame + "," + featureText("7"))), "feature 2: a ring has fewer than three points");
    EXPECT_EQ(messageOf(list(featureText("7") + "," + lame)), "feature 2: a polygon has no coordinates");
    ReadLimits few;
    few.mostPoints = 7;  // of 5, 2 and 5
    EXPECT_EQ(messageOf(list(lame), few), "feature 2: a ring has fewer than three points");
    few.mostPoints = 6;
    EXPECT_EQ(messageOf(list(lame), few), "it has more than 6 points");
    few = {};
    few.mostFeatures = 2;
    EXPECT_EQ(messageOf(list(good), few), "it has more than 2 features");
}

/// What one parser of JSON reads and another doesn't is read all the same.
TEST(GeoJson, WhatJsonMayHoldIsRead) {
    const auto wordsOf = [](const std::string& text) {
        const auto f = readGeoJson(text);
        if (!f.ok()) return f.error().message;
        std::string all = f->list[0].name;
        for (const Property& p : f->list[0].properties)
            all += fmt::format(" {}={}", p.name,
                               p.value.index() == 0 ? std::get<0>(p.value) : fmt::format("{}", std::get<1>(p.value)));
        return all;
    };
    const auto featureOf = [](const std::string& id, const std::string& properties) {
        return R"({"type":"Feature","id":)" + id + R"(,"properties":)" + properties + R"(,"geometry":)" +
               polygonText(square) + "}";
    };
    EXPECT_EQ(wordsOf(featureOf("7", R"({"b":1,"a":"x","b":2,"c":[],"aa":false})")), "7 a=x aa=false b=2")
        << "by name, the last of a name";
    EXPECT_EQ(wordsOf(featureOf("-0", R"({"n":-0,"m":-0.0,"e":1E2})")), "0 e=100 m=-0 n=0");
    EXPECT_EQ(wordsOf(featureOf("18446744073709551615", R"({"n":9007199254740993})")),
              "18446744073709551615 n=9007199254740992");
    EXPECT_EQ(wordsOf(featureOf("184467440737095516150", R"({"n":123456789012345678901234})")),
              " n=1.2345678901234569e+23")
        << "no whole number of 64 bits is no id";
    EXPECT_EQ(wordsOf("\xEF\xBB\xBF" + featureOf("7.5", R"({"name":"é\u00e9"})")), "éé name=éé")
        << "a mark of byte order";
    EXPECT_EQ(wordsOf(featureOf("7", "\"\xFF\"")), "line 1: this is no JSON") << "no UTF-8";
    EXPECT_EQ(wordsOf(featureOf("7", "\"\t\"")), "line 1: this is no JSON");
    EXPECT_EQ(wordsOf(featureOf("07", "{}")), "line 1: this is no JSON");
    const auto nested = [&](size_t lists) {
        return wordsOf(featureOf("7", R"({"a":)" + std::string(lists, '[') + "1" + std::string(lists, ']') + "}"));
    };
    EXPECT_EQ(nested(62), "7");
    EXPECT_THAT(nested(63), HasSubstr("lists nest deeper than 64 at byte 106"));
}

TEST(GeoJson, NumbersAreTheNearestDoubles) {
    test::Draws draw(3);
    for (int round = 0; round < 300; ++round) {
        const int digits = draw.whole(1, 25);
        std::string number = draw.whole(0, 1) ? "-" : "";
        for (int i = 0; i < digits; ++i)
            number += static_cast<char>('0' + (i == 0 ? draw.whole(1, 9) : draw.whole(0, 9)));
        number += ".";
        for (int i = draw.whole(1, 25); i > 0; --i) number += static_cast<char>('0' + draw.whole(0, 9));
        if (draw.whole(0, 1)) number += "e" + std::to_string(draw.whole(-320, 250));
        const auto f = readGeoJson(collection(featureText(square, R"({"n":)" + number + "}")));
        ASSERT_TRUE(f.ok()) << number << ": " << f.error().message;
        EXPECT_EQ(std::get<double>(*f->list[0].find("n")), std::strtod(number.c_str(), nullptr)) << number;
    }
}

TEST(GeoJson, PlansOfMetresTakenForDegreesAreToldAsSuch) {
    const std::string plan = R"({"type":"Polygon","coordinates":[[[0,0],[20,0],[20,10],[0,10],[0,0]]])";
    const auto f = readGeoJson(plan + "}");
    ASSERT_FALSE(f.ok());
    EXPECT_THAT(f.error().message, HasSubstr("all its coordinates lie within 180 and 90, so they count as degrees"));
    EXPECT_THAT(f.error().message, HasSubstr(R"("crs": {"type": "name", "properties": {"name": "metres"}})"));
    const auto metres = readGeoJson(plan + R"(,"crs": {"type": "name", "properties": {"name": "metres"}}})");
    ASSERT_TRUE(metres.ok()) << metres.error().message;
    EXPECT_DOUBLE_EQ(area(metres->list[0].footprint), 200);
}

TEST(GeoJson, TenThousandBuildingsTakeAMoment) {
    std::string text;
    for (int i = 0; i < 10'000; ++i) {
        std::string ring;
        for (int k = 0; k < 16; ++k)
            ring += "[" + std::to_string(i % 100 * 30 + 9 * std::cos(k * pi / 8) + 1000) + "," +
                    std::to_string(i / 100 * 30 + 9 * std::sin(k * pi / 8)) + "],";
        text += (i ? "," : "") +
                featureText("[[" + ring.substr(0, ring.size() - 1) + "]]", R"({"height":9,"roof:shape":"hipped"})");
    }
    text = collection(text);
    const double before = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    const auto f = readGeoJson(text);
    ASSERT_TRUE(f.ok());
    EXPECT_EQ(f->list.size(), 10'000u);
    for (const Feature& feature : f->list) ASSERT_TRUE(monotoneFormula(feature.footprint).ok());
    EXPECT_LT(secondsOf(CLOCK_PROCESS_CPUTIME_ID) - before, boundSeconds(1.5));
}

TEST(Svg, ShapesPathsAndTransforms) {
    const auto f =
        readSvg(R"svg(<?xml version="1.0"?><!-- <path d="M0 0"/> --><svg><defs><rect width="9" height="9"/></defs>
        <g transform="translate(10,20) scale(2)"><rect id="r" class="lot big" x="1" y="2" width="3" height="4"/>
        <polygon points="0,0 4,0 4,4"/></g>
        <path id="court" d="M0 0 h10 v10 h-10 z m2 2 h6 v6 h-6 z"/>
        <path d="M0,0 C 0 5 5 10 10 10 L 10-5 Z"/><path transform="rotate(90 5 5)" d="m0 0l10 0 0 10z"/>
        <path d="M-5 0 A5 5 0 0110 0 A5 5 0 0 1 -5 0 z"/></svg>)svg");
    ASSERT_TRUE(f.ok()) << f.error().message;
    ASSERT_EQ(f->list.size(), 6u);
    EXPECT_EQ(f->list[0].name, "r");
    EXPECT_EQ(std::get<std::string>(*f->list[0].find("class")), "lot big");
    EXPECT_EQ(bounds(f->list[0].footprint).lo, (Vec2{12, 24}));
    EXPECT_DOUBLE_EQ(area(f->list[0].footprint), 48);
    EXPECT_DOUBLE_EQ(area(f->list[1].footprint), 32);
    EXPECT_NEAR(area(f->list[2].footprint), 64, 1e-4);
    EXPECT_EQ(f->list[2].footprint.polygons[0].courts.size(), 1u);
    EXPECT_NEAR(area(f->list[4].footprint), 50, 1e-9);
    EXPECT_NEAR(bounds(f->list[4].footprint).hi.x, 10, 1e-9);
    EXPECT_EQ(f->list[0].place, 2u);
    // Two half circles of radius 7.5 (5 is too small and grows), 8 chords each.
    EXPECT_NEAR(area(f->list[5].footprint), 16 / 2.0 * 7.5 * 7.5 * std::sin(pi / 8), 1e-6);
}

TEST(Svg, DamageIsLocated) {
    const auto messageOf = [](const std::string& text) {
        const auto f = readSvg(text);
        return f.ok() ? std::string("no error") : f.error().message;
    };
    EXPECT_THAT(messageOf("<svg>\n<path d='L 1 1'/></svg>"), HasSubstr("line 2: a path must begin with M"));
    EXPECT_THAT(messageOf("<svg>\n<path d='M 1 1 X 3'/></svg>"), HasSubstr("line 2: a path has a command"));
    EXPECT_THAT(messageOf("<svg>\n<polygon points='0 0 1 0 1 nan'/></svg>"), HasSubstr("line 2: a list of numbers"));
    EXPECT_THAT(messageOf("<svg><g transform='turn(3)'/></svg>"), HasSubstr("'turn' with 1 numbers is no transform"));
    EXPECT_THAT(messageOf("<svg><path d='M0 0h1v1"), HasSubstr("has no end"));
    EXPECT_THAT(messageOf("<svg><rect width='1e9' height='3'/></svg>"), HasSubstr("beyond"));
    EXPECT_THAT(messageOf("<svg/>"), HasSubstr("no outlines"));
    std::string deep;
    for (int i = 0; i < 1000; ++i) deep += "<g>";
    EXPECT_THAT(messageOf(deep), HasSubstr("nest too deep"));
}

TEST(Obj, LevelFacesOfAGroupAreJoined) {
    const auto f = readObjOutlines(
        "v 0 3 0\nv 4 3 0\nv 4 3 4\nv 0 3 4\nv 8 3 0\nv 8 3 4\nv 0 9 0\nv 0 9 4\n"
        "g east # two quads\nf 1 2 3 4\nf 2/1 5/2 -3/3 3/4\nf 1 4 8 7\ng\no tri\nf 1 3 2\n");
    ASSERT_TRUE(f.ok()) << f.error().message;
    ASSERT_EQ(f->list.size(), 2u);
    EXPECT_EQ(f->list[0].name, "east");
    EXPECT_NEAR(area(f->list[0].footprint), 32, 1e-4);
    EXPECT_EQ(f->list[0].footprint.edgeCount(), 4u);
    EXPECT_NEAR(area(f->list[1].footprint), 8, 1e-4);
    EXPECT_THAT(readObjOutlines("v 0 0 0\nf 1 2 3\n").error().message, HasSubstr("line 2: a face has a corner"));
    EXPECT_THAT(readObjOutlines("v 0 zero 0\n").error().message, HasSubstr("line 1: a vertex needs"));
    EXPECT_THAT(readObjOutlines("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").error().message, HasSubstr("no level faces"));
}

TEST(Read, MutatedFilesNeverCrash) {
    const std::string texts[] = {
        collection(featureText(square, R"({"tags":["a"],"h":3})")),
        R"svg(<svg><g transform="rotate(3) scale(2 3)"><path id="a" d="M0 0 C1 2 3 4 5 6 A3 4 5 0 1 9 9 Q 3 3 1 8z"/></g></svg>)svg",
        "v 0 3 0\nv 4 3 0\nv 4 3 4\nv 0 3 4\ng a\nf 1 2 3 4\n"};
    const auto read = [](size_t kind, const std::string& text) {
        return kind == 0 ? readGeoJson(text) : kind == 1 ? readSvg(text) : readObjOutlines(text);
    };
    for (uint64_t key = 0; key < 6000; ++key) {
        test::Draws draw(key);
        const size_t kind = key % 3;
        std::string text = texts[kind];
        for (int i = draw.whole(1, 6); i > 0 && !text.empty(); --i) {
            const auto at = static_cast<size_t>(draw.whole(0, static_cast<int>(text.size()) - 1));
            switch (draw.whole(0, 3)) {
                case 0:
                    text[at] = static_cast<char>(draw.whole(0, 255));
                    break;
                case 1:
                    text.erase(at, static_cast<size_t>(draw.whole(1, 9)));
                    break;
                case 2:
                    text.insert(at, texts[kind].substr(at / 2, 12));
                    break;
                default:
                    text[at] = "0123456789-.eE,[]{}<>\"' "[draw.whole(0, 23)];
            }
        }
        const auto features = read(kind, text);
        if (features.ok()) {
            for (const Feature& feature : features->list) EXPECT_FALSE(firstFault(feature.footprint)) << text;
        } else {
            EXPECT_FALSE(features.error().message.empty());
        }
    }
}

TEST(Read, TheErrorNamesTheFile) {
    EXPECT_THAT(readOutlines("nowhere.geojson").error().message, HasSubstr("nowhere.geojson: "));
    EXPECT_THAT(readOutlines("plan.dxf").error().message, HasSubstr(".geojson, .json, .svg and .obj"));
}

}  // namespace
}  // namespace sgm::plan
