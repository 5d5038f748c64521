#include "modeler/eval/fingerprint.h"
#include "modeler/eval/left_out.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

/// Values and derivatives, one after the other.
std::vector<float> gradients(const Tape& tape, const Cloud& cloud, Workspace& w) {
    const size_t n = cloud.size();
    std::vector<float> all(4 * n);
    evaluateGradient(tape, cloud.points(), &all[0], &all[n], &all[2 * n], &all[3 * n], w);
    return all;
}

/// Values, derivatives and owners of a tape and its shortened form must agree inside the region, and so on inside
/// smaller regions.
void descend(const Tape& full, const Tape& tape, const Box3f& box, int depth, Draws& draws, size_t& dropped) {
    Workspace w;
    Box3f boxes[64];
    const size_t n = 1 + draws.below(64);
    for (size_t i = 0; i < n; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const float a = draws.real(box.lo[axis], box.hi[axis]), b = draws.real(box.lo[axis], box.hi[axis]);
            boxes[i].lo[axis] = std::max(box.lo[axis], std::min(a, (a + b) / 2));
            boxes[i].hi[axis] = std::min(box.hi[axis], std::max(a, (a + b) / 2));
        }
    FloatInterval ranges[64];
    evaluateRanges(tape, {boxes, n}, ranges, w);
    for (int pick = 0; pick < 3; ++pick) {
        const size_t at = draws.below(n);
        Workspace inner;
        const RangeTrace trace = evaluateRanges(tape, {boxes, n}, ranges, inner);
        Tape shorter = full;  // whose memory is taken
        shorten(tape, trace, at, inner, shorter);
        EXPECT_LE(shorter.size(), tape.size());
        dropped += tape.size() - shorter.size();
        const Cloud cloud = pointsIn(boxes[at], 40, draws);
        const std::vector<float> expected = values(full, cloud), got = values(shorter, cloud);
        std::vector<OriginId> owners(cloud.size()), same(cloud.size());
        evaluateOrigin(full, cloud.points(), owners.data(), inner);
        evaluateOrigin(shorter, cloud.points(), same.data(), inner);
        const std::vector<float> slopes = gradients(full, cloud, inner), slopesLeft = gradients(shorter, cloud, inner);
        // Up to rounding: a blend weighs its only part by t · (1/t). Infinite slopes feel the parts of weight 0.
        for (size_t i = 0; i < slopes.size(); ++i) {
            const float slack = 1e-3f * (1 + std::abs(slopes[i]));
            ASSERT_TRUE(!std::isfinite(slopes[i]) || std::abs(slopes[i] - slopesLeft[i]) <= slack)
                << slopes[i] << " but " << slopesLeft[i];
        }
        for (size_t i = 0; i < cloud.size(); ++i) {
            ASSERT_TRUE(sameBits(expected[i], got[i])) << expected[i] << " but " << got[i];
            ASSERT_EQ(owners[i], same[i]);
            ASSERT_TRUE(std::isinf(ranges[at].lo) || std::isinf(ranges[at].hi) ||
                        (got[i] >= ranges[at].lo && got[i] <= ranges[at].hi));
        }
        if (depth > 0) descend(full, shorter, boxes[at], depth - 1, draws, dropped);
    }
}

TEST(Shorten, KeepsValuesDerivativesAndOwnersInsideTheRegion) {
    Draws draws{3};
    size_t dropped = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        Graph graph;
        const NodeRef root = randomExpression(graph, 5 + draws.below(80), draws);
        const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
        descend(tape, tape, {{-2, -2, -2}, {2, 2, 2}}, 2, draws, dropped);
        if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(dropped, 10000u);
}

/// Spheres on a line, united in a balanced tree.
NodeRef spheres(Graph& graph, int first, int count) {
    if (count > 1) return min(spheres(graph, first, count / 2), spheres(graph, first + count / 2, count - count / 2));
    const field::Point p = graph.position();
    return length(field::Point{p.x - graph.slot(float(first)), p.y, p.z}) - graph.slot(0.4f);
}

