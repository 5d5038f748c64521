// What others would take for the same job.
// Enters: blocks with their tapes, and the grid. Leaves: OpenVDB's times. Assumes blocks from mesh::subdivide.
#pragma once

#include <vector>

#include "modeler/core/result.h"
#include "modeler/mesh/subdivide.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {

struct OpenVdbResult {
    double sampleSeconds = 0;  ///< our sampling of a narrow band of three voxels into its grid, blocks skipped
    double meshSeconds = 0;    ///< openvdb::tools::volumeToMesh of that grid, no adaptivity
    uint64_t triangles = 0;    ///< a quad counts as two
    uint64_t blocks = 0;       ///< of 32³ cells, not skipped
};

/// Error as of volume::sample.
Result<OpenVdbResult> measureOpenVdb(const std::vector<mesh::Block>& blocks, const eval::Tape& tape,
                                     const mesh::Grid& grid, Running running);

}  // namespace sgm::bench
