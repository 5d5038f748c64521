// Mouldings, shells and leaning blocks of the primitive table: volumes, corners, what is no profile.
#include <gtest/gtest.h>

#include "tests/lower/lowered.h"

namespace sgm::testing_ {
namespace {

/// The volume inside the box by midpoints of cells of that size.
double volumeOf(const Lowered& model, Vec3d lo, Vec3d hi, double cell_m) {
    double count = 0;
    for (double x = lo.x + cell_m / 2; x < hi.x; x += cell_m)
        for (double y = lo.y + cell_m / 2; y < hi.y; y += cell_m)
            for (double z = lo.z + cell_m / 2; z < hi.z; z += cell_m) count += model.inside(Vec3d{x, y, z}.as<float>());
    return count * cell_m * cell_m * cell_m;
}

Lowered over(const std::string& solid, const std::string& size = "extrude 1m ") {
    return Lowered("grammar 1\nstart S -> footprint rect(6, 4) " + size + solid + "\n");
}

TEST(Mouldings, HaveTheVolumeOfTheirProfileRoundTheOutline) {
    // Outward of the outline a profile of area A and centre c sweeps A · (perimeter + 8 c) round a rectangle.
    const Lowered model = over("moulding((0, 0), (.5, 0), (.5, .4), (0, .4))");
    EXPECT_NEAR(volumeOf(model, {-4, -1, -3}, {4, 1, 3}, .05), .2 * (20 + 8 * .25), .05);
}

TEST(Mouldings, FormsFillTheHeightAndStandOut) {
    for (const char* form : {"cyma", "cove", "ovolo", "steps", "slope"}) {
        const Lowered model = over(std::string("corniceMoulding(.5m, ") + form + ")");
        EXPECT_TRUE(model.inside({3.45f, .45f, 0})) << form;
        EXPECT_FALSE(model.inside({3.45f, -.3f, 0})) << form << " is narrow below";
        EXPECT_TRUE(model.inside({3.45f, .45f, 2.45f})) << form << ": mitred at the corner";
        EXPECT_FALSE(model.inside({2.5f, 0, 0})) << form << " leaves the wall free";
        EXPECT_FALSE(model.inside({3.6f, .45f, 0})) << form;
    }
    EXPECT_TRUE(over("plinthMoulding(.2m)").inside({3.15f, -.4f, 0}));
    EXPECT_TRUE(over("stringMoulding(.2m)").inside({3.15f, 0, 0}));
    EXPECT_TRUE(over("sillMoulding(.2m)").inside({3.1f, .2f, 0}));
    const Lowered gutter = over("gutterMoulding(.3m)");
    EXPECT_FALSE(gutter.inside({3.15f, .3f, 0})) << "open at its top";
    EXPECT_TRUE(gutter.inside({3.14f, -.495f, 0})) << "closed below";
}

TEST(Mouldings, GoRoundCourtsToo) {
    const Lowered model(
        "grammar 1\nstart S -> footprint ring(20, 16, 5) extrude 1m moulding((0, 0), (.5, 0), (.5, .4), (0, .4))\n");
    EXPECT_TRUE(model.inside({10.2f, -.3f, 0}));
    EXPECT_TRUE(model.inside({4.8f, -.3f, 0})) << "into the court";
    EXPECT_FALSE(model.inside({5.2f, -.3f, 0}));
}

TEST(Mouldings, AProfileThatCrossesItselfIsToldWithItsPlace) {
    const auto d =
        tryDerive("grammar 1\nstart S -> footprint rect(6, 4) moulding((0, 0), (.5, .5), (.5, 0), (0, .5))\n");
    ASSERT_FALSE(d.ok());
    EXPECT_NE(d.error().message.find("profile of the moulding"), std::string::npos) << d.error().message;
    EXPECT_NE(d.error().message.find("test.sgm:2:33"), std::string::npos) << d.error().message;
    const auto two = tryDerive("grammar 1\nstart S -> footprint rect(6, 4) moulding((0, 0), (.5, .5))\n");
    ASSERT_FALSE(two.ok());
    EXPECT_NE(two.error().message.find("three points"), std::string::npos);
}

TEST(Shells, HaveARoomInside) {
    const Lowered model = over("shellBlock(.3m, .2m)", "extrude 3m ");
    EXPECT_FALSE(model.inside({0, 1, 0}));
    EXPECT_TRUE(model.inside({0, -.4f, 0})) << "the floor";
    EXPECT_TRUE(model.inside({2.85f, 1, 0})) << "a wall";
    EXPECT_NEAR(volumeOf(model, {-3.5, -1, -2.5}, {3.5, 3, 2.5}, .05), 6 * 4 * 3 - 5.4 * 3.4 * 2.8, .4);
}

TEST(TaperBlocks, Lean) {
    const Lowered model = over("taperBlock(45deg)", "extrude 1m ");
    EXPECT_TRUE(model.inside({2.9f, -.45f, 0}));
    EXPECT_FALSE(model.inside({2.9f, .4f, 0}));
    EXPECT_TRUE(model.inside({2.05f, .4f, 0}));
}

}  // namespace
}  // namespace sgm::testing_
