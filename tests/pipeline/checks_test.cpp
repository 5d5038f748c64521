// Figures of checks: of objects at all places too.
#include "grammar/pipeline/checks.h"

#include <gtest/gtest.h>

#include "grammar/pipeline/load.h"

namespace sgm::pipeline {
namespace {

const std::string town =
    "grammar 1\n"
    "start Town -> cube size (100, 1, 100), for i in 1..3 { Plot move (10 * i, 0, 0) }\n"
    "rule Plot -> cube size .1 report plots 1, size 4 place Hut, size 1 place Yard\n"
    "start Yard -> for i in 1..2 { place Hut move (0, 0, 8 * i) }\n"
    "start Hut -> cube size (4, 3, 5) report area 20\n";

/// What each of the checks said, of a grammar that ends with them.
std::vector<Verdict> verdictsOf(const std::string& text) {
    syntax::Diagnostics problems;
    const auto grammar = load("town.sgm", text, problems);
    EXPECT_TRUE(grammar) << (problems.all().empty() ? "" : problems.all()[0].message);
    if (!grammar) return {};
    Context context{nullptr, 2};
    const auto verdicts = runChecks(grammar, 1, context);
    EXPECT_TRUE(verdicts.ok());
    return verdicts.ok() ? *verdicts : std::vector<Verdict>();
}

TEST(Checks, SumWhatObjectsReportAtAllPlaces) {
    const auto verdicts =
        verdictsOf(town + "check Town expect area == 180 and plots == 3\ncheck Yard expect area == 40\n");
    ASSERT_EQ(verdicts.size(), 2u);
    for (const Verdict& v : verdicts) EXPECT_TRUE(v.passed) << v.message;
}

TEST(Checks, CountObjectsThatDiffer) {
    // A hut draws nothing, so all are one; a yard has nothing solid of its own.
    const auto verdicts = verdictsOf(town + "check Town expect objects == 1 and places == 9\n");
    ASSERT_EQ(verdicts.size(), 1u);
    EXPECT_TRUE(verdicts[0].passed) << verdicts[0].message;
}

TEST(Checks, SayWhyAnObjectCantBeDerived) {
    const auto verdicts = verdictsOf(
        "grammar 1\nstart Town -> cube, place Hut move (10, 0, 0)\nstart Hut -> cube size (scope.x - 1) report n 1\n"
        "check Town expect n == 1\ncheck Town expect shapes == 3\n");
    ASSERT_EQ(verdicts.size(), 2u);
    EXPECT_FALSE(verdicts[0].passed);
    EXPECT_NE(verdicts[0].message.find("town.sgm:3:"), std::string::npos) << verdicts[0].message;
    EXPECT_TRUE(verdicts[1].passed) << verdicts[1].message;
}

}  // namespace
}  // namespace sgm::pipeline
