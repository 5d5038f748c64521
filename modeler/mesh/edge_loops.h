// The loops over a brick's cut edges, compiled for each instruction set.
// Enters: arrays of n entries. Leaves: the same arrays moved on. Assumes arrays don't overlap and have room for whole
// vectors: entries from n up to the next multiple of `edgeVector` are read and written too, and hold any numbers. Plain
// loops for the compiler's vectors, and every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sgm::mesh {

/// Vertices keep this share of a cell away from the ends of their edge, so that no two ever meet at a corner.
inline constexpr float edgeMargin = 0x1.0p-10f;

/// Floats of the longest vector.
inline constexpr size_t edgeVector = 16;
constexpr size_t wholeVectors(size_t n) { return (n + edgeVector - 1) / edgeVector * edgeVector; }

/// A corner of a brick, and an axis, as one number of a byte each. Sums of two are sums of corners.
constexpr uint32_t codeOf(uint32_t i, uint32_t j, uint32_t k, uint32_t axis = 0) {
    return i | j << 8 | k << 16 | axis << 24;
}

/// Where the field is evaluated on edges, and what came of it.
struct EdgePoints {
    float *x, *y, *z;     ///< where the field is evaluated and, at last, the vertex; metres
    float *dx, *dy, *dz;  ///< derivatives where last evaluated; at last the normal
    float* f;             ///< value where last evaluated
};

/// One entry an edge.
struct EdgeArrays : EdgePoints {
    float* base;         ///< moving coordinate of the low end, metres
    float* span;         ///< the way to the high end, metres
    float *tIn, *fIn;    ///< end of the bracket that is inside: share of the edge, value
    float *tOut, *fOut;  ///< the other end
    float* t;            ///< share of the edge
    float* axis;         ///< along which it lies: 0, 1, 2
    float* open;         ///< 1 where the vertex has to be looked at again, else 0
};

/// A brick's corners, and the block's samples and numbers from the brick's low corner on.
struct EdgeEnds {
    const float* coordinates[3];  ///< metres, by corner along each axis; `edgeVector` of them may be read
    const float* values;          ///< by corner, `strides` apart along the axes
    uint32_t strides[3];
    uint32_t numbers[3];  ///< what a corner's number grows by along the axes
};

struct EdgeLoops {
    /// Writes n entries, edges up from corners along axes, by `codes`: where they lie, how long they are, the samples
    /// at their ends; and to `places` three times the corner's number plus the axis. Both
    /// may be one list, and the arrays of entries may begin anywhere.
    void (*place)(const EdgeEnds& ends, const uint32_t* codes, size_t n, const EdgeArrays& e, uint32_t* places);
    /// Makes brackets of the samples at the low ends (in fIn) and high ends (in fOut), and goes where the line between
    /// them is zero (SG-M III-G).
    void (*interpolate)(const EdgeArrays& e, size_t n);
    /// Narrows the brackets by t and f and moves each vertex to where the line between their ends is zero. With
    /// `weaken` an end that never moved counts half.
    void (*narrow)(const EdgeArrays& e, size_t n, bool weaken);
    /// Narrows the brackets by t and f and moves each vertex by Newton's step, or to the middle where that would leave
    /// the bracket. Tells in `open` which have to be looked at again; returns how many.
    size_t (*step)(const EdgeArrays& e, size_t n);
    /// Moves each vertex by Newton's step for the last time, where that can be trusted.
    void (*settle)(const EdgeArrays& e, size_t n);
    /// Scales (dx, dy, dz) to unit length, to zero where it has no direction; returns how many have none.
    size_t (*normalize)(const EdgeArrays& e, size_t n);
    /// Takes over the open ones of n entries, but for f, open and derivatives; returns how many. They stay in order.
    size_t (*pick)(const EdgeArrays& from, size_t n, const EdgeArrays& to);
    /// Hands places and derivatives back to the open ones of n entries, which `from` was picked from.
    void (*putBack)(const EdgeArrays& from, size_t n, const EdgeArrays& to);
    /// Writes n points (x, y, z) one after the other.
    void (*interleave)(const float* x, const float* y, const float* z, size_t n, float* points);
};

namespace portable {
extern const EdgeLoops loops;
}
namespace avx2 {
extern const EdgeLoops loops;
}
namespace avx512 {
extern const EdgeLoops loops;
}

}  // namespace sgm::mesh
