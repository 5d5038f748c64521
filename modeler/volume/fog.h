// A level set as fog: densities for a renderer that scatters light, as Blender, Houdini and Unreal read them.
// Enters: a level set. Leaves: a fog volume on the same voxels: 0 outside, `density` deep inside, between them an edge
// that wisps eat and an inside that billows thin. Assumes distances in metres; OpenVDB's headers stay in the .cpp.
#pragma once

#include "modeler/volume/volume.h"

namespace sgm::volume {

struct FogOptions {
    double density = 1;  ///< deep inside, > 0
    double edge_m = 0;   ///< depth over which fog thickens to that, metres; 0: three voxels
    double wisps = 0;    ///< 0 … 0.95: how far noise eats into the edge
    double billow = 0;   ///< 0 … 1: how much noise thins the inside; stores the inside voxel by voxel
    double lump_m = 0;   ///< size of the largest lumps of both noises, metres; 0: an eighth of the least extent
};

/// With depth d below the surface, e = min(edge, d at the core of a part thinner than twice the edge), p = min(1, d/e)
/// and noises w, b in [0, 1]:
///   density · max(0, p − wisps·w)/(1 − wisps·w) · (1 − billow·b).
/// The ramp is OpenVDB's own (tools::sdfToFogVolume); beyond the level set's band depths come from fast sweeping
/// (Zhao 2004). Error::Usage for numbers out of range or a volume that is no level set, Error::Budget where the inside
/// has more than 2³¹ voxels to store, Error::Cancelled when `progress` says so.
Result<Volume> fog(const Volume& levelSet, const FogOptions& options, const Progress* progress = nullptr);

}  // namespace sgm::volume
