// The rule tree changed by clicks: parts of splits, rules and starts, and the selection that it shares with the shapes.
#include "tests/window/simulated_user.h"

namespace sgm::window::test {
namespace {

using Rules = SimulatedUser;

constexpr const char* front = R"(grammar 2
start Front -> size (4, 3, .5) Row
rule Row -> split x { 1m: cube | { ~1m: Bay }* | 1m: sphere } // bays
rule Bay -> split y {
    1m: cube   // the sill
  | ~1: cylinder
}
)";

/// `text` with the only `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST_F(Rules, PartsOfASplitAreChanged) {
    openText(front);
    click("rule.5.1m:");
    click("part.duplicate");
    EXPECT_EQ(text(), replaced(front, "// the sill\n", "// the sill\n  | 1m: cube\n"));
    click("part.down");
    EXPECT_EQ(text(), replaced(front, "  | ~1: cylinder\n", "  | ~1: cylinder\n  | 1m: cube\n"));
    click("part.delete");
    EXPECT_EQ(text(), front) << "the part goes, and not its rule";
    while (state()["undo"] != "") key("ctrl+z");
    click("rule.4.split y");
    fill("part.0.size", ".5m");
    click("part.add");
    click("part.up");
    EXPECT_EQ(text(), replaced(replaced(front, "1m: cube   //", ".5m: cube   //"), "  | ~1: cylinder\n",
                               "  | ~1: cube\n  | ~1: cylinder\n"))
        << "a part that is added is selected";
    while (state()["undo"] != "") key("ctrl+z");
    click("rule.4.split y");
    click("split.axis.x");
    EXPECT_EQ(text(), replaced(front, "split y", "split x"));
    key("ctrl+z");
    // What fills a part alone stands for it; a group repeats.
    click("rule.3.sphere");
    click("part.up");
    EXPECT_EQ(text(), replaced(front, "{ ~1m: Bay }* | 1m: sphere", "1m: sphere | { ~1m: Bay }*"));
    key("ctrl+z");
    click("rule.3.{ }*");
    fill("part.times", "2");
    EXPECT_EQ(text(), replaced(front, "}*", "}2"));
}

TEST_F(Rules, TextAndShapesAreOneSelection) {
    openText(
        "grammar 2\nstart Front -> size (4, 3, .5) Row\nrule Row -> split x { 1m: cube | ~1: sphere }\nrule Never when "
        "1 > 2 -> "
        "cube\n");
    click("rule.3.sphere");
    EXPECT_EQ(state()["selection"], "Front/Row/split/sphere");
    click("rule.4.Never");
    EXPECT_EQ(state()["selection"], "");
    EXPECT_NE(std::string(state()["notice"]).find("made no shape"), std::string::npos);
    click("shape.Front/Row/split/sphere");
    ASSERT_TRUE(has("edit.solid")) << "its row is selected";
    fill("edit.solid", "cylinder");
    until("the edited shape", [](const auto& s) { return s["selection"] == "Front/Row/split/cylinder"; });
    EXPECT_TRUE(has("edit.solid"));
    click("attribute.add");
    click("attribute.add.size");
    until("the shape", [](const auto& s) { return !s["busy"] && s["selection"] == "Front/Row/split/cylinder"; });
    EXPECT_TRUE(has("edit.solid"));
}

TEST_F(Rules, WordsArePicked) {
    const std::string before =
        "grammar 2\nmaterial oak color #885522\nstart A -> cube size 2 of oak + sphere color #aa5533 at +x\n";
    openText(before);
    click("rule.3.+ sphere");
    click("solid.words");
    EXPECT_TRUE(has("solid.words.torus"));
    click("solid.words.cylinder");
    EXPECT_EQ(text(), replaced(before, "sphere", "cylinder"));
    click("attribute.add");
    click("attribute.add.rough");
    EXPECT_EQ(text(), replaced(before, "sphere color #aa5533 at +x", "cylinder color #aa5533 at +x rough .8"));
    while (state()["undo"] != "") key("ctrl+z");
    click("rule.3.cube");
    click("of.words");
    EXPECT_TRUE(has("of.words.oak"));
    click("of.words.oak");
    click("attribute.add");
    click("attribute.add.split");
    EXPECT_EQ(text(), replaced(before, "cube size 2 of oak", "size 2 of oak split x { ~1: cube | ~1: cube }"));
    EXPECT_TRUE(has("part.1.size")) << "its parts are there to be changed";
    key("ctrl+z");
    // A colour that is dragged in its swatch is one entry.
    click("rule.3.+ sphere");
    click("swatch.color");
    const auto [x, y] = placeOf("swatch.color", .5, .5);
    for (const int by : {40, 70}) dragTo("swatch.color", x + by, y + 60);
    key("Escape");
    EXPECT_EQ(state()["undo"], "Change color");
}

TEST_F(Rules, ParametersAreMade) {
    openText("grammar 2\nstart House -> cube size (9, 3, .5)\n");
    fill("param.new", "tall = 4m in 1m..9m");  // Enter presses its button
    EXPECT_EQ(text(), "grammar 2\nparam tall = 4m in 1m..9m\nstart House -> cube size (9, 3, .5)\n");
    click("rule.3.cube");
    click("size.parameter");
    click("size.parameter.9");
    EXPECT_EQ(text(),
              "grammar 2\nparam tall = 4m in 1m..9m\nparam houseSize = 9m in 4.5m..18m\n"
              "start House -> cube size (houseSize, 3, .5)\n");
    until("its slider", [&](const auto&) { return has("param.houseSize"); });
    EXPECT_TRUE(has("edit.size")) << "the shape is still selected";
}

TEST_F(Rules, RulesAndStartsAreAdded) {
    openText("grammar 2\nstart House -> cube size 2\nrule A -> + cone at +y\n");
    fill("rule.new", "B -> + torus at +y");
    fill("rule.new", "C -> + cube at +y");
    EXPECT_EQ(text(),
              "grammar 2\nstart House -> cube size 2\nrule A -> + cone at +y\nrule B -> + torus at +y\n"
              "rule C -> + cube at +y\n")
        << "each behind the one before, which is selected";
    fill("rule.new", "start Shed -> cube");
    EXPECT_EQ(text().substr(0, 60), "grammar 2\nstart House -> cube size 2\nstart Shed -> cube\nrule");
}

}  // namespace
}  // namespace sgm::window::test
