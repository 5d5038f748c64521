// Derivation by hand: SG-M figure 1 by `derive`, by a session and by itself; undo, redo; the way as text.
#include "grammar/derive/session.h"

#include "grammar/derive/way.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;
using derive::Session;

/// The tree as text: shapes, scopes, bonds, rules, keys.
std::string treeOf(const derive::Derivation& d) { return derive::toText(d, false); }

Session begun(const std::string& text, derive::Options options = {}) {
    auto session = Session::begin(grammarOf(text), options);
    EXPECT_TRUE(session.ok()) << (session.ok() ? "" : session.error().message);
    return *std::move(session);
}

uint32_t ruleCalled(const Session& session, const std::string& name) {
    const auto& rules = session.grammar().rules;
    for (uint32_t r = 0; r < rules.size(); ++r)
        if (rules[r].name == name) return r;
    return derive::none;
}

/// Applies a rule by name where it alone matches, or at a place.
Status step(Session& session, const std::string& rule, const std::string& place = "") {
    const uint32_t r = ruleCalled(session, rule);
    const auto shape = session.meant(r, place);
    if (!shape.ok()) return shape.error();
    return session.apply({r, *shape});
}

std::string sessionTree(const Session& session) {
    auto d = session.derivation();
    EXPECT_TRUE(d.ok());
    return d.ok() ? treeOf(*d) : "";
}

std::string wayOf(const Session& session) {
    const auto steps = session.way();
    return steps.ok() ? derive::wayText(session.grammar(), "w", *steps) : steps.error().message;
}

TEST(Figure1, ByHandByWayAndByItself) {
    // By itself A is drawn to be R1's or R2's, so the seed decides between the paper's two ways.
    int left = 0, right = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        derive::Options leftWay = way("left"), rightWay = way("right");
        leftWay.seed = rightWay.seed = seed;
        const std::string byItself = treeOf(derived(figure1, withSeed(seed)));
        const std::string leftTree = treeOf(derived(figure1, leftWay)), rightTree = treeOf(derived(figure1, rightWay));
        left += byItself == leftTree;
        right += byItself == rightTree;

        Session hand = begun(figure1, withSeed(seed));
        for (const char* rule : {"R0", "R1", "R3"}) ASSERT_TRUE(step(hand, rule).ok());
        EXPECT_EQ(sessionTree(hand), leftTree);
        EXPECT_EQ(wayOf(hand), "derive w: R0 => R1 => R3\n");
        ASSERT_TRUE(hand.undo().ok() && hand.undo().ok());
        for (const char* rule : {"R2", "R4"}) ASSERT_TRUE(step(hand, rule).ok());
        EXPECT_EQ(sessionTree(hand), rightTree);

        Session rest = begun(figure1, withSeed(seed));
        ASSERT_TRUE(step(rest, "R0").ok() && rest.applyRest().ok());
        EXPECT_EQ(sessionTree(rest), byItself);
    }
    EXPECT_EQ(left + right, 20);
    EXPECT_GT(left, 2);
    EXPECT_GT(right, 2);
}

TEST(Sessions, SayWhatIsLiveAndWhatMatches) {
    Session s = begun(figure1);
    ASSERT_EQ(s.live().size(), 1u);
    EXPECT_EQ(s.tree().path(s.live()[0]), "Figure/I0");
    EXPECT_EQ(s.rulesFor(s.live()[0]), std::vector<uint32_t>{0});
    ASSERT_TRUE(step(s, "R0").ok());
    ASSERT_EQ(s.live().size(), 1u);
    EXPECT_EQ(s.rulesFor(s.live()[0]), (std::vector<uint32_t>{1, 2}));
    EXPECT_FALSE(step(s, "R3").ok());
    EXPECT_FALSE(step(s, "R1", "Figure/I0").ok());
    EXPECT_EQ(wayOf(s), "derive w: R0\n");
}

TEST(Sessions, UndoAndRedoLeadBackToTheSameTree) {
    Session s = begun(house);
    std::vector<std::string> trees{sessionTree(s)};
    while (!s.live().empty()) {
        uint32_t rule = derive::none;
        for (const auto shape : s.live())
            if (const auto rules = s.rulesFor(shape); rule == derive::none && !rules.empty()) {
                rule = rules[0];
                ASSERT_TRUE(s.apply({rule, shape}).ok());
            }
        if (rule == derive::none) break;
        trees.push_back(sessionTree(s));
    }
    ASSERT_GT(trees.size(), 2u);
    EXPECT_EQ(trees.back(), treeOf(derived(house)));
    EXPECT_FALSE(s.canRedo());
    for (size_t i = trees.size() - 1; i-- > 0;) {
        ASSERT_TRUE(s.undo().ok());
        EXPECT_EQ(sessionTree(s), trees[i]);
    }
    EXPECT_FALSE(s.canUndo());
    for (size_t i = 1; i < trees.size(); ++i) {
        ASSERT_TRUE(s.redo().ok());
        EXPECT_EQ(sessionTree(s), trees[i]);
    }
}

TEST(Sessions, AFailedStepChangesNothing) {
    Session s = begun(
        "grammar 1\nstart S -> cube : A\nrule Good: A -> + sphere at +x : B\nrule Bad: A -> + sphere size (scope.x - "
        "1m) at +x : B\n");
    const std::string before = sessionTree(s);
    const Status bad = step(s, "Bad");
    ASSERT_FALSE(bad.ok());
    EXPECT_NE(bad.error().message.find("test.sgm:4:"), std::string::npos) << bad.error().message;
    EXPECT_EQ(sessionTree(s), before);
    EXPECT_FALSE(s.canUndo());
    EXPECT_TRUE(step(s, "Good").ok());
}

