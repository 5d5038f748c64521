// A small sampled grid for tests.
#pragma once

#include <cmath>
#include <memory>

#include "modeler/field/sampled_grid.h"

namespace sgm::field::test {

/// A torus about z of radii 1 and 0.4, its distances sampled `perMetre` times a metre.
inline SampledGridPtr sampledTorus(int perMetre = 8) {
    const float cell = 1.0f / static_cast<float>(perMetre);
    const Vec3f low = Vec3f{-1.4f, -1.4f, -0.4f} - Vec3f{1, 1, 1} * (1.7f * cell);
    const Vec3i nodes = Vec3i{28, 28, 8} * perMetre / 10 + Vec3i{5, 5, 5};
    std::vector<float> distances;
    for (int k = 0; k < nodes.z; ++k)
        for (int j = 0; j < nodes.y; ++j)
            for (int i = 0; i < nodes.x; ++i) {
                const Vec3f p = low + Vec3i{i, j, k}.as<float>() * cell;
                distances.push_back(std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.4f);
            }
    return std::make_shared<const SampledGrid>(low, cell, nodes, distances,
                                               Box3f{{-1.4f, -1.4f, -0.4f}, {1.4f, 1.4f, 0.4f}});
}

}  // namespace sgm::field::test
