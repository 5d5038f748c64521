// The verbs that window_test.cpp leaves: every one by a real click or key. docs/viewer.md lists which test drives
// which.
#include "tests/window/simulated_user.h"

#include <algorithm>
#include <fstream>

#include "tests/cpu_time.h"

namespace sgm::window::test {
namespace {

namespace fs = std::filesystem;
using Verbs = SimulatedUser;

constexpr const char* hall = R"(grammar 1
param wide = 2m in 1m..4m "Width" group Size key w
param tall = 3.0 in 1.0..5.0 "Height" group Size
param count = 2 in 1..9 "Columns" key n

start Hall -> cube size (4, tall, 4) : Base
rule Base -> + sphere size wide at +y : Ball + cylinder size (1, .2 * count, 1) at +x : Post
rule Ball -> + cylinder at +y : Cap
rule Ball weight 2 -> + cone at +y
style Low for Hall { tall = 2.0 }
derive one: Base#1 => Ball#1
)";

std::string lineOf(const std::string& text, int number) {
    size_t begin = 0;
    for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
    return text.substr(begin, text.find('\n', begin) - begin);
}

TEST_F(Verbs, RulesAndShapes) {
    openText(hall);
    // A rule is dragged above another by its head row; the derive line goes on meaning the same rule.
    dragTo("rule.9.Ball", placeOf("rule.8.Ball", 0.4, 0.2));
    EXPECT_EQ(lineOf(text(), 8), lineOf(hall, 9));
    EXPECT_EQ(lineOf(text(), 9), lineOf(hall, 8));
    EXPECT_EQ(lineOf(text(), 11), "derive one: Base#1 => Ball#2");
    shoot("reordered");
    key("ctrl+z");
    dragTo("rule.7.Base", placeOf("rule.9.Ball", 0.4, 0.9));
    EXPECT_EQ(lineOf(text(), 9), lineOf(hall, 7)) << "below the last one";
    key("ctrl+z");
    EXPECT_EQ(text(), hall);

    click("rule.7.+ sphere : Ball");
    fill("edit.solid", "morph(sphere, cube, .5)");
    EXPECT_NE(lineOf(text(), 7).find("-> + morph(sphere, cube, .5) size wide at +y : Ball"), std::string::npos);
    click("attribute.add");
    click("attribute.add.shift");
    fill("edit.shift", "(.2, 0, 0)");
    EXPECT_NE(lineOf(text(), 7).find("size wide at +y shift (.2, 0, 0) : Ball"), std::string::npos)
        << lineOf(text(), 7);
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), hall);

    // Shapes: folded, found again, filtered.
    ASSERT_TRUE(has("shape.Hall/Base/Ball"));
    click("shape.Hall/Base", 0.06);
    EXPECT_FALSE(has("shape.Hall/Base/Ball")) << "folded";
    click("shape.Hall/Base", 0.06);
    EXPECT_TRUE(has("shape.Hall/Base/Ball"));
    click("shapes.filter");
    type("Ball");
    EXPECT_FALSE(has("shape.Hall/Base/Post"));
    EXPECT_TRUE(has("shape.Hall/Base/Ball"));
    key("ctrl+a");
    key("BackSpace");
    key("Escape");
    EXPECT_TRUE(has("shape.Hall/Base/Post"));
    click("look.joints");
    click("look.joints.All joints");
    EXPECT_EQ(state()["look"]["joints"], 2);

    // A way, walked back and forward.
    click("tab.Step");
    click("step.way.one");
    const size_t whole = until("the way", [](const auto& s) { return s["stepping"] == true && !s["busy"]; })["shapes"];
    click("step.undo");
    until("a step back", [&](const auto& s) { return s["shapes"] < whole; });
    click("step.redo");
    until("a step forward", [&](const auto& s) { return s["shapes"] == whole; });
    click("step.end");

    // A problem leads to its line.
    click("tab.Text");
    click("line.9", 0.99);
    type(" colr red");
    until("a problem", [](const auto& s) { return !s["problems"].empty(); });
    key("Escape");
    click("problem.0");
    EXPECT_EQ(until("its place", [](const auto& s) { return s["textSelection"] != ""; })["textSelection"], "colr");
}

