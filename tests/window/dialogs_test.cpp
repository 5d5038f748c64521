// Dialogs and the keys that they take. docs/viewer.md lists which test drives what.
#include "tests/window/simulated_user.h"

#include <fstream>
#include <sstream>

namespace sgm::window::test {
namespace {

namespace fs = std::filesystem;
using Dialogs = SimulatedUser;

constexpr const char* ball = R"(grammar 1
param wide = 2m in 1m..4m "Width" key w
param round = false "Round"
start Ball -> sphere size wide
)";

std::string contentOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

TEST_F(Dialogs, SaveAsAsksBeforeItReplacesAFile) {
    openText(ball);
    const fs::path other = folder / "other.sgm";
    std::ofstream(other) << "precious";
    key("ctrl+shift+s");
    until("a dialog", [&](const auto&) { return has("save.name"); });
    key("ctrl+a");
    type(other.string());  // its field takes keys at once
    key("Return");
    until("a question", [&](const auto&) { return has("save.replace"); });
    shoot("question");
    EXPECT_EQ(contentOf(other), "precious");
    click("save.keep");
    until("the name again", [&](const auto&) { return has("save.save"); });
    EXPECT_EQ(contentOf(other), "precious");
    click("save.save");
    click("save.replace");
    until("the file", [&](const auto&) { return !has("save.name"); });
    EXPECT_EQ(contentOf(other), ball);
    click("param.round");
    key("ctrl+s");
    EXPECT_EQ(contentOf(other), text()) << "the document's file from then on";
    EXPECT_EQ(fileText(), ball) << "the one before stays";
    // Its own name is no question.
    key("ctrl+shift+s");
    key("Return");
    EXPECT_FALSE(has("save.name"));
    // A name that can't be written keeps the dialog.
    key("ctrl+shift+s");
    key("ctrl+a");
    type((folder / "none" / "a.sgm").string());
    key("Return");
    EXPECT_TRUE(has("save.name"));
    key("Escape");
    until("no dialog", [&](const auto&) { return !has("save.name"); });
}

TEST_F(Dialogs, TakeAllKeys) {
    openText(ball);
    const auto nothingHappens = [&] {
        for (const char* each : {"w", "t", "p", "5", "Home", "ctrl+z"}) key(each);
        EXPECT_EQ(state()["turning"], false);
        EXPECT_EQ(text(), ball);
        EXPECT_FALSE(fs::exists(folder / "test-1.png"));
    };
    const auto eye = state()["eye"];
    key("ctrl+shift+s");
    click("save.cancel", 4, 0.5);  // beside it: no field takes the keys
    nothingHappens();
    key("Escape");
    until("no dialog", [&](const auto&) { return !has("save.name"); });
    key("ctrl+o");
    until("a dialog", [&](const auto&) { return has("open.cancel"); });
    click("open.cancel", 4, 0.5);
    nothingHappens();
    key("Escape");
    until("no dialog", [&](const auto&) { return !has("open.cancel"); });
    EXPECT_EQ(state()["eye"], eye);
    click("param.round");
    std::ofstream(file) << ball << "// from outside\n";
    until("a question", [](const auto& s) { return s["question"] != ""; });
    const std::string changed = text();
    for (const char* each : {"w", "t", "5", "ctrl+z", "Escape"}) key(each);
    EXPECT_EQ(state()["turning"], false);
    EXPECT_EQ(text(), changed);
    EXPECT_NE(state()["question"], "") << "no answer leaves all as it is";
    click("answer.Keep mine");
    // The text that took keys before takes none either.
    click("tab.Text");
    click("line.4", 0.99);
    key("ctrl+shift+s");
    click("save.cancel", 4, 0.5);
    key("x");
    key("Escape");
    EXPECT_EQ(text(), changed);
}

TEST_F(Dialogs, FilesAreOpenedByTheirPaths) {
    openText(ball);
    const fs::path other = folder / "below" / "other.sgm";
    fs::create_directory(folder / "below");
    std::ofstream(other) << "grammar 1\nstart Other -> torus\n";
    key("ctrl+o");
    until("a dialog", [&](const auto&) { return has("open.folder"); });
    key("ctrl+a");
    type((folder / "below" / "non.sgm").string());
    key("Return");
    EXPECT_TRUE(has("open.folder")) << "there is no such file";
    click("open.folder", 0.9);
    key("ctrl+a");
    type((folder / "below" / "oth").string());
    until("what begins so", [&](const auto&) { return has("open.other.sgm"); });
    type("er.sgm");
    key("Return");
    until("the file", [](const auto& s) { return s["text"] == "grammar 1\nstart Other -> torus\n"; });
    EXPECT_FALSE(has("open.folder"));
}

TEST_F(Dialogs, AListIsClosedByEscape) {
    openText(ball);
    click("look.joints");
    until("the list", [&](const auto&) { return has("look.joints.All joints"); });
    key("w");
    EXPECT_EQ(text(), ball) << "the list takes the keys";
    key("Escape");
    EXPECT_FALSE(has("look.joints.All joints"));
}

TEST_F(Dialogs, AClosedWindowAsksAtOnce) {
    openText(ball);
    click("param.round");
    settled();
    requestClose();
    until(
        "a question", [&](const auto& s) { return s["question"] != "" && has("answer.Stay"); }, 5);
    key("Escape");
    EXPECT_EQ(state()["question"], "");
    EXPECT_EQ(state()["dirty"], true);
}

TEST_F(Dialogs, ACommandEndsAFieldFirst) {
    openText(ball);
    click("rule.4.sphere");
    click("edit.solid", 0.3);
    key("ctrl+a");
    type("torus");
    key("ctrl+s");
    EXPECT_EQ(fileText(), std::string(ball).replace(std::string(ball).find("sphere"), 6, "torus"));
    EXPECT_EQ(state()["dirty"], false);
    holding("ctrl", [&] { click("param.wide"); });
    key("ctrl+a");
    type("3");
    key("ctrl+s");
    EXPECT_NE(fileText().find("wide = 3"), std::string::npos) << fileText();
}

TEST_F(Dialogs, EnterPressesTheButtonOfItsField) {
    openText(ball);
    fill("style.name", "Mine");
    EXPECT_NE(text().find("style Mine for Ball {"), std::string::npos);
    fill("rule.new", "Ball -> cube");
    EXPECT_NE(text().find("rule Ball -> cube"), std::string::npos);
    EXPECT_EQ(text().find("rule Ball -> cube"), text().rfind("rule Ball -> cube")) << "once";
}

TEST_F(Dialogs, WhatIsRefusedStaysInItsField) {
    openText(ball);
    click("rule.4.sphere");
    fill("edit.solid", "sphere(");
    EXPECT_EQ(text(), ball);
    EXPECT_TRUE(has("refused")) << "the reason stands below";
    shoot("refused");
    click("edit.solid", 0.9);
    key("End");
    key("BackSpace");
    key("Return");
    EXPECT_FALSE(has("refused"));
    EXPECT_EQ(text(), ball) << "the text that was there";
    click("edit.solid", 0.9);
    key("End");
    type("(");
    key("ctrl+s");
    EXPECT_NE(std::string(state()["notice"]).find("refused"), std::string::npos) << state()["notice"];
    click("edit.solid", 0.9);
    key("ctrl+a");
    type("torus");
    key("Return");
    EXPECT_NE(text().find("-> torus size"), std::string::npos) << text();
    EXPECT_FALSE(has("refused"));
    fill("edit.solid", "(");
    EXPECT_TRUE(has("refused"));
    key("Escape");
    EXPECT_FALSE(has("refused"));
    click("edit.solid", 0.9);
    key("ctrl+s");
    EXPECT_NE(text().find("-> torus size"), std::string::npos) << "Esc gave it up";
}

TEST_F(Dialogs, ExportAsksBeforeItReplacesAFile) {
    openText(ball);
    std::ofstream(folder / "test.ply") << "precious";
    click("tab.Export");
    drag("export.cells", 0.5, 0.5, 0.05, 0.5);
    fill("export.file", (folder / "test.ply").string());  // Return at its end presses the button
    until("a question", [](const auto& s) { return s["question"] != ""; });
    click("answer.Cancel");
    EXPECT_EQ(contentOf(folder / "test.ply"), "precious");
    click("export.export");
    click("answer.Replace");
    const auto wrote = [](const auto& s) { return std::string(s["notice"]).starts_with("Wrote ") && !s["busy"]; };
    until("the mesh", wrote);
    EXPECT_NE(contentOf(folder / "test.ply"), "precious");
    click("export.export");
    until("the mesh again, without a question", wrote);
    EXPECT_EQ(state()["question"], "");
}

TEST_F(Dialogs, AnExportIsNeverOfAnotherText) {
    openText(ball);
    const fs::path broken = folder / "broken.sgm";
    std::ofstream(broken) << "grammar 1\nstart A -> cube size (1\n";
    key("ctrl+o");
    until("a dialog", [&](const auto&) { return has("open.folder"); });
    key("ctrl+a");
    type(broken.string());
    key("Return");
    until("the file", [](const auto& s) { return std::string(s["text"]).find("cube size (1") != std::string::npos; });
    click("tab.Export");
    drag("export.cells", 0.5, 0.5, 0.05, 0.5);
    const auto isRefused = [](const auto& s) {
        return s["notice"] == "What is shown is older than the text: nothing is written (see Problems)";
    };
    fill("export.file", (folder / "broken.ply").string());
    until("a refusal", isRefused);
    EXPECT_FALSE(fs::exists(folder / "broken.ply"));
    // The text of the same file, once it is corrected, and broken again.
    std::ofstream(broken) << ball;
    until("the file", [](const auto& s) { return s["text"] == ball && !s["busy"]; });
    click("export.export");
    until("the mesh", [](const auto& s) { return std::string(s["notice"]).starts_with("Wrote ") && !s["busy"]; });
    fs::remove(folder / "broken.ply");
    std::ofstream(broken) << "grammar 1\nstart Ball -> spher\n";
    until("the file", [](const auto& s) { return std::string(s["text"]).ends_with("spher\n") && !s["busy"]; });
    click("export.export");
    until("a refusal", isRefused);
    EXPECT_FALSE(fs::exists(folder / "broken.ply"));
}

TEST_F(Dialogs, ATurntableLeavesTheOneBefore) {
    openText(ball);
    drawn();
    for (const char* name : {"test-turn-1", "test-turn-2"}) {
        key("t");
        until(
            "a turntable", [&](const auto&) { return fs::exists(folder / name / "001.png"); }, 120);
        key("Escape");
        until("its end", [](const auto& s) { return s["turning"] == false; });
    }
    EXPECT_FALSE(fs::exists(folder / "test-turn-3"));
}

TEST_F(Dialogs, ANewNameBeginsAGrammar) {
    file = folder / "fresh.sgm";
    start();
    EXPECT_EQ(text().substr(0, 9), "grammar 2");
    EXPECT_EQ(state()["notice"], "fresh.sgm is new: Ctrl+S writes the file");
    EXPECT_EQ(state()["dirty"], false);
    settled();
    shoot("fresh");
    EXPECT_FALSE(fs::exists(file)) << "saved only when the user saves";
    EXPECT_EQ(state()["new"], true);
    click("bar.save");
    until("the file", [&](const auto&) { return fs::exists(file); });
    EXPECT_EQ(fileText(), text());
    until("its name alone", [](const auto& s) { return s["new"] == false; });
}

TEST_F(Dialogs, AProblemOfAUsedFileOpensIt) {
    std::ofstream(folder / "parts.sgm") << "grammar 2\nrule Wall -> cube size 2 - cube size 1 move (9, 0, 0)\n";
    openText("grammar 2\nuse \"parts.sgm\"\nstart A -> Wall\n");
    until("a warning", [&](const auto&) { return has("problem.0"); });
    shoot("used");
    click("problem.0", 0.1);
    until("the other file", [](const auto& s) { return std::string(s["text"]).find("start") == std::string::npos; });
    until("its text", [&](const auto&) { return has("text"); });
    EXPECT_EQ(state()["textSelection"], "- cube size 1 move (9, 0, 0)");
    EXPECT_EQ(state()["notice"], "parts.sgm is open, which test.sgm uses");
    shoot("opened");
}

}  // namespace
}  // namespace sgm::window::test
