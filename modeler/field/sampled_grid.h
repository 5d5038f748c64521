// A solid as samples: true distances on a dense grid around it, interpolated between them.
// Enters: distances at the corners of a grid, from modeler/mesh/distances.h. Leaves: an immutable block of words that
// the op `sampled`, the graph and the GPU share. Assumes the grid reaches past the solid's box, so that its outermost
// samples are positive.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::field {

class SampledGrid {
public:
    /// Where the words say what. Whole numbers are held as floats, so that one table serves all.
    enum Word : size_t {
        low,
        cell = 3,
        inverseCell,
        lipschitzBound,
        least,
        cells,
        nodesX = cells + 3,
        nodesXY,
        firstSample = 12
    };

    /// `distances` at low + cell_m · (i, j, k) for i < nodes.x … in order of (k, j, i), less than 2²⁴ of them, at least
    /// two along each axis; those on the grid's border are positive. `bounds` is the solid's own box.
    SampledGrid(Vec3f low, float cell_m, Vec3i nodes, const std::vector<float>& distances, const Box3f& bounds);

    const std::vector<float>& words() const { return words_; }
    const Box3f& bounds() const { return bounds_; }
    /// Of the interpolated field everywhere: the steepest gradient of a cell, at least 1.
    float lipschitz() const { return words_[lipschitzBound]; }
    /// Equal for equal words.
    uint64_t hash() const { return hash_; }

private:
    std::vector<float> words_;
    Box3f bounds_;
    uint64_t hash_ = 0;
};

using SampledGridPtr = std::shared_ptr<const SampledGrid>;

}  // namespace sgm::field
