// L-systems pass by pass: the letters are those that the model was made of.
#include "viewer/document/letters.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/scope_footprint.h"
#include "tests/document/shown.h"

namespace sgm::document {
namespace {

LettersShown after(const BuiltModel& model, uint32_t passes) {
    auto shown = lettersAfter(model, 0, passes);
    if (shown.ok()) return *std::move(shown);
    ADD_FAILURE() << shown.error().message;
    return {};
}

TEST(Letters, AreThoseOfEachPass) {
    const auto model =
        shown(Document("grammar 2\nlsystem Koch passes 3 angle 90deg step 2m\n  axiom \"F+F+F+F\"\n  F -> \"F-F+F\"\n"
                       "start S -> footprint Koch extrude 3m block\n"));
    ASSERT_EQ(lettersRead(*model), std::vector<uint32_t>{0});
    EXPECT_EQ(after(*model, 0).letters.text, "F+F+F+F");
    EXPECT_EQ(after(*model, 1).letters.text, "F-F+F+F-F+F+F-F+F+F-F+F");
    const LettersShown whole = after(*model, 100);
    EXPECT_EQ(whole.all, 3u);
    EXPECT_EQ(whole.passes, 3u) << "no more than the model makes";
    EXPECT_EQ(whole.steps.size(), 4u * 27);
    EXPECT_FALSE(lettersAfter(*model, 1, 0).ok());
}

TEST(Letters, OfASquareAreDrawnFromTheStart) {
    const auto model =
        shown(Document("grammar 2\nlsystem Plan passes 0 angle 90deg step 4m\n  axiom \"FK+F+F+F\"\n"
                       "start S -> footprint Plan extrude 3m block\n"));
    const LettersShown square = after(*model, 0);
    ASSERT_EQ(square.steps.size(), 4u);
    EXPECT_EQ(square.steps[1].at, 3u) << "the letter that draws it";
    EXPECT_NEAR(square.steps[0].to.right, 4, 1e-9);
    EXPECT_NEAR(std::abs(square.steps[1].to.up), 4, 1e-9);
    EXPECT_NEAR(square.steps[3].to.right, 0, 1e-9);
}

TEST(Letters, AreDrawnAsTheModelDrewThem) {
    for (uint64_t seed = 1; seed < 20; ++seed) {
        Document document(
            "grammar 2\nlsystem Plan passes 1 angle 90deg step 4m\n  axiom \"F+F+F+F\"\n"
            "  F -> \"FK\" : 1\n  F -> \"FB\" : 1\n"
            "start S -> House size (20m, 3m, 20m)\nrule House -> footprint Plan extrude 3m block\n");
        Choice choice = document.choice();
        choice.seed = seed;
        document.choose(choice, "seed");
        const auto model = shown(document);
        std::string drawn, read;
        for (const derive::Shape& s : model->model.derivation.tree.shapes) {
            if (s.scope.footprint == derive::none || !drawn.empty()) continue;
            const plan::Footprint footprint = footprintOf(s.scope, model->model.derivation.tree.footprints);
            for (const plan::PlacedEdge& edge : edgesOf(footprint)) drawn += footprint.tags[edge.edge.tag];
        }
        for (const char letter : after(*model, 1).letters.text)
            if (letter == 'K' || letter == 'B') read += letter;
        std::sort(drawn.begin(), drawn.end());
        std::sort(read.begin(), read.end());
        ASSERT_EQ(drawn.size(), 4u);
        EXPECT_EQ(drawn, read) << "seed " << seed;
    }
}

TEST(Letters, HaveTheirNumbersInTheText) {
    const auto model = shown(
        Document("grammar 2\nlsystem Oak passes 2\n  axiom \"A(4m)\"\n  A(l) -> \"F(l)[&(30deg)A(l / 2)]\" when l > 1\n"
                 "start Tree -> size (.5m, 1m, .5m) turtle Oak upward { F: cylinder }\n"));
    const LettersShown oak = after(*model, 9);
    EXPECT_EQ(textOf(oak.letters, 0, 100), "F(4)[&(0.5236)F(2)[&(0.5236)A(1)]]");
    EXPECT_EQ(textOf(oak.letters, 1, 2), "[&(0.5236)");
    ASSERT_EQ(oak.steps.size(), 2u);
    EXPECT_NEAR(oak.steps[0].to.up, 4, 1e-9) << "it rises, so it is seen from the front";
}

}  // namespace
}  // namespace sgm::document
