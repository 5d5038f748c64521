// Where a picture is taken from, and ways to find such a place.
#pragma once

#include <optional>

#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"

namespace sgm::render {

/// An eye and what it looks at.
struct Camera {
    Vec3d eye, at;             ///< metres, object frame
    double fieldOfView = 0.7;  ///< vertical, radians
    double lamp_m = 0;         ///< reach of a warm lamp beside the eye, metres; 0 for none
    friend bool operator==(const Camera&, const Camera&) = default;
};
/// Frames `bounds` three-quarter from above: the box takes 84 % of the tighter side of the picture, centred.
Camera frame(const Box3f& bounds, double aspect);
/// The same for the solid itself, seen on a grid: closer wherever it leaves corners of its bounds empty.
Camera frame(const eval::Tape& tape, const Box3f& bounds, double aspect);
/// The part of `bounds` that may hold the solid; found on a grid, exact to about a cell.
Box3f tighten(const eval::Tape& tape, const Box3f& bounds);
/// The same for a solid seen from all sides in turn: it stays whole in every picture.
Camera frameTurning(const eval::Tape& tape, const Box3f& bounds, double aspect);
/// The camera, gone around the vertical axis through the place it looks at: by `angle` radians to its right.
Camera turned(Camera camera, double angle);
/// Stands inside the largest hollow of the field, looking along its longest free direction with a lamp (`--camera
/// inside`). A field without a hollow is taken as the hollow itself: the camera stands in its solid, which is then
/// drawn inside out.
Camera inside(const eval::Tape& tape, const Box3f& bounds);
/// How far a lamp beside an eye has to reach, metres, where this stands in a hollow: the surface lies in nine of ten
/// directions within `bounds`. 0 elsewhere. Up to 25,000 values of the field.
double lampFor(const eval::Tape& tape, const Box3f& bounds, Vec3d eye);
/// The height of the surface straight below a place that is in the open, metres; nothing where none is found above
/// `lowest_m`. Some fifty values of the field.
std::optional<double> surfaceBelow(const eval::Tape& tape, Vec3d from, double lowest_m);

}  // namespace sgm::render
