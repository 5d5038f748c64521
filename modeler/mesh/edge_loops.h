// The loops over a brick's cut edges, compiled for each instruction set.
// Enters: arrays of n entries. Leaves: the same arrays moved on. Assumes arrays don't overlap; nothing else, so that
// they are plain loops for the compiler's vectors, and every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sgm::mesh {

/// Vertices keep this share of a cell away from the ends of their edge, so that no two ever meet at a corner.
inline constexpr float edgeMargin = 0x1.0p-10f;

/// One entry an edge.
struct EdgeArrays {
    const float* base;   ///< moving coordinate of the low end, metres
    const float* span;   ///< the way to the high end, metres
    const float* slope;  ///< derivative along the edge where last evaluated
    float *tIn, *fIn;    ///< end of the bracket that is inside: share of the edge, value
    float *tOut, *fOut;  ///< the other end
    float* t;            ///< share of the edge
    float* f;            ///< value where last evaluated
    float* place;        ///< moving coordinate, metres
};

struct EdgeLoops {
    /// Makes brackets of the samples at the low ends (in fIn) and high ends (in fOut), and goes where the line between
    /// them is zero (SG-M III-G).
    void (*interpolate)(const EdgeArrays& e, size_t n);
    /// Narrows the brackets by t and f and moves each vertex by Newton's step, or to the middle where that would leave
    /// the bracket. Sets f to 1 where the vertex has to be looked at again, else to 0; returns how many have to.
    size_t (*step)(const EdgeArrays& e, size_t n);
    /// Scales (x, y, z) to unit length, to zero where it has no direction; returns how many have none.
    size_t (*normalize)(float* x, float* y, float* z, size_t n);
    /// Lists those of [begin, end) whose f isn't 0; returns how many. The list needs room for end − begin.
    size_t (*listOpen)(const float* f, size_t begin, size_t end, uint32_t* list);
    /// to[i] = from[list[i]]
    void (*pick)(const float* from, const uint32_t* list, size_t n, float* to);
    /// to[list[i]] = from[i]
    void (*putBack)(const float* from, const uint32_t* list, size_t n, float* to);
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
