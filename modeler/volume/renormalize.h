// A level set whose band holds distances, made from one whose values are only near to them.
// Enters: a level set of any slope near its isosurface. Leaves: a level set with |∇f| = 1 off the medial axis and the
// same isosurface. OpenVDB's headers stay in the .cpp.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/volume/volume.h"

namespace sgm::volume {

/// A new level set of the same band, voxels and signs. Each value becomes the distance, in metres, to the isosurface
/// as marching cubes triangulates it, exact at every voxel centre; a level set of a distance field keeps its values to
/// second order in voxel over radius of curvature. The zero crossings move by a hundredth of a voxel on average:
/// where the isosurface curves or bends within a cell, linear interpolation no longer gives the very same place.
/// Equal bytes at any thread count. Linear in the active voxels. Error::Cancelled when `progress` says so,
/// Error::Usage for a grid that is no level set and for a band wider than 24 voxels.
Result<Volume> renormalize(const Volume& level, int threads, Progress* progress);

}  // namespace sgm::volume
