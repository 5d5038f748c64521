#include "samples.h"

namespace sgm::eval::testing {
namespace {

/// A sphere on the x axis.
NodeRef ball(Graph& graph, float x, float radius) {
    const field::Point p = graph.position();
    return length(field::Point{p.x - graph.slot(x), p.y, p.z}) - graph.slot(radius);
}

OriginId ownerAt(const Graph& graph, NodeRef root, float x) {
    const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
    Workspace w;
    Cloud cloud;
    cloud.add(x, 0, 0);
    OriginId owner = 99;
    evaluateOrigin(tape, cloud.points(), &owner, w);
    return owner;
}

NodeRef chosen(Graph& graph, field::OpCode op, NodeRef a, OriginId ofA, NodeRef b, OriginId ofB) {
    const field::Operand both[] = {{a.id(), ofA}, {b.id(), ofB}};
    return graph.apply(op, both);
}

TEST(Origin, AUnionBelongsToTheNearerPart) {
    Graph graph;
    const NodeRef both = chosen(graph, codeOf<ops::Min>, ball(graph, 0, 1), 1, ball(graph, 4, 1), 2);
    EXPECT_EQ(ownerAt(graph, both, 1), 1u);
    EXPECT_EQ(ownerAt(graph, both, 3), 2u);
}

TEST(Origin, TheOwnerOfASinglePartCostsNothing) {
    Graph graph;
    const NodeRef alone = ball(graph, 0, 1), owned = chosen(graph, codeOf<ops::Min>, alone, 3, alone, 3);
    EXPECT_EQ(ownerAt(graph, owned, 1), 3u);
    EXPECT_EQ(compile(graph, {owned, {}, 1, 1}, graph.constants()).size(),
              compile(graph, {alone, {}, 1, 1}, graph.constants()).size());
}

TEST(Origin, AMeltOfNumbersAndABallBelongsToTheLeast) {
    Graph graph;
    const field::Operand parts[] = {
        {graph.slot(0.1f).id(), 0}, {graph.slot(3).id(), 4}, {ball(graph, 0, 1).id(), 5}, {graph.slot(1).id(), 6}};
    const NodeRef smoothMin = graph.apply(codeOf<ops::Blend>, parts);
    EXPECT_EQ(ownerAt(graph, smoothMin, 1), 5u);
    EXPECT_EQ(ownerAt(graph, smoothMin, 4), 6u);
}

TEST(Origin, TheWallOfACutBelongsToTheCutter) {
    Graph graph;
    const NodeRef cut = chosen(graph, codeOf<ops::Max>, ball(graph, 0, 2), 1, -ball(graph, 2, 1), 2);
    EXPECT_EQ(ownerAt(graph, cut, -2), 1u);
    EXPECT_EQ(ownerAt(graph, cut, 1), 2u);
}

TEST(Origin, AnOuterOwnerHidesTheInnerOnesAndZeroLetsThemThrough) {
    Graph graph;
    const NodeRef inner = chosen(graph, codeOf<ops::Min>, ball(graph, 0, 1), 1, ball(graph, 4, 1), 2);
    const NodeRef shown = chosen(graph, codeOf<ops::Min>, inner, 0, ball(graph, 8, 1), 3);
    const NodeRef hidden = chosen(graph, codeOf<ops::Min>, inner, 7, ball(graph, 8, 1), 3);
    EXPECT_EQ(ownerAt(graph, shown, 4), 2u);
    EXPECT_EQ(ownerAt(graph, hidden, 4), 7u);
    EXPECT_EQ(ownerAt(graph, hidden, 8), 3u);
    EXPECT_EQ(ownerAt(graph, -shown * 2.0f + 1.0f, 4), 2u);
}

TEST(Origin, AMorphBelongsToItsOwnerElseToTheNearerForm) {
    Graph graph;
    const NodeRef a = chosen(graph, codeOf<ops::Min>, ball(graph, 0, 1), 1, ball(graph, 9, 1), 1);
    const NodeRef b = chosen(graph, codeOf<ops::Min>, ball(graph, 1, 1), 2, ball(graph, 9, 1), 2);
    for (const float t : {0.25f, 0.75f}) {
        const NodeRef at = graph.slot(t);
        const field::Operand owned[] = {{a.id(), 5}, {b.id(), 5}, {at.id(), 0}};
        const field::Operand open[] = {{a.id(), 0}, {b.id(), 0}, {at.id(), 0}};
        EXPECT_EQ(ownerAt(graph, graph.apply(codeOf<ops::Morph>, owned), 0), 5u);
        EXPECT_EQ(ownerAt(graph, graph.apply(codeOf<ops::Morph>, open), 0), t < 0.5f ? 1u : 2u);
    }
}

TEST(Origin, WhatNobodyOwnsIsZero) {
    Graph graph;
    EXPECT_EQ(ownerAt(graph, ball(graph, 0, 1), 0), 0u);
    EXPECT_EQ(ownerAt(graph, graph.literal(1), 0), 0u);
}

}  // namespace
}  // namespace sgm::eval::testing
