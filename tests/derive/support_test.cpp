// Nothing floats: groups of touching boxes, and the rule that made the one in the air.
#include "grammar/derive/support.h"

#include "grammar/pipeline/checks.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

const char* const raised = R"(grammar 1
param gap = .5m in 0m..1m
start House -> cube size (8, 3, 6) : Storey
rule Build: Storey repeat 4
  -> + cube size (8, 3, 6) at +y move (0, if(i == 3, gap, 0m), 0) : Storey
check House { } expect floating == 0
check House { gap = 0m } expect floating == 0
)";

TEST(Support, AFloatingStoreyIsNamedWithItsRuleAndLine) {
    const auto d = derived(raised);
    EXPECT_EQ(d.floating(), 2u);  // the raised storey and the one that stands on it
    const auto shapes = d.floatingShapes();
    ASSERT_EQ(shapes.size(), 1u);
    EXPECT_EQ(derive::madeBy(d, shapes[0]), "'House/Storey/Storey[3]', made by rule 'Build' (test.sgm:5)");
    pipeline::Context context;
    const auto verdicts = pipeline::runChecks(grammarOf(raised), 1, context);
    ASSERT_TRUE(verdicts.ok());
    EXPECT_FALSE((*verdicts)[0].passed);
    EXPECT_NE((*verdicts)[0].message.find("made by rule 'Build' (test.sgm:5)"), std::string::npos)
        << (*verdicts)[0].message;
    EXPECT_NE((*verdicts)[0].message.find("floating is 2: 2 solids in 1 group: 'House/"), std::string::npos)
        << (*verdicts)[0].message;
    EXPECT_TRUE((*verdicts)[1].passed) << (*verdicts)[1].message;
}

TEST(Support, AStoreyOfManyPartsIsNamedAsAWhole) {
    const auto d = derived(R"(grammar 1
start House -> Level size (8, 3, 6) : Storey
rule Storey repeat 2 -> + Level size (8, 3, 6) at +y move (0, i - 1, 0) : Storey
rule Level -> cube - cube size (90%, 70%, 200%) + sphere size .5 at +x to centre
)");
    const auto shapes = d.floatingShapes();
    ASSERT_EQ(shapes.size(), 1u);
    EXPECT_EQ(d.tree.path(shapes[0]), "House/Storey/Storey[2]");
}

TEST(Support, CuttersHoldNothingUp) {
    const auto cut = derived(
        "grammar 1\nstart A -> cube size 2 - cube size (1, 6, 1) move (0, 4, 0) + cube size 1 move (0, 7, 0)\n");
    EXPECT_EQ(cut.floating(), 1u);
    const auto added = derived(
        "grammar 1\nstart A -> cube size 2 + cube size (1, 6, 1) move (0, 4, 0) + cube size 1 move (0, 7, 0)\n");
    EXPECT_EQ(added.floating(), 0u);
}

TEST(Support, WhatStandsOnTheGroundNeedsNoNeighbour) {
    EXPECT_EQ(derived("grammar 1\nstart A -> cube size 2, cube size 2 move (9, 0, 0)\n").floating(), 0u);
    EXPECT_EQ(derived("grammar 1\nstart A -> cube size 2, cube size 2 move (9, 1, 0)\n").floating(), 1u);
}

TEST(Support, WhatStandsOutOfItsScopeHolds) {
    const auto floating = [](const std::string& support) {
        return derived("grammar 2\nstart S -> block size (4, 4, 4) + " + support +
                       " at +y + around 4 radius 2.3m { cube size (.1m, 1m, .1m) move (0, 3m, 0) }\n")
            .floating();
    };
    EXPECT_EQ(floating("cube size (4, .5, 4)"), 4u);
    EXPECT_EQ(floating("corniceMoulding(.5m) size (4, .5, 4)"), 0u);
    EXPECT_EQ(floating("corniceMoulding(.2m) size (4, .5, 4)"), 4u);
    EXPECT_EQ(floating("moulding((-.1, 0), (.5, 0), (.5, .5), (-.1, .5)) size (4, .5, 4)"), 0u);
    EXPECT_EQ(floating("taperBlock(-45deg) size (4, .5, 4)"), 0u);
    EXPECT_EQ(floating("domeRoof(overhang: .5m, fascia: .2m) size (4, .5, 4)"), 0u);
    EXPECT_EQ(floating("domeRoof(overhang: .5m) size (4, .5, 4)"), 4u) << "a dome comes to nothing at its eaves";
}

}  // namespace
}  // namespace sgm
