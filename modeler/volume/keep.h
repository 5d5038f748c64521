// What floats, taken out of a level set: the solids that `mesh::keepOnly` takes out of its mesh.
// Enters: a level set and which solids stay. Leaves: the level set of those, closed cavities filled, changed in place.
// Assumes signs of a solid's own: voxels hang together by their six neighbours, as the mesher joins corners.
#pragma once

#include "modeler/mesh/connected_components.h"
#include "modeler/volume/volume.h"

namespace sgm::volume {

/// Nothing with Keep::All. `slack_m` as in mesh::keepOnly. Beside what was taken away, values are bounds of the
/// distance rather than distances. Error::Budget for more than 2²⁸ voxels inside, or in the box around them;
/// Error::Cancelled.
Status keepOnly(Volume& level, mesh::Keep keep, float slack_m, Progress* progress);

}  // namespace sgm::volume
