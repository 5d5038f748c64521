// The separate solids of a mesh, and which of them float.
// Enters: a Mesh. Leaves: its connected solids with volume, box and owners. Assumes closed surfaces facing outward, so
// that a surface around air (a cavity) has negative volume.
#pragma once

#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// One connected surface that encloses solid.
struct ConnectedComponent {
    uint64_t triangles = 0;
    double volume_m3 = 0;  ///< of what the surface encloses, its cavities included
    Box3f bounds;
    std::vector<OriginId> origins;  ///< who owns it, most triangles first
    bool floats = false;            ///< doesn't stand on the model's lowest level
};

/// The pieces in the order of their first triangle. Whatever comes down to `slack_m` above the mesh's lowest point
/// stands; one cell is a sensible slack. So does the greatest, where less than a hundredth of its volume stands: a
/// cloud over its debris. O(n log n); `threads` 0: all.
std::vector<ConnectedComponent> connectedComponents(const Mesh& mesh, float slack_m, int threads = 1);

/// Which solids of a mesh stay: all; those that stand and aren't debris of less than a thousandth of the greatest one;
/// or the greatest one alone. Never none.
enum class Keep { All, Grounded, Largest };
/// Whether each of a model's solids stays; of a piece, volume and bounds count.
std::vector<bool> selectKept(std::vector<ConnectedComponent> solids, Keep keep, float slack_m);
/// What was taken away.
struct Dropped {
    uint64_t pieces = 0;    ///< solids
    double volume_m3 = 0;   ///< of theirs
    uint64_t cavities = 0;  ///< surfaces around air that no way leads to: filled
    double filled_m3 = 0;
};
/// Takes away what doesn't stay, and the closed cavities of what does. Nothing with Keep::All. Vertices are numbered
/// anew.
Dropped keepOnly(Mesh& mesh, Keep keep, float slack_m, int threads = 1);

}  // namespace sgm::mesh
