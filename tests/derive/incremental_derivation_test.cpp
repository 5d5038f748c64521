// A derivation that follows its parameters is at every step the one that `derive` gives, and runs again only what read
// the change.
#include "grammar/derive/incremental_derivation.h"

#include "tests/derive/same.h"

namespace sgm::derive {
namespace {

using namespace testing_;

std::vector<rules::Value> defaults(const rules::Grammar& grammar) {
    std::vector<rules::Value> values;
    for (const rules::Param& p : grammar.params) values.push_back(p.value);
    return values;
}

/// Brings the regrowth there and compares.
void expectSame(IncrementalDerivation& regrowth, const std::shared_ptr<const rules::Grammar>& grammar,
                const Options& options) {
    const auto whole = derive(grammar, options, nullptr);
    const Status done = regrowth.to(grammar, options, nullptr);
    ASSERT_EQ(done.ok(), whole.ok());
    if (done.ok())
        testing_::expectSame(regrowth.derivation(), *whole);
    else
        EXPECT_EQ(done.error().message, whole.error().message);
}

class Walk : public testing::TestWithParam<const char*> {};

TEST_P(Walk, IsTheSameAsFromTheStart) {
    const auto grammar = grammarOf(fileText(GetParam()));
    ASSERT_TRUE(grammar && !grammar->params.empty());
    for (uint32_t start = 0; start < grammar->starts.size(); ++start) {
        Options options;
        options.start = start;
        options.budget.shapes = 3000;
        options.params = defaults(*grammar);
        IncrementalDerivation regrowth;
        uint64_t key = hashText(GetParam()) + start;
        for (int step = 0; step < 12; ++step, key = mix(key)) {
            const size_t which = pick(key, grammar->params.size());
            if (step > 0)
                options.params[which] = drawn(grammar->params[which], options.params[which], combine(key, which));
            if (step == 9) options.seed = 2;
            SCOPED_TRACE(grammar->symbols[grammar->starts[start].symbol].name + ", " + grammar->params[which].name +
                         ", step " + std::to_string(step));
            expectSame(regrowth, grammar, options);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Grammars, Walk,
                         testing::Values("examples/tower.sgm", "examples/grotto.sgm", "examples/cumulus.sgm",
                                         "examples/buildings/hall.sgm", "examples/caves/branching.sgm",
                                         "tests/bench/scenes/buildings.sgm"));

constexpr const char* street =
    "grammar 1\nparam a = 3m in 1m..6m\nparam b = 3m in 1m..6m\nparam gap = 9m in 2m..20m\nparam many = 2 in 1..5\n"
    "start Street -> for k in 1..3 {\n"
    "    when k < 3 { House with high = a move (gap * k, 0, 0) }\n"
    "    when k == 3 { House with high = b move (gap * k, 0, 0) } }\n"
    "rule House -> Floor size (4, high, 4) : Tower\n"
    "rule Tower repeat many -> + Floor size (4, high, 4) at +y : Tower\n  finally + sphere size 1 on last at +y\n"
    "rule Floor when scope.y > 5m -> cylinder\n"
    "rule Floor -> cube\n";

TEST(IncrementalDerivation, RunsOnlyWhatReadTheChange) {
    const auto grammar = grammarOf(street);
    Options options;
    options.params = defaults(*grammar);
    IncrementalDerivation regrowth;
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
    expectSame(regrowth, grammar, options);
    EXPECT_FALSE(regrowth.whole());
    EXPECT_TRUE(regrowth.changed().empty());

    options.params[1].n[0] = 3.5;
    expectSame(regrowth, grammar, options);
    EXPECT_FALSE(regrowth.whole());
    const ShapeTree& tree = regrowth.derivation().tree;
    const ShapeId third = tree.find("Street/House[3]");
    for (const ShapeId id : regrowth.changed()) {
        ShapeId s = id;
        while (s != none && s != third) s = tree.shapes[s].parent;
        EXPECT_EQ(s, third) << tree.path(id);
    }
    EXPECT_GE(regrowth.changed().size(), 8u);
}

TEST(IncrementalDerivation, StartsOverWhereTheCourseChanges) {
    const auto grammar = grammarOf(street);
    Options options;
    options.params = defaults(*grammar);
    IncrementalDerivation regrowth;
    expectSame(regrowth, grammar, options);
    options.params[1].n[0] = 5.5;  // floors of cylinders
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
    options.params[3].n[0] = 4;  // more of them
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
    options.params[2].n[0] = 4;  // the houses come to stand wall to wall: floors of one height meet
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
    options.params[0].n[0] = 3.25;  // and with another height they meet their like alone
    expectSame(regrowth, grammar, options);
    options.params[1].n[0] = 3.25;
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
    options.params[2].n[0] = 5;  // apart again
    expectSame(regrowth, grammar, options);
    EXPECT_TRUE(regrowth.whole());
}

}  // namespace
}  // namespace sgm::derive
