// Places of the text that pick something out of shapes, and are told where they never do.
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

std::string told(const std::string& body) { return warningsOf(derived("grammar 2\n" + body), true); }

TEST(Selections, WordsOfFacesThatNoEdgeHasAreTold) {
    EXPECT_EQ(told("start A -> size (10, 6, 8) faces .5m { sides: cube | top: cube }\n"),
              "2:40 no edge of this plan is called 'sides', so no face gets this part; did you mean 'side'?\n");
    EXPECT_EQ(told("start A -> size (10, 6, 8) faces .5m { side: cube | roof: cube | rest: nil }\n"),
              "2:53 no edge of this plan is called 'roof', so no face gets this part; did you mean 'top'?\n");
    EXPECT_EQ(told("lsystem P passes 1 angle 90deg step 3m\n  axiom \"FW+F+F+F\"\n"
                   "start A -> footprint P extrude 3m faces .2m { w: cube | top: cube }\n"),
              "4:47 no edge of this plan is called 'w', so no face gets this part; did you mean 'W'?\n");
    EXPECT_EQ(told("lsystem P passes 1 angle 90deg step 3m\n  axiom \"FW+F+F+F\"\n"
                   "start A -> footprint P extrude 3m faces .2m { side: cube | W: cube }\n"),
              "4:60 parts before this one take all edges called 'W'; write it before them: the first word that fits an "
              "edge wins\n");
}

TEST(Selections, WordsOfTheLanguageThatThePlanLacksAreTold) {
    const std::string lacks = " no edge of this plan is called 'court', so no";
    EXPECT_EQ(told("start A -> footprint rect(9, 5) extrude 3m faces .2m { court: cube | front: cube | side: cube }\n"),
              "2:56" + lacks + " face gets this part; besides side, its edges are called back, right, front, left\n");
    EXPECT_EQ(told("start A -> footprint rect(9, 5) setback edges(court: 1m, rest: .1m) extrude 3m block\n"),
              "2:54" + lacks + "ne goes inward by this; besides side, its edges are called back, right, front, left\n");
    EXPECT_EQ(told("start A -> footprint rect(9, 5) extrude 3m faces .2m { side: cube | front: cube }\n"),
              "2:69 parts before this one take all edges called 'front'; write it before them: the first word that "
              "fits an edge wins\n");
    EXPECT_EQ(told("start A -> footprint rect(9, 5) setback edges(front: 2m, back: 2m, left: 1m, right: 1m, side: 1m) "
                   "extrude 3m faces .2m { front: cube | back: cube | left: cube | right: cube | side: cube }\n"),
              "")
        << "'side' may stand for whatever is left";
    EXPECT_EQ(
        told("start A -> footprint rect(9, 5) setback edges(side: 1m, front: 2m) extrude 3m block\n"),
        "2:64 words before this one take all edges called 'front'; write it before them: the first word that fits "
        "an edge wins\n");
    const std::string both = "start A -> footprint rect(9, 5) B, footprint ring(9, 9, 2) B\nrule B -> ";
    EXPECT_EQ(told(both + "extrude 3m faces .2m { court: cube | side: cube }\n"), "");
    EXPECT_EQ(told(both + "setback edges(court: .2m, rest: .1m) extrude 3m block\n"), "");
}

TEST(Selections, APlaceThatPicksSomethingOnceIsFine) {
    const std::string plan =
        "lsystem P passes 1 angle 90deg step 3m\n  axiom \"FW+F+F+F\"\n"
        "lsystem Q passes 1 angle 90deg step 3m\n  axiom \"F+F+F+F\"\n"
        "rule B -> extrude 3m faces .2m { W: cube | side: cube }\n";
    EXPECT_EQ(told(plan + "start A -> footprint P B, footprint Q B\n"), "");
    EXPECT_EQ(told(plan + "start A -> footprint Q B, footprint P B\n"), "");
    EXPECT_NE(told(plan + "start A -> footprint Q B\n").find("no edge of this plan is called 'W'"), std::string::npos);
}