TEST_F(Verbs, StepsGoOnWhileTheTextIsWrong) {
    openText(hall);
    click("tab.Step");
    click("step.begin");
    const size_t shapes = until("the start", [](auto& s) { return s["stepping"] == true && !s["busy"]; })["shapes"];
    click("tab.Text");
    click("line.9", 0.99);
    type("(colr");  // wrong from its first letter on
    until("a problem", [](const auto& s) { return !s["problems"].empty(); });
    key("Escape");
    click("tab.Step");
    click("apply.Hall/Base.Base#1");
    click("live.Hall/Base/Post");
    EXPECT_EQ(state()["shapes"], shapes) << "no model has the step yet";
    click("tab.Text");
    click("line.9", 0.99);
    for (int i = 0; i < 5; ++i) key("BackSpace");
    const auto stepped = until("the step", [&](const auto& s) { return s["shapes"] > shapes; });
    EXPECT_EQ(stepped["selection"], "Hall/Base/Post");
}

TEST_F(Verbs, Parameters) {
    openText(hall);
    keys({"w", "w"});
    EXPECT_EQ(lineOf(text(), 2), "param wide = 2.3m in 1m..4m \"Width\" group Size key w")
        << "both steps count, though the model was late";
    keys({"n", "n", "n", "shift+n"});
    EXPECT_EQ(lineOf(text(), 4), "param count = 4 in 1..9 \"Columns\" key n");
    while (state()["undo"] != "") key("ctrl+z");

    click("choice.style");
    click("choice.style.Low");
    EXPECT_EQ(state()["choice"]["style"], "Low");
    drag("param.tall", 0.25, 0.5, 0.75, 0.5);
    EXPECT_EQ(lineOf(text(), 3), lineOf(hall, 3)) << "the style takes the value";
    EXPECT_NE(lineOf(text(), 10), lineOf(hall, 10));
    while (state()["undo"] != "") key("ctrl+z");
    EXPECT_EQ(text(), hall);
    EXPECT_EQ(state()["choice"]["style"], "");

    click("choice.way");
    click("choice.way.one");
    EXPECT_EQ(state()["choice"]["way"], "one");
    key("ctrl+z");
    click("seed");
    key("ctrl+a");
    type("7");
    key("Return");
    EXPECT_EQ(state()["seed"], 7);
    click("lock.wide");
    click("reroll");
    EXPECT_EQ(state()["seed"], 8);
    EXPECT_EQ(lineOf(text(), 2), lineOf(hall, 2)) << "locked";
    EXPECT_NE(lineOf(text(), 3), lineOf(hall, 3)) << "not locked";
    key("ctrl+z");
    EXPECT_EQ(text(), hall);
}

TEST_F(Verbs, AFieldIsEnteredAgain) {
    openText(hall);
    for (int turn = 0; turn < 2; ++turn) {
        holding("ctrl", [&] { click("param.tall"); });
        if (turn == 0) {
            type("1111111111");
        } else {
            for (int i = 0; i < 12; ++i) press("ctrl+z");  // of what was typed before nothing is left to undo
        }
        key("Return");
        EXPECT_EQ(lineOf(text(), 3), "param tall = 5.0 in 1.0..5.0 \"Height\" group Size");
    }
}

TEST_F(Verbs, TheView) {
    openText(hall);
    const auto cameraAfter = [&](auto&& act) {
        const nlohmann::json before = state();
        act();
        const nlohmann::json now = state();
        return std::pair(before["eye"] != now["eye"], before["at"] != now["at"]);
    };
    const std::pair turned(true, false), moved(true, true);
    holding("alt", [&] {
        EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7); }), turned) << "left";
        EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7, 2); }), moved) << "middle";
        EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.5, 0.7, 3); }), turned) << "right";
    });
    holding("shift", [&] { EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7); }), moved); });
    key("F1");
    click("navigation.Blender's");
    key("Escape");
    EXPECT_EQ(state()["look"]["navigation"], 1);
    holding("shift", [&] { EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.6, 0.7, 2); }), moved); });
    holding("ctrl", [&] { EXPECT_EQ(cameraAfter([&] { drag("view.field", 0.5, 0.8, 0.5, 0.7, 2); }), turned); });

    const auto width = [&](const char* widget) { return report()["widgets"][widget][2].get<double>(); };
    const double before = width("view.field");
    dragTo("left", placeOf("left", 12, 0.5));
    EXPECT_GT(before - width("view.field"), 40) << "the left panels are wider";
    dragTo("right", placeOf("right", 12, 0.5));
    EXPECT_NEAR(width("view.field"), before, 12) << "the right ones narrower";

    click("look.ground");
    EXPECT_EQ(state()["look"]["ground"], false);
    click("look.inside");
    EXPECT_GT(until("a place inside", [](const auto& s) { return s["lamp"] > 0; })["lamp"], 0);
    drawn();
    shoot("inside");
    click("look.inside");
    EXPECT_EQ(state()["lamp"], 0);

    click("pane.Mesh");
    until("a mesh", [](const auto& s) { return s["triangles"] > 1000; });
    click("mesh.cells");
    click("mesh.cells.64");
    EXPECT_LT(
        until("a coarser mesh", [](const auto& s) { return s["look"]["cells"] == 64 && !s["busy"]; })["triangles"],
        30000);
    for (int look = 1; const char* name : {"Normals", "Curvature", "Rules", "Components", "Labels", "Creases"}) {
        click("mesh.look");
        click(std::string("mesh.look.") + name);
        EXPECT_EQ(state()["look"]["mesh"], look++);
    }
    click("mesh.wire");
    EXPECT_EQ(state()["look"]["wire"], true);
    click("mesh.section");
    click("section.axis.z");
    drag("section.share", 0.5, 0.5, 0.9, 0.5);
    EXPECT_EQ(state()["look"]["axis"], 2);
    EXPECT_GT(state()["look"]["share"], 0.8);
    drawn();
    key("p");
    until("a picture of the mesh", [&](const auto&) { return fs::exists(folder / "test-1.png"); });

    click("pane.Fog");
    until(
        "fog", [](const auto& s) { return s["fog"] == true && s["drawn"] == true; }, 120);
    shoot("fog");
    key("t");
    until(
        "a turntable", [&](const auto&) { return fs::exists(folder / "test-turn-1/001.png"); }, 120);
    key("Escape");
    EXPECT_EQ(state()["turning"], false);
}

