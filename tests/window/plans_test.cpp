// Plans in the view: their handles, maps over the ground, cameras that fly and walk.
#include "tests/window/simulated_user.h"

namespace sgm::window::test {
namespace {

using Plans = SimulatedUser;

TEST_F(Plans, KeysFlyAndWalk) {
    openText("grammar 2\nstart A -> cube size (30m, 2m, 30m)\n");
    const auto eye = [&] { return state()["eye"][1].get<double>(); };
    const auto choose = [&](const std::string& motion) {
        click("look.motion");
        click("look.motion." + motion);
    };
    choose("Fly");
    const nlohmann::json before = state();
    key("w");
    EXPECT_NE(state()["eye"], before["eye"]);
    EXPECT_NE(state()["at"], before["at"]) << "the eye goes ahead, and what it looks at with it";
    const double height = eye();
    key("e");
    EXPECT_GT(eye(), height);
    const nlohmann::json standing = state();
    drag("view.field", 0.5, 0.8, 0.52, 0.8);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(state()["eye"][i].get<double>(), standing["eye"][i].get<double>(), 1e-6) << "looks about";
    // Down over the slab: the ground carries a visitor.
    key("Home");
    key("5");
    choose("Walk");
    key("w");
    EXPECT_NEAR(eye(), 1 + 1.7, .01);
    // Beside the model the plane at its foot does.
    key("Home");
    key("1");
    for (int i = 0; i < 3; ++i) key("w");
    EXPECT_GT(state()["eye"][2], 15);
    EXPECT_NEAR(eye(), -1 + 1.7, .01);
}

TEST_F(Plans, ANarrowBarShowsAllItsControls) {
    size = "780x700";
    openText("grammar 2\nstart A -> cube size (3m, 2m, 3m)\n");
    click("pane.Mesh");
    click("mesh.section");
    for (const char* name : {"pane.Field", "look.inside", "look.motion", "bar.help", "mesh.look", "section.share"}) {
        ASSERT_TRUE(has(name)) << name;
        const auto place = report()["widgets"][name];
        EXPECT_LE(place[0].get<double>() + place[2].get<double>(), 780) << name;
    }
    shoot("narrow");
}

TEST_F(Plans, APlanIsDraggedByItsHandles) {
    openText("grammar 2\nstart A -> footprint rect(8, 6) extrude 3m block\n");
    key("5");  // from above, where the pointer moves in the plan
    click("view.field");
    ASSERT_TRUE(has("handle.side 1"));
    ASSERT_TRUE(has("handle.side 4"));
    const auto [x, y] = placeOf("handle.side 1", .5, .5);
    const auto [cx, cy] = placeOf("view.field", .5, .5);
    dragTo("handle.side 1", x + (x - cx) / 2, y + (y - cy) / 2);
    settled();
    EXPECT_NE(text().find("rect("), std::string::npos);
    EXPECT_EQ(text().find("rect(8, 6)"), std::string::npos) << "half as far again from the middle";
    EXPECT_EQ(state()["undo"], "Move side 1");
    shoot("handles");
    key("ctrl+z");
    EXPECT_NE(text().find("rect(8, 6)"), std::string::npos) << "one step back for the whole drag";
}

TEST_F(Plans, FacesAreTold) {
    openText(
        "grammar 2\nterminal wall\nterminal tiles = hipRoof(40deg)\n"
        "start A -> footprint rect(8, 6) extrude 3m House\nrule House -> wall + tiles at +y\n");
    key("1");  // from the front
    point("view.field", .5, .62);
    const auto told = [&](const std::string& face) {
        until(face,
              [&](const auto& s) { return s["hover"].template get<std::string>().find(face) != std::string::npos; });
    };
    told("side: front");
    point("view.field", .5, .32);
    told("slope: front");
    click("view.field", .5, .32);
    EXPECT_EQ(state()["face"], "slope: front") << "lit";
    shoot("face");
    click("view.field", .02, .02);
    EXPECT_EQ(state()["face"], "");
}

TEST_F(Plans, WhatIsToldFollowsThePointer) {
    size = "1000x700";
    openText("grammar 1\nstart A -> cube size (4, 2, 2) + sphere at +x\n");
    const auto told = [&](const std::string& shape) {
        return until("the word on " + shape, [&](const auto& s) {
            return std::string(s["hover"]).find(shape) != std::string::npos || (shape.empty() && s["hover"] == "");
        });
    };
    key("1");
    drawn();
    point("view.field", .3, .5);
    told("cube");
    // The camera moves under a pointer that rests.
    key("2");
    drawn();
    told("sphere");
    key("5");
    point("view.field", .4, .5);
    told("cube");
    wheel("view.field", -8);  // the label of a small face stands beside the shape
    click("view.field", .4, .5);
    shoot("label");
    pointAway(1200, 750);
    told("");
    settled();
    shoot("outside");
    point("view.field", .4, .5);
    told("cube");
    click("pane.Split");
    point("view.field", .4, .5);
    told("cube");
    point("tab.Rules");
    told("");
}

TEST_F(Plans, LettersOfAnLsystem) {
    openText(
        "grammar 2\nlsystem Plan passes 2 angle 90deg step 2m\n  axiom \"F+F+F+F\"\n  F -> \"F-F+FK\"\n"
        "start A -> footprint Plan extrude 3m block\n");
    click("tab.Step");
    EXPECT_EQ(state()["letters"]["pass"], 2);
    const size_t whole = state()["letters"]["count"];
    EXPECT_EQ(state()["letters"]["read"], whole);
    click("letters.fewer");
    EXPECT_EQ(state()["letters"]["pass"], 1);
    EXPECT_EQ(state()["letters"]["count"], 4u * 6 + 3);
    click("letters.letter", .5);
    EXPECT_LT(state()["letters"]["read"], 4u * 6 + 3);
    EXPECT_GT(state()["letters"]["read"], 0u);
    shoot("letters");
    click("letters.more");
    EXPECT_EQ(state()["letters"]["count"], whole);
}

TEST_F(Plans, AMapIsLaidOverTheGround) {
    openText("grammar 2\nmap rise = here.x\nstart A -> cube size (30m, 2m, 30m) color #808080\n");
    click("look.map");
    click("look.map.rise");
    EXPECT_EQ(state()["look"]["map"], "rise");
    shoot("map");
    click("look.map");
    click("look.map.No map");
    EXPECT_EQ(state()["look"]["map"], "");
}

TEST_F(Plans, OfATownFollowsASlider) {
    openText(
        "grammar 2\nmap people = bump((0m, 0m), 300m)\nparam width = 9m in 4m..20m \"Street\"\n"
        "roads Net { pull = people spread = people > .1 street = width block = 60m step = 60m junction = 4 }\n"
        "terminal lawn\nstart Town -> size (500m, 4m, 500m) network Net { ground: lawn | block: Block }\n"
        "rule Block -> lots box(300m2) { lot: nil }\n");
    click("look.plan");
    EXPECT_EQ(state()["look"]["plan"], true);
    key("5");
    shoot("plan");
    drag("param.width", 0.4, 0.5, 0.8, 0.5);
    settled();
    EXPECT_EQ(text().find("width = 9m"), std::string::npos);
    shoot("plan-wide");
}

}  // namespace
}  // namespace sgm::window::test
