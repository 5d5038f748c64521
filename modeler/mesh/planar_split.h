// Regions that are planar but for a few bumps, split into the plane and the bumps.
// Enters: regions and which of them are planar. Leaves: more regions, so that more of the surface is planar. Assumes a
// closed 2-manifold.
#pragma once

#include <vector>

#include "modeler/mesh/chains.h"
#include "modeler/mesh/planes.h"

namespace sgm::mesh {

/// Gives triangles that keep a large region from being planar within `bound_m` a region of their own, of the same
/// origin and label, where they are few; what is left of the region gets its plane. Returns these regions. O(n).
std::vector<uint32_t> separateBumps(const FlatMesh& mesh, double bound_m, SurfaceRegions& regions,
                                    std::vector<Plane>& planes);

/// Takes the planes from regions whose border touches itself in the plane, both simplified within `chain_m` and whole,
/// on `threads` threads (0: all).
void rejectTouching(const FlatMesh& mesh, const Chains& chains, std::span<const uint32_t> regions, double chain_m,
                    std::vector<Plane>& planes, int threads);

}  // namespace sgm::mesh
