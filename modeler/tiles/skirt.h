// Strips that hang from a cell's ground along the cell's borders: where a neighbour of another level of detail lies a
// little higher or lower, they close the gap.
// Enters: a piece of ground about the cell's centre. Leaves: the piece with more triangles. Assumes that the vertices
// on a border lie on it exactly.
#pragma once

#include <functional>

#include "modeler/tiles/surface.h"

namespace sgm::tiles {

/// Tells of each place whether it is inside the solid.
using InsideTest = std::function<std::vector<bool>(const std::vector<Vec3d>&)>;

struct SkirtRequest {
    double side_m = 256;  ///< of the cell
    double depth_m = 1;   ///< how far a strip reaches at most
    InsideTest inside;    ///< of places about the cell's centre: strips stay inside
};

/// Adds strips under the edges that lie on the cell's borders, into the solid, and counts them in `skirtTriangles`.
/// They face the neighbour and are shaded as the surface above them.
void addSkirts(SurfacePiece& piece, const SkirtRequest& request);

}  // namespace sgm::tiles
