// The loops over a brick's corners and cells, compiled for each instruction set.
// Enters: rows of corners, coordinates, samples, bits. Leaves: points in one batch, samples by corner, bits, lists,
// triangles. Assumes arrays don't overlap and may be read and written `rowPadding` entries beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sgm::mesh {

/// Floats that a row of at most nine is copied as.
inline constexpr int rowPadding = 16;

/// Rows of bits that whole vectors make of the 9² rows of a brick.
inline constexpr int cutRows = 96;

/// Corners of a brick next to each other along x.
struct CornerRow {
    uint16_t corner;  ///< number of the first one, counted from the brick's low corner
    uint8_t i, j, k;  ///< its coordinates in the brick
    uint8_t count;    ///< 0 … 9
};

/// A cell with surface, by its low corner.
struct SurfaceCell {
    uint16_t corner;
    uint16_t inside;  ///< which corners are, a case of marching cubes
};

/// A case of marching cubes, for numbers of vertices kept three a corner (one an axis) in rows of corners.
struct PlacedCase {
    int16_t edges[15];  ///< of its triangles, by their places counted from the cell's low corner
    uint16_t triangles;
    uint8_t lanes[16];  ///< the same among the first eight places of the cell's four rows
};

struct BrickLoops {
    /// Writes the rows' coordinates one after the other.
    void (*gather)(const CornerRow* rows, size_t n, const float* xs, const float* ys, const float* zs, float* x,
                   float* y, float* z);
    /// Writes values, one row after the other, to where they belong.
    void (*scatter)(const CornerRow* rows, size_t n, const float* f, float* values);
    /// Bit i of bits[j + 9k]: corner (i, j, k) has f < 0, counted from `corner`; rows and layers are `rowStride` and
    /// `layerStride` floats apart.
    void (*inside)(const float* corner, size_t rowStride, size_t layerStride, uint16_t* bits);
    /// The edges among `edges` with one end inside: bits (inside ^ inside[row + up] >> shift) & edges of `cutRows`
    /// rows; `up` more of them may be read. Returns which groups of four rows have any.
    uint32_t (*cut)(const uint16_t* inside, int up, int shift, const uint16_t* edges, uint16_t* cut);
    /// Lists the edges that the surface cuts and a brick owns: along x, y and z, each ascending, by codeOf their low
    /// corner and axis; returns how many. Bits 0 … 7 and 1 … 8 of the rows of corners, whether they are inside, are in
    /// `low` and `high`, row j + 9k. The list's last vector is filled up with zeros.
    size_t (*ownEdges)(const uint8_t* low, const uint8_t* high, uint32_t* codes);
    /// Lists the cells of a brick that hold surface, ascending, with their cases; returns how many. The brick's low
    /// corner is `corner`, rows and layers are so many corners apart. The list needs room for `rowPadding` more.
    size_t (*cells)(const uint8_t* low, const uint8_t* high, int corner, int rowStride, int layerStride,
                    SurfaceCell* cells);
    /// Joins vertices, cell by cell; `number` holds three numbers a corner, rows and layers are so many corners apart.
    /// Writes the cells' triangles, three numbers each, and nothing beside them.
    void (*join)(const SurfaceCell* cells, size_t n, const uint32_t* number, size_t rowStride, size_t layerStride,
                 const PlacedCase* cases, uint32_t* triangles);
    /// Owners of n triangles: that of most corners, the lowest where all three differ. Corners that are ghosts (bit
    /// 31) are listed in `origins` from `own` on.
    void (*owners)(const uint32_t* triangles, size_t n, const uint32_t* origins, uint32_t own, uint32_t* to);
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
