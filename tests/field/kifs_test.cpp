// The KIFS op against the Menger sponge's own definition and against algorithm 1 as printed (McGraw; errata in
// docs/papers.md).
#include "modeler/field/kifs.h"

#include <gtest/gtest.h>

#include <bit>

#include "modeler/core/conventions.h"
#include "modeler/eval/values_interval.h"
#include "modeler/field/ops.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

using ops::Kifs;
using Operands = std::array<float, Kifs::operandCount>;

Operands operands(Vec3d center, double scale, const Mat3& fold = {}, const Mat3& turn = {}, double bailout = 0) {
    Operands a{};
    const auto put = [&](size_t at, Vec3d v) {
        for (int i = 0; i < 3; ++i) a[at + static_cast<size_t>(i)] = static_cast<float>(v[i]);
    };
    put(Kifs::centreOfScale, center);
    a[Kifs::scale] = static_cast<float>(scale);
    for (const auto& [at, m] : {std::pair{Kifs::fold, fold}, {Kifs::turn, turn}})
        put(at, m.x), put(at + 3, m.y), put(at + 6, m.z);
    a[Kifs::bailout] = static_cast<float>(bailout);
    put(Kifs::stretch, {1, 1, 1});
    return a;
}

float kifs(Operands a, Vec3d p, const Kifs::Form& form) {
    for (int i = 0; i < 3; ++i) a[static_cast<size_t>(i)] = static_cast<float>(p[i]);
    return Kifs::apply<float>(std::span<const float>(a), Kifs::pack(form));
}

/// Level-n Menger sponge on [−1, 1]³: at no level are two of the three ternary digits 1.
bool inSponge(Vec3d p, int level) {
    for (int i = 0; i < level; ++i) {
        int middles = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(p[axis]) > 1) return false;
            const double scaled = (p[axis] + 1) * 1.5;  // 0 … 3
            const double digit = std::min(2.0, std::floor(scaled));
            middles += digit == 1;
            p[axis] = (scaled - digit) * 2 - 1;
        }
        if (middles > 1) return false;
    }
    return true;
}

