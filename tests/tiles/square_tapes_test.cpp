// Tapes over squares hold what the whole one does there, whatever was asked before.
#include "grammar/pipeline/square_tapes.h"

#include <gtest/gtest.h>

#include <random>

#include "modeler/field/graph.h"
#include "modeler/field/ops.h"

namespace sgm::pipeline {
namespace {

using field::Graph;
using field::NodeRef;
using tiles::Cell;

constexpr double side_m = 256;
constexpr float half_m = 9000;
const Box3f bounds{{-half_m, -3, -half_m}, {half_m, 14, half_m}};

/// A plain with balls, most of them about its middle: there the tape is long enough to be cut twice.
eval::Tape plainWithBalls() {
    Graph graph;
    const field::Point p = graph.position();
    std::minstd_rand draw(3);
    const auto within = [&](float reach) { return reach * (float(draw() % 20001) / 10000 - 1); };
    std::vector<NodeRef> parts{p.y + 2.0f};
    for (int i = 0; i < 22'000; ++i) {
        const float far = i % 5 == 0 ? half_m - 20 : 1500;
        const float x = within(far), y = within(4), z = within(far), radius = 5 + within(3);
        parts.push_back(length(field::Point{p.x - graph.slot(x), p.y - graph.slot(y), p.z - graph.slot(z)}) -
                        graph.slot(radius));
    }
    for (; parts.size() > 1;) {
        std::vector<NodeRef> pairs;
        for (size_t i = 0; i + 1 < parts.size(); i += 2) pairs.push_back(min(parts[i], parts[i + 1]));
        if (parts.size() % 2 == 1) pairs.push_back(parts.back());
        parts = pairs;
    }
    return eval::compile(graph, {parts[0], bounds, 1, 1}, graph.constants());
}

std::vector<float> valuesOf(const eval::Tape& tape, const Cell& cell, eval::Workspace& workspace) {
    std::minstd_rand draw(7);
    const auto share = [&] { return float(draw() % 20001) / 10000 - 1; };
    std::vector<float> x, y, z, values(500);
    const Vec3d c = cell.centre(side_m);
    const auto half = static_cast<float>(cell.side_m(side_m) / 2);
    for (size_t i = 0; i < values.size(); ++i) {
        x.push_back(static_cast<float>(c.x) + half * share());
        y.push_back(8 * share());
        z.push_back(static_cast<float>(c.z) + half * share());
    }
    eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    return values;
}

TEST(SquareTapes, HoldWhatTheWholeTapeDoes) {
    const eval::Tape whole = plainWithBalls();
    ASSERT_GT(whole.size(), 200'000u);
    eval::Workspace workspace, other;
    SquareTapes tapes(whole, bounds, side_m, {72, 2});
    for (const Cell& cell : {Cell{2, 0, 0}, Cell{1, 1, 1}, Cell{0, 2, 3}, Cell{0, 3, 3}, Cell{2, -9, -9},
                             Cell{0, 35, 35}, Cell{1, -18, 17}, Cell{2, 30, 0}}) {
        const eval::Tape tape = tapes.over(cell, workspace);
        EXPECT_LT(tape.size(), whole.size() / 2) << cell.name();
        EXPECT_EQ(valuesOf(tape, cell, workspace), valuesOf(whole, cell, workspace)) << cell.name();
        // By itself the cell has the same tape.
        SquareTapes fresh(whole, bounds, side_m, {72, 2});
        const eval::Tape& alone = fresh.over(cell, other);
        ASSERT_EQ(alone.size(), tape.size()) << cell.name();
        for (size_t i = 0; i < tape.size(); ++i)
            EXPECT_TRUE(alone.code()[i].op == tape.code()[i].op && alone.code()[i].out == tape.code()[i].out) << i;
    }
}

}  // namespace
}  // namespace sgm::pipeline
