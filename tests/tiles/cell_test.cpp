// Cells, shares of them, and their names.
#include <gtest/gtest.h>

#include <set>

#include "modeler/tiles/cell.h"

namespace sgm::tiles {
namespace {

TEST(Cells, HoldTheirPlacesOnBothSidesOfTheOrigin) {
    EXPECT_EQ(cellAt(0, 0, 256), (Cell{0, 0, 0}));
    EXPECT_EQ(cellAt(-.001, 255.999, 256), (Cell{0, -1, 0}));
    EXPECT_EQ(cellAt(256, -256, 256), (Cell{0, 1, -1}));
    EXPECT_EQ((Cell{0, -1, 3}.parent()), (Cell{1, -1, 1}));
    EXPECT_EQ((Cell{2, -1, 0}.centre(256)), (Vec3d{-512, 0, 512}));
}

TEST(Cells, HaveNamesThatReadBack) {
    const Cell cell{2, -13, 7};
    EXPECT_EQ(cell.name(), "2/-13_7");
    EXPECT_EQ(cellNamed(cell.name()), cell);
    for (const char* no : {"", "2/1", "2/1_", "2/1_2x", "-1/0_0", "2_1_3"}) EXPECT_FALSE(cellNamed(no)) << no;
}

TEST(Cells, ThePyramidHoldsEveryCellOnce) {
    const auto cells = pyramidOver({{0, 0, 0}, {0, 1, 0}, {0, -1, -1}, {0, 0, 0}}, 3);
    EXPECT_EQ(cells.size(), 3u + 2u + 2u);
    EXPECT_EQ(std::set<Cell>(cells.begin(), cells.end()).size(), cells.size());
    for (size_t i = 1; i < cells.size(); ++i)
        if (cells[i].level == cells[i - 1].level) {
            EXPECT_LT(cells[i - 1].morton(), cells[i].morton());
        } else {
            EXPECT_EQ(cells[i].level, cells[i - 1].level + 1);
        }
}

TEST(Shares, CoverEverythingOnceAndKnowTheirTasks) {
    for (const size_t count : {size_t{1}, size_t{7}, size_t{64}, size_t{1000}})
        for (const int of : {1, 3, 7, 64, 1500}) {
            size_t next = 0;
            for (int task = 1; task <= of; ++task) {
                const auto [begin, end] = Share{task, of}.range(count);
                EXPECT_EQ(begin, next);
                for (size_t i = begin; i < end; ++i)
                    EXPECT_EQ(Share::taskOf(i, count, of), task) << i << " of " << count;
                next = end;
            }
            EXPECT_EQ(next, count);
        }
}

TEST(Shares, AreReadAsIOfN) {
    EXPECT_EQ(parseShare("3/64")->task, 3);
    EXPECT_EQ(parseShare("64/64")->of, 64);
    for (const char* no : {"", "3", "0/4", "5/4", "1/0", "a/4", "1/4 ", "1/9999999"})
        EXPECT_FALSE(parseShare(no)) << no;
    EXPECT_EQ(arrayNotation({3, 7, 12, 13, 14, 20, 21}), "3,7,12-14,20-21");
    EXPECT_EQ(arrayNotation({}), "");
}

}  // namespace
}  // namespace sgm::tiles
