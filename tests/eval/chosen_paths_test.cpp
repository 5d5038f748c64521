#include "modeler/eval/chosen_paths.h"

#include <bit>
#include <limits>

#include "samples.h"

namespace sgm::eval::testing {
namespace {

TEST(Below, IsTheSameOnEveryLevel) {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const float some[] = {0, -0.0f, 1, -1, infinity, -infinity, nan, 0.5f};
    alignas(64) float a[pathPoints], b[pathPoints];
    uint64_t expected = 0;
    for (size_t i = 0; i < pathPoints; ++i) {
        a[i] = some[i % 8], b[i] = some[i / 8];
        expected |= uint64_t{a[i] + 0.5f < b[i]} << i;
    }
    for (const Isa isa : {Isa::Portable, Isa::Avx2, Isa::Avx512})
        EXPECT_EQ(Workspace(isa).impl().kernels.below(a, 0.5f, b, 0, pathPoints), expected);
}

/// Values, derivatives, labels and owners at up to 64 points.
struct Seen {
    explicit Seen(size_t n) : rows(4, std::vector<float>(n)), labels(n), origins(n) {}
    void take(const Tape& tape, const StepContext& c, const LabelPass& names, size_t planes, const Workspace& w) {
        for (size_t plane = 0; plane < planes; ++plane)
            storeResult(tape, c, w.impl().kernels.store, planes, plane, rows[plane].data(), labels.size());
        names.store(labels.data(), origins.data(), labels.size());
    }
    std::vector<std::vector<float>> rows;
    std::vector<uint32_t> labels;
    std::vector<OriginId> origins;
};

/// By all instructions.
Seen byAll(const Tape& tape, const Cloud& cloud, size_t planes, const Step* steps, Workspace& w) {
    Seen seen(cloud.size());
    LabelPass pass(tape, w.impl(), planes);
    runBlocks(
        tape, cloud.points(), steps, planes, w.impl(), {},
        [&](const Instruction& in, const StepContext& c) { pass(in, c); },
        [&](const StepContext& c, size_t, size_t) { seen.take(tape, c, pass, planes, w); });
    return seen;
}

Seen byPaths(const Tape& tape, const Cloud& cloud, size_t planes, const Step* steps, Workspace& w) {
    Seen seen(cloud.size());
    ChosenPaths paths(tape, w.impl(), planes, steps);
    const StepContext& c = paths.run(cloud.points());
    seen.take(tape, c, paths.names(), planes, w);
    return seen;
}

/// Points whose derivatives, by the paths run last, are of another operand than their values.
uint64_t tiedPoints(const Tape& tape, const Workspace& w) {
    uint64_t tied = 0;
    for (size_t i = 0; i < tape.size(); ++i)
        if (field::traits(tape.code()[i].op).selects) {
            const Choice& choice = w.impl().choices[i];
            tied |= (choice.values ^ choice.names) & choice.points;
        }
    return tied;
}

TEST(ChosenPaths, GiveTheBitsOfAllInstructions) {
    Draws draws{20};
    size_t selections = 0, ties = 0, points = 0;
    for (int round = 0; round < 400; ++round) {
        Graph graph;
        const NodeRef root = randomExpression(graph, 5 + draws.below(120), draws);
        const Tape tape = compile(graph, {root, {{-2, -2, -2}, {2, 2, 2}}, 1, 1}, graph.constants());
        for (const Instruction& in : tape.code()) selections += field::traits(in.op).selects ? 1 : 0;
        const Isa isa = std::array{Isa::Portable, Isa::Avx2, Isa::Avx512}[draws.below(3)];
        Workspace w(isa);
        // Few points in a small box take few ways.
        const Box3f box = draws.below(2) == 0 ? boxIn(2, draws) : Box3f{{-2, -2, -2}, {2, 2, 2}};
        const Cloud cloud = pointsIn(box, 1 + draws.below(pathPoints), draws);
        for (const size_t planes : {size_t{1}, size_t{4}}) {
            const Step* const steps = planes == 1 ? w.impl().kernels.values : w.impl().kernels.pieceGradients;
            const Seen expected = byAll(tape, cloud, planes, steps, w), got = byPaths(tape, cloud, planes, steps, w);
            const uint64_t tied = tiedPoints(tape, w);
            ties += static_cast<size_t>(std::popcount(tied)), points += cloud.size();
            for (size_t i = 0; i < cloud.size(); ++i) {
                for (size_t plane = 0; plane < (tied >> i & 1 ? 1 : planes); ++plane)
                    ASSERT_TRUE(sameBits(expected.rows[plane][i], got.rows[plane][i]))
                        << round << ": " << expected.rows[plane][i] << " but " << got.rows[plane][i];
                ASSERT_EQ(expected.labels[i], got.labels[i]) << round;
                ASSERT_EQ(expected.origins[i], got.origins[i]) << round;
            }
        }
    }
    EXPECT_GT(selections, 2000u);
    EXPECT_LT(ties, points / 3);
}

/// The derivative along x of min(x, a x + b y) where the second operand is less by half of the tie margin.
float alongFirst(float a, float b) {
    Graph graph;
    const NodeRef first = graph.x(), second = graph.x() * a + graph.y() * b;
    const Tape tape = compile(graph, {min(first, second), {{-2, -2, -2}, {2, 2, 2}}, 1, 1}, graph.constants());
    Workspace w;
    const float x = 0, y = -tape.tieMargin() / 2 / b, z = 0;
    float value, dx, dy, dz;
    uint32_t label;
    OriginId origin;
    evaluatePieces(tape, {&x, &y, &z, 1}, {&value, &dx, &dy, &dz, &label, &origin}, w);
    EXPECT_FLOAT_EQ(value, b * y);
    return dx;
}

TEST(ChosenPaths, GiveTheDerivativesOfTheNameWhereTwoBendByLittle) {
    EXPECT_EQ(alongFirst(.96f, .28f), 1) << "16 degrees";
    EXPECT_EQ(alongFirst(.8f, .6f), .8f) << "37 degrees";
    EXPECT_EQ(alongFirst(0, 1), 0);
}

}  // namespace
}  // namespace sgm::eval::testing