TEST(Shorten, AUnionNearOneOfItsSpheresIsThatSphere) {
    Graph graph;
    const NodeRef root = spheres(graph, 0, 256);
    const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f box{{99.9f, -0.1f, -0.1f}, {100.1f, 0.1f, 0.1f}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    const Tape one = shorten(tape, trace, 0, w);
    const NodeRef hundredth = spheres(graph, 100, 1);
    const Tape alone = compile(graph, {hundredth, {}, 1, 1}, graph.constants());
    EXPECT_EQ(one.size(), alone.size());
    EXPECT_LE(one.registerCount(), alone.registerCount() + 1);
}

TEST(Shorten, TracesOfOneWorkspaceStandBesideEachOther) {
    Graph graph;
    const NodeRef roots[] = {spheres(graph, 0, 64), spheres(graph, 8, 16)};
    const Tape many = compile(graph, {roots[0], {}, 1, 1}, graph.constants());
    const Tape few = compile(graph, {roots[1], {}, 1, 1}, graph.constants());
    const auto around = [](float x) { return Box3f{{x - 0.1f, -0.1f, -0.1f}, {x + 0.1f, 0.1f, 0.1f}}; };
    const Box3f boxes[] = {around(10), around(20), around(40)};
    FloatInterval ranges[3];
    Workspace shared, alone;
    const RangeTrace first = evaluateRanges(many, {boxes, 3}, ranges, shared);
    const RangeTrace second = evaluateRanges(few, {boxes, 2}, ranges, shared);
    for (size_t i = 0; i < 3; ++i) {
        const RangeTrace own = evaluateRanges(many, {boxes, 3}, ranges, alone);
        EXPECT_EQ(fingerprint(shorten(many, first, i, shared)), fingerprint(shorten(many, own, i, alone)));
        if (i == 2) break;
        const RangeTrace other = evaluateRanges(few, {boxes, 2}, ranges, alone);
        EXPECT_EQ(fingerprint(shorten(few, second, i, shared)), fingerprint(shorten(few, other, i, alone)));
    }
    EXPECT_LT(shorten(many, first, 2, shared).size(), 20u);
}

TEST(Shorten, FewRegionsGiveTheTapesThatManyGive) {
    Draws draws{11};
    for (int repeat = 0; repeat < 200; ++repeat) {
        Graph graph;
        const NodeRef root =
            repeat % 4 == 0 ? spheres(graph, 0, 16) : randomExpression(graph, 5 + draws.below(80), draws);
        const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
        Box3f boxes[5];
        for (Box3f& box : boxes) {
            const Vec3f lo{draws.real(-2, 1), draws.real(-2, 1), draws.real(-2, 1)};
            box = {lo, lo + Vec3f{1, 1, 1} * draws.real(.1f, 1)};
        }
        Workspace w;
        FloatInterval few[5], many[5];
        const RangeTrace all = evaluateRanges(tape, {boxes, 5}, many, w);
        for (size_t n = 1; n <= 4; ++n) {
            const RangeTrace some = evaluateRanges(tape, {boxes, n}, few, w);
            for (size_t i = 0; i < n; ++i) {
                EXPECT_TRUE(sameBits(few[i].lo, many[i].lo) && sameBits(few[i].hi, many[i].hi));
                ASSERT_EQ(fingerprint(shorten(tape, some, i, w)), fingerprint(shorten(tape, all, i, w)))
                    << n << ' ' << i;
            }
        }
    }
}

TEST(Shorten, APartIsDroppedForANearerOneElsewhereInTheTree) {
    Graph graph;
    const auto ball = [&](float x) {
        const field::Point p = graph.position();
        return length(field::Point{p.x - graph.slot(x), p.y, p.z}) - graph.slot(0.4f);
    };
    // The balls at 1.2 and 1.25 don't beat each other, nor does that at 0.6 beat them; the one at 0 does.
    const NodeRef others = min(min(ball(1.2f), ball(1.25f)), ball(0.6f));
    const NodeRef root = max(-min(ball(0), others), graph.y() - 9.0f);
    const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f box{{-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    const Tape one = shorten(tape, trace, 0, w);
    size_t balls = 0;
    for (const Instruction& in : one.code()) balls += in.op == codeOf<ops::Sqrt>;
    EXPECT_EQ(balls, 2u);  // those at 0 and 0.6, whose ranges meet
}

/// Shortened to a box, a tape keeps its bits within what is told apart, and its side beyond.
void expectSides(const Tape& tape, const Box3f& box, RelevantRange care) {
    Workspace w;
    Draws draws{5};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    const Tape exact = shorten(tape, trace, 0, w), near = shorten(tape, trace, 0, w, care);
    const auto operands = [](const Tape& t) {
        size_t n = 0;
        for (const Instruction& in : t.code()) n += in.count;
        return n;
    };
    EXPECT_LT(operands(near), operands(exact));
    const Cloud cloud = pointsIn(box, 2000, draws);
    const std::vector<float> expected = values(tape, cloud), got = values(near, cloud);
    for (size_t i = 0; i < cloud.size(); ++i) {
        if (expected[i] > care.most)
            EXPECT_GT(got[i], care.most);
        else if (expected[i] < care.least)
            EXPECT_LT(got[i], care.least);
        else
            EXPECT_TRUE(sameBits(expected[i], got[i])) << expected[i] << " but " << got[i];
    }
}

TEST(Shorten, ValuesBeyondWhatIsToldApartKeepTheirSide) {
    Graph graph;
    const NodeRef holes = max(graph.y() - 0.1f, -spheres(graph, 0, 64));
    expectSides(compile(graph, {holes, {}, 1, 1}, graph.constants()), {{20, -3, -3}, {26, 3, 3}}, {-0.1f, 0.3f});
}

TEST(Shorten, WhatItMayLeaveOutIsKnownBefore) {
    const auto roots = [](const Tape& tape) {
        return std::count_if(tape.code().begin(), tape.code().end(),
                             [](const Instruction& in) { return in.op == field::codeOf<field::ops::Sqrt>; });
    };
    Draws draws{5};
    size_t kept = 0, dropped = 0, unsure = 0;
    for (int form = 0; form < 4; ++form) {
        field::Graph g;
        const field::NodeRef tube = field::sqrt(g.x() * g.x() + g.y() * g.y()) - 1, slab = field::abs(g.z()) - 1;
        const field::NodeRef both = form % 2 == 0 ? field::max(tube, slab) : field::min(slab, tube);
        const field::NodeRef f = form < 2 ? both : field::min(both, g.x() + 3);
        const Tape tape = compile(g, {f, {{-3, -3, -3}, {3, 3, 3}}, 1, 1}, g.constants());
        size_t root = 0;
        while (tape.code()[root].op != field::codeOf<field::ops::Sqrt>) ++root;
        Box3f boxes[64];
        for (Box3f& box : boxes) {
            const auto at = [&] { return draws.real(-3, 2.5f); };
            const Vec3f lo{at(), at(), at()};
            box = {lo, lo + Vec3f{.5f, .5f, .5f}};
        }
        Workspace w;
        FloatInterval ranges[64];
        const RangeTrace trace = evaluateRanges(tape, {boxes, 64}, ranges, w);
        const RelevantRange care{-0.4f, 0.4f};
        const uint64_t out = mayLeaveOut(tape, root, 64, trace, care);
        for (size_t i = 0; i < 64; ++i) {
            const bool left = roots(shorten(tape, trace, i, w, care)) == 0, may = (out >> i & 1) != 0;
            if (form < 2)
                EXPECT_EQ(left, may) << "form " << form << ", box " << i;
            else
                EXPECT_TRUE(may || !left);
            (left ? dropped : kept) += form < 2;
            unsure += form >= 2 && may && !left;
        }
    }
    EXPECT_GT(kept, 20u);
    EXPECT_GT(dropped, 20u);
    EXPECT_GT(unsure, 0u);
}

TEST(Shorten, WhatIsToldApartGoesThroughSumsAndScales) {
    Graph graph;
    const NodeRef row = spheres(graph, 0, 64), wave = graph.slot(0.05f) * sin(graph.x() * graph.slot(3.0f));
    const Box3f box{{20, -3, -3}, {26, 3, 3}};
    for (const NodeRef root : {row - graph.slot(0.1f), row + graph.slot(0.2f), row * graph.slot(3.0f), row - wave,
                               (row - wave) / graph.slot(1.5f), graph.slot(0.7f) * (graph.slot(-0.1f) + row)})
        expectSides(compile(graph, {root, {}, 1, 1}, graph.constants()), box, {-0.1f, 0.3f});
}

TEST(Shorten, WhatIsToldApartGoesThroughMorphs) {
    Graph graph;
    const NodeRef row = spheres(graph, 0, 64), others = spheres(graph, -3, 64);
    const NodeRef slanted = min(others, graph.y() + graph.x() * graph.slot(0.1f));
    for (const float t : {0.01f, 0.5f, 0.9f})
        for (const NodeRef to : {others, slanted}) {
            const field::Operand operands[] = {{row.id(), 0}, {to.id(), 0}, {graph.slot(t).id(), 0}};
            const NodeRef root = graph.apply(codeOf<ops::Morph>, operands);
            expectSides(compile(graph, {root, {}, 1, 1}, graph.constants()), {{20, -3, -3}, {26, 3, 3}}, {-0.1f, 0.1f});
        }
}

TEST(Shorten, PartsOfABlendThatAreFarFromWhatIsToldApartAreDropped) {
    Graph graph;
    std::vector<field::Operand> operands{{graph.slot(0.2f).id(), 0}};
    for (int i = 0; i < 64; ++i) operands.push_back({spheres(graph, i, 1).id(), 0});
    const NodeRef smoothMin = graph.apply(codeOf<ops::Blend>, operands);
    expectSides(compile(graph, {smoothMin, {}, 1, 1}, graph.constants()), {{20, 1, 1}, {26, 4, 4}}, {-0.1f, 0.1f});
    expectSides(compile(graph, {smoothMin, {}, 1, 1}, graph.constants()), {{20, -3, -3}, {26, 3, 3}}, {-0.1f, 0.1f});
}

TEST(Shorten, NothingIsCopiedWhenOperandsHaveOwners) {
    Graph graph;
    const NodeRef s = spheres(graph, 0, 1), t = spheres(graph, 10, 1), u = spheres(graph, 20, 1);
    const field::Operand inner[] = {{s.id(), 1}, {t.id(), 2}};
    const NodeRef pair = graph.apply(codeOf<ops::Min>, inner);
    const field::Operand outer[] = {{pair.id(), 0}, {u.id(), 3}};
    const NodeRef all = graph.apply(codeOf<ops::Min>, outer);
    const Tape tape = compile(graph, {all, {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f box{{-0.1f, 0, 0}, {0.1f, 0, 0}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    const Tape one = shorten(tape, trace, 0, w);
    for (const Instruction& in : one.code()) EXPECT_NE(in.op, codeOf<ops::Copy>);
    Cloud cloud;
    cloud.add(0, 0, 0);
    OriginId owner = 0;
    evaluateOrigin(one, cloud.points(), &owner, w);
    EXPECT_EQ(owner, 1u);
}

}  // namespace
}  // namespace sgm::eval::testing
