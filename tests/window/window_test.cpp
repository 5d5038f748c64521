// The window driven by hand: every verb by a real click or key, asserted on text, tree or file.
#include "tests/window/simulated_user.h"

#include <fstream>
#include <sstream>

namespace sgm::window::test {
namespace {

using Window = SimulatedUser;

/// Lines that differ, from 1; −1 where the texts have other numbers of lines.
std::vector<int> changedLines(const std::string& a, const std::string& b) {
    std::vector<int> changed;
    std::istringstream left(a), right(b);
    std::string x, y;
    for (int line = 1;; ++line) {
        const bool more = static_cast<bool>(std::getline(left, x)), also = static_cast<bool>(std::getline(right, y));
        if (more != also) return {-1};
        if (!more) return changed;
        if (x != y) changed.push_back(line);
    }
}

std::string lineOf(const std::string& text, int number) {
    std::istringstream in(text);
    std::string line;
    for (int i = 0; i < number; ++i) std::getline(in, line);
    return line;
}

constexpr const char* pair = R"(grammar 1
// Two solids that meet; comments stay.
param wide = 2m in 1m..4m "Width" group Size key w
param round = false "Round"   // a switch

start Pair -> cube size (wide, 2, 2) : Base
rule R0: Base -> + sphere size 1.5 at +x : Ball   // the ball
rule R1: Ball -> + cylinder size 1 at +y : Cap
rule R2: Cap when not round -> cone
)";

TEST_F(Window, ACaveIsChangedByHandAndTakenBack) {
    open("examples/grotto.sgm");
    const std::string original = text();
    drawn();
    shoot("1-opened");

    drag("param.cells", 0.16, 0.5, 0.55, 0.5);
    const std::string slid = until("a moved slider", [&](const auto& s) { return s["text"] != original; })["text"];
    EXPECT_EQ(changedLines(original, slid), std::vector{7});
    EXPECT_EQ(state()["undo"], "Set cells") << "a drag is one entry";
    EXPECT_GT(settled()["shapes"], 30) << "more rules, more shapes";
    shoot("2-slid");

    const std::string grown = "rule.26.+ morph(sphere, cube, 0..square) : Cell";
    click(grown);
    click("op.-");
    EXPECT_EQ(lineOf(text(), 26),
              "  -> - morph(sphere, cube, 0..square) size wide ~> narrow at free(+x, +x, +z, -z) to centre");
    shoot("3-cut");

    click("joint.+y");
    EXPECT_EQ(lineOf(text(), 26), "  -> - morph(sphere, cube, 0..square) size wide ~> narrow at +y to centre");
    EXPECT_EQ(changedLines(slid, text()), std::vector{26});
    shoot("4-retargeted");

    click("tab.Step");
    click("step.begin");
    const size_t before =
        until("the start", [](const auto& s) { return s["stepping"] == true && s["shapes"] < 8; })["shapes"];
    click("live.Grotto/rock/Cave");
    EXPECT_EQ(state()["selection"], "Grotto/rock/Cave");
    click("apply.Grotto/rock/Cave.Cave#1");
    until("a step", [&](const auto& s) { return s["shapes"] > before; });
    shoot("5-stepped");
    click("step.undo");
    until("a step back", [&](const auto& s) { return s["shapes"] == before; });
    click("step.end");

    for (int i = 0; i < 3; ++i) key("ctrl+z");
    EXPECT_EQ(text(), original) << "all is taken back";
    EXPECT_EQ(state()["dirty"], false);
    key("ctrl+y");
    EXPECT_EQ(text(), slid);
    key("ctrl+s");
    EXPECT_EQ(fileText(), slid);
    EXPECT_EQ(state()["dirty"], false);
    drawn();
    shoot("6-saved");
}

TEST_F(Window, HandsMoveTheCamera) {
    openText(pair);
    const auto cameraAfter = [&](auto&& act) {
        const nlohmann::json before = state();
        act();
        const nlohmann::json now = state();
        return std::pair(before["eye"] != now["eye"], before["at"] != now["at"]);
    };
    const std::pair turned(true, false), moved(true, true), still(false, false);
    EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7); }), turned) << "left button";
    EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7, 2); }), moved) << "middle button";
    EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.5, 0.7, 3); }), turned) << "right button comes nearer";
    EXPECT_EQ(cameraAfter([&] { wheel("view.field", 2); }), turned);
    EXPECT_EQ(cameraAfter([&] { click("view.field", 0.5, 0.95); }), still) << "a click is no drag";
    for (const char* turns : {"s", "a", "d", "k"}) EXPECT_EQ(cameraAfter([&] { key(turns); }), turned) << turns;
    EXPECT_EQ(cameraAfter([&] { key("Home"); }).first, true);
    key("1");
    const auto front = state();
    EXPECT_NEAR(front["eye"][0].get<double>(), front["at"][0].get<double>(), 1e-6);
    EXPECT_GT(front["eye"][2], front["at"][2]);
    key("5");
    const auto top = state();
    EXPECT_GT(top["eye"][1].get<double>() - top["at"][1].get<double>(), 3);
    for (const char* view : {"2", "3", "4", "6", "7"}) EXPECT_EQ(cameraAfter([&] { key(view); }), turned) << view;
    key("1");
    EXPECT_EQ(cameraAfter([&] { key("Home"); }).first, true);
    click("shape.Pair/Base/Ball");
    EXPECT_EQ(cameraAfter([&] { key("f"); }), moved);
    key("F1");
    until("the sheet", [&](const auto&) { return has("help"); });
    shoot("sheet");
    click("navigation.Blender's");
    key("Escape");
    EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7); }), still)
        << "Blender's left button only selects";
    EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7, 2); }), turned);
}

