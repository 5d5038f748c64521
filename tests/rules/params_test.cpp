// Parameters of every kind, `--set` values and the table for other programs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grammar/rules/params.h"
#include "modeler/core/conventions.h"
#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

const char* const everyKind = R"(
param count = 4 in 1..9 "How many" group Panel key n
param share = .5 in 0..1
param width = 1.2 in .4m..2.4m
param tilt = 12deg in 0..45deg
param size = (1, 2, 3) in 0..4m
param shape = round of round, square
param paint = #c8b090
param lit = true
start A -> cube size (width, count, share) turn tilt : B
rule B when lit and shape == round -> + cube size size color paint at +x
)";

class Params : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(c.grammar) << c.messages(); }
    const Param& param(size_t i) const { return c.grammar->params.at(i); }
    std::string set(size_t i, const std::string& text) const {
        const auto value = parseValue(param(i), text);
        return value.ok() ? toText(*value) : value.error().message;
    }
    Checked c = checkedBody(everyKind);
};

TEST_F(Params, TakeTheirKindFromDefaultAndRange) {
    EXPECT_TRUE(param(0).value.integer);
    EXPECT_FALSE(param(1).value.integer);
    EXPECT_EQ(param(2).value.units[0], Unit::Metre) << "the range's unit";
    EXPECT_NEAR(param(3).value.num(), radians(12), 1e-15);
    EXPECT_EQ(param(4).hi->count, 3) << "one end for every component";
    EXPECT_EQ(param(4).value.units[1], Unit::Metre);
    EXPECT_EQ(param(5).value.text, "round");
    EXPECT_EQ(toText(param(6).value), "#c8b090");
    EXPECT_TRUE(param(7).value.truth());
    EXPECT_EQ(param(0).valueSpan.text(), "4");
    EXPECT_EQ(param(0).label, "How many");
    EXPECT_EQ(param(0).key, "n");
}

TEST_F(Params, AreSetFromText) {
    EXPECT_EQ(set(0, "7"), "7");
    EXPECT_EQ(set(2, "2"), "2m");
    EXPECT_EQ(set(2, "(1m + .5m)"), "1.5m");
    EXPECT_EQ(set(3, "30deg"), "30deg");
    EXPECT_EQ(set(3, "0"), "0deg");
    EXPECT_EQ(set(4, "(1, 1, 2m)"), "(1m, 1m, 2m)");
    EXPECT_EQ(set(4, "3"), "(3m, 3m, 3m)");
    EXPECT_EQ(set(5, "square"), "square");
    EXPECT_EQ(set(6, "#000000"), "#000000");
    EXPECT_EQ(set(7, "false"), "false");
    EXPECT_EQ(set(0, "3.0"), "3") << "a whole number, however it is written";
}

TEST_F(Params, SayWhyAValueIsRefused) {
    EXPECT_EQ(set(0, "10"), "'count' is 10, outside its range 1..9");
    EXPECT_EQ(
        set(0, "2.5"),
        "'count' is a whole number, not 2.5: with a point in its default or range (0..1.0) it would be a real one");
    EXPECT_EQ(set(2, "30deg"), "'width' is a length, but this is an angle");
    EXPECT_EQ(set(3, "30"), "an angle needs its unit: write '30deg'");
    EXPECT_EQ(set(3, "52,5deg"),
              "'tilt' can't be '52,5deg': '52,5deg' is no number; a decimal point is '.': write '52.5deg'");
    EXPECT_EQ(set(4, "(1, 2)"), "'size' is a vector of 3, but this is a vector of 2");
    EXPECT_EQ(set(5, "oval"), "'shape' is one of round, square, not 'oval'");
    EXPECT_EQ(set(6, "red"), "'paint' is a colour such as #c8b090, not 'red'");
    EXPECT_EQ(set(7, "no"), "'lit' is true or false, not 'no'");
    EXPECT_EQ(set(7, "1"), "'lit' is true or false, but this is a plain number");
    EXPECT_EQ(set(0, ""), "'count' is set to nothing");
    EXPECT_EQ(set(1, "0..1"),
              "'share' can't be '0..1': nothing is drawn by chance here: a plain value must stand here");
}

TEST_F(Params, MakeATableForOtherPrograms) {
    const auto table = nlohmann::json::parse(paramsJson(*c.grammar));
    ASSERT_EQ(table.size(), 8u);
    EXPECT_EQ(table[0], (nlohmann::json{{"name", "count"},
                                        {"kind", "integer"},
                                        {"default", 4},
                                        {"minimum", 1},
                                        {"maximum", 9},
                                        {"label", "How many"},
                                        {"group", "Panel"},
                                        {"key", "n"},
                                        {"file", "test.sgm"},
                                        {"line", 3}}));
    EXPECT_EQ(table[3]["default"], 12);
    EXPECT_EQ(table[3]["unit"], "deg");
    EXPECT_EQ(table[4]["default"], nlohmann::json::array({1, 2, 3}));
    EXPECT_EQ(table[5]["choices"], nlohmann::json::array({"round", "square"}));
    EXPECT_EQ(table[6]["default"], "#c8b090");
    EXPECT_EQ(table[7]["default"], true);
    EXPECT_FALSE(table[1].contains("label"));
}

TEST(Panel, HasStartsStylesAndWays) {
    const Checked c = checkedBody(
        "param n = 2 in 1..9\nparam tint = #ff0000\nstart A -> cube size n color tint : Live\nstart B -> sphere size "
        "n\n"
        "rule R: Live -> + cube size 1 at +y\nderive left: R\nstyle default for B { n = 5 }\nstyle default { n = 3 }\n"
        "style Tall for A { n = 7 tint = #00ff00 }\nstyle Any { n = 1 }\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto panel = nlohmann::json::parse(panelJson(*c.grammar));
    EXPECT_EQ(panel["parameters"], nlohmann::json::parse(paramsJson(*c.grammar)));
    EXPECT_EQ(panel["starts"],
              nlohmann::json::parse(R"([{"name": "A", "values": {"n": 3}}, {"name": "B", "values": {"n": 5}}])"));
    EXPECT_EQ(panel["styles"],
              nlohmann::json::parse(R"([{"name": "Tall", "start": "A", "values": {"n": 7, "tint": "#00ff00"}},
                                                         {"name": "Any", "values": {"n": 1}}])"));
    EXPECT_EQ(panel["ways"], nlohmann::json::parse(R"(["left"])"));
}

}  // namespace
}  // namespace sgm::rules
