// Tapes cut to regions hold what the whole one does there.
#include "modeler/eval/region_cuts.h"

#include <limits>

#include "samples.h"

namespace sgm::eval::testing {
namespace {

/// A balanced union of what `part` gives for 0 … count − 1, each with an owner of its own.
template <class Part>
Tape unionOf(Graph& graph, size_t count, float reach, Part part) {
    std::vector<field::Operand> parts;
    for (size_t i = 0; i < count; ++i) parts.push_back({part(i).id(), static_cast<OriginId>(i + 1)});
    const Box3f box{{-reach, -reach, -reach}, {reach, reach, reach}};
    return compile(graph, {balancedUnion(graph, parts), box, 1, 1}, graph.constants());
}

/// Names of what the points lie on.
struct Names {
    explicit Names(const Tape& tape, const Cloud& cloud)
        : owners(cloud.size()), labels(cloud.size()), taken(cloud.size()) {
        Workspace w;
        evaluateOrigin(tape, cloud.points(), owners.data(), w);
        evaluateLabels(tape, cloud.points(), labels.data(), taken.data(), w);
    }
    friend bool operator==(const Names&, const Names&) = default;
    std::vector<OriginId> owners;
    std::vector<uint32_t> labels;
    std::vector<OriginId> taken;
};

void expectSame(const Tape& cut, const Tape& whole, const Box3f& box, uint64_t seed) {
    Draws draws{seed};
    const Cloud cloud = pointsIn(box, 300, draws);
    const std::vector<float> some = values(cut, cloud), all = values(whole, cloud);
    for (size_t i = 0; i < cloud.size(); ++i) ASSERT_TRUE(sameBits(some[i], all[i])) << i;
    EXPECT_TRUE(Names(cut, cloud) == Names(whole, cloud));
}

/// Balls over a square of sixteen by sixteen metres, of random sizes and heights, with a slab that all of them share.
TEST(RegionCuts, AreTheWholeTapeInTheirRegion) {
    Graph graph;
    Draws draws{5};
    const field::Point p = graph.position();
    const NodeRef slab = abs(p.y) - 0.5f;
    const Tape tape = unionOf(graph, 1500, 9, [&](size_t i) {
        const field::Point at{p.x - graph.slot(draws.real(-8, 8)), p.y - graph.slot(draws.real(-1, 1)),
                              p.z - graph.slot(draws.real(-8, 8))};
        const NodeRef ball = length(at) - graph.slot(draws.real(0.1f, 0.4f));
        return i % 3 == 0 ? max(ball, slab) : ball;
    });
    std::vector<Box3f> boxes;
    for (int z = -4; z < 4; ++z)
        for (int x = -4; x < 4; ++x)
            boxes.push_back({{2.0f * float(x), -2, 2.0f * float(z)}, {2.0f * float(x) + 2, 2, 2.0f * float(z) + 2}});
    Workspace w;
    const RegionCuts cuts(tape, {boxes.data(), boxes.size()}, w);
    ASSERT_FALSE(cuts.empty());
    for (size_t i = 0; i < boxes.size(); ++i) {
        const Tape cut = cuts.cut(tape, i, w);
        EXPECT_LT(cut.size(), tape.size() / 4) << i;
        EXPECT_LE(cut.registerCount(), tape.registerCount());
        expectSame(cut, tape, boxes[i], i + 1);
        FloatInterval range;
        const RangeTrace trace = evaluateRanges(tape, {&boxes[i], 1}, &range, w);
        const Tape usual = shorten(tape, trace, 0, w);
        const RangeTrace ofCut = evaluateRanges(cut, {&boxes[i], 1}, &range, w);
        EXPECT_EQ(shorten(cut, ofCut, 0, w).size(), usual.size()) << i;
    }
}

/// Whatever the tape is: unions within other operations, parts that others read, numbers, a NaN.
TEST(RegionCuts, AreTheWholeTapeForRandomExpressions) {
    size_t shorter = 0;
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        Graph graph;
        Draws draws{seed};
        NodeRef root = randomExpression(graph, 10 + draws.below(60), draws);
        for (int i = 0; i < 6; ++i) {
            const NodeRef other = randomExpression(graph, 5 + draws.below(20), draws);
            root = smaller(graph, {root.id(), OriginId(draws.below(4))}, {other.id(), OriginId(draws.below(4))});
        }
        const Box3f all{{-4, -4, -4}, {4, 4, 4}};
        const Tape tape = compile(graph, {root, all, 1, 1}, graph.constants());
        std::vector<Box3f> boxes;
        for (size_t i = 0; i <= draws.below(20); ++i) boxes.push_back(boxIn(4, draws));
        Workspace w;
        const RegionCuts cuts(tape, {boxes.data(), boxes.size()}, w);
        if (cuts.empty()) continue;
        for (size_t i = 0; i < boxes.size(); ++i) {
            const Tape cut = cuts.cut(tape, i, w);
            shorter += cut.size() < tape.size();
            expectSame(cut, tape, boxes[i], seed);
        }
    }
    EXPECT_GT(shorter, 200u);
}

TEST(RegionCuts, KeepAllWhereAPartIsUnknown) {
    Graph graph;
    const field::Point p = graph.position();
    const Tape tape = unionOf(graph, 3, 9, [&](size_t i) {
        return i == 1 ? p.x + graph.slot(std::numeric_limits<float>::quiet_NaN())
                      : length(p) - graph.slot(float(i + 1));
    });
    const Box3f box{{-1, -1, -1}, {1, 1, 1}};
    Workspace w;
    const RegionCuts cuts(tape, {&box, 1}, w);
    EXPECT_EQ(cuts.cut(tape, 0, w).size(), tape.size());
}

TEST(RegionCuts, AreEmptyWithoutAUnion) {
    Graph graph;
    const field::Point p = graph.position();
    const Tape tape = compile(graph, {max(length(p) - 1.0f, p.x), {}, 1, 1}, graph.constants());
    const Box3f box{{-1, -1, -1}, {1, 1, 1}};
    Workspace w;
    EXPECT_TRUE(RegionCuts(tape, {&box, 1}, w).empty());
}

/// Short ones by their trace, long unions by their parts, what else is long by a trace after all.
TEST(ShortenTo, HoldsWhatTheWholeTapeDoesInTheBox) {
    for (const auto& [count, isUnion] : {std::pair<size_t, bool>{60, true}, {4000, true}, {4000, false}}) {
        Graph graph;
        Draws draws{11};
        const field::Point p = graph.position();
        std::vector<field::Operand> balls;
        for (size_t i = 0; i < count; ++i) {
            const field::Point at{p.x - graph.slot(draws.real(-60, 60)), p.y - graph.slot(draws.real(-1, 1)),
                                  p.z - graph.slot(draws.real(-60, 60))};
            balls.push_back({(length(at) - graph.slot(draws.real(0.4f, 1.2f))).id(), static_cast<OriginId>(i + 1)});
        }
        const NodeRef all = balancedUnion(graph, balls);
        const Box3f bounds{{-64, -4, -64}, {64, 4, 64}}, box{{8, -1, 8}, {16, 1, 16}};
        const Tape tape = compile(graph, {isUnion ? all : max(all, abs(p.y) - 0.5f), bounds, 1, 1}, graph.constants());
        ASSERT_EQ(tape.size() > mostTraced, count > 1000);
        Workspace w;
        const Tape some = shortenTo(tape, box, w);
        EXPECT_LT(some.size(), tape.size() / 4) << count;
        expectSame(some, tape, box, count);
    }
}

}  // namespace
}  // namespace sgm::eval::testing
