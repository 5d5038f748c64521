// A small lattice of heights for tests.
#pragma once

#include <cmath>

#include "modeler/field/height_grid.h"

namespace sgm::field::test {

/// The height of `waves` before it is sampled.
inline double waveAt(double x, double z) { return .3 * std::sin(2.1 * x) + .2 * std::cos(1.7 * z - x); }

/// Waves over [-1.5, 1.5] x [-1.2, 1.2], `perMetre` squares a metre.
inline SampledGridPtr waves(int perMetre = 7) {
    const float cell = 1.0f / static_cast<float>(perMetre);
    const int columns = 3 * perMetre + 1, rows = 12 * perMetre / 5 + 1;
    std::vector<float> heights;
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i < columns; ++i)
            heights.push_back(
                static_cast<float>(waveAt(-1.5 + static_cast<double>(cell) * i, -1.2 + static_cast<double>(cell) * k)));
    return heightGrid(-1.5f, -1.2f, cell, columns, rows, heights);
}

}  // namespace sgm::field::test
