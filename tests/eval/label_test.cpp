#include "modeler/field/solids.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

/// Rows of evaluatePieces with the memory behind them.
struct Pieces {
    explicit Pieces(size_t n) : rows(4 * n), labels(n), origins(n) {}
    PieceSamples samples() {
        const size_t n = labels.size();
        return {&rows[0], &rows[n], &rows[2 * n], &rows[3 * n], labels.data(), origins.data()};
    }
    std::vector<float> rows;
    std::vector<uint32_t> labels;
    std::vector<OriginId> origins;
};

Pieces piecesOf(const Tape& tape, const Cloud& cloud) {
    Workspace w;
    Pieces pieces(cloud.size());
    evaluatePieces(tape, cloud.points(), pieces.samples(), w);
    return pieces;
}

std::vector<uint32_t> labelsOf(const Tape& tape, const Cloud& cloud) {
    Workspace w;
    std::vector<uint32_t> labels(cloud.size());
    std::vector<OriginId> origins(cloud.size());
    evaluateLabels(tape, cloud.points(), labels.data(), origins.data(), w);
    return labels;
}

Tape compiled(const Graph& graph, NodeRef root) {
    return compile(graph, {root, {{-2, -2, -2}, {2, 2, 2}}, 1, 1}, graph.constants());
}

/// Labels, origins and the bits of derivatives must be equal inside every smaller region.
void descend(const Graph& graph, NodeRef root, const Tape& full, const Tape& tape, const Box3f& box, int depth,
             Draws& draws, size_t& dropped, size_t& compared) {
    Box3f boxes[8];
    for (Box3f& b : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            const float p = draws.real(box.lo[axis], box.hi[axis]), q = draws.real(box.lo[axis], box.hi[axis]);
            b.lo[axis] = std::min(p, (p + q) / 2);
            b.hi[axis] = std::max(p, (p + q) / 2);
        }
    FloatInterval ranges[8];
    for (size_t at = 0; at < 2; ++at) {
        Workspace w;
        const RangeTrace trace = evaluateRanges(tape, {boxes, 8}, ranges, w);
        const Tape shorter = shorten(tape, trace, at, w);
        dropped += tape.size() - shorter.size();
        const Cloud cloud = pointsIn(boxes[at], 40, draws);
        const Pieces expected = piecesOf(full, cloud), got = piecesOf(shorter, cloud);
        const std::vector<uint32_t> plain = labelsOf(shorter, cloud);
        std::vector<bool> finite(cloud.size());  // a NaN on the way takes sides by its place
        for (size_t i = 0; i < cloud.size(); ++i) finite[i] = isFinite(graph, root, cloud.x[i], cloud.y[i], cloud.z[i]);
        for (size_t i = 0; i < cloud.size(); ++i) {
            if (!finite[i]) continue;
            ++compared;
            ASSERT_EQ(expected.labels[i], got.labels[i]) << i;
            ASSERT_EQ(expected.labels[i], plain[i]) << i;
            ASSERT_EQ(expected.origins[i], got.origins[i]);
        }
        for (size_t i = 0; i < expected.rows.size(); ++i) {
            if (!finite[i % cloud.size()] || !std::isfinite(expected.rows[i])) continue;
            ASSERT_EQ(expected.rows[i], got.rows[i]) << i;
        }
        if (depth > 0) descend(graph, root, full, shorter, boxes[at], depth - 1, draws, dropped, compared);
    }
}

TEST(Labels, AShortenedTapeHasTheSameLabelsAndTheSameBitsOfDerivatives) {
    Draws draws{11};
    size_t dropped = 0, compared = 0;
    for (int repeat = 0; repeat < 1500; ++repeat) {
        Graph graph;
        const NodeRef root = randomExpression(graph, 5 + draws.below(80), draws);
        const Tape tape = compiled(graph, root);
        descend(graph, root, tape, tape, {{-2, -2, -2}, {2, 2, 2}}, 2, draws, dropped, compared);
        if (::testing::Test::HasFatalFailure()) FAIL() << repeat;
    }
    EXPECT_GT(dropped, 10000u);
    EXPECT_GT(compared, 100000u);
}

