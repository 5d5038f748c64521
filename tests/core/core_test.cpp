#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <thread>

#include "modeler/core/conventions.h"
#include "modeler/core/parallel.h"
#include "modeler/core/random.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm {
namespace {

TEST(Vec, RotationIsRightHanded) {
    const Mat3 r = Mat3::rotation({0, 1, 0}, radians(90));
    const Vec3d v = r * Vec3d{1, 0, 0};  // x turns to −z about y
    EXPECT_NEAR(v.x, 0, 1e-15);
    EXPECT_NEAR(v.z, -1, 1e-15);
    const Mat3 identity = r * r.transposed();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(identity.x[i], i == 0 ? 1 : 0, 1e-15);
}

TEST(Box, EmptyBoxIsTheNeutralElementOfHull) {
    const Box3d box{{-1, 0, 2}, {3, 4, 5}};
    EXPECT_EQ(hull(Box3d{}, box), box);
    EXPECT_TRUE(Box3d{}.empty());
    EXPECT_TRUE(Box3d{}.inflated(1).empty());
    EXPECT_TRUE(intersection(box, Box3d{{4, 0, 2}, {5, 1, 3}}).empty());
    EXPECT_FALSE(Box3d::everything().finite());
}

TEST(Random, DrawsAreFixedForever) {
    // Meshes depend on these bits: a change here changes every user's models.
    EXPECT_EQ(mix(1), 0x910a2dec89025cc1ull);
    EXPECT_EQ(hashText("size"), hashText("size"));
    EXPECT_NE(combine(1, 2), combine(2, 1));
}

TEST(Random, UniformIsEvenAndInRange) {
    int low = 0;
    for (uint64_t k = 0; k < 10000; ++k) {
        const double u = uniform(k);
        ASSERT_GE(u, 0);
        ASSERT_LT(u, 1);
        low += u < 0.25;
        ASSERT_LT(pick(k, 7), 7u);
    }
    EXPECT_NEAR(low, 2500, 150);
}

TEST(Parallel, EveryIndexOnceAtAnyThreadCount) {
    for (const int threads : {1, 2, 5}) {
        std::vector<std::atomic<int>> seen(1000);
        std::atomic<int> worst{0};
        parallelFor(seen.size(), threads, nullptr, [&](size_t i, int worker) {
            ++seen[i];
            if (worker >= threads) ++worst;
        });
        for (const auto& n : seen) ASSERT_EQ(n, 1);
        EXPECT_EQ(worst, 0);
    }
}

TEST(Parallel, LoopsInLoopsAndSideBySide) {
    std::atomic<int> calls{0};
    const auto loops = [&] {
        for (int round = 0; round < 50; ++round)
            parallelFor(6, 3, nullptr, [&](size_t, int) { parallelFor(5, 2, nullptr, [&](size_t, int) { ++calls; }); });
    };
    std::thread beside(loops);
    loops();
    beside.join();
    EXPECT_EQ(calls, 2 * 50 * 6 * 5);
}

TEST(Parallel, ThreadsStayFromLoopToLoop) {
    std::atomic<int> most{0};
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> begun{0};
        parallelFor(2, 2, nullptr, [&](size_t, int worker) {
            ++begun;
            while (begun < 2) std::this_thread::yield();  // each of the two takes one
            thread_local int loops = 0;
            if (worker == 1) most = std::max(most.load(), ++loops);
        });
    }
    EXPECT_GT(most, 1);
}

TEST(Parallel, ThrowsInTheCallerWhatABodyThrew) {
    for (const int threads : {1, 2, 5}) {
        std::atomic<int> calls{0};
        const auto loop = [&] {
            parallelFor(100'000, threads, nullptr, [&](size_t, int) {
                if (++calls == 3) throw std::bad_alloc();
            });
        };
        const auto slowLoop = [&] {
            parallelFor(100'000, threads, nullptr, [&](size_t, int) {
                const int call = ++calls;
                if (call == 3) throw std::bad_alloc();
                // The system may not let the one that throws go on for a while.
                if (call > 3) std::this_thread::sleep_for(std::chrono::microseconds(50));
            });
        };
        EXPECT_THROW(slowLoop(), std::bad_alloc) << threads;
        EXPECT_LT(calls, 10'000) << "the others stop too";
        const auto nested = [&] { parallelFor(4, threads, nullptr, [&](size_t, int) { loop(), loop(); }); };
        calls = 0;
        EXPECT_THROW(nested(), std::bad_alloc) << threads;
        calls = 0;
        parallelFor(50, threads, nullptr, [&](size_t, int) { ++calls; });
        EXPECT_EQ(calls, 50) << "the threads are still there";
    }
}
TEST(Parallel, CancelStopsHandingOut) {
    Progress progress;
    std::atomic<int> done{0};
    parallelFor(1'000'000, 2, &progress, [&](size_t, int) {
        if (++done == 10) progress.cancel();
    });
    EXPECT_LT(done, 1000);
}

TEST(Result, HoldsOneOfTwo) {
    const Result<int> good = 3;
    const Result<int> bad = Error{Error::Kind::Budget, "too many shapes"};
    EXPECT_EQ(*good, 3);
    EXPECT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().message, "too many shapes");
}

}  // namespace
}  // namespace sgm