TEST_F(Window, WhatIsSeenLeadsToItsTextAndBack) {
    openText(pair);
    click("tab.Text");
    key("1");
    drawn();
    // From the front the cube is on the left, the ball beside it.
    point("view.field", 0.32, 0.55);
    until("a label", [](const auto& s) { return std::string(s["hover"]).find("test.sgm:6") != std::string::npos; });
    click("view.field", 0.32, 0.55);
    EXPECT_EQ(state()["selection"], "Pair/Base");
    EXPECT_EQ(until("its text", [](const auto& s) { return s["textSelection"] != ""; })["textSelection"],
              "cube size (wide, 2, 2) : Base");
    shoot("picked");
    click("line.7", 0.55);
    EXPECT_EQ(state()["selection"], "Pair/Base/Ball") << "the place in the text that made it";
    click("shape.Pair/Base/Ball/Cap");
    EXPECT_EQ(until("the text",
                    [](const auto& s) { return s["textSelection"] == "+ cylinder size 1 at +y : Cap"; })["selection"],
              "Pair/Base/Ball/Cap");
    click("look.joints");
    click("look.joints.All joints");
    shoot("joints");
}

TEST_F(Window, MeshAndFieldSideBySide) {
    openText(pair);
    click("pane.Split");
    click("mesh.cells");
    click("mesh.cells.64");
    until("a mesh", [](const auto& s) { return s["triangles"] > 1000 && s["drawn"] == true; });
    shoot("split");
    click("pane.Mesh");
    for (const char* look : {"Normals", "Curvature", "Rules", "Components", "Labels", "Creases"}) {
        click("mesh.look");
        click(std::string("mesh.look.") + look);
        drawn();
        shoot(look);
    }
    click("mesh.wire");
    click("mesh.section");
    click("section.axis.z");
    drag("section.share", 0.5, 0.5, 0.6, 0.5);
    drawn();
    shoot("section");
}

TEST_F(Window, TextIsTyped) {
    openText(pair);
    const size_t shapes = state()["shapes"];
    click("tab.Text");
    click("line.9", 0.99);
    type(" colr #ff0000");
    const auto wrong = until("a problem", [](const auto& s) { return !s["problems"].empty(); });
    EXPECT_EQ(wrong["problems"][0]["line"], 9);
    EXPECT_EQ(wrong["shapes"], shapes) << "the last good model stays";
    shoot("problem");
    for (int i = 0; i < 10; ++i) key("BackSpace");
    type("lor #ff0000");
    EXPECT_EQ(until("no problem", [](const auto& s) { return s["problems"].empty(); })["text"],
              std::string(pair).insert(std::string(pair).size() - 1, " color #ff0000"));
    key("Escape");
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), pair);
}

