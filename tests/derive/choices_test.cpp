// Values and rules drawn by weight.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

/// How many of the shapes that grew stand toward each of the six directions of their host.
std::array<int, 6> grownToward(const derive::Derivation& d) {
    std::array<int, 6> count{};
    for (const derive::Bond& b : d.tree.bonds().all) ++count[b.joint[0]];
    return count;
}

TEST(Choices, DirectionsAreDrawnByWeight) {
    const auto d = derived(
        "grammar 1\nstart S -> for k in 1..600 { cube move (3 * k, 0, 0) : A }\nrule A -> + sphere at choose { 4: +y | "
        "2: -y | 0: +z } to centre\n");
    const auto n = grownToward(d);
    EXPECT_EQ(n[2] + n[3], 600);
    EXPECT_NEAR(n[2], 400, 40);
}

TEST(Choices, ValuesOfAnyKindAndRangesInThem) {
    const auto d = derived(R"(grammar 1
param share = .5 in 0..1.0
start S -> for k in 1..300 { cube size choose { share: 1m | 1 - share: 2..3 } move (9 * k, 0, 0) color choose { 1: #ff0000 | 1: #0000ff } }
)");
    int small = 0;
    for (const auto& s : d.tree.shapes) {
        if (s.solid == derive::none) continue;
        small += s.scope.size.x == 1;
        EXPECT_TRUE(s.scope.size.x == 1 || (s.scope.size.x >= 2 && s.scope.size.x <= 3));
    }
    EXPECT_NEAR(small, 150, 30);
    EXPECT_EQ(d.materials.size(), 3u);
}

TEST(Choices, DeclaredJointsAndLoops) {
    const auto d = derived(
        "grammar 1\nstart S -> cone : A\nrule A repeat choose { 0: 1 | 1: 3 } -> + cone size 1 at choose { 1: apex } "
        "to centre : A\n");
    EXPECT_EQ(d.terminals(), 4u);
}

TEST(Choices, NothingToDrawIsALocatedError) {
    const auto expectError = [](const std::string& text, const char* start) {
        const auto d = tryDerive("grammar 1\nparam none = 0 in 0..1.0\n" + text);
        ASSERT_FALSE(d.ok());
        EXPECT_EQ(d.error().kind, Error::Kind::Input);
        EXPECT_EQ(d.error().message.rfind(start, 0), 0u) << d.error().message;
    };
    expectError("start S -> cube size choose { none: 1 | none: 2 }\n", "test.sgm:3:22: all weights are 0");
    expectError("start S -> choose { none: cube | none: sphere }\n", "test.sgm:3:12: all weights are 0");
    expectError("start S -> A\nrule A weight none -> cube\nrule A weight none -> sphere\n",
                "test.sgm:4:15: every rule for 'A' that matches has weight 0");
    expectError("start S -> A\nrule A weight none -> cube\n",
                "test.sgm:4:15: every rule for 'A' that matches has weight 0");
}

TEST(Choices, AComputedRangeThatRunsBackwardsIsALocatedError) {
    const auto failure = [](const std::string& start) {
        const auto d = tryDerive("grammar 2\nparam n = 9m in 5m..20m\nstart S -> cube size " + start + "\n");
        return d.ok() ? std::string() : d.error().message;
    };
    const auto expectError = [&](const std::string& start, const std::string& text) {
        EXPECT_NE(failure(start).find(text), std::string::npos) << failure(start);
    };
    expectError("(1m, n..3m, 1m)", "test.sgm:3:27: the range runs backwards: it is 9m..3m here");
    expectError("(1m, (2 * n)..(n + 1m), 1m)", "test.sgm:3:27: the range runs backwards: it is 18m..10m here");
    expectError("n..3m", "test.sgm:3:22: the range runs backwards: it is 9m..3m here");
    EXPECT_EQ(failure("(1m, 3m..n, 1m)"), "");
    EXPECT_EQ(failure("(1m, n..9m, 1m)"), "") << "one value";
    EXPECT_EQ(failure("(1m, min(n, 3m)..max(n, 3m), 1m)"), "") << "the fix";
    EXPECT_EQ(warningsOf(derived("grammar 1\nparam n = 9 in 5..20\nstart S -> cube size (1m, n..3m, 1m)\n")),
              "3:27 the range runs backwards: it is 9..3m here\n");
}

}  // namespace
}  // namespace sgm
