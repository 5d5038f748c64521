#include <limits>

#include "modeler/eval/workspace.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

TEST(NotAbove, IsTheSameOnEveryLevel) {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const float some[] = {0, -0.0f, 1, -1, infinity, -infinity, nan, 0.5f};
    alignas(64) float row[maxBoxes], most[maxBoxes];
    uint64_t expected = 0;
    for (size_t i = 0; i < maxBoxes; ++i) {
        row[i] = some[i % 8], most[i] = some[i / 8];
        expected |= uint64_t{!(row[i] > most[i])} << i;
    }
    for (const Isa isa : {Isa::Portable, Isa::Avx2, Isa::Avx512})
        EXPECT_EQ(Workspace(isa).impl().kernels.notAbove(row, most, maxBoxes), expected);
}

field::Operand ball(Graph& graph, float x, OriginId owner) {
    const field::Point p = graph.position();
    return {(length(field::Point{p.x - graph.slot(x), p.y, p.z}) - graph.slot(0.4f)).id(), owner};
}

std::vector<OriginId> ownersOf(const Tape& tape, const Cloud& cloud) {
    Workspace w;
    std::vector<OriginId> owners(cloud.size());
    evaluateOrigin(tape, cloud.points(), owners.data(), w);
    return owners;
}

/// A long union, whose tree leans to neither side, shortened to all of it.
TEST(UnionParts, ThatAreAllLeftTakeFewRegisters) {
    Graph graph;
    std::vector<field::Operand> parts;
    for (int i = 0; i < 1000; ++i) parts.push_back(ball(graph, float(i), OriginId(i + 1)));
    const Tape tape = compile(graph, {balancedUnion(graph, parts), {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f box{{-1, -600, -1}, {1000, 600, 1}};  // so wide that no ball is above another all over
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    const Tape same = shorten(tape, trace, 0, w);
    EXPECT_EQ(same.size(), tape.size());
    EXPECT_LE(same.registerCount(), tape.registerCount());
    Draws draws{9};
    const Cloud cloud = pointsIn(box, 3000, draws);
    EXPECT_EQ(values(same, cloud), values(tape, cloud));
    EXPECT_EQ(ownersOf(same, cloud), ownersOf(tape, cloud));
}

TEST(UnionParts, OwnersAreHeardFromTheResultDown) {
    Graph graph;
    const NodeRef inner = smaller(graph, ball(graph, 0, 1), ball(graph, 1, 2));
    const NodeRef outer = smaller(graph, {inner.id(), 0}, ball(graph, 2, 3));
    const NodeRef named = smaller(graph, {outer.id(), 7}, ball(graph, 3, 4));  // 7 speaks for balls 0 to 2
    const NodeRef root =
        smaller(graph, {named.id(), 0}, ball(graph, 3, 5));  // where 4 and 5 are equal, the first is it
    const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f boxes[] = {{{-1, -9, -1}, {9, 9, 1}}, {{0.9f, 0, 0}, {1.1f, 0, 0}}, {{2.9f, 0, 0}, {3.1f, 0, 0}}};
    FloatInterval ranges[3];
    for (size_t region = 0; region < 3; ++region) {
        const RangeTrace trace = evaluateRanges(tape, {boxes, 3}, ranges, w);
        const Tape some = shorten(tape, trace, region, w);
        Draws draws{11};
        const Cloud cloud = pointsIn(boxes[region], 200, draws);
        const std::vector<OriginId> owners = ownersOf(some, cloud);
        EXPECT_EQ(owners, ownersOf(tape, cloud));
        if (region == 0) continue;
        EXPECT_EQ(owners, std::vector<OriginId>(cloud.size(), region == 1 ? 7u : 4u));
    }
}

/// A minimum that is read outside of the union too stays one value: no instruction is written for it twice.
TEST(UnionParts, AMinimumWithAnotherReaderIsAPart) {
    Graph graph;
    const NodeRef shared = smaller(graph, ball(graph, 0, 0), ball(graph, 1, 0));
    const NodeRef root = smaller(graph, {shared.id(), 0}, {(shared * graph.slot(0.5f) + graph.slot(0.1f)).id(), 0});
    const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
    Workspace w;
    const Box3f box{{-1, -1, -1}, {2, 1, 1}};
    FloatInterval range;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &range, w);
    EXPECT_EQ(shorten(tape, trace, 0, w).size(), tape.size());
}

}  // namespace
}  // namespace sgm::eval::testing