TEST_F(Window, RulesAreChangedByClicks) {
    openText(pair);
    click("rule.8.R1: Ball");
    click("rule.duplicate");
    EXPECT_EQ(changedLines(pair, text()), std::vector{-1}) << "a line more";
    key("ctrl+z");
    click("rule.8.R1: Ball");
    click("rule.up");
    EXPECT_EQ(lineOf(text(), 7), lineOf(pair, 8));
    key("ctrl+z");
    click("rule.8.R1: Ball");
    fill("edit.when", "wide > 1.5m");
    EXPECT_EQ(lineOf(text(), 8), "rule R1: Ball when wide > 1.5m -> + cylinder size 1 at +y : Cap");
    fill("edit.weight", "3");
    EXPECT_EQ(lineOf(text(), 8), "rule R1: Ball when wide > 1.5m weight 3 -> + cylinder size 1 at +y : Cap");
    fill("edit.repeat", "2");
    EXPECT_NE(lineOf(text(), 8).find("repeat 2"), std::string::npos);
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), pair);
    click("rule.7.+ sphere : Ball");
    click("op.morph");
    EXPECT_NE(lineOf(text(), 7).find("morph sphere"), std::string::npos);
    key("ctrl+z");
    fill("edit.solid", "cylinder");
    EXPECT_EQ(lineOf(text(), 7), "rule R0: Base -> + cylinder size 1.5 at +x : Ball   // the ball");
    click("attribute.add");
    click("attribute.add.shift");
    EXPECT_NE(lineOf(text(), 7).find(" shift "), std::string::npos);
    shoot("rules");
    key("ctrl+z");
    key("ctrl+z");
    click("element.delete");
    EXPECT_FALSE(std::string(state()["notice"]).empty());
    while (state()["undo"] != "") key("ctrl+z");
    fill("rule.new", "Cap -> sphere");  // Enter presses the button
    EXPECT_NE(text().find("rule Cap -> sphere\n"), std::string::npos);
    click("rule.9.R1: Ball");  // the new one stands before it
    click("rule.delete");
    EXPECT_EQ(text().find("rule R1"), std::string::npos);
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), pair);
}

TEST_F(Window, AShapeIsDraggedOntoAJoint) {
    openText(pair);
    // Joints show while something is dragged.
    const auto drop = [&](const std::string& shape, const char* joint) {
        nlohmann::json place;
        hold(shape, [&] {
            until("the joints",
                  [&](const auto&) { return !(place = report()["widgets"].value(joint, nlohmann::json())).is_null(); });
        });
        dragTo(shape, static_cast<int>(place[0].get<double>() + place[2].get<double>() / 2),
               static_cast<int>(place[1].get<double>() + place[3].get<double>() / 2));
    };
    drop("shape.Pair/Base/Ball", "joint.Pair/Base.+y");
    EXPECT_EQ(lineOf(text(), 7), "rule R0: Base -> + sphere size 1.5 at +y : Ball   // the ball");
    // On a shape that its rule doesn't match: why not, and what to write.
    const std::string before = text();
    drop("shape.Pair/Base/Ball/Cap", "joint.Pair/Base.+z");
    EXPECT_EQ(text(), before);
    EXPECT_NE(std::string(state()["notice"]).find("write 'rule Base -> + cylinder size 1 at +z : Cap' for one there"),
              std::string::npos)
        << state()["notice"];
}

TEST_F(Window, ParametersLocksStylesAndKeys) {
    openText(pair);
    key("w");
    EXPECT_NE(lineOf(text(), 3), lineOf(pair, 3)) << "a hotkey steps";
    key("shift+w");
    EXPECT_EQ(lineOf(text(), 3), lineOf(pair, 3)) << "Shift goes back";
    click("param.round");
    EXPECT_EQ(lineOf(text(), 4), "param round = true \"Round\"   // a switch");
    click("lock.wide");
    EXPECT_EQ(state()["locked"], nlohmann::json({"wide"}));
    click("reroll");
    EXPECT_EQ(lineOf(text(), 3), lineOf(pair, 3)) << "locked";
    EXPECT_EQ(state()["seed"], 2);
    click("style.name");
    type("Mine");
    click("style.save");
    EXPECT_NE(text().find("style Mine for Pair {"), std::string::npos);
    shoot("style");
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), pair);
    EXPECT_EQ(state()["seed"], 1);
}

