// Camera control: what stays where, and what comes into sight.
#include "viewer/window/orbit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "viewer/render/scene.h"

namespace sgm::window::test {
namespace {

TEST(Orbit, GivesBackTheCameraItWasMadeFrom) {
    const render::Camera camera{{4, 3, -2}, {1, 1, 1}};
    const render::Camera back = Orbit::from(camera).camera();
    EXPECT_LT(length(back.eye - camera.eye), 1e-9);
    EXPECT_EQ(back.at, camera.at);
}

TEST(Orbit, KeysMoveByTheClock) {
    const auto held = [](int frames, double frame_s) {
        double seconds = secondsHeld(9, true);  // the window rested for 9 s
        for (int i = 0; i < frames; ++i) seconds += secondsHeld(frame_s, false);
        return seconds;
    };
    EXPECT_NEAR(held(60, 1.0 / 60), held(4, 1.0 / 4), 1e-9) << "as far in slow pictures as in fast ones";
    EXPECT_LT(held(1, .1), .2);
}

TEST(Orbit, TurningKeepsDistanceAndCentre) {
    Orbit orbit = Orbit::from({{4, 3, -2}, {1, 1, 1}});
    const double before = orbit.distance;
    orbit.turn(0.3, 5);  // far beyond the zenith
    const render::Camera camera = orbit.camera();
    EXPECT_NEAR(length(camera.eye - camera.at), before, 1e-9);
    EXPECT_GT(camera.eye.y, camera.at.y + 0.999 * before) << "it stops above";
}

TEST(Orbit, WhatIsMovedStaysUnderThePointer) {
    Orbit orbit = Orbit::from({{4, 3, -2}, {1, 1, 1}});
    const Vec3d place = orbit.at;
    orbit.move(0.2, -0.1);
    const render::View view = viewOf(orbit.camera(), 1000, 1000);
    const Vec3d v = place - view.eye;
    const double depth = dot(v, view.forward);
    EXPECT_NEAR(dot(v, view.right) / dot(view.right, view.right) / depth, 0.4, 1e-6);
    EXPECT_NEAR(dot(v, view.up) / dot(view.up, view.up) / depth, 0.2, 1e-6);
}

TEST(Orbit, FramesWholeInAnyPicture) {
    const Box3d box{{-8, 0, -1}, {8, 2, 1}};
    for (const auto& [width, height] : {std::pair{1600, 900}, std::pair{300, 900}}) {
        Orbit orbit = Orbit::from({{30, 20, 30}, {0, 0, 0}});
        orbit.frame(box);
        const render::View view = viewOf(orbit.camera(static_cast<double>(width) / height), width, height);
        double most = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3d v =
                Vec3d{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z} - view.eye;
            const double depth = dot(v, view.forward);
            most = std::max({most, std::abs(dot(v, view.right) / dot(view.right, view.right) / depth),
                             std::abs(dot(v, view.up) / dot(view.up, view.up) / depth)});
        }
        EXPECT_LT(most, 1.0);
        EXPECT_GT(most, 0.4);
    }
}

TEST(Orbit, InAHollowOneLooksAboutAndWalks) {
    render::Camera inside{{1, 2, 3}, {4, 2, 3}};
    inside.lamp_m = 5;
    Orbit orbit = Orbit::from(inside);
    orbit.turn(0.25, 0);
    EXPECT_LT(length(orbit.camera().eye - inside.eye), 1e-9);
    const Vec3d eye = orbit.camera().eye;
    orbit.approach(0.5);
    EXPECT_GT(length(orbit.camera().eye - eye), 1.0);
    EXPECT_NEAR(orbit.distance, 3, 1e-9) << "it can pass by what it looked at";
}

}  // namespace
}  // namespace sgm::window::test
