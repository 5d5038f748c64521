// A field made ready for rays: space cut into cells with shortened tapes, and the materials of its parts.
// Enters: a tape, bounds and provenance. Leaves: what tracers read. Needs no GPU, so that any thread can make it.
#pragma once

#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "viewer/render/cells.h"
#include "viewer/render/surface_textures.h"

namespace sgm::render {

struct PreparedField {
    eval::Tape tape;
    Box3f bounds;  ///< of the solid, metres
    Box3f box;     ///< what the cells cover
    CellTree tree;
    std::vector<Material> materials;
    std::vector<uint32_t> materialOf;  ///< by OriginId
    SurfaceTextures textures;

    /// A way through a surface: from before it to behind it, metres.
    struct Probe {
        Vec3f from, to;
    };

    float inverseLipschitz() const { return 1.0f / std::max(tape.lipschitz(), 1e-6f); }
    /// 1; −1 where `eye` stands inside the solid, which is then drawn inside out.
    float sideOf(Vec3f eye) const;
    /// Whose surface each probe meets first: the owner a twentieth of its way behind that place, at its end where it
    /// meets none. 0 where no part owns it. Takes four values and an owner a probe.
    std::vector<OriginId> originsOf(const std::vector<Probe>& probes, int threads) const;
};

/// Cuts space into cells, at most `levels` deep. The errors of SurfaceTextures::create.
Result<PreparedField> prepareField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                                   int threads, Progress* progress, int levels = CellTree::surfaceDepth);

}  // namespace sgm::render
