// The references: every sample of the grid, and marching cubes over them, in two forms.
// Enters: a sampler and a grid. Leaves: what it took. Assumes nothing about the field: nothing is skipped.
// `Stored` samples the whole grid into memory and then walks it, as users of a dense grid do. `Fused` joins planes of
// samples as soon as there are two, so that no sample goes through memory. Vertices are linear interpolations, shared
// within a slab of layers. Neither makes normals, origins or a closed border: all of that flatters them. They are
// frozen: what they do stays as it is, so that figures of different days compare.
#pragma once

#include <functional>
#include <memory>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/subdivide.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {

/// Fills in values at points, on a worker of its number.
using Sampler = std::function<void(eval::Points points, float* out, int worker)>;

enum class Sweep { Stored, Fused };

struct DenseResult {
    double seconds = 0;            ///< wall clock of the whole grid
    double evaluateSeconds = 0;    ///< of them, sampling
    double polygonizeSeconds = 0;  ///< and marching cubes
    uint64_t triangles = 0;
    bool scaled = false;              ///< a part was measured; times and triangles are scaled up
    std::shared_ptr<float[]> values;  ///< every corner, x fastest: of a stored sweep that measured all
};

/// Sweeps the grid. With `inPart` only one thin slab a thread, spread evenly, scaled up.
DenseResult sweepDense(Sweep kind, const Sampler& sampler, const mesh::Grid& grid, Running running, bool inPart);

}  // namespace sgm::bench
