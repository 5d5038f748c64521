// `sgm step`: the paper's figure 1 by hand.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

/// What `sgm step FILE` says when these lines are piped to it.
Outcome stepped(const std::string& commands, const std::string& file) {
    return sgm("step " + file, "printf '" + commands + "' | ");
}

TEST_F(Cli, StepSavesFigureOnesWays) {
    const std::string file = path("figure1.sgm");
    const std::string text = read("examples/figure1.sgm");
    std::ofstream(file) << text;
    const Outcome run =
        stepped("R0\\nundo\\nredo\\nR1\\nundo\\nR2 at Figure/A\\n1\\nway\\nsave mine\\nsave right\\n", file);
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("derive way: R0 => R2 => R4\n"), std::string::npos) << run.out;
    EXPECT_EQ(read(file), text + "derive mine: R0 => R2 => R4\n");
    const auto tree = [&](const std::string& way) { return sgm("tree " + file + " --derive " + way).out; };
    EXPECT_EQ(tree("mine"), tree("right"));
    EXPECT_NE(tree("mine"), tree("left"));
    const Outcome hand = stepped("R0 => R2\\nrest\\ntree\\n", file);
    EXPECT_NE(hand.out.find(tree("right")), std::string::npos) << hand.out;
}

TEST_F(Cli, StepStopsAtTheFirstMistakeInAPipe) {
    const auto expectSaid = [&](const std::string& commands, const char* said) {
        const Outcome run = stepped(commands, "examples/figure1.sgm");
        EXPECT_EQ(run.code, 1) << run.out;
        EXPECT_NE(run.out.find(said), std::string::npos) << run.out;
        EXPECT_EQ(run.out.find("DE"), std::string::npos) << "went on: " << run.out;
    };
    expectSaid("undo\\nR0\\nR2\\n", "there is nothing to undo");
    expectSaid("R9\\nR0\\nR2\\n", "no rule is called 'R9'");
    expectSaid("R1\\nR0\\nR2\\n", "rule 'R1' matches nothing here");
    expectSaid("7\\nR0\\nR2\\n", "there is no number 7");
    expectSaid("way\\nR0\\nR2\\n", "no rule was applied yet");
    expectSaid("R0 at Figure/B\\nR0\\nR2\\n", "there is no shape 'Figure/B' here");
    EXPECT_EQ(sgm("step examples/figure1.sgm </dev/null").code, 0);
}

TEST_F(Cli, StepSaysWhichShapeClosedAJoint) {
    const std::string file = path("closed.sgm");
    std::ofstream(file) << "grammar 2\nstart A -> cube size 2 : B\n"
                           "rule Up: B -> + cube size 1 at +x + sphere size 3 at +x + cube size 1 at +y : K\n"
                           "rule K -> + sphere size 1 at -y\n";
    const Outcome run = stepped("Up\n", file);
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("closed.sgm:3:35: nothing grew here: '+x' of 'A/B' is closed by 'A/B/cube', made by rule "
                           "'Up' ("),
              std::string::npos)
        << run.out;
    EXPECT_NE(run.out.find("no rule matches: '-y' of 'A/B/K' is closed by 'A/B', made by the start ("),
              std::string::npos)
        << run.out;
}

}  // namespace
}  // namespace sgm::cli
