// A sparse grid of floats behind OpenVDB: a level set, or fog (fog.h) made from one.
// Enters: a tape and a grid. Leaves: a narrow band of signed distances (negative inside), in metres. Assumes the field
// is near 1-Lipschitz; values further than the band are clamped to ±band. OpenVDB's headers stay in the .cpp.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::volume {

class Volume {
public:
    struct Impl;  ///< holds an openvdb::FloatGrid
    explicit Volume(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
    Impl& impl() const { return *impl_; }
    float voxel_m() const;
    uint64_t activeVoxels() const;
    /// Value at the voxel nearest to p (metres): signed distance, ±band away from the surface.
    float at(Vec3f p) const;
    /// Volume enclosed by the level set, m³; 0 where the grid is none.
    double enclosed_m3() const;
    /// Integral of the active values: of fog, its density times m³.
    double integral_m3() const;
    /// Box of the active voxels, their whole cells, metres; empty where there are none.
    Box3f bounds() const;

private:
    std::shared_ptr<Impl> impl_;
};

constexpr int usualHalfWidth = 3;  ///< of a level set, in voxels: what OpenVDB's own tools expect

/// Loads what needs OpenVDB, where that isn't linked or loaded yet; what works with volumes does so too, when it is
/// called. Error::Internal or Error::Input where this program has none, Error::Budget where there are no threads.
Status load();

/// Samples `whole` at the grid's corners into a level set of `halfWidth` voxels (1 … 32) to each side: in the blocks,
/// which hold the surface, and in all that touch them. Beyond the band voxels are inactive and inside and outside tiled
/// by sign. Equal bytes at any thread count. Error::Usage for another width, the errors of mesh::subdivide for the
/// grid.
Result<Volume> sample(const std::vector<mesh::Block>& blocks, const eval::Tape& whole, const mesh::Grid& grid,
                      int halfWidth, int threads, Progress* progress);

/// OpenVDB's own polygonisation, to compare ours with: one chunk, no origins.
Result<mesh::Mesh> toMesh(const Volume& volume);

struct VdbOptions {
    bool half = false;                            ///< 16-bit floats on disk: about a third smaller, three digits
    std::map<std::string, std::string> metadata;  ///< of the file
};

/// A volume and what its grid is called in a file.
struct NamedVolume {
    const Volume& volume;
    std::string name;
};

/// Writes a .vdb with a grid `name` and OpenVDB's statistics of it; written beside `path` and renamed into place. The
/// same bytes for the same volume, the file's tag being made from its content.
Status writeVdb(const Volume& volume, const std::filesystem::path& path, const std::string& name,
                const VdbOptions& options = {});
/// The same of several volumes into an existing `file` as it is; errors speak of `target`. For callers that do their
/// own renaming. Error::Cancelled when `progress` says so.
Status fillVdb(const std::vector<NamedVolume>& volumes, const std::filesystem::path& file,
               const std::filesystem::path& target, const VdbOptions& options, const Progress* progress = nullptr);
/// Reads the float grid of that name, or the first one.
Result<Volume> readVdb(const std::filesystem::path& path, const std::string& name = "");

}  // namespace sgm::volume
