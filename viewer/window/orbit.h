// Camera control: turning about a point, moving it, coming nearer.
// Enters: movements of the pointer as shares of the view's height. Leaves: a Camera. Assumes Y up.
#pragma once

#include "viewer/render/camera.h"

namespace sgm::window {

/// Views along an axis, and the one from which every picture starts.
enum class StandardView { Front = 1, Back, Right, Left, Top, Bottom, ThreeQuarter };

/// A camera about a point. Plain values; `camera` makes what the pictures take.
struct Orbit {
    Vec3d at;              ///< what it turns about, metres
    double distance = 10;  ///< from eye to `at`, metres
    double yaw = 0;        ///< radians about +y; 0 looks along −z
    double pitch = 0.4;    ///< radians above the horizon, −π/2 … π/2
    double fieldOfView = render::Camera{}.fieldOfView;
    double lamp_m = 0;    ///< as Camera::lamp_m
    bool stands = false;  ///< turns about the eye, not about `at`: flying and walking

    static Orbit from(const render::Camera& camera);
    render::Camera camera() const;
    /// For a picture of this shape: the narrower side shows the angle `fieldOfView`.
    render::Camera camera(double aspect) const;

    /// Turns by a drag of (x right, y down) heights of the view: half a turn a height.
    void turn(double x, double y);
    /// Moves with the pointer, so that what lies at `at` stays under it.
    void move(double x, double y);
    /// Moves the eye, metres: to the right, straight up, and ahead, which is level where `isLevel`.
    void walk(double right_m, double up_m, double ahead_m, bool isLevel);
    /// Where the eye is.
    Vec3d eye() const { return camera().eye; }
    /// `factor` below 1 comes nearer. Where one stands or is in a hollow the eye walks instead, so that it can pass by
    /// `at`.
    void approach(double factor);
    void look(StandardView view);
    /// Keeps the direction and shows `bounds` whole in a picture of any shape.
    void frame(const Box3d& bounds);

    friend bool operator==(const Orbit&, const Orbit&) = default;
};

/// How long keys have moved the camera in a frame of so many seconds, at any rate of frames: the first one behind a
/// rest is as long as the rest was, and counts as a short one.
double secondsHeld(double frame_s, bool pressedNow);

}  // namespace sgm::window
