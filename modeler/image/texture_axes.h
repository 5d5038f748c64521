// How a texture lies on a face: directions in which its coordinates grow.
// Enters: a face's normal and the axes of its shape. Leaves: u and v. Assumes orthonormal axes and unit normals.
#pragma once

#include "modeler/core/vec.h"

namespace sgm::image {

/// Directions in which the texture coordinates u (right) and v (up) of a face grow, seen from outside; unit vectors.
struct TextureAxes {
    Vec3d u, v;
};

/// Of a flat face: in its own plane, v along what the shape's `axes` call up; a face that looks straight up or down has
/// u along the shape's x.
TextureAxes axesInPlane(const Mat3& axes, Vec3d normal);
/// Of a place on a curved face: it is seen along the nearest axis of the shape.
TextureAxes axesAlongNearest(const Mat3& axes, Vec3d normal);

/// The axis that a direction points along most: +x −x +y −y +z −z as 0 … 5; ties go to the earlier axis.
int nearestAxis(Vec3f direction);
/// u and v of what is seen against that axis, never mirrored.
TextureAxes axesAgainst(int axis);

}  // namespace sgm::image
