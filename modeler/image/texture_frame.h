// Where textures begin on the surface of a shape, and how they lie on its faces.
// Enters: a frame, a face. Leaves: directions and beginnings of u and v. Assumes orthonormal axes and unit normals.
#pragma once

#include <vector>

#include "modeler/core/vec.h"
#include "modeler/image/texture.h"

namespace sgm::image {

/// A vertical side of a shape's outline, in the frame's x and z.
struct TextureSide {
    Vec3d from;           ///< its left end, seen from outside; metres from the frame's origin, y is 0
    Vec3d along;          ///< unit, to the right
    double length_m = 0;  ///< from end to end
    double begin_m = 0;   ///< the outline's length up to its left end
    double round_m = 0;   ///< the whole outline's length
};

/// The place that textures are laid out from: a shape's lower left front corner. On its sides u runs on around the
/// outline and v is the height above the foot.
struct TextureFrame {
    Vec3d origin;                    ///< the corner, in the object
    Mat3 axes;                       ///< of the shape's scope: object from local
    Vec3d size_m;                    ///< of the scope
    std::vector<TextureSide> sides;  ///< of its outline; empty: u begins at the corner everywhere
};

/// Texture coordinates of one face: u = (p · `u` − `begin_m[0]`) · `stretch[0]` metres, v likewise.
struct TextureMap {
    Vec3d u, v;                  ///< unit, to the right and up, seen from outside
    double begin_m[2] = {0, 0};  ///< what of p · u and p · v lies before the beginning
    double stretch[2] = {1, 1};  ///< other than 1 where a whole number of tiles fills the frame
};

/// The map of a face that looks along `normal` (unit where it is flat) at `point`, in the object's frame.
/// `axes` are those of its own shape. Without a frame, u and v count from the object's origin; with one, from its
/// corner, and on a face that looks as a side of the outline does, from where the nearest such side begins. Flat faces
/// are mapped in their own plane, curved ones are seen along the nearest axis. Where the texture fits, its tiles are
/// stretched so that a whole number of them goes round the outline and up the frame. O(sides).
TextureMap mapFace(const TextureFrame* frame, const Mat3& axes, const Texture* texture, bool flat, Vec3d normal,
                   Vec3d point);

}  // namespace sgm::image
