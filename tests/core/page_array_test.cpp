// Arrays that grow by moving pages: what they hold from the first element to many pages, and what they give back.
#include "modeler/core/page_array.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace sgm {
namespace {

/// Not a divisor of a page.
struct Item {
    uint64_t a, b, c;
    uint32_t d, e, f;
};

Item item(uint64_t i) { return {i, ~i, i * i, static_cast<uint32_t>(i), 7, 0}; }

void expectItems(const PageArray<Item>& items, uint64_t count) {
    ASSERT_EQ(items.size(), count);
    for (uint64_t i = 0; i < count; ++i) {
        ASSERT_EQ(items[i].a, i);
        ASSERT_EQ(items[i].c, i * i);
        ASSERT_EQ(items[i].d, static_cast<uint32_t>(i));
    }
}

TEST(PageArray, KeepsWhatItHoldsWhereverItMoves) {
    for (const uint64_t count : {1, 100, 26'000, 45'000, 300'000}) {  // up to 14 MiB
        PageArray<Item> items;
        for (uint64_t i = 0; i < count; ++i) {
            items.push_back(item(i));
            ASSERT_LE(items.size(), items.capacity());
        }
        expectItems(items, count);
        items.shrink();
        EXPECT_EQ(items.capacity(), count);
        expectItems(items, count);
        for (uint64_t i = count; i < 2 * count; ++i) items.push_back(item(i));
        expectItems(items, 2 * count);
        items.truncate(count / 2);
        items.shrink();
        expectItems(items, count / 2);
        EXPECT_EQ(items.capacity(), count / 2);
    }
}

TEST(PageArray, LeavesLittleUnusedWhileItGrows) {
    PageArray<Item> items;
    for (uint64_t i = 0; i < 1'000'000; ++i) items.push_back(item(i));
    EXPECT_LE(static_cast<double>(items.capacity()), 1.3 * static_cast<double>(items.size()));
}

TEST(PageArray, CopiesAndMoves) {
    PageArray<Item> items;
    EXPECT_TRUE(items.empty());
    for (uint64_t i = 0; i < 60'000; ++i) items.push_back(item(i));
    PageArray<Item> copy = items;
    copy[0].a = 5;
    expectItems(items, 60'000);
    EXPECT_EQ(copy.capacity(), copy.size());
    const PageArray<Item> moved = std::move(items);
    expectItems(moved, 60'000);
    items = copy;
    EXPECT_EQ(items[0].a, 5u);
    items = PageArray<Item>();
    EXPECT_EQ(items.capacity(), 0u);
}

TEST(PageArray, TakesAnElementOfItsOwn) {
    PageArray<Item> items;
    items.push_back(item(3));
    for (int i = 0; i < 100'000; ++i) items.push_back(items[0]);
    EXPECT_EQ(items.back().c, 9u);
}

}  // namespace
}  // namespace sgm
