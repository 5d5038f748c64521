// The Text panel's keys, its search, and the way from a problem to its place. docs/viewer.md lists which test drives
// what.
#include "tests/window/simulated_user.h"

namespace sgm::window::test {
namespace {

using Text = SimulatedUser;

constexpr const char* pair = R"(grammar 1
start Pair -> cube size 2 : Base
rule Base -> + sphere size 1.5 at +x : Ball
rule Ball -> + cylinder size 1 at +y : Cap
rule Cap -> cone
)";

TEST_F(Text, KeysThatMoveDropTheSelection) {
    openText(pair);
    click("tab.Text");
    for (const char* moves : {"Right", "End", "Down", "ctrl+End", "Left", "ctrl+Home", "Page_Down", "Page_Up"}) {
        click("line.1", 0.5);
        key("ctrl+a");
        EXPECT_EQ(state()["textSelection"], pair);
        key(moves);
        EXPECT_EQ(state()["textSelection"], "") << moves;
        type(" ");
        EXPECT_EQ(text().size(), std::string(pair).size() + 1) << moves;
        key("ctrl+z");
        ASSERT_EQ(text(), pair) << moves;
    }
    click("line.2", 0.5);
    key("Home");
    key("shift+Right");
    key("shift+End");
    EXPECT_EQ(state()["textSelection"], "start Pair -> cube size 2 : Base") << "Shift keeps it";
}

TEST_F(Text, SelectedLinesAreIndentedAndCommented) {
    openText(pair);
    const std::string before = pair;
    click("tab.Text");
    click("line.3", 0.5);
    key("Home");
    key("shift+Down");
    key("shift+Down");
    key("Tab");
    EXPECT_EQ(text(),
              "grammar 1\nstart Pair -> cube size 2 : Base\n  rule Base -> + sphere size 1.5 at +x : Ball\n"
              "  rule Ball -> + cylinder size 1 at +y : Cap\nrule Cap -> cone\n");
    key("shift+Tab");
    EXPECT_EQ(text(), before);
    key("shift+Tab");
    EXPECT_EQ(text(), before) << "nothing left to take away";
    key("Tab");
    key("ctrl+z");
    EXPECT_EQ(text(), before);
    key("ctrl+slash");
    EXPECT_NE(text().find("\n// rule Base"), std::string::npos) << text();
    EXPECT_NE(text().find("\n// rule Ball"), std::string::npos) << text();
    key("ctrl+slash");
    EXPECT_EQ(text(), before);
}

TEST_F(Text, WordsAreFound) {
    openText(pair);
    click("tab.Text");
    key("ctrl+f");
    type("size");
    const auto first = state()["textSelection"];
    key("Return");
    EXPECT_EQ(state()["textSelection"], "size");
    const auto at = [&] { return state()["caret"].get<int>(); };
    const int one = at();
    key("Return");
    const int two = at();
    EXPECT_GT(two, one);
    click("search.next");
    EXPECT_GT(at(), two);
    click("search.previous");
    EXPECT_EQ(at(), two);
    key("F3");
    EXPECT_GT(at(), two);
    key("F3");
    EXPECT_EQ(at(), one) << "round the end";
    shoot("search");
    click("search.word");
    key("Escape");
    EXPECT_FALSE(has("search.word"));
    key("Delete");
    EXPECT_EQ(text().find("size"), std::string(pair).find("size", 40) - 4) << "the text takes keys again";
    EXPECT_EQ(state()["turning"], false);
}

TEST_F(Text, AProblemLeadsToItsPlace) {
    std::string far = " size (1";
    for (int i = 0; i < 40; ++i) far += " + 0.125";
    far += ", 2, colr)";
    openText("grammar 1\nstart A -> cube\n");
    click("tab.Text");
    click("line.2", 0.99);
    type(far);
    until("a problem", [](const auto& s) { return !s["problems"].empty(); });
    key("ctrl+Home");
    key("Escape");
    click("tab.Rules");
    until("the rules", [&](const auto&) { return !has("text"); });
    click("problem.0", 0.1);
    until("the text", [&](const auto&) { return has("text"); });
    EXPECT_EQ(state()["textSelection"], "colr");
    EXPECT_GT(settled()["textScroll"], 100) << "it is seen";
    shoot("place");
    point("note.0");
    shoot("note");
    point("problem.0", 0.1);
    shoot("tip");
}

}  // namespace
}  // namespace sgm::window::test
