// `grammar 1` as `grammar 2`: what is rewritten means the same, and what means something else is told.
#include "grammar/rules/upgrade.h"

#include "grammar/syntax/parser.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

rules::Upgrade upgradedText(const std::string& text) {
    syntax::Diagnostics diagnostics;
    const auto source = std::make_shared<const syntax::Source>("old.sgm", text);
    const syntax::Ast ast = syntax::parse(source, operations::table(), diagnostics);
    EXPECT_FALSE(diagnostics.hasErrors());
    rules::Upgrade made = rules::upgraded(ast);
    for (auto& note : made.notes) note.span = {};  // the source goes
    return made;
}

/// Where the solids stand, in tree order.
std::vector<derive::Scope> scopesOf(const std::string& text) {
    const auto d = derived(text);
    std::vector<derive::Scope> found;
    for (derive::ShapeId s = 0; s != derive::none; s = d.tree.next(s))
        if (d.tree.shapes[s].solid != derive::none) found.push_back(d.tree.shapes[s].scope);
    return found;
}

void expectSameModel(const std::string& body, size_t notes) {
    SCOPED_TRACE(body);
    const std::string old = "grammar 1\nstart A -> size (4, 5, 6) B\nrule B -> " + body + "\n";
    const rules::Upgrade made = upgradedText(old);
    SCOPED_TRACE(made.text);
    EXPECT_EQ(made.notes.size(), notes);
    EXPECT_TRUE(made.text.starts_with("grammar 2\n"));
    const auto before = scopesOf(old), after = scopesOf(made.text);
    ASSERT_EQ(before.size(), after.size());
    for (size_t i = 0; i < before.size(); ++i) {
        expectNear(before[i].centre, after[i].centre);
        expectNear(before[i].size, after[i].size);
        expectNear(before[i].axes.x, after[i].axes.x);
        expectNear(before[i].axes.y, after[i].axes.y);
    }
}

TEST(Upgrade, KeepsWhatShapesMeasureBy) {
    expectSameModel("cube size 1m move (1m, 0, 0) + sphere size 50%", 1);
    expectSameModel(
        "cube color #804020 turn 30deg size (50%, 1m, 50%) move (10%, 0, 1m) + sphere size .2 move (1m, 0, 0)", 1);
    expectSameModel("cube size 2m + cube size 1m at +x + cone size (100%, 1m, 100%) at +y", 1);
    expectSameModel("cube size 2m for d in sides { + cube size 30% at d }, sphere move (9, 0, 0)", 1);
    expectSameModel("(cube + sphere size 2m) size 50% + cube", 1);
    expectSameModel("let w = 2m cube size w + sphere size 50%", 1);
}

TEST(Upgrade, TellsOfPlansThatSizesStretch) {
    const std::string body = "start A -> footprint rect(8, 6) extrude 3m B\nrule B -> block size ";
    EXPECT_EQ(upgradedText("grammar 1\n" + body + "(100% - 1m, 100%, 100%)\n").notes.size(), 1u);
    EXPECT_EQ(upgradedText("grammar 1\n" + body + "(50%, 1m, scope.z)\n").notes.size(), 0u);
    EXPECT_EQ(upgradedText("grammar 1\nstart A -> cube size (100% - 1m)\n").notes.size(), 0u) << "no plan";
}

TEST(Upgrade, GivesTheFirstShapesSizeWhereNoScopeIsAsked) {
    expectSameModel("cube size (1m, 2m, 3m) - sphere move (1m, 0, 0) + cone size 1m at +y", 1);
    EXPECT_EQ(upgradedText("grammar 1\nstart A -> cube size 3m - B move (1m, 0, 0)\nrule B -> cube\n").text,
              "grammar 2\nstart A -> cube size 3m - B size 3m move (1m, 0, 0)\nrule B -> cube\n");
}

TEST(Upgrade, LeavesWhatMeansTheSame) {
    expectSameModel("cube + sphere size 50%", 0);
    expectSameModel("cube size 2m + cube size 1m at +x, cube size 1 turn 30deg", 0);
    expectSameModel("cube size 2m + cube size (1m, 3m, 1m), cube size 1m - sphere size 2m at +y", 0);
    expectSameModel("split x { ~1: cube size 50% | ~1: C }\nrule C -> cube", 0);
}

TEST(Upgrade, LeavesBehindARoofWhatNoGroupCouldMeasure) {
    const auto made = upgradedText("grammar 1\nstart A -> size 9m hipRoof(30deg) + cube size 50% at +y\n");
    ASSERT_EQ(made.notes.size(), 1u);
    EXPECT_NE(made.notes[0].message.find("measured by the matched scope now"), std::string::npos);
    EXPECT_EQ(made.text, "grammar 2\nstart A -> size 9m hipRoof(30deg) + cube size 50% at +y\n");
}

TEST(Upgrade, IsWarnedOfOnceAFile) {
    const auto warned = [](const std::string& text) {
        syntax::Diagnostics diagnostics;
        rules::load(std::make_shared<const syntax::Source>("old.sgm", text), operations::table(), nullptr, diagnostics);
        std::vector<std::string> found;
        for (const auto& d : diagnostics.all()) found.push_back(d.message);
        return found;
    };
    const std::string rest = "start A -> cube size 1m move (2m, 0, 0) + sphere size 50%, cube size 2m + cube at +x\n";
    EXPECT_EQ(warned("grammar 1\n" + rest),
              std::vector<std::string>{"'grammar 2' reads this in another way, and 1 more place"});
    EXPECT_EQ(warned("grammar 2\n" + rest),
              (std::vector<std::string>{"a share of what? A start's own scope is 1m",
                                        "'cube' has no size, and a start's own scope is 1m"}));
    EXPECT_EQ(warned("grammar 1\nstart A -> cube size 2m + cube size 1m at +x\n").size(), 0u);
}

TEST(Upgrade, PutsASizeOfSharesBeforeItsTurn) {
    expectSameModel("cylinder turn (90deg, 0deg, 0deg) size (100%, 1m, 100%)", 1);
    expectSameModel("cylinder turn (90deg, 0deg, 0deg) size (1m, 2m, 1m)", 0);
}

TEST(Upgrade, TellsOfSizesThatEveryRepetitionDraws) {
    const auto notesOf = [](const std::string& split) {
        return upgradedText("grammar 1\nstart A -> size (20, 1, 1) split x { " + split + " }\n").notes;
    };
    ASSERT_EQ(notesOf("{ ~(4m..9m): cube }*").size(), 1u);
    EXPECT_EQ(notesOf("{ ~(4m..9m): cube }*")[0].message,
              "this size is drawn and counted anew for every repetition now");
    EXPECT_EQ(notesOf("{ 1m: cube | (i * 1m): cube }*").size(), 1u);
    EXPECT_EQ(notesOf("{ ~4m: cube }*").size(), 0u);
    EXPECT_EQ(notesOf("(1m..2m): cube | { ~4m: cube }*").size(), 0u) << "what isn't repeated is drawn once in both";
}

TEST(Upgrade, TellsOfNeighboursThatWin) {
    const auto made = upgradedText("grammar 1\nstart A -> B\nrule B -> cube\nrule B beside A -> sphere\n");
    ASSERT_EQ(made.notes.size(), 1u);
    EXPECT_NE(made.notes[0].message.find("drawn by weight against the one of line 3"), std::string::npos);
    EXPECT_EQ(upgradedText("grammar 2\nstart A -> cube\n").text, "grammar 2\nstart A -> cube\n");
}

}  // namespace
}  // namespace sgm
