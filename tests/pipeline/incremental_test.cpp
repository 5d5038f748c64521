// Walks over the parameters of grammars: after every step tree, field, parts and mesh of what was kept and what changed
// are those of a build from the start, byte for byte.
#include "tests/fuzz_keys.h"
#include "tests/pipeline/followed.h"

namespace sgm::pipeline {
namespace {

using namespace testing_;

class Walk : public testing::TestWithParam<const char*> {};

TEST_P(Walk, KeepsTheBytes) {
    const auto grammar = grammarOf(fileText(GetParam()));
    ASSERT_TRUE(grammar && !grammar->params.empty());
    derive::Options options = defaults(*grammar);
    options.budget.shapes = 3000;
    Followed followed(grammar, 40);
    uint64_t key = hashText(GetParam());
    for (int step = 0; step < 10; ++step, key = mix(key)) {
        const size_t which = pick(key, grammar->params.size());
        SCOPED_TRACE("step " + std::to_string(step) + ", " + grammar->params[which].name);
        if (step > 0 && step != 4)
            options.params[which] = drawn(grammar->params[which], options.params[which], combine(key, which));
        if (step == 8) options.seed = 7;
        followed.expectSame(options);
        if (testing::Test::HasFatalFailure()) return;
    }
    // Every parameter of the L-system's house moves all of its walls.
    const bool movesAll = std::string(GetParam()) == "examples/buildings/lsystem.sgm";
    EXPECT_TRUE(followed.blocksKept > 0 || movesAll);
    EXPECT_TRUE(followed.followed > 0 || movesAll);
}

INSTANTIATE_TEST_SUITE_P(Examples, Walk,
                         testing::Values("examples/tower.sgm", "examples/grotto.sgm", "examples/cumulus.sgm",
                                         "examples/buildings/hall.sgm", "examples/caves/branching.sgm",
                                         "tests/bench/scenes/buildings.sgm", "examples/morphs.sgm",
                                         "examples/buildings/terrace.sgm", "examples/buildings/villa.sgm",
                                         "examples/buildings/lsystem.sgm"));

/// 200 buildings, of which one is dragged, then all.
TEST(District, OneBuildingIsDragged) {
    const auto grammar = grammarOf(fileText("tests/bench/scenes/buildings.sgm"));
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar, 2);
    Followed district(grammar, 100);
    district.expectSame(options);
    const size_t all = district.pipeline.rebuild().blocksMade();
    for (const double height : {3.05, 3.3, 2.9, 4.1}) {
        options.params[1].n[0] = height;
        district.expectSame(options);
        EXPECT_TRUE(district.pipeline.followed()) << height;
        EXPECT_LT(district.pipeline.rebuild().blocksMade(), all / 2);
    }
    options.params[0].n[0] = 3.2;
    district.expectSame(options);
    options.params[1].n[0] = 3.2;  // as high as the others
    district.expectSame(options);
}

/// Parts that cut, blend, mirror each other's surface, shrink to a morph's end or to nothing special (0, 1).
constexpr const char* mixed =
    "grammar 1\n"
    "param a = .4 in 0..1\nparam b = 1m in 0m..2m\nparam c = 1.5m in .5m..3m\nparam t = 20deg in 0deg..45deg\nparam n "
    "= 2 in 1..4\n"
    "param melt = .2m in 0m..1m\nparam rough = .05m in 0m..0.2m\nparam paint = #ff0000\n"
    "terminal red = cube color paint\n"
    "start All -> Row, Melted move (0, 0, 8m), Noisy move (0, 0, -8m)\n"
    "rule Row -> for k in 1..6 { Box with high = if(k == 3, c, 2m) move (3m * k, 0, 0) }\n"
    "rule Box -> cube size (2, high, 2) - sphere size 1 at +y to centre move (0, b - 1m, 0)\n"
    "rule Melted -> cube size (3, c, 3) + sphere size 2 at +y to centre blend melt morph sphere size 3 by a\n"
    "rule Noisy -> red size (c, 2, 2) turn t, group\n"
    "rule Turned repeat n -> + cube size 1 at +y : Turned\n";

TEST(Mixed, EveryParameterKeepsTheBytes) {
    std::string text = mixed;
    text.replace(text.find(", group\n"), 8, ", Pile move (4m, 0, 0) displace billow(rough, 2/m)\n");
    text += "rule Pile -> cube : Turned\n";
    const auto grammar = grammarOf(text);
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar);
    Followed followed(grammar, 60);
    const FuzzKeys keys = fuzzKeys(48);
    uint64_t key = 5 + keys.first;
    for (size_t step = 0; step < keys.count; ++step, key = mix(key)) {
        const size_t which = step % grammar->params.size();
        SCOPED_TRACE("step " + std::to_string(step) + ", " + grammar->params[which].name);
        rules::Value& value = options.params[which];
        const rules::Param& param = grammar->params[which];
        const double end = pick(key, 6);
        if (step > 0 && param.lo && end < 2)
            value.n[0] = end == 0 ? param.lo->n[0] : param.hi->n[0];
        else if (step > 0 && param.lo)
            value = drawn(param, value, key);
        else if (step > 0)
            value.n[1] = uniform(key);
        followed.expectSame(options);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(followed.followed, 12u);
    EXPECT_GT(followed.blocksKept, 0u);
}

/// Axes that differ in the sign of a zero are equal: their shapes share the slots of one rotation.
TEST(Mixed, ZerosOfEitherSignAreOneNumber) {
    const auto grammar = grammarOf(
        "grammar 2\nparam wide = .5 in .25...75\nstart A -> size (6.5, 7.5, 5.5) around 5 radius 2m { B }\n"
        "rule B -> mirror y { split z { ~1: cylinder size (wide, 2.75, 3.25) | ~1.75: (cube + sphere size 2.5 at +x) } "
        "}\n");
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar);
    Followed followed(grammar, 24);
    followed.expectSame(options);
    options.params[0].n[0] = .6;
    followed.expectSame(options);
}

TEST(Pipeline, AfterAnErrorItStartsAfresh) {
    const auto grammar = grammarOf(
        "grammar 1\nparam n = 2 in 0..9\nparam w = 1m in .1m..2m\nstart A -> for k in 1..3 when k <= n { cube size w "
        "move (2m * k, 0, 0) }\n");
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar);
    Followed followed(grammar, 30);
    followed.expectSame(options);
    options.params[0].n[0] = 0;  // nothing solid
    followed.expectSame(options);
    options.params[0].n[0] = 2;
    followed.expectSame(options);
    options.params[1].n[0] = 1.5;
    Progress progress;
    progress.cancel();
    mesh::Counts counts;
    Context context;
    ASSERT_TRUE(followed.pipeline.to(grammar, options, context).ok());
    EXPECT_FALSE(followed.pipeline.mesh({{-2, -2, -2}, .1f, {100, 40, 40}}, &progress, counts).ok());
    followed.expectSame(options);
    options.params[1].n[0] = 1.25;  // a step without a mesh between two with one
    ASSERT_TRUE(followed.pipeline.to(grammar, options, context).ok());
    options.params[1].n[0] = .75;
    followed.expectSame(options);
    EXPECT_TRUE(followed.pipeline.followed());
}

}  // namespace
}  // namespace sgm::pipeline
