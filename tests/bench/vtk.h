// VTK's marching cubes on a dense grid, where the package is installed.
// Enters: samples of a grid. Leaves: what vtkFlyingEdges3D took; nothing where libvtk9-dev wasn't there at build time.
// Assumes C++17 only: VTK 9.1's headers are no C++20.
#pragma once

#include <cstdint>

#include "tests/bench/stopwatch.h"

namespace sgm::bench {

struct VtkResult {
    double seconds = 0;  ///< 0: not measured
    uint64_t triangles = 0;
};

/// vtkFlyingEdges3D over `corners` samples along each axis (x fastest, cells of edge 1), without normals and gradients,
/// which it makes by default.
VtkResult measureVtk(const float* values, const int (&corners)[3], Running running);

}  // namespace sgm::bench