TEST_F(Verbs, AMeshFollowsTheHand) {
    openText(hall);
    click("pane.Split");
    const int before = until("a mesh", [](const auto& s) {
        return s["triangles"] > 1000 && !s["busy"] && s["preview"] == false;
    })["triangles"];
    hold("param.tall", [&] {
        until(
            "the GPU's mesh", [](const auto& s) { return s["preview"] == true; }, 60);
    });
    const auto after = until("the real mesh", [](const auto& s) { return s["preview"] == false && !s["busy"]; });
    EXPECT_GT(after["triangles"], before / 2);
}

TEST_F(Verbs, EveryFormatIsExported) {
    openText("grammar 1\nstart A -> sphere size 2 + cube at +x\n");
    click("tab.Export");
    click("export.format");
    std::vector<std::string> formats;
    const nlohmann::json widgets = report()["widgets"];
    for (const auto& [name, box] : widgets.items())
        if (name.starts_with("export.format..")) formats.push_back(name);
    EXPECT_GE(formats.size(), 7u);
    ASSERT_FALSE(formats.empty());
    click(formats.front());
    drag("export.cells", 0.5, 0.5, 0.05, 0.5);
    for (const std::string& format : formats) {
        click("export.format");
        click(format);
        const std::string extension = format.substr(14, format.find(' ') - 14);
        click("export.export");
        // A plan is of a town, which this isn't.
        const bool isPlan = extension == ".svg" || extension == ".geojson";
        until("a file of " + extension, [&](const auto& s) {
            const std::string notice = s["notice"];
            return isPlan ? notice.find("no plan") != std::string::npos : notice.ends_with("test" + extension);
        });
        if (isPlan) continue;
        EXPECT_GT(fs::file_size(folder / ("test" + extension)), 100u) << extension;
    }
}

TEST_F(Verbs, APictureThatCantBeWrittenIsTriedOnce) {
    const fs::path gone = folder / "gone";
    fs::create_directory(gone);
    openText("grammar 1\nstart A -> sphere\n", "gone/test.sgm");
    drawn();
    fs::remove_all(gone);
    for (const auto& [asked, name] : {std::pair{"p", ".png"}, {"t", "turn-1"}}) {
        press(asked);
        until("the word that a picture can't be written", [&, part = name](const auto& s) {
            return std::string(s["notice"]).find(part) != std::string::npos && s["turning"] == false;
        });
        settled();
    }
    fs::create_directory(gone);
    settled();
    EXPECT_TRUE(fs::is_empty(gone));
}