TEST(Selections, PartsOfASplitForWhichNothingIsLeftAreTold) {
    EXPECT_EQ(told("start A -> split x { 1m: cube | ~1: sphere }\n"),
              "2:33 nothing is left of 1m for this part; the scope of a start is 1 m a side: write 'size (…)' before "
              "the split\n");
    const std::string smaller = "; make the other sizes smaller, or what is split larger\n";
    EXPECT_EQ(told("start A -> size 2 split x { 2m: cube | ~1: sphere | ~1: nil }\n"),
              "2:40 nothing is left of 2m for this part" + smaller);
    EXPECT_EQ(told("start A -> size 2 split x { 1m: cube | { 2m: sphere }* }\n"), "") << "as often as it fits";
    EXPECT_EQ(told("start A -> size 2 split x { 2m: cube | ~0: sphere }\n"), "") << "its share is 0";
    EXPECT_EQ(told("start A -> size 2 B, size 4 B\nrule B -> split x { 2m: cube | ~1: sphere }\n"), "");
}

TEST(Selections, SetbacksTellWordsAndWhatTheyLeave) {
    EXPECT_EQ(told("start A -> footprint rect(10, 8) setback edges(fornt: 2m, rest: 1m) extrude 4m block\n"),
              "2:55 no edge of this plan is called 'fornt', so none goes inward by this; did you mean 'front'?\n");
    EXPECT_EQ(
        told("start A -> footprint rect(10, 8) setback 5m extrude 4m block, cube size 2\n"),
        "2:34 nothing is left of a plan of 10 m by 8 m, so no shape is made; take less away, or begin with a larger "
        "plan\n");
    EXPECT_EQ(told("start A -> for k in 1..3 { footprint rect(10, 8) setback (2m * k) extrude 4m block }\n"), "")
        << "the first has room";
}

TEST(Selections, CourtsThatWingsLeaveNoRoomForAreTold) {
    EXPECT_EQ(
        told("start A -> footprint rect(20, 20) court 11m extrude 4m block\n"),
        "2:35 wings of 11 m leave no court in a plan of 20 m by 20 m, which stays whole; make the wings narrower, "
        "or begin with a larger plan\n");
    EXPECT_EQ(told("start A -> for k in 1..3 { footprint rect(20, 20) court (4m * k) extrude 4m block }\n"), "")
        << "the first has room";
    const auto d = derived("grammar 2\nstart A -> footprint rect(20, 20) court 11m extrude 4m block\n");
    const derive::Scope& scope = d.tree.shapes.back().scope;
    EXPECT_DOUBLE_EQ(scope.size.x, 20);
    EXPECT_DOUBLE_EQ(scope.size.z, 20);
}

TEST(Selections, FacesThatAShapeLacksAreTold) {
    const std::string house = "start A -> footprint rect(10, 8) extrude 4m House\nrule House -> block + ";
    EXPECT_EQ(told(house + "gableRoof(40deg) at +y + cube at each(slopes)\n"),
              "3:53 no edge of this plan is called 'slopes', so nothing grows here; did you mean 'slope'?\n");
    EXPECT_EQ(
        told(house + "Cover at +y\nrule Cover -> hipRoof(40deg) + cube at each(gable)\n"),
        "4:37 'hipRoof' has no gable, so nothing grows here; there it has each of side, corner, slope, eave, apex, "
        "ridge, hip\n");
    EXPECT_EQ(
        told(house + "cube at +y : Post + cube size 1 at each(Post)\nrule Post -> cylinder\n"),
        "3:55 no edge of this plan is called 'Post', so nothing grows here; 'on each(Post)' is every shape of that "
        "symbol\n");
    EXPECT_EQ(told(house + "gableRoof(40deg) at +y + cube at each(slope, front)\n"), "");
}

