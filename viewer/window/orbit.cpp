#include "viewer/window/orbit.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/conventions.h"

namespace sgm::window {
namespace {

constexpr double steepest = 0.5 * pi - 1e-4;  // straight up there is no "right"

/// Unit vector from `at` to the eye.
Vec3d towardsEye(const Orbit& orbit) {
    const double level = std::cos(orbit.pitch);
    return {std::sin(orbit.yaw) * level, std::sin(orbit.pitch), std::cos(orbit.yaw) * level};
}

}  // namespace

Orbit Orbit::from(const render::Camera& camera) {
    Orbit orbit;
    const Vec3d v = camera.eye - camera.at;
    orbit.at = camera.at;
    orbit.distance = length(v);
    orbit.yaw = std::atan2(v.x, v.z);
    orbit.pitch = std::clamp(std::asin(v.y / orbit.distance), -steepest, steepest);
    orbit.fieldOfView = camera.fieldOfView;
    orbit.lamp_m = camera.lamp_m;
    return orbit;
}

render::Camera Orbit::camera() const {
    render::Camera camera;
    camera.at = at;
    camera.eye = at + towardsEye(*this) * distance;
    camera.fieldOfView = fieldOfView;
    camera.lamp_m = lamp_m;
    return camera;
}

render::Camera Orbit::camera(double aspect) const {
    render::Camera narrow = camera();
    if (aspect < 1) narrow.fieldOfView = 2 * std::atan(std::tan(fieldOfView / 2) / aspect);
    return narrow;
}

void Orbit::turn(double x, double y) {
    // One who stands, or is in a hollow, looks about from there.
    const Vec3d eye = at + towardsEye(*this) * distance;
    yaw = std::remainder(yaw - x * pi, 2 * pi);
    pitch = std::clamp(pitch + y * pi, -steepest, steepest);
    if (lamp_m > 0 || stands) at = eye - towardsEye(*this) * distance;
}

void Orbit::move(double x, double y) {
    const Vec3d back = towardsEye(*this), right = normalized(cross(Vec3d{0, 1, 0}, back)), up = cross(back, right);
    const double height = 2 * distance * std::tan(fieldOfView / 2);
    at += (up * y - right * x) * height;
}

void Orbit::walk(double right_m, double up_m, double ahead_m, bool isLevel) {
    const Vec3d back = towardsEye(*this), right = normalized(cross(Vec3d{0, 1, 0}, back));
    const Vec3d ahead = isLevel ? cross(Vec3d{0, 1, 0}, right) : back * -1.0;
    at += right * right_m + Vec3d{0, up_m, 0} + ahead * ahead_m;
}

void Orbit::approach(double factor) {
    if (lamp_m > 0 || stands)
        at += towardsEye(*this) * (distance * (factor - 1));
    else
        distance = std::clamp(distance * factor, 1e-3, 1e6);
}

void Orbit::look(StandardView view) {
    constexpr double quarter = 0.5 * pi;
    switch (view) {
        case StandardView::Front:
            yaw = 0, pitch = 0;
            break;
        case StandardView::Back:
            yaw = pi, pitch = 0;
            break;
        case StandardView::Right:
            yaw = quarter, pitch = 0;
            break;
        case StandardView::Left:
            yaw = -quarter, pitch = 0;
            break;
        case StandardView::Top:
            yaw = 0, pitch = steepest;
            break;
        case StandardView::Bottom:
            yaw = 0, pitch = -steepest;
            break;
        case StandardView::ThreeQuarter: {
            const Orbit usual = from(render::frame(Box3f{{-1, -1, -1}, {1, 1, 1}}, 1));
            yaw = usual.yaw, pitch = usual.pitch;
            break;
        }
    }
}

void Orbit::frame(const Box3d& bounds) {
    at = bounds.centre();
    const Vec3d back = towardsEye(*this), right = normalized(cross(Vec3d{0, 1, 0}, back)), up = cross(back, right);
    constexpr double fill = 0.84;  // as render::frame
    const double reach = std::tan(fieldOfView / 2) * fill;
    distance = 1e-3;
    for (int i = 0; i < 8; ++i) {
        const Vec3d v = Vec3d{i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y,
                              i & 4 ? bounds.hi.z : bounds.lo.z} -
                        at;
        distance = std::max(
            {distance, std::abs(dot(v, right)) / reach + dot(v, back), std::abs(dot(v, up)) / reach + dot(v, back)});
    }
}

double secondsHeld(double frame_s, bool pressedNow) {
    constexpr double shortest_s = 1.0 / 15, longest_s = 1;
    return std::min(frame_s, pressedNow ? shortest_s : longest_s);
}

}  // namespace sgm::window