TEST_F(Verbs, FilesAreOpened) {
    openText(hall);
    std::ofstream(folder / "other.sgm") << "grammar 1\nstart Other -> torus\n";
    key("ctrl+o");
    shoot("open");
    click("open.other.sgm");
    until("the other file", [](const auto& s) { return s["text"] == "grammar 1\nstart Other -> torus\n"; });
    dropFile(folder / "test.sgm");
    until("the dropped file", [](const auto& s) { return s["text"] == hall; });
    click("tab.Export");
    dropFile(folder / "other.sgm");
    until("the other file again", [](const auto& s) { return s["text"] != hall && !s["busy"]; });
    drag("export.cells", 0.5, 0.5, 0.05, 0.5);
    click("export.export");
    EXPECT_TRUE(
        std::string(
            until("its mesh", [](const auto& s) { return std::string(s["notice"]).starts_with("Wrote "); })["notice"])
            .ends_with("other.glb"));
    dropFile(folder / "test.sgm");
    until("the first file again", [](const auto& s) { return s["text"] == hall && !s["busy"]; });
    click("param.tall", 0.9);
    dropFile(folder / "other.sgm");
    until("a question, for there is unsaved work", [](const auto& s) { return s["question"] != ""; });
    click("answer.Stay");
    EXPECT_NE(text(), hall);
    EXPECT_EQ(state()["dirty"], true);
}

TEST_F(Verbs, WorkIsCancelled) {
    openText(
        "grammar 1\nparam n = 1 in 1..60000\nstart A -> cube : B\nrule B repeat n -> + sphere size .9 ~> .2 on any(+x) "
        "at free(+x, +y, +z) : B\n");
    const int shapes = state()["shapes"];
    poke("param.n", 0.97);
    until("work", [&](const auto& s) { return s["busy"] == true && has("progress.cancel"); });
    poke("progress.cancel");
    until("rest", [](const auto& s) { return !s["busy"] && std::string(s["notice"]).starts_with("Cancelled"); });
    key("ctrl+z");
    until("the small model", [&](const auto& s) { return s["shapes"] == shapes && !s["busy"]; });

    // While the slider is dragged the key does it, unless the work is done before the key comes: then again.
    const auto ended = [](const auto& s) { return s["shapes"] > 30000; };
    const auto cancelled = [](const auto& s) { return std::string(s["notice"]).starts_with("Cancelled"); };
    bool stopped = false;
    for (int tries = 0; tries < 10 && !stopped; ++tries)
        dragAtWork("param.n", 0.97, [&] {
            until("work on what the slider says",
                  [&](const auto& s) { return ended(s) || (s["busy"] == true && s["notice"] == "Set n"); });
            press("Escape");
            stopped = cancelled(
                until("rest in the hand", [&](const auto& s) { return !s["busy"] && (cancelled(s) || ended(s)); }));
        });
    EXPECT_TRUE(stopped);
}

TEST_F(Verbs, MemoryOfLargerModelsIsGivenBack) {
    if (isSanitized) GTEST_SKIP() << "instrumented programs keep what was freed for a while";
    openText(
        "grammar 1\nparam n = 1 in 1..20000\nstart A -> cube : B\nrule B repeat n -> + sphere size .9 ~> .2 on any(+x) "
        "at free(+x, +y, +z) : B\n");
    drawn();
    const size_t before = residentBytes();
    size_t most = before;
    for (int turn = 0; turn < 3; ++turn) {
        click("param.n", 0.97);
        until(
            "a large model", [](const auto& s) { return s["shapes"] > 10000 && !s["busy"]; }, 60);
        most = std::max(most, residentBytes());
        key("ctrl+z");
        until("the small model", [](const auto& s) { return s["shapes"] < 10 && !s["busy"]; });
    }
    size_t after = 0;
    until(
        "memory at rest", [&](const auto&) { return (after = residentBytes()) < before + (most - before) / 2; }, 10);
    RecordProperty(
        "MiB", std::to_string(before >> 20) + ", " + std::to_string(most >> 20) + ", " + std::to_string(after >> 20));
}

TEST_F(Verbs, AnExportGoesOnWhileOneWorks) {
    openText("grammar 1\nstart A -> sphere size 2 + cube at +x\n");
    click("tab.Export");
    drag("export.cells", 0.5, 0.5, 0.2, 0.5);
    poke("export.export");
    click("tab.Rules");
    until("the word that it is written", [](const auto& s) { return std::string(s["notice"]).starts_with("Wrote "); });
    EXPECT_FALSE(has("export.cancel"));
    click("tab.Export");
    drag("export.cells", 0.2, 0.5, 0.99, 0.5);
    fill("export.file", (folder / "large.ply").string());
    EXPECT_FALSE(has("export.uv")) << "the file's ending chooses the format, and with it the options";
    until("a way to stop it", [&](const auto&) { return has("export.cancel"); });
    poke("export.cancel");
    until("its end", [&](const auto& s) { return s["notice"] == "cancelled" && !has("export.cancel"); });
    EXPECT_FALSE(fs::exists(folder / "large.ply"));
}

}  // namespace
}  // namespace sgm::window::test
