// What the tests of tapes share: random expression graphs, a walk over a graph in plain floats, points and boxes.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/ops.h"
#include "tests/field/heights.h"
#include "tests/field/sampled.h"

namespace sgm::eval::testing {

namespace ops = field::ops;
using field::codeOf;
using field::Field;
using field::Graph;
using field::NodeRef;

/// The minimum of two values, which owns what it shows.
inline NodeRef smaller(Graph& graph, field::Operand a, field::Operand b) {
    const field::Operand both[] = {a, b};
    return graph.apply(codeOf<ops::Min>, both);
}

/// The union of one part or more, whose tree of minima leans to neither side.
inline NodeRef balancedUnion(Graph& graph, std::vector<field::Operand> parts) {
    while (parts.size() > 1) {
        std::vector<field::Operand> pairs;
        for (size_t i = 0; i + 1 < parts.size(); i += 2)
            pairs.push_back({smaller(graph, parts[i], parts[i + 1]).id(), 0});
        if (parts.size() % 2 == 1) pairs.push_back(parts.back());
        parts = pairs;
    }
    return {&graph, parts[0].node};
}

/// Equal bits; any NaN equals any other.
inline bool sameBits(float a, float b) {
    return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

/// A stream of draws.
struct Draws {
    uint64_t key;
    uint64_t next() { return key = mix(key); }
    float real(double lo, double hi) { return static_cast<float>(uniform(next(), lo, hi)); }
    size_t below(size_t n) { return pick(next(), n); }
};

/// Points in the caller's form.
struct Cloud {
    std::vector<float> x, y, z;
    size_t size() const { return x.size(); }
    Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
    void add(float px, float py, float pz) {
        x.push_back(px);
        y.push_back(py);
        z.push_back(pz);
    }
};

/// n points in a box, some of them on its corners.
inline Cloud pointsIn(const Box3f& box, size_t n, Draws& draws) {
    Cloud cloud;
    const auto along = [&](float lo, float hi) {
        const size_t k = draws.below(8);
        if (k == 0) return lo;
        if (k == 1) return hi;
        return std::min(hi, std::max(lo, draws.real(lo, hi)));
    };
    for (size_t i = 0; i < n; ++i) {
        const float px = along(box.lo.x, box.hi.x), py = along(box.lo.y, box.hi.y), pz = along(box.lo.z, box.hi.z);
        cloud.add(px, py, pz);
    }
    return cloud;
}

/// A box in [-range, range]³ of a size between nothing and all of it, flat at times.
inline Box3f boxIn(float range, Draws& draws) {
    const float scale = range * std::pow(10.0f, -draws.real(0, 4));
    Box3f box;
    for (int i = 0; i < 3; ++i) {
        const float a = draws.real(-range, range), w = draws.below(6) == 0 ? 0.0f : draws.real(0, scale);
        box.lo[i] = a;
        box.hi[i] = a + w;
    }
    return box;
}

inline std::vector<float> values(const Tape& tape, const Cloud& cloud, Isa isa = bestIsa()) {
    Workspace w(isa);
    std::vector<float> out(cloud.size());
    evaluate(tape, cloud.points(), out.data(), w);
    return out;
}

/// The values of all nodes up to one at one point, node after node, in plain floats.
inline std::vector<float> walkAll(const Graph& graph, NodeRef root, float x, float y, float z) {
    std::vector<float> value(root.id() + 1);
    std::vector<float> args;
    for (field::NodeId id = 0; id <= root.id(); ++id) {
        const field::Node& n = graph.node(id);
        args.clear();
        for (const field::Operand& o : graph.operands(id)) args.push_back(value[o.node]);
        value[id] = field::visitOp(n.op, [&]<class Row>() -> float {
            if constexpr (Row::arity == 1)
                return Row::apply(args[0]);
            else if constexpr (Row::arity == 2)
                return Row::apply(args[0], args[1]);
            else if constexpr (field::traitsOf<Row>().readsGrid)
                return Row::apply(std::span<const float>(args), graph.grids()[n.data]->words().data());
            else if constexpr (Row::arity == ops::variadic)
                return Row::apply(std::span<const float>(args), n.data);
            else if constexpr (std::is_same_v<Row, ops::Input>)
                return n.data == 0 ? x : n.data == 1 ? y : z;
            else if constexpr (std::is_same_v<Row, ops::Slot>)
                return graph.constants()[n.data];
            else
                return std::bit_cast<float>(n.data);
        });
    }
    return value;
}

/// The node's value at one point.
inline float walk(const Graph& graph, NodeRef root, float x, float y, float z) {
    return walkAll(graph, root, x, y, z).back();
}

/// Whether all nodes up to one are finite at one point.
inline bool isFinite(const Graph& graph, NodeRef root, float x, float y, float z) {
    const std::vector<float> all = walkAll(graph, root, x, y, z);
    return std::all_of(all.begin(), all.end(), [](float v) { return std::isfinite(v); });
}

/// Operands for one example of a row: how many, and the range each may lie in.
struct Example {
    struct Operand {
        float lo, hi;
        bool varies = true;  ///< false: a slot, as a parameter is
    };
    std::vector<Operand> operands;
    uint32_t data = 0;  ///< of a row that reads a grid: its number in `addGrids`
    bool tight = true;  ///< the interval of a point is a point, but for rounding
};

/// The grids that rows of the table read, by number: samples of a torus, heights.
inline void addGrids(Graph& graph) {
    graph.grid(field::test::sampledTorus());
    graph.grid(field::test::waves());
}

/// A KIFS with fixed parameters: a turn about y, a fold about z, both small.
inline Example kifsExample(ops::Kifs::Form form) {
    const float t = 0.3f, c = std::cos(t), s = std::sin(t);
    const float numbers[] = {0.93f, 0.93f, 0.33f, 3, c, s, 0, -s, c, 0,  0,    0, 1,
                             c,     0,     -s,    0, 1, 0, s, 0,  c, 50, 0.8f, 1, 1.25f};
    Example e{{{-2, 2}, {-2, 2}, {-2, 2}}, ops::Kifs::pack(form), form.continuous()};
    for (const float n : numbers) e.operands.push_back({n, n, false});
    return e;
}

/// A facade of fixed numbers: bays of two facade ids, three storeys, both shells near.
inline Example facadeExample(ops::Kifs::Form form) {
    using Op = ops::Facade;
    const Example fractal = kifsExample(form);
    Example e{{{-2, 2}, {-1, 3}, {-2, 2}, {-0.5f, 0.7f}, {-0.3f, 0.5f}}, Op::pack(form)};
    e.operands.insert(e.operands.end(), fractal.operands.begin() + 3, fractal.operands.begin() + ops::Kifs::bailout);
    const float numbers[] = {1.3f,  1.1f,  1, 0.8f, 0.25f, 0.125f, 0.4f, 0.9f, 3,     0.9f, 0.4f, 0.05f,
                             1e-4f, 1e-5f, 0, 1,    0,     0.5f,   1.4f, 0.1f, 0.75f, 1.8f, 0.2f, Op::noBay};
    for (const float n : numbers) e.operands.push_back({n, n, false});
    e.operands.resize(Op::operandCount, {0, 0, false});
    return e;
}

/// Examples of every row; new rows of one or two operands need none.
template <class Row>
std::vector<Example> examplesOf() {
    constexpr float r = 4;
    if constexpr (std::is_same_v<Row, ops::Exp>)
        return {{{{-3, 3}}}, {{{-90, -84}}}, {{{80, 89}}}};
    else if constexpr (std::is_same_v<Row, ops::Sin> || std::is_same_v<Row, ops::Cos>)
        return {{{{-r, r}}}, {{{990, 1000}}}};
    else if constexpr (std::is_same_v<Row, ops::Mod>)
        return {{{{-r, r}, {1.5f, 1.5f, false}}}, {{{-r, r}, {0.3f, 2}}}};
    else if constexpr (std::is_same_v<Row, ops::Div>)
        return {{{{-r, r}, {0.5f, 3}}}, {{{-r, r}, {-1, 1}}}};
    else if constexpr (std::is_same_v<Row, ops::Morph>)
        return {{{{-r, r}, {-r, r}, {0, 1, false}}}, {{{-r, r}, {-r, r}, {0, 1}}}};
    else if constexpr (std::is_same_v<Row, ops::Noise>)
        return {{{{-r, r}, {-r, r}, {-r, r}}, ops::Noise::pack(false, 1, 7)},
                {{{-r, r}, {0, 1}, {5, 9}}, ops::Noise::pack(true, 3, 8)}};
    else if constexpr (std::is_same_v<Row, ops::Sampled>)
        return {{{{-2, 2}, {-2, 2}, {-1, 1}}}, {{{-1, 1}, {0.9f, 0.9f, false}, {-0.3f, 0.3f}}}};
    else if constexpr (std::is_same_v<Row, ops::Heights>)
        return {{{{-2, 2}, {-2, 2}}, 1, false},
                {{{-0.02f, 0.01f}, {0.1f, 0.13f}}, 1, false},
                {{{-1, 1}, {0.9f, 0.9f, false}}, 1, false}};
    else if constexpr (std::is_same_v<Row, ops::Blend>)
        return {{{{0.3f, 0.3f, false}, {-r, r}, {-r, r}}},
                {{{0, 2, false}, {-1, 1}, {-1, 1}, {-1, 0}, {0.5f, 0.5f, false}}},
                {{{0, 1}, {0, 1}, {0, 0.5f}}},
                {{{0, 0, false}, {-1, 1}, {-1, 1}}}};
    else if constexpr (std::is_same_v<Row, ops::Ball> || std::is_same_v<Row, ops::Box>) {
        std::vector<Example> examples(2, {{{-r, r}, {-r, r}, {-r, r}}});
        for (Example& e : examples)
            for (size_t i = 3; i < Row::operandCount; ++i)
                e.operands.push_back({i < 6 ? -1.0f : 0.5f, &e == &examples[0] ? 1.0f : 1.5f, false});
        examples[1].operands[0] = {-0.1f, 0.1f};
        return examples;
    } else if constexpr (std::is_same_v<Row, ops::Kifs>)
        return {kifsExample({3, false, false, false, true, true}), kifsExample({2, true, true, false, true, false}),
                kifsExample({4, true, false, true, true, true})};
    else if constexpr (std::is_same_v<Row, ops::Facade>)
        return {facadeExample({3, false, false, false, true, true}),
                facadeExample({2, true, false, false, true, false})};
    else if constexpr (Row::arity == 1)
        return {{{{-r, r}}}, {{{0.001f, 1}}}};
    else
        return {{{{-r, r}, {-r, r}}}, {{{-r, r}, {-1, 1, false}}}};
}

/// A random expression of up to `size` ops, rich in min and max, with owners on their operands.
inline NodeRef randomExpression(Graph& graph, size_t size, Draws& draws) {
    addGrids(graph);
    std::vector<NodeRef> pool{graph.x(), graph.y(), graph.z()};
    for (int i = 0; i < 4; ++i) pool.push_back(graph.slot(draws.real(-2, 2)));
    for (int i = 0; i < 3; ++i) pool.push_back(graph.literal(draws.real(-2, 2)));
    const auto any = [&] {
        // Late nodes more often, so that depth grows.
        return pool[draws.below(2) == 0 ? draws.below(pool.size())
                                        : pool.size() - 1 - draws.below(std::min<size_t>(6, pool.size()))];
    };
    for (size_t i = 0; i < size; ++i) {
        const uint64_t kind = draws.below(10);
        if (kind < 3) {
            const field::Operand both[] = {{any().id(), static_cast<OriginId>(draws.below(3) * (i + 1))},
                                           {any().id(), static_cast<OriginId>(draws.below(3) * (i + 1))}};
            pool.push_back(graph.apply(draws.below(2) == 0 ? codeOf<ops::Min> : codeOf<ops::Max>, both));
        } else if (kind == 3) {
            field::Point p{any(), any(), any()};
            pool.push_back(length(p) - draws.real(0, 2));
        } else {
            pool.push_back(field::visitOp(field::OpCode(draws.below(field::opCount)), [&]<class Row>() {
                if constexpr (Row::arity == 1)
                    return graph.apply(codeOf<Row>, {any()});
                else if constexpr (Row::arity == 2)
                    return graph.apply(codeOf<Row>, {any(), any()});
                else if constexpr (std::is_same_v<Row, ops::Blend>) {
                    std::vector<field::Operand> parts{{graph.slot(draws.real(0, 1)).id(), 0}};
                    const size_t count = 1 + draws.below(6);
                    for (size_t k = 0; k < count; ++k)
                        parts.push_back({any().id(), static_cast<OriginId>(draws.below(3) * (i + 1))});
                    return graph.apply(codeOf<Row>, parts);
                } else if constexpr (Row::arity == ops::variadic) {
                    const std::vector<Example> examples = examplesOf<Row>();
                    const Example& e = examples[draws.below(examples.size())];
                    std::vector<field::Operand> parts;
                    for (const Example::Operand& o : e.operands)
                        parts.push_back({(o.varies ? any() : graph.slot(draws.real(o.lo, o.hi))).id(), 0});
                    return graph.apply(codeOf<Row>, parts, e.data);
                } else
                    return any() + any();
            }));
        }
    }
    return pool.back();
}

}  // namespace sgm::eval::testing
