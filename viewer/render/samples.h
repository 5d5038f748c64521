// A coarse look at a field: its values on a grid over its bounds, for choosing a place to stand and a frame.
// Enters: a tape and finite bounds. Leaves: values. Assumes nothing of the field but its Lipschitz bound.
#pragma once

#include <vector>

#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"

namespace sgm::render {

/// Field values at the centres of a grid's cubic cells, which cover the bounds.
struct Samples {
    static constexpr int edge = 40;  ///< samples along the longest side
    Box3f bounds;
    Vec3i count;
    float cell = 1;  ///< metres
    std::vector<float> values;

    Vec3f at(int i, int j, int k) const {
        return bounds.lo + Vec3f{float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f} * cell;
    }
    size_t index(int i, int j, int k) const {
        return (size_t(k) * size_t(count.y) + size_t(j)) * size_t(count.x) + size_t(i);
    }
    bool holds(int i, int j, int k) const {
        return i >= 0 && j >= 0 && k >= 0 && i < count.x && j < count.y && k < count.z;
    }
    /// Centres of the cells with f < `below`.
    std::vector<Vec3f> placesBelow(float below) const;
};

Samples sample(const eval::Tape& tape, const Box3f& bounds);

/// Values of the field at places, in their order.
std::vector<float> valuesAt(const eval::Tape& tape, const std::vector<Vec3f>& points);

}  // namespace sgm::render