TEST(Selections, LotsWithoutStreetsAreTold) {
    EXPECT_EQ(
        told("start A -> size (40, 2, 40) B\nrule B -> lots 100 { lot: cube | inner: cube }\n"),
        "3:11 no edge of this block is called 'street', so all of it is 'inner' and no lot is made; lots stand along "
        "streets: the blocks of a 'network' have them, and 'tag street' before 'lots' makes one of every edge, 'tag "
        "street along front' of some\n");
}

TEST(Selections, TheCauseOfNothingSolidIsNamed) {
    const auto d = derived("grammar 2\nstart A -> footprint rect(10, 8) setback 5m extrude 4m block\n");
    EXPECT_EQ(
        derive::nothingSolid(d).message,
        "test.sgm:2:34: nothing is left of a plan of 10 m by 8 m, so no shape is made, and nothing solid is left of "
        "'A'; take less away, or begin with a larger plan");
    EXPECT_EQ(derive::nothingSolid(derived("grammar 2\nstart A -> nil\n")).message,
              "test.sgm:2:1: nothing solid is left of 'A': name a solid in it, such as 'cube'");
}

TEST(Selections, AChainWhoseNewcomerHasNoNameIsTold) {
    EXPECT_EQ(
        told("start A -> cube size 3 : B\nrule B repeat 5 -> + cube size (3, 3, 3) at +y\n"),
        "3:15 the chain ends after 1 of 5 steps: none of its newcomers is a 'B' from which the next step could go "
        "on, and the joint of the first one is used; write ': B' behind the newcomer that the next step grows on\n");
    EXPECT_EQ(told("start A -> cube size 3 : B\nrule B repeat 5 -> + cube size (3, 3, 3) at +y : B\n"), "");
    EXPECT_EQ(told("start A -> cube size 3 : B\nrule B repeat 3 -> + cube size 1 at free(+x, -x, +z)\n"), "");
}

TEST(Selections, AChainWhoseStepsReplaceEachOtherIsTold) {
    EXPECT_EQ(
        told("start A -> cube size 3 : B\nrule B repeat 3 -> sphere\n"),
        "3:15 each of the 3 steps replaces what the one before made, so the last alone is left: none of its "
        "newcomers is a 'B' from which the next step could go on; begin the body with '+' to grow on what stands, "
        "or write ': B' behind what the next step goes on from\n");
    EXPECT_EQ(told("start A -> cube size 3 : B\nrule B repeat 3 -> sphere size 90% : B\n"), "");
    EXPECT_EQ(told("start A -> cube size 3 : B\nrule B repeat 1 -> sphere\n"), "");
}

TEST(Selections, ABodyWhoseJointsAreAllClosedIsTold) {
    EXPECT_EQ(told("start A -> cube size 2 : H\nrule H -> + cube size 1 at +y : K\nrule K -> + sphere size 1 at -y\n"),
              "4:11 '-y' of 'A/H/K' is closed by 'A/H', made by the start (test.sgm:2), so this grows nowhere; choose "
              "another joint of ours, 'at free(…)', or place it by 'move'\n");
    EXPECT_EQ(
        told("start A -> cube size 3 + cube size 2 at +y + cube size 1 at +y\n"),
        "2:44 '+y' of 'A/cube' is closed by 'A/cube/cube', made by the start (test.sgm:2), so this grows nowhere; "
        "write 'on last' to let it grow on the shape before it, choose another joint of ours, 'at free(…)', or "
        "place it by 'move'\n");
    const auto d = derived(
        "grammar 2\nstart A -> cube size 2 : H\nrule H -> + cube size 1 at +y : K + cube size 1 at +x : K\n"
        "rule K -> + sphere size 1 at -y\n");
    EXPECT_TRUE(derive::warnings(d).all().empty()) << "it grows on the other";
    ASSERT_EQ(d.closed.size(), 1u);
    EXPECT_EQ(d.closed[0].count, 1u);
}

}  // namespace
}  // namespace sgm