NodeRef boxAt(Graph& graph, float x, float half) {
    const field::Point p = graph.position();
    const NodeRef h = graph.slot(half);
    return field::solids::boxDistance({p.x - graph.slot(x), p.y, p.z}, {h, h, h});
}

TEST(Labels, ABoxHasSixPieces) {
    Graph graph;
    const Tape tape = compiled(graph, boxAt(graph, 0, 1));
    Cloud cloud;
    for (const float d : {-1.0f, 1.0f}) cloud.add(d, 0.3f, 0.2f), cloud.add(0.3f, d, 0.2f), cloud.add(0.3f, 0.2f, d);
    std::vector<uint32_t> labels = labelsOf(tape, cloud);
    std::sort(labels.begin(), labels.end());
    EXPECT_EQ(std::unique(labels.begin(), labels.end()) - labels.begin(), 6);
    cloud = {};
    for (const float y : {-0.9f, 0.0f, 0.9f}) cloud.add(1, y, 0.1f);
    labels = labelsOf(tape, cloud);
    EXPECT_EQ(labels[0], labels[1]);
    EXPECT_EQ(labels[0], labels[2]);
}

TEST(Labels, CoplanarFacesBelongToTheFirstWhereTheyOverlap) {
    Graph graph;
    const field::Operand both[] = {{boxAt(graph, 0, 1).id(), 1}, {boxAt(graph, 1, 1.0000001f).id(), 2}};
    const Tape tape = compiled(graph, graph.apply(codeOf<ops::Min>, both));
    Cloud cloud;
    for (const float x : {-0.5f, 0.2f, 0.5f, 0.9f, 1.5f}) cloud.add(x, 1, 0.3f);
    const Pieces pieces = piecesOf(tape, cloud);
    const std::vector<OriginId> owners{1, 1, 1, 1, 2};
    EXPECT_EQ(pieces.origins, owners);
}

TEST(Labels, ACylinderHasThreePieces) {
    Graph graph;
    const field::Point p = graph.position();
    const NodeRef side = sqrt(square(p.x) + square(p.z)) - 1.0f, cap = abs(p.y) - 1.0f;
    Cloud cloud;
    for (const float grown : {0.999f, 1.0f, 1.001f}) {
        cloud.add(grown, 0.5f, 0), cloud.add(0, -0.5f, grown);
        cloud.add(0.3f, grown, 0), cloud.add(0.3f, -grown, 0.2f);
    }
    const std::vector<uint32_t> labels = labelsOf(compiled(graph, graph.apply(codeOf<ops::Rim>, {side, cap})), cloud);
    EXPECT_EQ(labels[0], labels[1]);
    EXPECT_NE(labels[0], labels[2]);
    EXPECT_NE(labels[2], labels[3]);
    for (size_t i = 4; i < labels.size(); ++i) EXPECT_EQ(labels[i], labels[i % 4]) << i;
}

TEST(Labels, ABlendIsOnePiece) {
    Graph graph;
    const field::Point p = graph.position();
    Cloud cloud;
    const auto ball = [&](float x) { return length(field::Point{p.x - graph.slot(x), p.y, p.z}) - 0.7f; };
    const NodeRef parts[] = {graph.slot(0.2f), ball(-0.5f), ball(0.5f)};
    const NodeRef blend = graph.apply(codeOf<ops::Blend>, {parts[0], parts[1], parts[2]});
    for (const float x : {-1.2f, -0.3f, 0.0f, 0.3f, 1.2f}) cloud.add(x, 0.5f, 0);
    const std::vector<uint32_t> joined = labelsOf(compiled(graph, blend), cloud);
    for (const uint32_t label : joined) EXPECT_EQ(label, joined[0]);
}

}  // namespace
}  // namespace sgm::eval::testing
