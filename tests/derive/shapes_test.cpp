// Shapes are read as they were put, bit for bit, and take little memory.
#include "grammar/derive/shapes.h"

#include <cmath>
#include <cstring>

#include "grammar/derive/incremental_derivation.h"
#include "modeler/core/random.h"
#include "tests/derive/same.h"

namespace sgm::derive {
namespace {

using namespace testing_;

/// Any values, in some of which many shapes agree.
Shape shapeOf(uint64_t i, const syntax::Source& source) {
    const auto drawn = [&](uint64_t what, uint32_t of) { return static_cast<uint32_t>(pick(combine(i, what), of)); };
    Shape s;
    s.parent = i == 0 ? none : drawn(1, static_cast<uint32_t>(i));
    s.firstChild = drawn(2, 1000), s.lastChild = drawn(3, 1000), s.nextSibling = drawn(4, 1000);
    s.occurrence = drawn(5, 1000), s.depth = i % 7 ? drawn(6, 1000) : Shapes::mostDepth;
    s.solid = drawn(7, 1000), s.material = drawn(8, 3), s.extras = i % 2 ? none : drawn(9, 1000);
    s.op = static_cast<rules::Operator>(drawn(10, 5));
    s.amount = i % 3 ? .5 : uniform(combine(i, 11), 0, 1);
    s.blend_m = i % 5 ? 0 : -0.0;
    s.key = i * 77, s.symbol = drawn(12, 4), s.label = drawn(13, 4), s.valuesAt = drawn(14, 1000);
    s.jointSet = drawn(15, 3), s.madeBy = drawn(16, 1000), s.chainRule = i % 2 ? none : drawn(17, 3);
    s.live = drawn(18, 2) == 1, s.dead = drawn(19, 2) == 1;
    s.sharesPlace = drawn(20, 2) == 1, s.meetsNobody = drawn(21, 2) == 1;
    s.scope.centre = {uniform(combine(i, 22), -9, 9), 1, -0.0};
    s.scope.size = {uniform(combine(i, 23), 1, 9), 2, 3};
    s.scope.footprint = i % 4 ? none : drawn(24, 1000);
    if (i % 2) s.scope.axes = Mat3::rotation({0, 1, 0}, static_cast<double>(i % 100));
    if (i % 8 == 0) s.scope.axes.x.y = -0.0;
    s.span = {&source, drawn(25, 4), 9};
    return s;
}

bool sameBits(const Scope& a, const Scope& b) {
    return std::memcmp(&a.centre, &b.centre, sizeof a.centre) == 0 &&
           std::memcmp(&a.axes, &b.axes, sizeof a.axes) == 0 && std::memcmp(&a.size, &b.size, sizeof a.size) == 0;
}

TEST(Shapes, AreReadAsTheyWerePut) {
    const syntax::Source source("a.sgm", "0123456789");
    constexpr uint64_t count = 20'000;
    Shapes shapes;
    for (uint64_t i = 0; i < count; ++i) shapes.push_back(shapeOf(i, source));
    shapes.shrink();
    const Shapes copy = shapes;
    for (ShapeId i = 0; i < count; ++i) {
        const Shape s = copy[i];
        ASSERT_TRUE(told(s) == told(shapeOf(i, source))) << i;
        ASSERT_TRUE(sameBits(s.scope, shapeOf(i, source).scope)) << i;
        ASSERT_EQ(std::signbit(s.blend_m), i % 5 == 0) << i;
        ASSERT_TRUE(sameBits(copy.scopeOf(i), s.scope)) << i;
    }
    uint64_t keys = 0;
    for (const Shape& s : copy) keys += s.key;
    EXPECT_EQ(keys, 77 * count * (count - 1) / 2);
}

TEST(Shapes, ChangeOneByOneWithoutPilingUpWhatTheyWere) {
    const syntax::Source source("a.sgm", "0123456789");
    constexpr ShapeId count = 300;
    Shapes shapes;
    for (uint64_t i = 0; i < count; ++i) shapes.push_back(shapeOf(i, source));
    for (int turn = 0; turn < 200; ++turn) {
        for (ShapeId i = 0; i < count; i += 2) {
            Scope scope = shapeOf(i, source).scope;
            scope.axes = Mat3::rotation({0, 1, 0}, .01 * turn + i);
            shapes.setScope(i, scope);
            shapes.setJoining(i, {.001 * turn, .1 * i});
        }
        shapes.shrink();
    }
    for (ShapeId i = 0; i < count; ++i) {
        const Shape now = shapes[i], before = shapeOf(i, source);
        const double angle = .01 * 199 + i;
        const Mat3 axes = i % 2 ? before.scope.axes : Mat3::rotation({0, 1, 0}, angle);
        ASSERT_EQ(now.scope.axes, axes) << i;
        ASSERT_EQ(now.amount, i % 2 ? before.amount : .001 * 199) << i;
        ASSERT_EQ(now.blend_m, i % 2 ? before.blend_m : .1 * i) << i;
    }
    EXPECT_LT(shapes.memory(), 600'000u) << "30,000 rotations were put";
}

/// 30,000 shapes of a wall: docs/lab/derivation.md.
TEST(Shapes, OfAWallTakeAtMost128BytesEach) {
    Options options;
    const auto d = derived(
        "grammar 2\nterminal a\nterminal b\nstart Wall -> Front size (120m, 100m, .5m) turn 30deg\n"
        "rule Front -> split y { { ~3.2m: Row }* }\nrule Row -> split x { { ~2.4m: Tile }* }\n"
        "rule Tile -> split x { .6m: a | ~1: Bay | .6m: a }\nrule Bay -> split y { .9m: a | ~1: Window | .5m: a }\n"
        "rule Window -> split x { .07m: b | ~1: Panes | .07m: b }\nrule Panes -> split y { .07m: b | ~1: a | .07m: b "
        "}\n",
        options);
    ASSERT_GT(d.tree.shapes.size(), 25'000u);
    EXPECT_LE(static_cast<double>(d.memory()) / static_cast<double>(d.tree.shapes.size()), 128);
}

}  // namespace
}  // namespace sgm::derive
