// How textures lie on faces.
#include "modeler/image/texture_axes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sgm::image {
namespace {

void expectNear(Vec3d a, Vec3d b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << i;
}

TEST(TextureAxes, AreRightHandedWithTheNormal) {
    const Mat3 turned = Mat3::rotation({.3, 1, -.2}, .7);
    for (const Vec3d n :
         {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, -1}, Vec3d{.6, .8, 0}, Vec3d{.48, -.6, .64}})
        for (const Mat3& axes : {Mat3{}, turned}) {
            const auto [u, v] = axesInPlane(axes, axes * n);
            expectNear(cross(u, v), axes * n);
        }
}

TEST(TextureAxes, RunUprightOnAWallAndUpASlope) {
    const auto wall = axesInPlane({}, {0, 0, 1});
    expectNear(wall.u, {1, 0, 0});
    expectNear(wall.v, {0, 1, 0});
    const auto slope = axesInPlane({}, normalized(Vec3d{0, 1, 1}));
    expectNear(slope.u, {1, 0, 0});
    expectNear(slope.v, normalized(Vec3d{0, 1, -1}));
    const Mat3 turned = Mat3::rotation({0, 1, 0}, .5);
    expectNear(axesInPlane(turned, turned.z).u, turned.x);
}

TEST(TextureAxes, SeeCurvedFacesAlongTheNearestAxis) {
    EXPECT_EQ(nearestAxis({-.9f, .3f, .1f}), 1);
    EXPECT_EQ(nearestAxis({.5f, .5f, -.5f}), 0) << "ties go to the earlier axis";
    const auto east = axesAlongNearest({}, normalized(Vec3d{1, .5, .2}));
    expectNear(east.u, {0, 0, -1});
    expectNear(east.v, {0, 1, 0});
    for (int axis = 0; axis < 6; ++axis) {
        const auto [u, v] = axesAgainst(axis);
        Vec3d n;
        n[axis / 2] = axis % 2 == 0 ? 1 : -1;
        expectNear(cross(u, v), n);
    }
}

}  // namespace
}  // namespace sgm::image
