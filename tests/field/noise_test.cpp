#include "modeler/field/noise.h"

#include <gtest/gtest.h>

#include <bit>

#include "modeler/eval/values_dual.h"
#include "modeler/eval/values_interval.h"
#include "modeler/field/ops.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

using ops::Noise;

float noise(Vec3d p, uint32_t data) {
    const float args[] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    return Noise::apply<float>(std::span<const float>(args), data);
}

const Box3d region{{-40, -40, -40}, {40, 40, 40}};

TEST(Noise, StaysInItsRangeAndLipschitzBound) {
    for (const bool fbm : {false, true})
        for (const int octaves : {1, 2, 3, 8}) {
            Draws draw(combine(fbm, static_cast<uint64_t>(octaves)));
            const uint32_t data = Noise::pack(fbm, octaves, 42);
            double least = 2, most = -2, steepest = 0;
            for (int i = 0; i < 20000; ++i) {
                const Vec3d p = draw.in(region), q = p + draw.direction() * draw.size(0.003, 1);
                const double f = noise(p, data), apart = length(q - p);
                least = std::min(least, f);
                most = std::max(most, f);
                steepest = std::max(steepest, (std::abs(noise(q, data) - f) - 6e-5) / apart);
            }
            EXPECT_GE(least, fbm ? -1 : 0);
            EXPECT_LE(most, 1);
            EXPECT_GT(most, 0.6);
            EXPECT_LE(steepest, Noise::lipschitz(octaves)) << octaves;
            EXPECT_GT(steepest, Noise::lipschitz(octaves) * 0.2) << octaves;  // the bound isn't idle
        }
}

/// A single octave reaches its bound: a step of the lattice from one sign to the other.
TEST(Noise, LipschitzFigureIsTight) {
    const uint32_t data = Noise::pack(true, 1, 5);
    const Vec3d step{0.01, 0, 0};
    double steepest = 0;
    for (int i = 0; i < 40000; ++i) {
        const Vec3d p{0.5, double(i % 200), double(i / 200)};
        steepest = std::max(steepest, std::abs(double(noise(p + step, data)) - noise(p - step, data)) / 0.02);
    }
    EXPECT_GT(steepest, 0.95 * Noise::lipschitz(1));
    EXPECT_LE(steepest, Noise::lipschitz(1) * 1.001);
}

TEST(Noise, SeedsGiveOtherNoise) {
    Draws draw(3);
    int differ = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec3d p = draw.in(region);
        differ += std::abs(noise(p, Noise::pack(true, 2, 1)) - noise(p, Noise::pack(true, 2, 2))) > 0.01f;
    }
    EXPECT_GT(differ, 90);
}

TEST(Noise, DerivativesMatchDifferences) {
    using D = eval::Dual<float>;
    Draws draw(4);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d p = draw.in({{-4, -4, -4}, {4, 4, 4}});
        const D args[] = {D(static_cast<float>(p.x), 1, 0, 0), D(static_cast<float>(p.y), 0, 1, 0),
                          D(static_cast<float>(p.z), 0, 0, 1)};
        const uint32_t data = Noise::pack(true, 2, 9);
        const D f = Noise::gradient(std::span<const D>(args), data);
        EXPECT_EQ(std::bit_cast<uint32_t>(f.value), std::bit_cast<uint32_t>(noise(p, data)));
        const double h = 1e-3;
        EXPECT_NEAR(f.dx, (noise(p + Vec3d{h, 0, 0}, data) - noise(p - Vec3d{h, 0, 0}, data)) / (2 * h), 0.01);
        EXPECT_NEAR(f.dy, (noise(p + Vec3d{0, h, 0}, data) - noise(p - Vec3d{0, h, 0}, data)) / (2 * h), 0.01);
        EXPECT_NEAR(f.dz, (noise(p + Vec3d{0, 0, h}, data) - noise(p - Vec3d{0, 0, h}, data)) / (2 * h), 0.01);
    }
}

TEST(Noise, IntervalsEnclose) {
    using I = eval::Interval<float>;
    Draws draw(5);
    for (int trial = 0; trial < 2000; ++trial) {
        const Vec3d corner = draw.in(region);
        I args[3];
        for (int i = 0; i < 3; ++i) {
            const auto lo = static_cast<float>(corner[i]);
            args[i] = {lo, lo + static_cast<float>(draw.size(1e-3, 1))};
        }
        const uint32_t data = Noise::pack(trial % 2 == 0, 1 + trial % 4, static_cast<uint32_t>(trial));
        const I range = Noise::interval(std::span<const I>(args), data);
        EXPECT_GE(range.lo, trial % 2 == 0 ? -1.001f : -0.001f);
        EXPECT_LE(range.hi, 1.001f);
        for (int i = 0; i < 20; ++i) {
            float at[3];
            for (int axis = 0; axis < 3; ++axis)
                at[axis] = static_cast<float>(draw.uniform(args[axis].lo, args[axis].hi));
            const float f = Noise::apply<float>(std::span<const float>(at), data);
            ASSERT_LE(range.lo, f);
            ASSERT_GE(range.hi, f);
        }
    }
}

/// The same bits on every machine, compiler and vector width: a digest of values of the tape, and of the plain
/// function.
TEST(Noise, BitsNeverChange) {
    Graph graph;
    const uint32_t data = Noise::pack(true, 4, 2024);
    Probe probe(graph, {graph.apply(codeOf<Noise>, {graph.x(), graph.y(), graph.z()}, data), {}});
    Draws draw(6);
    std::vector<Vec3f> points;
    for (int i = 0; i < 1000; ++i) points.push_back(draw.in(region).as<float>());
    const std::vector<float> f = probe(points);
    uint64_t digest = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(std::bit_cast<uint32_t>(f[i]), std::bit_cast<uint32_t>(noise(points[i].as<double>(), data)));
        digest = combine(digest, std::bit_cast<uint32_t>(f[i]));
    }
    EXPECT_EQ(digest, 17721316676846304460u);
}

}  // namespace
}  // namespace sgm::field::test
