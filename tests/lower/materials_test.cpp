// Materials of a model: one a look, named by what gives the look.
#include <gtest/gtest.h>

#include <map>

#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

/// Names of the materials, in order.
std::vector<std::string> namesIn(const std::string& text) {
    const Lowered d("grammar 1\n" + text);
    std::vector<std::string> names;
    for (const Material& m : d.model->provenance.materials) names.push_back(m.name);
    return names;
}

using Names = std::vector<std::string>;

TEST(Materials, EqualLooksAreOneNamedByTheirParameter) {
    EXPECT_EQ(namesIn("param trim = #efe6d2\nparam wall = #cfae7c\n"
                      "start S -> cube color wall + cylinder color trim at +y + Ledge at +y, cube color wall\n"
                      "rule Ledge -> prism color trim\n"),
              (Names{"wall", "trim"}));
}

TEST(Materials, LooksOfOneNameAreNumbered) {
    EXPECT_EQ(namesIn("param paint = #b3392c\nstart S -> cube color paint + cube color paint rough .3 at +y "
                      "+ cube color paint metal 1 at +x + cube color paint rough .3 at -y\n"),
              (Names{"paint", "paint_2", "paint_3"}));
    EXPECT_EQ(namesIn("terminal paint_2 color #00ff00\nparam paint = #b3392c\n"
                      "start S -> paint_2 + cube color paint at +y + cube color paint rough .3 at +x\n"),
              (Names{"paint_2", "paint", "paint_3"}));
}

TEST(Materials, TerminalsNameTheirLookAndWhatChangesTheRestOfIt) {
    EXPECT_EQ(namesIn("terminal stone color #c2b59b rough .9\nstart S -> stone + stone rough .1 at +y + stone color "
                      "#ff0000 at +x\n"),
              (Names{"stone", "stone_2", "stone_3"}));
    EXPECT_EQ(namesIn("terminal stone color #c2b59b\nparam tint = #112233\nstart S -> stone color tint\n"),
              (Names{"tint"}));
    // A terminal that nobody uses doesn't name a look.
    EXPECT_EQ(namesIn("terminal stone color #c2b59b\nparam tint = #c2b59b\nstart S -> cube color tint\n"),
              (Names{"tint"}));
    EXPECT_EQ(namesIn("terminal stone color #c2b59b\nparam tint = #c2b59b\nstart S -> cube color tint + stone at +y\n"),
              (Names{"stone"}));
}

TEST(Materials, ATerminalsLookFollowsItsParameters) {
    const std::string text =
        "grammar 1\nparam tint = #ff0000\nparam gloss = .8 in 0..1\nterminal rock color tint rough gloss\n"
        "start S -> rock + rock color #00ff00 at +y\n";
    derive::Options other;
    rules::Value blue;
    blue.kind = rules::Value::Kind::Color;
    blue.n = {0, 0, 1};
    other.params = {blue, rules::Value::number(.25)};
    const Lowered d(text, other);
    ASSERT_EQ(d.model->provenance.materials.size(), 2u);
    EXPECT_EQ(d.model->provenance.materials[0], (Material{"rock", {0, 0, 1}, .25f, 0, nullptr}));
    EXPECT_EQ(d.model->provenance.materials[1], (Material{"rock_2", {0, 1, 0}, .25f, 0, nullptr}));
}

TEST(Materials, AColourThatNothingNamesIsItsOwnName) {
    EXPECT_EQ(namesIn("start S -> cube color #a4503a\n"), (Names{"color_a4503a"}));
    EXPECT_EQ(namesIn("start S -> cube\n"), (Names{"default"}));
    EXPECT_EQ(namesIn("start S -> cube + sphere rough .2 at +y\n"), (Names{"default", "default_2"}));
}

TEST(Materials, AChosenColourIsNamedByTheOneThatWasChosen) {
    const std::string text =
        "param a = #ff0000\nparam b = #00ff00\nstart S -> cube : Row\n"
        "rule Row repeat 30 -> + cube at +x color choose { 1: a | 1: b | 1: #0000ff } : Row\n";
    const Lowered d("grammar 1\n" + text);
    std::map<std::string, Vec3f> colors;
    for (const Material& m : d.model->provenance.materials) colors[m.name] = m.color;
    EXPECT_EQ(colors["a"], (Vec3f{1, 0, 0}));
    EXPECT_EQ(colors["b"], (Vec3f{0, 1, 0}));
    EXPECT_EQ(d.model->provenance.materials.size(), 4u);  // the first cube has the default's
}

TEST(Materials, InheritedValuesNameTheirLook) {
    EXPECT_EQ(namesIn("start S -> Wing with tint = #ff0000, Wing with tint = #00ff00\nrule Wing -> cube color tint\n"),
              (Names{"tint", "tint_2"}));
}

TEST(Poses, PartsStandAsTheirScopes) {
    const Lowered d("grammar 1\nstart S -> cube size (4, 1, 1) turn 90deg move (0, 0, 5) + sphere at +y\n");
    const Pose& pose = d.owner({0, 0, 6.9f}).pose;
    EXPECT_EQ(pose.origin, (Vec3d{0, 0, 5}));
    EXPECT_NEAR(length(pose.axes * Vec3d{1, 0, 0} - Vec3d{0, 0, -1}), 0, 1e-12);
    EXPECT_EQ(d.model->provenance.parts[0].pose.origin, Vec3d{});
}

}  // namespace
}  // namespace sgm
