// Small polygons to triangles: the worst one is shaped as well as may be, and none faces away.
#include "modeler/mesh/small_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sgm::mesh {
namespace {

const auto anyDiagonal = [](size_t, size_t) { return true; };

double doubleAreaOf(std::span<const Vec3d> points, const SmallPolygon& polygon, Vec3d normal) {
    double sum = 0;
    for (const auto& [a, b, c] : polygon.triangles()) {
        const double area = dot(cross(points[b] - points[a], points[c] - points[a]), normal);
        EXPECT_GT(area, 0);
        sum += area;
    }
    return sum;
}

SmallPolygon polygonOver(std::span<const Vec3d> points) {
    SmallPolygon polygon;
    for (const Vec3d& p : points) polygon.add(p);
    return polygon;
}

TEST(SmallPolygon, BestEarFirstWouldLeaveANeedle) {
    // The second corner lies almost on the way from the first to the third, and far below it: the best ear is the one
    // at the fourth, which leaves a triangle that stands across the polygon.
    const std::vector<Vec3d> points{{0, 0, 0}, {.5, .01, -.4}, {1, 0, 0}, {.5, 1, 0}};
    SmallPolygon polygon = polygonOver(points);
    const Vec3d normal = normalized(polygon.doubleArea());
    ASSERT_TRUE(polygon.triangulate(normal, true, anyDiagonal));
    for (const auto& t : polygon.triangles())
        EXPECT_EQ(std::count(t.begin(), t.end(), 1u), 1) << "the diagonal is 1, 3";
    EXPECT_EQ(polygon.triangles().size(), 2u);
}

TEST(SmallPolygon, MostOfAFlatOneLiesInItsPlane) {
    // The same with its second corner off the plane: the best ear holds the other three.
    const std::vector<Vec3d> points{{0, 0, 0}, {.5, .01, -.4}, {1, 0, 0}, {.5, 1, 0}};
    SmallPolygon polygon = polygonOver(points);
    ASSERT_TRUE(polygon.triangulate(normalized(polygon.doubleArea()), false, anyDiagonal));
    const auto isWithout = [](const auto& t) { return std::count(t.begin(), t.end(), 1u) == 0; };
    EXPECT_EQ(std::count_if(polygon.triangles().begin(), polygon.triangles().end(), isWithout), 1);
}

TEST(SmallPolygon, StarsOfAnySizeAreCovered) {
    for (const size_t count : {3u, 4u, 5u, 6u, 8u, 9u, 14u, 24u}) {
        std::vector<Vec3d> points;
        for (size_t i = 0; i < count; ++i) {
            const double turn = 6.283185307 * static_cast<double>(i) / static_cast<double>(count);
            const double reach = count > 5 && i % 2 != 0 ? .5 : 1;
            points.push_back({reach * std::cos(turn), reach * std::sin(turn), .05 * std::cos(3 * turn)});
        }
        SmallPolygon polygon = polygonOver(points);
        const Vec3d twice = polygon.doubleArea(), normal = normalized(twice);
        ASSERT_TRUE(polygon.triangulate(normal, true, anyDiagonal)) << count;
        EXPECT_EQ(polygon.triangles().size(), count - 2);
        EXPECT_NEAR(doubleAreaOf(points, polygon, normal), length(twice), 1e-12) << count;
    }
}

TEST(SmallPolygon, DiagonalsThatMayNotBeAreNot) {
    std::vector<Vec3d> points;
    for (int i = 0; i < 7; ++i) points.push_back({std::cos(.9 * i), std::sin(.9 * i), 0});
    SmallPolygon polygon = polygonOver(points);
    const auto mayJoin = [](size_t i, size_t k) { return std::min(i, k) == 2 || std::max(i, k) == 2; };
    ASSERT_TRUE(polygon.triangulate({0, 0, 1}, true, mayJoin));
    for (const auto& t : polygon.triangles()) EXPECT_EQ(std::count(t.begin(), t.end(), 2u), 1);
    SmallPolygon none = polygonOver(points);
    EXPECT_FALSE(none.triangulate({0, 0, 1}, true, [](size_t, size_t) { return false; }));
}

TEST(SmallPolygon, WhatFacesAwayIsRefused) {
    const std::vector<Vec3d> points{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    SmallPolygon polygon = polygonOver(points);
    EXPECT_FALSE(polygon.triangulate({0, 0, 1}, true, anyDiagonal));
    polygon.clear();
    for (const Vec3d& p : points) polygon.add(p);
    EXPECT_TRUE(polygon.triangulate({0, 0, -1}, true, anyDiagonal));
}

}  // namespace
}  // namespace sgm::mesh
