// The loops over a brick's corners, compiled for each instruction set.
// Enters: rows of corners, coordinates and samples. Leaves: points in one batch, samples by corner, rows of bits.
// Assumes arrays don't overlap and may be read and written `rowPadding` floats beyond a row's start.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sgm::mesh {

/// Floats that a row of at most nine is copied as.
inline constexpr int rowPadding = 16;

/// Corners of a block next to each other along x.
struct CornerRow {
    uint16_t corner;  ///< number of the first one in the block
    uint8_t i, j, k;  ///< its coordinates in the block
    uint8_t count;    ///< 0 … 9
};

struct BrickLoops {
    /// Writes the rows' coordinates one after the other.
    void (*gather)(const CornerRow* rows, size_t n, const float* xs, const float* ys, const float* zs, float* x,
                   float* y, float* z);
    /// Writes values, one row after the other, to where they belong in the block.
    void (*scatter)(const CornerRow* rows, size_t n, const float* f, float* values);
    /// Bit i of bits[j + 9k]: corner (i, j, k) has f < 0, counted from `corner`; rows and layers are `rowStride` and
    /// `layerStride` floats apart.
    void (*inside)(const float* corner, size_t rowStride, size_t layerStride, uint16_t* bits);
};

namespace portable {
extern const BrickLoops brickLoops;
}
namespace avx2 {
extern const BrickLoops brickLoops;
}
namespace avx512 {
extern const BrickLoops brickLoops;
}

/// Those for the widest vectors this processor has.
const BrickLoops& brickLoops();

}  // namespace sgm::mesh
