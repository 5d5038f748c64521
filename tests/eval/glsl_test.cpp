// CPU and GLSL give the same field, for every row of the op table and of the primitive table.
#include <gtest/gtest.h>

#include <cmath>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/glsl.h"
#include "modeler/field/ops.h"
#include "tests/field/heights.h"
#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/evaluate_gpu.h"
#include "viewer/render/samples.h"

namespace sgm::render::test {
namespace {

using field::NodeRef;

constexpr double sceneSize = 6;  // metres

std::vector<Vec3f> scatter(size_t count) {
    std::vector<Vec3f> points;
    for (size_t i = 0; i < count; ++i)
        points.push_back({static_cast<float>(uniform(combine(1, i), -3, 3)),
                          static_cast<float>(uniform(combine(2, i), -3, 3)),
                          static_cast<float>(uniform(combine(3, i), -3, 3))});
    return points;
}

/// At most 1 % of 10⁴ points (those beside a discontinuity) may differ by more than 1e-4 of the scene.
void expectAgreement(const eval::Tape& tape, const std::string& what) {
    const std::vector<Vec3f> points = scatter(10000);
    const std::vector<float> cpu = render::valuesAt(tape, points);
    const auto gpu = evaluateOnGpu(tape, points);
    ASSERT_TRUE(gpu.ok()) << what << ": " << gpu.error().message;
    ASSERT_EQ(gpu->size(), points.size());
    size_t apart = 0, numbers = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        numbers += std::isfinite(cpu[i]) ? 1 : 0;
        if (!(std::abs(cpu[i] - (*gpu)[i]) <= 1e-4 * sceneSize)) ++apart;
    }
    EXPECT_GT(numbers, points.size() / 2) << what;
    EXPECT_LT(apart, points.size() / 100) << what;
}

/// A node of the op over operands that vary through space; invalid when no sample is known for a variadic row.
std::vector<NodeRef> sampleNodes(field::Graph& g, field::OpCode op) {
    const auto& row = field::traits(op);
    const NodeRef a = g.x() * 1.3f + 0.2f, b = g.y() * 0.9f - g.z() * 0.4f;
    // A divisor stays away from 0.
    const NodeRef positive = field::abs(b) + 0.5f;
    if (row.arity == 1) return {g.apply(op, {a})};
    if (row.arity == 2) return {g.apply(op, {a, row.name == "div" || row.name == "mod" ? positive : b})};
    if (row.name == "morph") return {g.apply(op, {a, b, field::abs(g.z()) * 0.3f})};
    if (row.name == "blend") return {g.apply(op, {g.literal(0.7f), a, b, g.z() + 0.1f, a * b * 0.2f})};
    if (row.name == "ball" || row.name == "box") {
        std::vector<field::Operand> operands{{a.id(), 0}, {b.id(), 0}, {g.z().id(), 0}};
        for (const float v : {0.4f, -0.3f, 0.2f, 1.0f, 0.7f, 0.9f, 0.8f}) operands.push_back({g.literal(v).id(), 0});
        if (row.name == "box") operands.pop_back();
        return {g.apply(op, operands)};
    }
    if (row.name == "heights")
        return {g.apply(op, {a, b}, g.grid(field::test::waves())),
                g.apply(op, {b * 3.0f, a}, g.grid(field::test::waves()))};
    if (row.readsGrid)
        return {g.apply(op, {a, b, g.z()}, g.grid(field::test::sampledTorus(5))),
                g.apply(op, {b, a, g.z() * 0.3f}, g.grid(field::test::sampledTorus(9)))};
    std::vector<NodeRef> nodes;
    if (row.name == "noise")
        for (const bool fbm : {false, true})
            nodes.push_back(g.apply(op, {a * 2.0f, b * 2.0f, g.z() * 2.0f}, field::ops::Noise::pack(fbm, 4, 77)));
    if (row.name == "kifs") {
        std::vector<field::Operand> operands;
        for (const float v : {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 3.0f}) operands.push_back({g.literal(v).id(), 0});
        operands[0].node = a.id(), operands[1].node = b.id(), operands[2].node = g.z().id();
        for (const double angle : {0.2, 0.15}) {
            const Mat3 m = Mat3::rotation({0, 1, 0.3}, angle);
            for (const Vec3d& column : {m.x, m.y, m.z})
                for (int i = 0; i < 3; ++i) operands.push_back({g.literal(static_cast<float>(column[i])).id(), 0});
        }
        for (const float v : {1000.0f, 0.8f, 1.0f, 1.25f}) operands.push_back({g.literal(v).id(), 0});
        for (const bool cube : {false, true}) {
            field::ops::Kifs::Form form;
            form.passes = 4;
            form.cube = cube;
            nodes.push_back(g.apply(op, operands, field::ops::Kifs::pack(form)));
        }
    }
    if (row.name == "facade") {
        using Op = field::ops::Facade;
        std::vector<field::Operand> operands;
        for (const NodeRef n : {a, b, g.z(), g.x() * 0.2f, g.z() * 0.2f + 0.2f}) operands.push_back({n.id(), 0});
        const Mat3 turn = Mat3::rotation({0, 1, 0.3}, 0.2);
        std::vector<float> numbers{0.93f, 0.93f, 0.33f, 3};
        for (int rotation = 0; rotation < 2; ++rotation)
            for (const Vec3d& column : {turn.x, turn.y, turn.z})
                for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<float>(column[i]));
        for (const float v : {1.3f,  1.1f,  1.0f, 0.8f, 0.25f, 0.125f, 0.4f, 0.9f, 3.0f,  0.9f, 0.4f, 0.05f,
                              1e-4f, 1e-5f, 0.0f, 1.0f, 0.0f,  0.5f,   1.4f, 0.1f, 0.75f, 1.8f, 0.2f, Op::noBay})
            numbers.push_back(v);
        numbers.resize(Op::operandCount - Op::varyingOperands, 0);
        for (const float v : numbers) operands.push_back({g.literal(v).id(), 0});
        field::ops::Kifs::Form form;
        form.passes = 3;
        nodes.push_back(g.apply(op, operands, Op::pack(form)));
    }
    return nodes;
}

