// Every op of the table on every value type: one family of tests, no list of ops.
#include <limits>
#include <regex>
#include <string>

#include "modeler/eval/glsl.h"
#include "samples.h"

namespace sgm::eval::testing {
namespace {

/// f = op(operands), where operand i is lo + (hi − lo)·(coordinate i mod 3 as a share of [0, 1]), or a slot.
struct OneOp {
    Graph graph;
    Tape tape;
    bool tight = true;

    template <class Row>
    static OneOp make(const Example& example, Draws& draws) {
        OneOp one;
        one.tight = example.tight;
        addGrids(one.graph);
        std::vector<field::Operand> nodes;
        const NodeRef axes[] = {one.graph.x(), one.graph.y(), one.graph.z()};
        for (size_t i = 0; i < example.operands.size(); ++i) {
            const auto& o = example.operands[i];
            const NodeRef moving = axes[i % 3] * (o.hi - o.lo) + o.lo;
            nodes.push_back({(o.varies ? moving : one.graph.slot(draws.real(o.lo, o.hi))).id(), 0});
        }
        one.root = one.graph.apply(codeOf<Row>, nodes, example.data).id();
        one.tape = compile(one.graph, {{&one.graph, one.root}, {}, 1, 1}, one.graph.constants());
        return one;
    }
    float at(float x, float y, float z) { return walk(graph, {&graph, root}, x, y, z); }
    field::NodeId root = 0;
};

constexpr Box3f unit{{0, 0, 0}, {1, 1, 1}};

template <class Row>
class OpConformance : public ::testing::Test {
protected:
    Draws draws{hashText(Row::name)};
    template <class Check>
    void eachExample(Check&& check) {
        for (const Example& e : examplesOf<Row>())
            for (int repeat = 0; repeat < 4; ++repeat) check(OneOp::make<Row>(e, draws));
    }
};

template <class List>
struct Instructions;
template <class... Rows>
struct Instructions<field::TypeList<Rows...>> {
    template <class Row>
    using One = std::conditional_t<Row::arity == ops::leaf, std::tuple<>, std::tuple<Row>>;
    template <class Tuple>
    struct Types;
    template <class... R>
    struct Types<std::tuple<R...>> {
        using type = ::testing::Types<R...>;
    };
    using type = typename Types<decltype(std::tuple_cat(One<Rows>{}...))>::type;
};

struct RowName {
    template <class Row>
    static std::string GetName(int) {
        return std::string(Row::name);
    }
};
TYPED_TEST_SUITE(OpConformance, Instructions<field::OpTable>::type, RowName);

TYPED_TEST(OpConformance, EveryInstructionSetGivesTheBitsOfPlainFloats) {
    for (const Isa isa : {Isa::Portable, Isa::Avx2, Isa::Avx512})
        for (const size_t n : {1u, 15u, 17u, 64u, 1031u})
            this->eachExample([&](OneOp one) {
                const Cloud cloud = pointsIn(unit, n, this->draws);
                const std::vector<float> got = values(one.tape, cloud, isa);
                for (size_t i = 0; i < n; ++i) {
                    const float expected = one.at(cloud.x[i], cloud.y[i], cloud.z[i]);
                    ASSERT_TRUE(sameBits(expected, got[i]))
                        << expected << " but " << got[i] << " with isa " << int(isa);
                }
            });
}

TYPED_TEST(OpConformance, OddNumbersGiveTheSameBitsToo) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float odd[] = {0.0f,    -0.0f, 1.0f,   -1.0f,    0.5f,      -2.5f,        1e-42f,
                         -1e-42f, 1e30f, -1e30f, infinity, -infinity, std::nanf("")};
    if constexpr (TypeParam::arity == 1 || TypeParam::arity == 2) {
        Graph graph;
        const NodeRef root = TypeParam::arity == 1 ? graph.apply(codeOf<TypeParam>, {graph.x()})
                                                   : graph.apply(codeOf<TypeParam>, {graph.x(), graph.y()});
        const Tape tape = compile(graph, {root, {}, 1, 1}, graph.constants());
        Cloud cloud;
        for (const float x : odd)
            for (const float y : odd) cloud.add(x, y, 0);
        for (const Isa isa : {Isa::Portable, Isa::Avx2, Isa::Avx512}) {
            const std::vector<float> got = values(tape, cloud, isa);
            for (size_t i = 0; i < cloud.size(); ++i) {
                const float expected = walk(graph, root, cloud.x[i], cloud.y[i], 0);
                EXPECT_TRUE(sameBits(expected, got[i])) << expected << " but " << got[i] << " of " << cloud.x[i] << ", "
                                                        << cloud.y[i] << " with isa " << int(isa);
            }
        }
    }
}

TYPED_TEST(OpConformance, StatesWhatItCosts) {
    const field::OpTraits& row = field::traits(codeOf<TypeParam>);
    for (const Example& e : examplesOf<TypeParam>()) {
        const auto count = static_cast<uint32_t>(e.operands.size());
        EXPECT_GT(row.cost(count, e.data), 0u);
        EXPECT_LE(row.cost(count, e.data), row.cost(count + 1, e.data)) << "more operands are never cheaper";
        if constexpr (requires { TypeParam::foldSteps(0u); }) {
            EXPECT_GE(row.cost(count, e.data), TypeParam::foldSteps(e.data));
        }
    }
}

/// The shader's text has places and bits by the names that the row gives, and these with the row's numbers.
TYPED_TEST(OpConformance, ShaderHasTheNumbersOfTheRow) {
    const field::OpTraits& row = field::traits(codeOf<TypeParam>);
    const std::string text(row.glsl);
    EXPECT_EQ(row.arity == ops::variadic, !text.empty());
    const std::regex byHand(R"(first\)|first,|first \+ \d|word\(data, \d|data (&|>>|<<) \d)");
    std::smatch found;
    const std::string code = std::regex_replace(text, std::regex("//[^\n]*"), "");
    EXPECT_FALSE(std::regex_search(code, found, byHand)) << found.str();
    OpSet one;
    one.set(static_cast<size_t>(codeOf<TypeParam>));
    const std::string shader = interpreterGlsl(8, one);
    for (const auto& [name, number] : row.glslNumbers) {
        EXPECT_TRUE(std::regex_search(text, std::regex("\\b" + std::string(name) + "\\b"))) << name << " is unused";
        EXPECT_NE(shader.find("const uint " + std::string(name) + " = " + std::to_string(number) + "u;"),
                  std::string::npos)
            << name;
    }
}

TYPED_TEST(OpConformance, IntervalEnclosesEveryFloat) {
    for (const Isa isa : {Isa::Portable, Isa::Avx2, Isa::Avx512}) {
        Workspace w(isa);
        this->eachExample([&](OneOp one) {
            std::vector<Box3f> boxes;
            for (size_t i = 0; i < 1 + this->draws.below(64); ++i) {
                Box3f b = boxIn(0.5f, this->draws);
                boxes.push_back({b.lo + Vec3f{0.5f, 0.5f, 0.5f}, b.hi + Vec3f{0.5f, 0.5f, 0.5f}});
            }
            std::vector<FloatInterval> ranges(boxes.size());
            evaluateRanges(one.tape, {boxes.data(), boxes.size()}, ranges.data(), w);
            for (size_t b = 0; b < boxes.size(); ++b) {
                const Cloud cloud = pointsIn(boxes[b], 200, this->draws);
                const std::vector<float> got = values(one.tape, cloud, isa);
                const bool anything = std::isinf(ranges[b].lo) && std::isinf(ranges[b].hi);
                for (const float v : got)
                    ASSERT_TRUE(anything || (v >= ranges[b].lo && v <= ranges[b].hi))
                        << v << " outside " << ranges[b].lo << " … " << ranges[b].hi;
            }
        });
    }
}

TYPED_TEST(OpConformance, IntervalOfAPointIsTight) {
    Workspace w;
    this->eachExample([&](OneOp one) {
        if (!one.tight) return;
        const Cloud cloud = pointsIn(unit, 64, this->draws);
        std::vector<Box3f> boxes;
        for (size_t i = 0; i < cloud.size(); ++i) {
            const Vec3f p{cloud.x[i], cloud.y[i], cloud.z[i]};
            boxes.push_back({p, p});
        }
        std::vector<FloatInterval> ranges(boxes.size());
        evaluateRanges(one.tape, {boxes.data(), boxes.size()}, ranges.data(), w);
        for (const FloatInterval& r : ranges) EXPECT_LE(r.hi - r.lo, 1e-4f * (1 + std::abs(r.lo)));
    });
}

TYPED_TEST(OpConformance, DerivativesAgreeWithDifferences) {
    constexpr float h = 1.0f / 512;
    Workspace w;
    this->eachExample([&](OneOp one) {
        const Cloud cloud = pointsIn({{h, h, h}, {1 - h, 1 - h, 1 - h}}, 300, this->draws);
        std::vector<float> v(cloud.size()), d[3] = {v, v, v};
        evaluateGradient(one.tape, cloud.points(), v.data(), d[0].data(), d[1].data(), d[2].data(), w);
        size_t compared = 0, wrong = 0;
        for (size_t i = 0; i < cloud.size(); ++i) {
            const Vec3f p{cloud.x[i], cloud.y[i], cloud.z[i]};
            ASSERT_TRUE(sameBits(v[i], one.at(p.x, p.y, p.z)));
            for (int axis = 0; axis < 3; ++axis) {
                Vec3f lo = p, hi = p;
                lo[axis] -= h;
                hi[axis] += h;
                const float before = (v[i] - one.at(lo.x, lo.y, lo.z)) / h,
                            after = (one.at(hi.x, hi.y, hi.z) - v[i]) / h;
                const float slope = (before + after) / 2;
                // Kinks, jumps and poles have no derivative to compare with.
                if (!(std::abs(after - before) < 0.05f * (1 + std::abs(slope)))) continue;
                const float noise = 1e-5f * (1 + std::abs(v[i])) / h;
                wrong += !(std::abs(d[axis][i] - slope) <= noise + 0.05f * (1 + std::abs(slope)));
                ++compared;
            }
        }
        EXPECT_GT(compared, cloud.size());
        EXPECT_LE(wrong, compared / 20);  // kinks on both sides of a point can agree by chance
    });
}

}  // namespace
}  // namespace sgm::eval::testing
