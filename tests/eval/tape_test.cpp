#include "modeler/eval/workspace.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

Tape compiled(const Graph& graph, NodeRef root) { return compile(graph, {root, {}, 1, 1}, graph.constants()); }

TEST(Tape, IsTheGraphBitForBit) {
    Draws draws{1};
    for (int repeat = 0; repeat < 1000; ++repeat) {
        Graph graph;
        const NodeRef root = randomExpression(graph, 5 + draws.below(80), draws);
        const Tape tape = compiled(graph, root);
        const Cloud cloud = pointsIn({{-2, -2, -2}, {2, 2, 2}}, 33, draws);
        const std::vector<float> got = values(tape, cloud);
        for (size_t i = 0; i < cloud.size(); ++i)
            ASSERT_TRUE(sameBits(got[i], walk(graph, root, cloud.x[i], cloud.y[i], cloud.z[i])));
    }
}

TEST(Tape, HoldsBlendsOfMoreOperandsThanSixteenBits) {
    // Spheres in a row, far more than the blend reaches, so that a small blend around a point is the whole truth there.
    constexpr int count = 70'000;
    Graph graph;
    const auto rowOf = [&graph](int first, int last) {
        std::vector<field::Operand> operands{{graph.literal(0.5f).id(), 0}};
        for (int i = first; i < last; ++i)
            operands.push_back({abs(graph.x() - static_cast<float>(i)).id(), static_cast<OriginId>(i + 1)});
        return graph.apply(field::codeOf<ops::Blend>, operands);
    };
    const Tape all = compiled(graph, rowOf(0, count));
    Cloud cloud;
    cloud.add(69'000.75f, 0, 0);
    cloud.add(69'999.25f, 0, 0);
    const std::vector<float> got = values(all, cloud);
    EXPECT_EQ(got[0], values(compiled(graph, rowOf(68'999, 69'004)), cloud)[0]);
    EXPECT_EQ(got[1], values(compiled(graph, rowOf(69'996, count)), cloud)[1]);

    Workspace w;
    OriginId owners[2];
    evaluateOrigin(all, cloud.points(), owners, w);
    EXPECT_EQ(owners[0], 69'002u);
    EXPECT_EQ(owners[1], 70'000u);
    const Box3f box{{69'000.5f, 0, 0}, {69'001, 1, 1}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(all, {&box, 1}, &range, w);
    const Tape shorter = shorten(all, trace, 0, w);
    EXPECT_LT(shorter.size(), 20u);
    EXPECT_EQ(values(shorter, cloud)[0], got[0]);
}

TEST(Tape, ItsOperationsAreCounted) {
    Graph graph;
    const Tape tape = compiled(graph, min(graph.x() * graph.z() + graph.y() * graph.z(), graph.y()));
    Tally tally;
    Workspace w;
    w.tallyInto(&tally);
    const std::vector<float> at(100, 1.0f);
    std::vector<float> f(100), dx(100), dy(100), dz(100);
    evaluate(tape, {at.data(), at.data(), at.data(), 100}, f.data(), w);
    evaluateGradient(tape, {at.data(), at.data(), at.data(), 7}, f.data(), dx.data(), dy.data(), dz.data(), w);
    using field::codeOf;
    const Tally expected{{{codeOf<ops::Mul>, 2, 0, EvaluationKind::Value}, 200},
                         {{codeOf<ops::Add>, 2, 0, EvaluationKind::Value}, 100},
                         {{codeOf<ops::Min>, 2, 0, EvaluationKind::Value}, 100},
                         {{codeOf<ops::Mul>, 2, 0, EvaluationKind::Gradient}, 14},
                         {{codeOf<ops::Add>, 2, 0, EvaluationKind::Gradient}, 7},
                         {{codeOf<ops::Min>, 2, 0, EvaluationKind::Gradient}, 7}};
    EXPECT_EQ(tally, expected);

    tally.clear();
    const Box3f boxes[3]{};
    FloatInterval ranges[3];
    evaluateRanges(tape, {boxes, 3}, ranges, w);
    EXPECT_EQ((tally[{codeOf<ops::Mul>, 2, 0, EvaluationKind::Range}]), 6u);
    tally = expected;

    w.tallyInto(nullptr);
    evaluate(tape, {at.data(), at.data(), at.data(), 100}, f.data(), w);
    EXPECT_EQ(tally, expected);
}

TEST(Tape, FoldsWhatIsConstant) {
    Graph graph;
    const NodeRef a = graph.slot(2), b = graph.slot(3);
    const Tape folded = compiled(graph, sqrt(a * b + 3.0f));
    EXPECT_EQ(folded.size(), 0u);
    ASSERT_TRUE(isConstant(folded.result()));
    EXPECT_EQ(folded.constants()[indexOf(folded.result())], 3.0f);

    EXPECT_EQ(compiled(graph, (graph.x() - graph.slot(0)) * graph.slot(1)).size(), 0u);
    EXPECT_EQ(compiled(graph, graph.x() + (a + b)).size(), 1u);
}

TEST(Tape, BindsTheConstantsItIsGiven) {
    Graph graph;
    const NodeRef root = graph.x() * graph.slot(2);
    const float other[] = {5};
    const Tape tape = compile(graph, {root, {}, 1, 1}, other);
    Cloud cloud;
    cloud.add(3, 0, 0);
    EXPECT_EQ(values(tape, cloud)[0], 15.0f);
}

TEST(Tape, ConstantAndCoordinateFieldsNeedNoCode) {
    Graph graph;
    const Tape four = compiled(graph, graph.literal(4)), y = compiled(graph, graph.y());
    Cloud cloud;
    cloud.add(1, 2, 3);
    EXPECT_EQ(values(four, cloud)[0], 4.0f);
    EXPECT_EQ(values(y, cloud)[0], 2.0f);
    Workspace w;
    float v, dx, dy, dz;
    evaluateGradient(y, cloud.points(), &v, &dx, &dy, &dz, w);
    EXPECT_EQ((Vec3f{dx, dy, dz}), (Vec3f{0, 1, 0}));
    evaluateGradient(four, cloud.points(), &v, &dx, &dy, &dz, w);
    EXPECT_EQ((Vec3f{dx, dy, dz}), (Vec3f{}));
    const Box3f box{{0, 1, 2}, {3, 4, 5}};
    FloatInterval range;
    evaluateRanges(y, {&box, 1}, &range, w);
    EXPECT_EQ(range.lo, 1.0f);
    EXPECT_EQ(range.hi, 4.0f);
    const RangeTrace trace = evaluateRanges(four, {&box, 1}, &range, w);
    EXPECT_EQ(range.hi, 4.0f);
    EXPECT_EQ(shorten(four, trace, 0, w).size(), 0u);
}

TEST(Tape, BalancedUnionsNeedFewRegisters) {
    Graph graph;
    std::vector<NodeRef> parts;
    for (int i = 0; i < 1024; ++i) {
        const field::Point p = graph.position();
        parts.push_back(length(field::Point{p.x - graph.slot(float(i)), p.y, p.z}) - 0.5f);
    }
    while (parts.size() > 1) {
        std::vector<NodeRef> pairs;
        for (size_t i = 0; i < parts.size(); i += 2) pairs.push_back(min(parts[i], parts[i + 1]));
        parts = pairs;
    }
    EXPECT_LE(compiled(graph, parts[0]).registerCount(), 3u + 10u + 4u);
}

TEST(Tape, DeepChainsAndManyNodesDoNotOverflow) {
    Graph graph;
    NodeRef chain = graph.x();
    for (int i = 0; i < 100000; ++i)
        chain = i % 2 ? sqrt(chain + graph.slot(1)) : min(chain, graph.y() + graph.slot(float(i)));
    const Tape tape = compiled(graph, chain);
    EXPECT_LE(tape.registerCount(), 6u);
    Cloud cloud;
    cloud.add(0.5f, 1, 0);
    EXPECT_EQ(values(tape, cloud)[0], walk(graph, chain, 0.5f, 1, 0));
    Workspace w;
    const Box3f box{{0, 0, 0}, {1, 1, 1}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    EXPECT_LT(shorten(tape, trace, 0, w).size(), tape.size());
}

TEST(Tape, BitsDoNotDependOnThePlaceInABatch) {
    Draws draws{7};
    Graph graph;
    const Tape tape = compiled(graph, randomExpression(graph, 60, draws));
    const Cloud cloud = pointsIn({{-2, -2, -2}, {2, 2, 2}}, 1500, draws);
    const std::vector<float> all = values(tape, cloud);
    Workspace w;
    for (size_t first = 0; first < cloud.size(); first += 37) {
        float one;
        evaluate(tape, {&cloud.x[first], &cloud.y[first], &cloud.z[first], 1}, &one, w);
        EXPECT_TRUE(sameBits(one, all[first]));
    }
}

/// Rows of so many floats, aligned and padded.
struct Padded {
    AlignedFloats memory;
    size_t n, room = (n + pointPadding - 1) / pointPadding * pointPadding;
    float* row(size_t r) { return memory.get(7 * room) + r * room; }
    Padded(const Cloud& cloud, size_t count) : n(count) {
        const std::vector<float>* const from[] = {&cloud.x, &cloud.y, &cloud.z};
        for (size_t axis = 0; axis < 3; ++axis)
            for (size_t i = 0; i < room; ++i) row(axis)[i] = (*from[axis])[std::min(i, n - 1)];
    }
    Points points() { return {row(0), row(1), row(2), n, true}; }
};

TEST(Tape, PaddedPointsGiveTheSameBits) {
    Draws draws{11};
    for (int repeat = 0; repeat < 40; ++repeat) {
        Graph graph;
        const Tape tape = compiled(graph, randomExpression(graph, 3 + draws.below(60), draws));
        const Cloud cloud = pointsIn({{-2, -2, -2}, {2, 2, 2}}, 1500, draws);
        Workspace w;
        for (const size_t n : {1, 16, 95, 97, 729, 1500}) {
            Padded padded(cloud, n);
            std::vector<float> out[4];
            for (auto& row : out) row.resize(n);
            const Points loose{cloud.x.data(), cloud.y.data(), cloud.z.data(), n};
            evaluate(tape, loose, out[0].data(), w);
            evaluate(tape, padded.points(), padded.row(3), w);
            for (size_t i = 0; i < n; ++i) ASSERT_TRUE(sameBits(padded.row(3)[i], out[0][i]));
            evaluateGradient(tape, loose, out[0].data(), out[1].data(), out[2].data(), out[3].data(), w);
            evaluateGradient(tape, padded.points(), padded.row(3), padded.row(4), padded.row(5), padded.row(6), w);
            for (size_t r = 0; r < 4; ++r)
                for (size_t i = 0; i < n; ++i) ASSERT_TRUE(sameBits(padded.row(3 + r)[i], out[r][i]));
        }
    }
}

TEST(Tape, SolidsAtTheCoordinatesHaveTheDerivativesOfMovedOnes) {
    Draws draws{12};
    const Cloud cloud = pointsIn({{-2, -2, -2}, {2, 2, 2}}, 500, draws);
    // A ball, and a box, at x, y, z and the same at 2x/2 + .5, …, half a metre further.
    const auto slopes = [&](field::OpCode op, std::vector<float> numbers, bool moved) {
        Graph graph;
        std::vector<field::Operand> operands;
        for (const NodeRef at : {graph.x(), graph.y(), graph.z()})
            operands.push_back({(moved ? at * graph.slot(2) * graph.slot(.5f) + graph.slot(.5f) : at).id(), 0});
        for (size_t i = 0; i < numbers.size(); ++i)
            operands.push_back({graph.slot(numbers[i] + (moved && i < 3 ? .5f : 0)).id(), 0});
        const Tape tape = compiled(graph, graph.apply(op, operands));
        std::vector<float> out[4];
        for (auto& row : out) row.resize(cloud.size());
        Workspace w;
        evaluateGradient(tape, cloud.points(), out[0].data(), out[1].data(), out[2].data(), out[3].data(), w);
        std::vector<Vec3f> found;
        for (size_t i = 0; i < cloud.size(); ++i) found.push_back({out[1][i], out[2][i], out[3][i]});
        return found;
    };
    const auto compare = [&](field::OpCode op, const std::vector<float>& numbers) {
        const auto still = slopes(op, numbers, false), moved = slopes(op, numbers, true);
        size_t apart = 0;
        for (size_t i = 0; i < still.size(); ++i) apart += length(still[i] - moved[i]) > 1e-4f;
        EXPECT_LE(apart, 5u);  // on a crease the last bit decides
    };
    compare(field::codeOf<ops::Ball>, {.125f, -.25f, .5f, 1, 1.5f, .75f, .8f});
    compare(field::codeOf<ops::Box>, {.125f, -.25f, .5f, .7f, .9f, .4f});
}

}  // namespace
}  // namespace sgm::eval::testing