TEST(Kifs, IsTheMengerSponge) {
    const Operands a = operands({1, 1, 1}, 3);
    Draws draw(1);
    for (const int level : {1, 2, 3, 4})
        for (int i = 0; i < 5000; ++i) {
            const Vec3d p = draw.in({{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}});
            const float f =
                kifs(a, p, {.passes = static_cast<uint32_t>(level), .cube = true, .folds = false, .turns = false});
            if (std::abs(f) > 1e-5f) {
                ASSERT_EQ(f < 0, inSponge(p, level)) << level << ": " << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
}

/// Sections of the level-2 sponge as a person would draw them, sampled at the middles of 9 × 9 cells.
TEST(Kifs, CrossSectionsHaveTheirHoles) {
    const Operands a = operands({1, 1, 1}, 3);
    const char* face[9] = {"#########", "#.##.##.#", "#########", "###...###", "#.#...#.#",
                           "###...###", "#########", "#.##.##.#", "#########"};
    const char* middle[9] = {"#.#...#.#", ".........", "#.#...#.#", ".........", ".........",
                             ".........", "#.#...#.#", ".........", "#.#...#.#"};
    for (int row = 0; row < 9; ++row)
        for (int column = 0; column < 9; ++column) {
            const double x = (column - 4) / 4.5, z = (row - 4) / 4.5;
            EXPECT_EQ(kifs(a, {x, -0.9, z}, {.passes = 2, .cube = true}) < 0, face[row][column] == '#')
                << row << ' ' << column;
            EXPECT_EQ(kifs(a, {x, 0, z}, {.passes = 2, .cube = true}) < 0, middle[row][column] == '#')
                << row << ' ' << column;
        }
}

/// Algorithm 1 in double, with the paper's comparison (`<`) or the right one (`>`), and the paper's bailout or none.
double algorithm1(Vec3d p, Vec3d c, double s, const Mat3& r1, const Mat3& r2, int passes, bool printedComparison,
                  double bailout) {
    double scales = 1;
    for (int i = 0; i < passes; ++i) {
        p = r1 * p;
        p = {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
        if (p.x < p.y) std::swap(p.x, p.y);
        if (p.x < p.z) std::swap(p.x, p.z);
        if (p.y < p.z) std::swap(p.y, p.z);
        p = r2 * p;
        p = {s * (p.x - c.x) + c.x, s * (p.y - c.y) + c.y, s * p.z};
        if (printedComparison ? p.z < c.z * (s - 1) / 2 : p.z > c.z * (s - 1) / 2) p.z -= c.z * (s - 1);
        scales *= s;
        if (dot(p, p) > bailout) break;
    }
    return (length(p) - 2) / scales;
}

TEST(Kifs, PrintedComparisonGivesNothingAndPrintedBailoutTheWrongSign) {
    Draws draw(2);
    const Vec3d c{1, 1, 1};
    int rightInside = 0, printedInside = 0, wrongSign = 0, agree = 0, n = 20000;
    for (int i = 0; i < n; ++i) {
        const Vec3d p = draw.in({{-1, -1, -1}, {1, 1, 1}});
        const double right = algorithm1(p, c, 3, {}, {}, 6, false, 1e30), ours = kifs(operands(c, 3), p, {.passes = 6});
        rightInside += right < 0;
        printedInside += algorithm1(p, c, 3, {}, {}, 6, true, 1e30) < 0;
        wrongSign += (algorithm1(p, c, 3, {}, {}, 6, false, 1.5) < 0) != (right < 0);
        agree += std::abs(right - ours) < 1e-5;
    }
    EXPECT_GT(rightInside, n / 10);
    EXPECT_EQ(printedInside, 0);
    EXPECT_GT(wrongSign, n / 4);
    EXPECT_EQ(agree, n);
}

struct Setting {
    Vec3d center;
    double scale;
    Mat3 fold, turn;
};

std::vector<Setting> settings() {
    const Vec3d y{0, 1, 0}, z{0, 0, 1}, facade{0.93, 0.93, 0.33};
    return {{{1, 1, 1}, 3, {}, {}},
            {facade, 3, Mat3::rotation(y, 0.2201), {}},
            {facade, 3, Mat3::rotation(z, 0.3853), {}},
            {facade, 3.5, {}, Mat3::rotation(y, pi / 25)},
            {{1.0449, 0.9211, 0.2974}, 3, Mat3::rotation(z, 0.2077), Mat3::rotation(y, pi / 4)},
            {{0.8546, 0.8504, 0.3404}, 2.5, Mat3::rotation({1, 2, 3}, 0.4), Mat3::rotation({3, -1, 2}, 1)}};
}

TEST(Kifs, ContinuousFormIsOneLipschitz) {
    Draws draw(3);
    for (const Setting& s : settings())
        for (const bool cube : {false, true}) {
            const Operands a = operands(s.center, s.scale, s.fold, s.turn);
            double steepest = 0;
            for (int i = 0; i < 4000; ++i) {
                const Vec3d p = draw.in({{-2, -2, -2}, {2, 2, 2}}), q = p + draw.direction() * draw.size(1e-3, 1);
                const double rise =
                    std::abs(kifs(a, p, {.passes = 6, .cube = cube}) - kifs(a, q, {.passes = 6, .cube = cube}));
                steepest = std::max(steepest, (rise - 2e-6) / length(p - q));
            }
            EXPECT_LE(steepest, 1.00001);
            EXPECT_GT(steepest, 0.9);
        }
}

TEST(Kifs, FormsAgreeWithoutATurnAndDifferWithOne) {
    Draws draw(4);
    for (const Setting& s : settings()) {
        const Operands a = operands(s.center, s.scale, s.fold, s.turn);
        const bool turned = !(s.turn == Mat3{});
        int differ = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3d p = draw.in({{-1, -1, -1}, {1, 1, 1}});
            const float smooth = kifs(a, p, {.passes = 5}), jump = kifs(a, p, {.passes = 5, .jump = true});
            EXPECT_NEAR(jump, algorithm1(p, s.center, s.scale, s.turn, s.fold, 5, false, 1e30), turned ? 1 : 1e-4);
            differ += std::abs(smooth - jump) > 1e-5;
        }
        EXPECT_EQ(differ > 0, turned && s.turn != Mat3::rotation({0, 1, 0}, pi / 4));
    }
}

TEST(Kifs, LargeBailoutKeepsTheSignOfTheBall) {
    Draws draw(5);
    for (const double bailout : {4.0, 16.0, 1000.0})
        for (const Setting& s : settings()) {
            const Operands a = operands(s.center, s.scale, s.fold, s.turn, bailout);
            for (int i = 0; i < 1000; ++i) {
                const Vec3d p = draw.in({{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}});
                const float full = kifs(a, p, {.passes = 6}), early = kifs(a, p, {.passes = 6, .bails = true});
                EXPECT_TRUE((full < 0) == (early < 0) || std::abs(full) < 1e-5f);
            }
        }
}

/// Every form's interval holds the values of points inside, with fixed and with varying parameters.
TEST(Kifs, IntervalsEnclose) {
    using I = eval::Interval<float>;
    Draws draw(6);
    for (const Setting& s : settings())
        for (uint32_t trial = 0; trial < 320; ++trial) {
            const Operands a = operands(s.center, s.scale, s.fold, s.turn, 16);
            const Kifs::Form form{1 + trial % 6, (trial & 1) != 0, (trial & 2) != 0, (trial & 4) != 0};
            std::array<I, Kifs::operandCount> box;
            for (size_t i = 0; i < a.size(); ++i) {
                const auto r = static_cast<float>(i < 3 ? draw.size(1e-3, 1) : (trial & 8) && i < 7 ? 0.01 : 0);
                const float middle = i < 3 ? static_cast<float>(draw.uniform(-1.5, 1.5)) : a[i];
                box[i] = {middle - r, middle + r};
            }
            const I range = Kifs::interval(std::span<const I>(box), Kifs::pack(form));
            for (int n = 0; n < 50; ++n) {
                Operands at;
                for (size_t i = 0; i < a.size(); ++i) {
                    const double t = n < 2 ? n : draw.uniform(0, 1);
                    at[i] = std::min(
                        box[i].hi,
                        std::max(box[i].lo, static_cast<float>(box[i].lo + t * (double(box[i].hi) - box[i].lo))));
                }
                const float f = Kifs::apply<float>(std::span<const float>(at), Kifs::pack(form));
                ASSERT_LE(range.lo, f) << trial;
                ASSERT_GE(range.hi, f) << trial;
            }
        }
}

/// Where a pass may overflow, values are no numbers.
TEST(Kifs, NothingIsKnownFarOut) {
    using I = eval::Interval<float>;
    std::array<I, Kifs::operandCount> box;
    const Operands a = operands({1, 1, 1}, 3);
    for (size_t i = 0; i < a.size(); ++i) box[i] = I(a[i]);
    for (size_t i = 0; i < 3; ++i) box[i] = {0, 3e38f};
    EXPECT_FALSE(known(Kifs::interval(std::span<const I>(box), Kifs::pack({.passes = 4}))));
}

/// A small box about an empty place of the sponge is seen to be empty: what prunes a descent.
TEST(Kifs, IntervalsPrune) {
    using I = eval::Interval<float>;
    std::array<I, Kifs::operandCount> box;
    const Operands a = operands({1, 1, 1}, 3);
    for (size_t i = 0; i < a.size(); ++i) box[i] = I(a[i]);
    for (size_t i = 0; i < 3; ++i) box[i] = {-0.15f, 0.15f};  // the hole in the middle is (−1/3, 1/3)³
    const I range = Kifs::interval(std::span<const I>(box), Kifs::pack({.passes = 4, .cube = true}));
    EXPECT_GT(range.lo, 0);
    EXPECT_LT(range.hi - range.lo, 2.01f * 0.15f * std::sqrt(3.0f) + 1e-3f);
}

/// SIMD and the tape give the bits of the plain loop.
TEST(Kifs, TapeGivesTheSameBits) {
    Draws draw(7);
    for (const Setting& s : settings())
        for (uint32_t trial = 0; trial < 8; ++trial) {
            Operands a = operands(s.center, s.scale, s.fold, s.turn, 16);
            const Kifs::Form form{4, (trial & 1) != 0, (trial & 2) != 0, (trial & 4) != 0};
            Graph graph;
            std::vector<Operand> nodes{{graph.x().id(), 0}, {graph.y().id(), 0}, {graph.z().id(), 0}};
            for (size_t i = 3; i < a.size(); ++i) nodes.push_back({graph.slot(a[i]).id(), 0});
            Probe probe(graph, {graph.apply(codeOf<Kifs>, nodes, Kifs::pack(form)), {}});
            std::vector<Vec3f> points;
            for (int i = 0; i < 100; ++i) points.push_back(draw.in({{-2, -2, -2}, {2, 2, 2}}).as<float>());
            const std::vector<float> f = probe(points);
            for (size_t i = 0; i < points.size(); ++i)
                ASSERT_EQ(std::bit_cast<uint32_t>(f[i]),
                          std::bit_cast<uint32_t>(kifs(a, points[i].as<double>(), form)));
        }
}

/// Parameters of the row become the structure and operands of the op.
TEST(Kifs, RowFillsItsScope) {
    const Primitive& row = *findPrimitive("kifs");
    Graph graph;
    std::vector<Argument> arguments = defaults(graph, row);
    arguments[4] = argument(graph, {3.0});
    arguments[5] = argument(graph, {1.0});
    const Vec3d half{2, 4, 3};
    Probe probe(graph, build(graph, row, half, arguments, graph.position()));
    Draws draw(8);
    for (int i = 0; i < 4000; ++i) {
        const Vec3d p = draw.in(Box3d{-half, half}.inflated(0.2));
        const float f = probe(p.as<float>());
        if (std::abs(f) > 1e-5f) {
            ASSERT_EQ(f < 0, inSponge({p.x / half.x, p.y / half.y, p.z / half.z}, 3));
        }
    }
}

}  // namespace
}  // namespace sgm::field::test
