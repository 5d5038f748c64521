// The reference: every sample of the grid, and marching cubes over them.
// Enters: a sampler and a grid. Leaves: what it took. Assumes nothing about the field: nothing is skipped.
// Planes of samples are joined as soon as there are two, so that no sample goes through memory; vertices are linear
// interpolations, shared within a slab of 32 layers of cells. It makes no normals, no origins and no closed border: all
// of that flatters it.
#pragma once

#include <functional>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::bench {

/// Fills in values at points, on a worker of its number.
using Sampler = std::function<void(eval::Points points, float* out, int worker)>;

struct DenseResult {
    double seconds = 0;            ///< wall clock of the whole grid
    double evaluateSeconds = 0;    ///< of them, sampling
    double polygonizeSeconds = 0;  ///< and marching cubes
    uint64_t triangles = 0;
    int slabs = 0;          ///< in the grid
    int slabsMeasured = 0;  ///< fewer where times and triangles were scaled up
};

/// Sweeps the grid on `threads` threads. `maxSlabs` > 0 measures only so many slabs, spread evenly, and scales up.
DenseResult sweepDense(const Sampler& sampler, const mesh::Grid& grid, int threads, int maxSlabs);

}  // namespace sgm::bench
