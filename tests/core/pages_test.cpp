// Memory of large results: alignment, pieces that don't overlap, pieces freed by other threads.
#include "modeler/core/pages.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <thread>

namespace sgm {
namespace {

TEST(Pages, PiecesAreAlignedAndApart) {
    std::vector<PageVector<uint32_t>> pieces;
    for (uint32_t i = 0; i < 3000; ++i) {
        // From a few bytes to more than a region holds.
        pieces.emplace_back(i % 1000 == 999 ? 3'000'000 : 1 + i * 7 % 5000);
        ASSERT_EQ(reinterpret_cast<uintptr_t>(pieces.back().data()) % 64, 0u);
        std::fill(pieces.back().begin(), pieces.back().end(), i);
        if (i % 3 == 0) pieces[i / 2] = {};
    }
    for (uint32_t i = 0; i < pieces.size(); ++i)
        for (const uint32_t value : pieces[i]) ASSERT_EQ(value, i);
}

TEST(Pages, AnyThreadMayFreeWhatAnotherMade) {
    for (int round = 0; round < 20; ++round) {
        std::vector<PageVector<uint8_t>> made[2];
        std::thread makers[2];
        for (int t = 0; t < 2; ++t)
            makers[t] = std::thread([&list = made[t]] {
                for (size_t i = 0; i < 200; ++i) list.emplace_back(size_t{100'000}, uint8_t{7});
            });
        for (std::thread& m : makers) m.join();
        for (const auto& list : made)
            for (const PageVector<uint8_t>& piece : list) ASSERT_EQ(piece.back(), 7);
    }
    releasePages();
}

TEST(Pages, ClearingAheadLeavesWhatIsWritten) {
    constexpr size_t count = 4'000'000;
    PageVector<uint32_t> written;
    written.reserve(count);
    ASSERT_EQ(unusedOf(written).bytes, count * sizeof(uint32_t));
    const std::array unused{unusedOf(written), UnusedMemory{}};
    std::thread clearer([&] { clearAhead(unused); });
    for (uint32_t i = 0; i < count; ++i) written.push_back(i);
    clearer.join();
    EXPECT_EQ(unusedOf(written).bytes, 0u);
    for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(written[i], i);
}

TEST(Pages, ClearingAheadStops) {
    PageVector<uint32_t> written;
    written.reserve(4'000'000);
    const std::atomic<bool> isEnough{true};
    clearAhead(std::array{unusedOf(written)}, &isEnough);
    const auto* const begin = reinterpret_cast<unsigned char*>(written.data());
    std::vector<unsigned char> isThere(unusedOf(written).bytes / 4096);
    ASSERT_EQ(mincore(const_cast<unsigned char*>(begin), isThere.size() * 4096, isThere.data()), 0);
    EXPECT_EQ(std::count_if(isThere.begin(), isThere.end(), [](unsigned char c) { return c & 1; }), 0);
}

}  // namespace
}  // namespace sgm
