#include "tests/bench/peers.h"

#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include "modeler/volume/volume_impl.h"  // the grid itself: volume::toMesh adds normals and copies, which aren't OpenVDB's time

namespace sgm::bench {

Result<OpenVdbResult> measureOpenVdb(const std::vector<mesh::Block>& blocks, const eval::Tape& tape,
                                     const mesh::Grid& grid, Running running) {
    OpenVdbResult result;
    result.blocks = blocks.size();
    const Stopwatch sampling(running);
    const auto volume = volume::sample(blocks, tape, grid, 3, running.threads, nullptr);
    if (!volume.ok()) return volume.error();
    result.sampleSeconds = sampling.seconds();

    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    tbb::task_arena arena(running.threads);
    const Stopwatch meshing(running);
    arena.execute([&] { openvdb::tools::volumeToMesh(*volume->impl().grid, points, triangles, quads, 0.0, 0.0); });
    result.meshSeconds = meshing.seconds();
    result.triangles = triangles.size() + 2 * quads.size();
    return result;
}

}  // namespace sgm::bench