TEST_F(Window, AFastHandLosesNothing) {
    openText(pair);
    // All of it falls into few frames.
    burst("param.round", {"ctrl+z", "ctrl+y", "ctrl+z", "ctrl+y", "ctrl+z"});
    EXPECT_EQ(text(), pair);
    EXPECT_EQ(state()["redo"], "Set round");
    burst("param.round", {"ctrl+z", "ctrl+y"});
    EXPECT_EQ(lineOf(text(), 4), "param round = true \"Round\"   // a switch");
    for (int i = 0; i < 5; ++i) {
        poke("tab.Text");
        until(
            "the text", [&](const auto&) { return has("text"); }, 5);
        poke("tab.Rules");
        until(
            "the rules", [&](const auto&) { return !has("text"); }, 5);
    }
}

TEST_F(Window, ADerivationByHandIsKept) {
    openText(pair);
    click("tab.Step");
    click("step.begin");
    until("the start", [](const auto& s) { return s["stepping"] == true && s["shapes"] <= 2; });
    key("1");
    click("view.field", 0.5, 0.5);  // picked in the view
    click("apply.Pair/Base.R0");
    until("the ball", [](const auto& s) { return s["shapes"] > 2; });
    click("step.rest");
    fill("step.name", "mine");
    EXPECT_NE(text().find("derive mine: R0 => R1 => R2"), std::string::npos) << text();
    shoot("way");
    click("step.end");
    EXPECT_EQ(settled()["stepping"], false);
}

TEST_F(Window, FilesAreWritten) {
    openText(pair);
    key("p");
    until("a picture", [&](const auto&) { return std::filesystem::exists(folder / "test-1.png"); });
    click("tab.Export");
    click("export.format");
    const auto widgets = report()["widgets"];
    for (const auto& [name, box] : widgets.items())
        if (name.starts_with("export.format..ply")) click(name);
    drag("export.cells", 0.5, 0.5, 0.1, 0.5);
    click("export.keep");
    click("export.keep.largest");
    shoot("export");
    click("export.export");
    until("a mesh", [&](const auto&) { return std::filesystem::exists(folder / "test.ply"); });
    EXPECT_GT(std::filesystem::file_size(folder / "test.ply"), 1000u);
    key("t");
    until("a turntable", [&](const auto&) { return std::filesystem::exists(folder / "test-turn-1/001.png"); });
    key("Escape");
}

TEST_F(Window, NothingIsLost) {
    openText(pair);
    click("param.round");
    const std::string changed = text();
    ASSERT_NE(changed, pair);
    // Another program writes the file meanwhile: a question, and neither side is lost.
    std::ofstream(file) << pair << "// from outside\n";
    until("a question", [](const auto& s) { return s["question"] != ""; });
    shoot("question");
    click("answer.Keep mine");
    EXPECT_EQ(text(), changed);
    kill();
    // Another file has nothing to do with it: no question, but a word.
    const std::filesystem::path changedFile = file;
    openText("grammar 1\nstart Other -> torus\n", "other.sgm");
    EXPECT_EQ(state()["question"], "");
    EXPECT_NE(std::string(state()["notice"]).find("test.sgm"), std::string::npos) << state()["notice"];
    kill();
    file = changedFile;
    start();
    until("an offer", [](const auto& s) { return s["question"] != ""; });
    shoot("recovered");
    click("answer.Go on with it");
    EXPECT_EQ(text(), changed);
    EXPECT_EQ(state()["dirty"], true);
}

TEST_F(Window, AChangeFromOutsideIsTakenOver) {
    openText(pair);
    drag("view.field", 0.5, 0.8, 0.6, 0.7);
    click("shape.Pair/Base/Ball");
    const auto before = state();
    std::ofstream(file) << pair << "// from outside\n";
    const auto now =
        until("the new text", [](const auto& s) { return std::string(s["text"]).ends_with("// from outside\n"); });
    EXPECT_EQ(settled()["eye"], before["eye"]);
    EXPECT_EQ(state()["selection"], before["selection"]);
}

}  // namespace
}  // namespace sgm::window::test