TEST(Sessions, ACancelledStepChangesNothing) {
    Session s = begun(
        "grammar 1\nstart S -> cube : A\nrule R1: A -> for k in 1..5000 { + sphere move (3 * k, 0, 0) }, + cube : B\n"
        "rule R2: B -> + cone at +y\n");
    Progress cancelled;
    cancelled.cancel();
    const std::string start = sessionTree(s);
    EXPECT_EQ(s.apply({ruleCalled(s, "R1"), s.live()[0]}, &cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(sessionTree(s), start);
    ASSERT_TRUE(step(s, "R1").ok());
    ASSERT_TRUE(s.applyRest().ok());
    const std::string whole = sessionTree(s);
    EXPECT_EQ(s.undo(&cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(sessionTree(s), whole);
    ASSERT_TRUE(s.undo().ok());
    ASSERT_TRUE(s.undo().ok());
    EXPECT_EQ(s.redo(&cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(sessionTree(s), start);
    ASSERT_TRUE(s.redo().ok());
    EXPECT_EQ(s.derivation(&cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_TRUE(s.derivation().ok());
}

TEST(Sessions, ManyStepsAreCancelledAmidThem) {
    Session s = begun(
        "grammar 1\nstart S -> for k in 1..1500 { cube move (3 * k, 0, 0) : A }\nrule R1: A -> + sphere at +y : B\n"
        "rule R2: B -> + cone at +y\n");
    ASSERT_TRUE(s.applyRest().ok());
    const std::string whole = sessionTree(s);
    Progress cancelled;
    cancelled.cancel();
    EXPECT_EQ(s.derivation(&cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(s.way(&cancelled).error().kind, Error::Kind::Cancelled);
    ASSERT_TRUE(s.undo().ok());
    const std::string start = sessionTree(s);
    EXPECT_EQ(s.redo(&cancelled).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(sessionTree(s), start);
    ASSERT_TRUE(s.redo().ok());
    EXPECT_EQ(sessionTree(s), whole);
}

TEST(Sessions, ShapesThatAreGoneAreRefused) {
    Session s = begun("grammar 1\nstart S -> cube : A\nrule R1: A -> + sphere at +x : B\nrule R2: B -> + cone at +y\n");
    const auto a = s.live()[0];
    ASSERT_TRUE(step(s, "R1").ok());
    EXPECT_FALSE(s.apply({ruleCalled(s, "R1"), a}).ok()) << "rewritten already";
    EXPECT_FALSE(s.apply({ruleCalled(s, "R2"), 99}).ok()) << "never made";
    EXPECT_TRUE(step(s, "R2").ok());
}

TEST(Sessions, WaysNamePlacesAndUnnamedRulesAndRunAgain) {
    const std::string text =
        "grammar 1\nstart S -> for k in 1..3 { cube move (3 * k, 0, 0) : A }\nrule A -> + sphere at +y : B\nrule A "
        "weight 2 -> + cone at +y : A\nrule B -> torus\n";
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        Session s = begun(text, withSeed(seed));
        ASSERT_TRUE(step(s, "A#2", "S/A[2]").ok());
        ASSERT_TRUE(s.applyRest().ok());
        const std::string line = wayOf(s);
        EXPECT_EQ(line.rfind("derive w: A#2 at S/A[2]", 0), 0u) << line;
        derive::Options again = way("w");
        again.seed = seed;
        EXPECT_EQ(treeOf(derived(text + line, again)), sessionTree(s)) << line;
    }
}

TEST(Sessions, AGuardThatCountsMayNotBeSaidInAWay) {
    Session s = begun(
        "grammar 1\nstart S -> cube : A, cube move (3, 0, 0) : A\nrule A when count(B) < 1 -> cube : B\nrule B when "
        "count(B) > 2 -> cone\n");
    ASSERT_TRUE(s.applyRest().ok());
    EXPECT_EQ(s.derivation()->steps.size(), 2u);
    EXPECT_FALSE(s.way().ok());
}

TEST(Ways, AreWrittenWithoutTouchingTheRest) {
    const auto grammar = grammarOf(std::string(figure1) + "derive other: R0 // stays\n\n// the end");
    const std::string text(grammar->sources[0]->text());
    EXPECT_EQ(derive::fileWithWay(*grammar, "new", "derive new: R0 => R2\n"),
              std::string(figure1) + "derive other: R0 // stays\nderive new: R0 => R2\n\n// the end");
    EXPECT_EQ(derive::fileWithWay(*grammar, "other", "derive other: R0 => R2\n"),
              std::string(figure1) + "derive other: R0 => R2 // stays\n\n// the end");
    const auto bare = grammarOf("grammar 1\nstart S -> cube : A\nrule R: A -> nil");
    EXPECT_EQ(derive::fileWithWay(*bare, "w", "derive w: R\n"),
              "grammar 1\nstart S -> cube : A\nrule R: A -> nil\n\nderive w: R\n");
}

TEST(Ways, BreakLongLines) {
    const auto grammar = grammarOf(figure1);
    const std::vector<rules::Derive::Step> steps(30, {0, "Figure/I0", {}});
    const std::string line = derive::wayText(*grammar, "long", steps);
    size_t widest = 0;
    for (size_t at = 0; at < line.size(); at = line.find('\n', at) + 1)
        widest = std::max(widest, line.find('\n', at) - at);
    EXPECT_LE(widest, 100u);
    EXPECT_TRUE(grammarOf(std::string(figure1) + line));
}

}  // namespace
}  // namespace sgm
