#include "modeler/field/sampled_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "modeler/core/random.h"

namespace sgm::field {
namespace {

/// The steepest gradient of the trilinear interpolation: |∇f|² is convex along each axis, so it is greatest at a corner
/// of a cell, where the derivatives are the differences along the three edges that meet there.
float steepest(Vec3i nodes, float cell_m, const std::vector<float>& f) {
    const size_t stepY = static_cast<size_t>(nodes.x), stepZ = stepY * static_cast<size_t>(nodes.y);
    float most = 0;
    for (int k = 0; k + 1 < nodes.z; ++k)
        for (int j = 0; j + 1 < nodes.y; ++j)
            for (int i = 0; i + 1 < nodes.x; ++i) {
                const float* c =
                    &f[static_cast<size_t>(k) * stepZ + static_cast<size_t>(j) * stepY + static_cast<size_t>(i)];
                for (int corner = 0; corner < 8; ++corner) {
                    const size_t x = corner & 1, y = corner & 2 ? stepY : 0, z = corner & 4 ? stepZ : 0;
                    const float dx = c[y + z + 1] - c[y + z], dy = c[x + z + stepY] - c[x + z],
                                dz = c[x + y + stepZ] - c[x + y];
                    most = std::max(most, dx * dx + dy * dy + dz * dz);
                }
            }
    return std::sqrt(most) / cell_m;
}

}  // namespace

SampledGrid::SampledGrid(Vec3f lowCorner, float cell_m, Vec3i nodes, const std::vector<float>& distances,
                         const Box3f& bounds)
    : words_(firstSample), bounds_(bounds) {
    for (int axis = 0; axis < 3; ++axis) {
        words_[low + static_cast<size_t>(axis)] = lowCorner[axis];
        words_[cells + static_cast<size_t>(axis)] = static_cast<float>(nodes[axis] - 1);
    }
    words_[cell] = cell_m;
    words_[inverseCell] = 1 / cell_m;
    // Interpolating rounds a little.
    words_[lipschitzBound] = std::max(1.0f, steepest(nodes, cell_m, distances) * 1.0001f);
    words_[least] = *std::min_element(distances.begin(), distances.end());
    words_[nodesX] = static_cast<float>(nodes.x);
    words_[nodesXY] = static_cast<float>(nodes.x * nodes.y);
    words_.insert(words_.end(), distances.begin(), distances.end());
    for (const float w : words_)
        hash_ = (hash_ ^ std::bit_cast<uint32_t>(w)) * 0x9e3779b97f4a7c15ull, hash_ = std::rotl(hash_, 29);
    hash_ = mix(hash_);
}

}  // namespace sgm::field