class Glsl : public OnGpu {};

TEST_F(Glsl, AgreesForEveryOp) {
    for (uint16_t i = 0; i < field::opCount; ++i) {
        const field::OpCode op{i};
        if (field::traits(op).arity == field::ops::leaf) continue;
        const std::string name(field::traits(op).name);
        field::Graph graph;
        const std::vector<NodeRef> nodes = sampleNodes(graph, op);
        ASSERT_FALSE(nodes.empty()) << "no sample for op " << name;
        for (const NodeRef node : nodes) {
            const field::Field field{node, Box3f::everything(), 1, 0};
            expectAgreement(eval::compile(graph, field, graph.constants()), name);
        }
    }
}

TEST_F(Glsl, AgreesForEveryPrimitive) {
    for (const field::Primitive& row : field::primitives()) {
        Scene scene;
        expectAgreement(scene.compile(scene.solid(row, {0.2, -0.1, 0.3}, {1.5, 1.1, 0.8})), std::string(row.name));
    }
}

TEST_F(Glsl, AgreesForABlendedAndDisplacedSum) {
    Scene scene;
    for (int i = 0; i < 12; ++i)
        scene.parts.push_back(
            {scene.solid(i % 2 ? "sphere" : "cube",
                         {uniform(combine(9, i), -2, 2), uniform(combine(10, i), -2, 2), 0.1 * i}, {0.6, 0.5, 0.7}),
             0});
    field::Graph& g = scene.graph;
    const field::Field melted = field::blend(g, scene.parts, g.slot(0.3f), 0.3);
    const field::Field rough =
        field::displace(melted, g.position(), field::Noise::Billow, g.slot(0.05f), 0.05, g.slot(2.2f), 2.2, 3, 5);
    expectAgreement(scene.compile(rough), "cloud");
}

TEST_F(Glsl, RunsSeveralTapesFromOneBuffer) {
    Scene scene;
    const eval::Tape a = scene.compile(scene.solid("sphere", {0, 0, 0}, {1, 1, 1}));
    const eval::Tape b = scene.compile(scene.solid("cube", {0, 0, 0}, {1, 1, 1}));
    std::vector<uint32_t> words;
    const uint32_t startA = eval::appendTape(a, words), startB = eval::appendTape(b, words);
    EXPECT_EQ(startA, 0u);
    // One ball, whose list of ten operands takes three texels.
    EXPECT_EQ(words[0] + (a.sources().size() + 3) / 4, startB)
        << "the second tape starts behind the first one's code and lists";
    EXPECT_EQ(words.size() % 4, 0u);
}

TEST_F(Glsl, InterpretsOnlyTheOpsAskedFor) {
    eval::OpSet ops;
    ops.set(static_cast<size_t>(field::codeOf<field::ops::Add>));
    const std::string some = eval::interpreterGlsl(8, ops), all = eval::interpreterGlsl(8);
    EXPECT_NE(some.find("// add"), std::string::npos);
    EXPECT_EQ(some.find("// mul"), std::string::npos);
    for (uint16_t i = 0; i < field::opCount; ++i) {
        const auto& row = field::traits(field::OpCode{i});
        const bool found = all.find("// " + std::string(row.name)) != std::string::npos;
        EXPECT_EQ(found, row.arity != field::ops::leaf) << row.name;
    }
}

}  // namespace
}  // namespace sgm::render::test
