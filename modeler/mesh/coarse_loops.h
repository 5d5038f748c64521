// The loops over every second corner of a brick and those between them, compiled for each instruction set.
// Enters: values at every second corner. Leaves: which corners between them need a value, and the signs of all others.
// Assumes arrays don't overlap and may be read and written `rowPadding` (brick_loops.h) entries beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sgm::mesh {

/// Corners along an edge of a brick, every second one.
inline constexpr int coarseCorners = 5;

/// Bits of a brick's corners: bit i of rows[j + 9k].
struct Between {
    uint16_t needed[96];  ///< has to be asked; none of the coarse ones
    uint16_t inside[96];  ///< of the other ones between: which have f < 0
};

/// From such a value on the surface is more than a cell away from all corners at distance 1, √2 or √3 cells.
struct FarFrom {
    float edge, face, middle;
};

struct CoarseLoops {
    /// Looks at the values at every second corner, from the brick's low one on, rows and layers so many floats apart.
    /// False where no corner is needed.
    bool (*find)(const float* coarse, size_t rowStride, size_t layerStride, FarFrom far, Between& between);
    /// Writes the values of all corners but the needed ones: the coarse ones, and between them numbers of the right
    /// sign.
    void (*fill)(const float* coarse, size_t rowStride, size_t layerStride, const Between& between, float* values,
                 size_t valueRow, size_t valueLayer);
    /// Writes where the needed corners lie, one after the other; returns how many.
    size_t (*gather)(const Between& between, const float* xs, const float* ys, const float* zs, float* x, float* y,
                     float* z);
    /// Writes their values to where they belong.
    void (*scatter)(const Between& between, const float* f, float* values, size_t valueRow, size_t valueLayer);
};

namespace portable {
extern const CoarseLoops coarseLoops;
}
namespace avx2 {
extern const CoarseLoops coarseLoops;
}
namespace avx512 {
extern const CoarseLoops coarseLoops;
}

/// Those for the widest vectors this processor has.
const CoarseLoops& coarseLoops();

}  // namespace sgm::mesh
