// The face under a point of a shape's surface, with the words that rules call it by.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/derive/faces.h"
#include "tests/lower/lowered.h"
#include "tests/operations/shapes_called.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::NamedFace;
using derive::Shape;
using derive::ShapeId;

Derivation house(const std::string& roof, const std::string& more, const std::string& plan) {
    return derived("grammar 1\nterminal wall\nterminal tiles = " + roof +
                   "\nterminal bay = cube\nstart A -> footprint " + plan +
                   " extrude 6m Mass\nrule Mass -> wall + tiles at +y " + more + "\n");
}

ShapeId idOf(const Derivation& d, const std::string& label) {
    for (ShapeId s = 0; s < d.tree.shapes.size(); ++s)
        if (d.tree.labels[d.tree.shapes[s].label] == label) return s;
    ADD_FAILURE() << "no " << label;
    return 0;
}

bool has(const NamedFace& face, const std::string& word) {
    return std::find(face.words.begin(), face.words.end(), word) != face.words.end();
}

constexpr const char* plans[] = {"rect(12, 7)", "ell(16, 12, 6, 5)", "ring(30, 24, 7)", "tee(18, 12, 6, 5)"};

TEST(NamedFaces, AreTheSlopesThatEachMeans) {
    for (const char* roof : {"hipRoof(35deg, overhang: .4m)", "gableRoof(40deg)", "pyramidRoof", "shedRoof(20deg)",
                             "mansardRoof(70deg, 2m, 25deg)", "halfHipRoof(45deg)"})
        for (const char* plan : plans) {
            size_t asked = 0;
            for (const char* word : {"front", "back", "left", "right"}) {
                const Derivation d =
                    house(roof, std::string("+ bay size (.1, .1, .1) at each(slope, ") + word + ")", plan);
                const ShapeId tiles = idOf(d, "tiles");
                for (const Shape& bay : shapesCalled(d, "bay")) {
                    const auto face = namedFaceAt(d.tree, tiles, bay.scope.centre);
                    ASSERT_TRUE(face) << roof << ' ' << plan;
                    EXPECT_EQ(face->kind, "slope") << roof << ' ' << plan << ' ' << word;
                    EXPECT_TRUE(has(*face, word)) << roof << ' ' << plan << ' ' << word;
                    ++asked;
                }
            }
            if (std::string(roof) != "pyramidRoof") {
                EXPECT_GT(asked, 0u) << roof << ' ' << plan;
            }
        }
}

TEST(NamedFaces, HoldWhatLiesBetweenTheirCorners) {
    for (const char* plan : plans) {
        const Derivation d = house("hipRoof(35deg)", "+ bay size (.1, .1, .1) at each(slope)", plan);
        const ShapeId tiles = idOf(d, "tiles");
        for (const Shape& bay : shapesCalled(d, "bay")) {
            const auto face = namedFaceAt(d.tree, tiles, bay.scope.centre);
            ASSERT_TRUE(face);
            const auto& c = face->corners;
            EXPECT_NEAR(dot(cross(c[1] - c[0], c[2] - c[0]), bay.scope.centre - c[0]), 0, 1e-6);
            const Vec3d up = normalized(cross(c[1] - c[0], c[2] - c[0]));
            EXPECT_NEAR(std::abs(up.y), std::cos(35 * 3.14159265358979 / 180), 1e-6) << "they lie in the slope";
            const Vec3d middle = (c[0] + c[1] + c[2] + c[3]) * .25;
            for (const Vec3d& corner : c) {
                const auto again = namedFaceAt(d.tree, tiles, middle + (corner - middle) * .98);
                ASSERT_TRUE(again);
                EXPECT_EQ(again->kind, "slope");
                EXPECT_EQ(again->words, face->words);
            }
        }
    }
}

TEST(NamedFaces, StandUprightUnderTheSlopes) {
    const Derivation d = house("gableRoof(45deg, overhang: .5m, fascia: .3m)", "", "rect(12, 6)");
    const ShapeId tiles = idOf(d, "tiles");
    const auto gable = namedFaceAt(d.tree, tiles, {6.5, 7.5, 0});
    ASSERT_TRUE(gable);
    EXPECT_EQ(gable->kind, "gable");
    EXPECT_EQ(gable->words, std::vector<std::string>{"right"});
    const auto eave = namedFaceAt(d.tree, tiles, {1, 5.15, 3.5});
    ASSERT_TRUE(eave);
    EXPECT_EQ(eave->kind, "eave");
    EXPECT_EQ(eave->words, std::vector<std::string>{"front"});
}

TEST(NamedFaces, OfBlocksAreSidesTopAndBottom) {
    const Derivation d = house("hipRoof(35deg)", "", "ring(30, 24, 7)");
    const ShapeId wall = idOf(d, "wall");
    const auto at = [&](Vec3d p) {
        const auto face = namedFaceAt(d.tree, wall, p);
        return face ? face->kind + (has(*face, "court") ? " court" : "") + (has(*face, "front") ? " front" : "") : "";
    };
    EXPECT_EQ(at({2, 3, 12}), "side front");
    EXPECT_EQ(at({2, 3, 5}), "side court");
    EXPECT_EQ(at({13, 5.5, 2}), "top");
    EXPECT_EQ(at({13, -.5, 2}), "bottom");
    EXPECT_EQ(at({13, 3, 2}), "") << "not on the surface";
    EXPECT_FALSE(namedFaceAt(d.tree, 0, {2, 3, 12})) << "a shape without a solid of its own";
}

}  // namespace
}  // namespace sgm::testing_
