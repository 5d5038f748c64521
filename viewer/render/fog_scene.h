// Fog in GPU memory, ready for rays: a grid of density with the light that reaches each voxel, marched by one shader.
// Enters: a field's tape, or a ramp of fog. Leaves: the light of every job. Assumes a current GL 4.3 context for all
// but `fogGrid` and `prepareFog`.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "modeler/mesh/subdivide.h"
#include "modeler/volume/fog.h"
#include "viewer/render/draw.h"
#include "viewer/render/fog_light.h"
#include "viewer/render/gpu.h"
#include "viewer/render/pixels.h"

namespace sgm::render {

/// Everything about fog that needs no GPU, so that any thread can make it.
struct PreparedFog {
    FogTexels texels;
    Vec3i count;        ///< voxels
    Box3f box, bounds;  ///< the grid's outer faces; of the model, metres
    float voxel_m = 1, extinction_per_m = 1, lump_m = 1, wisps = 0;
};

/// A ramp of fog in a field's place.
struct FogGrid {
    volume::Dense dense;  ///< rises from 0 at the surface to 1 at the depth to which billows may eat the edge
    float edge_m = 0;     ///< that depth: a fifteenth of the bounds' least side
};
Result<FogGrid> fogGrid(const eval::Tape& tape, const mesh::Grid& grid, const Box3f& bounds, int threads,
                        Progress* progress);
/// The fog that files hold, by its options, in shares of its density.
Result<volume::Dense> fogGrid(const eval::Tape& tape, const mesh::Grid& grid, const volume::FogOptions& options,
                              int threads, Progress* progress);

/// Lights the fog. Error::Cancelled when `progress` says so.
Result<PreparedFog> prepareFog(const volume::Dense& grid, const Box3f& bounds, const FogLook& look, int threads,
                               Progress* progress);
/// How fog of this edge looks: thick enough to be white and whole, with billows that fit the edge.
inline FogLook usualFog(const FogGrid& grid) { return {0, 9 * grid.edge_m}; }

/// The shader and its noise, for all fogs.
struct FogPrograms {
    Program program;
    VolumeTexture billows;
    static Result<std::shared_ptr<const FogPrograms>> create();
};

class FogScene {
public:
    FogScene(const PreparedFog& fog, std::shared_ptr<const FogPrograms> programs);
    void look(const PictureOptions& options);
    /// Display light of up to 2¹⁸ jobs of the picture last looked at, 0 … 1, linear, and 1.
    Result<std::vector<std::array<float, 4>>> draw(std::span<const Job> jobs, Progress* progress);
    const Box3f& bounds() const { return bounds_; }

private:
    std::shared_ptr<const FogPrograms> programs_;
    VolumeTexture grid_, bricks_;
    Vec3i count_;
    Box3f box_, bounds_;
    float voxel_m_, extinction_per_m_, lump_m_, wisps_;
    size_t piece_ = 2048;  ///< jobs a dispatch, by the time the last ones took
};

}  // namespace sgm::render
