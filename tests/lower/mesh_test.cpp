// Solids from files: a mesh fills its scope and is combined like any other solid. Every file here is a torus about z of
// radii 1 and 0.4.
#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

double torus(Vec3f p) { return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.4; }

const std::vector<Vec3f> places{{1, 0, 0}, {0.7f, -0.7f, 0.2f}, {0, 0, 0}, {1.2f, 0.3f, -0.3f}, {0, 1.3f, 0.1f}};

TEST(Meshes, FillTheirScope) {
    const std::string text = "grammar 1\nterminal ring = mesh(\"ring.obj\")\nstart S -> ring size ";
    const Lowered same(text + "(2.8, 2.8, .8)\n"), twice(text + "(5.6, 5.6, 1.6)\n"), flat(text + "(2.8, 2.8, .08)\n");
    for (const Vec3f p : places) {
        EXPECT_NEAR(same.value(p), torus(p), 0.03);
        EXPECT_NEAR(twice.value(p * 2.0f), 2 * torus(p), 0.06);
        EXPECT_NEAR(flat.value({p.x, p.y, p.z * 0.1f}), 0.1 * torus(p), 0.01) << "no steeper than the distance";
    }
}

TEST(Meshes, AreCombinedLikeAnySolid) {
    const std::string ring = "mesh(\"ring.obj\")", size = " size (2.8, 2.8, .8)";
    const Lowered cut("grammar 1\nstart S -> cube size 4 - " + ring + size + "\n");
    EXPECT_FALSE(cut.inside({1, 0, 0}));
    EXPECT_TRUE(cut.inside({0, 0, 0}));
    const Lowered both("grammar 1\nstart S -> " + ring + size + " + sphere size 1 + " + ring + size +
                       " move (3, 0, 0) blend .2m\n");
    EXPECT_TRUE(both.inside({0, 0, 0}));
    EXPECT_TRUE(both.inside({4, 0, 0}));
    // Eq. 14 both ways: as a solid, and on what stands.
    const Lowered solid("grammar 1\nstart S -> morph(" + ring + ", sphere, .25)" + size + "\n");
    const Lowered onto("grammar 1\nstart S -> cube size 2 + cube size 1 move (1, 0, 0) morph " + ring + size +
                       " by .5\n");
    const Lowered stands("grammar 1\nstart S -> cube size 2 + cube size 1 move (1, 0, 0)\n"),
        ball("grammar 1\nstart S -> sphere" + size + "\n");
    for (const Vec3f p : places) {
        EXPECT_NEAR(solid.value(p), 0.75 * torus(p) + 0.25 * ball.value(p), 0.03);
        EXPECT_NEAR(onto.value(p), 0.5 * torus(p) + 0.5 * stands.value(p), 0.03);
    }
}

/// From a cube to the mesh along a chain.
TEST(Meshes, StandAtTheEndOfAMorphThatRunsThrough) {
    const Lowered row(
        "grammar 1\nstart S -> cube : A\nrule A repeat 3 -> + morph(cube, mesh(\"ring.obj\"), 0 ~> 1) size (2.8, 2.8, "
        ".8) move ((i * 5) * 1m, 0, 0) : A\n");
    EXPECT_TRUE(row.inside({5, 0, 0}));
    EXPECT_FALSE(row.inside({15, 0, 0}));
    EXPECT_TRUE(row.inside({16, 0, 0}));
}

}  // namespace
}  // namespace sgm
