// How much light reaches the inside of fog: optical depths swept through its grid, once for all pictures.
// Enters: a dense ramp of fog. Leaves: texels for the fog shader. Assumes parallel light.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/volume/dense.h"

namespace sgm::render {

/// Integral of the grid's values along `towardsLight` (a unit vector) from each voxel to the grid's end, times metres;
/// 0 outside. Slices across the direction's largest component follow each other, each interpolating in the one before
/// (first order; shadows soften a little on their way).
std::vector<float> opticalDepth(const volume::Dense& grid, Vec3f towardsLight, int threads);

/// What the shader reads of a voxel, 0 … 65535 for 0 … 1: the grid's value, the root of the sun's optical depth in
/// shares of `mostSunDepth`, what it sees of the sky above, and of what lies below.
struct FogTexels {
    static constexpr float mostSunDepth = 60;
    std::vector<uint16_t> rgba;
    /// For bricks of 8³ voxels, in the same order: how many bricks away fog is, 0 where it is inside; 255 for 255 or
    /// more.
    std::vector<uint8_t> bricks;
    Vec3i brickCount;
    static constexpr int brickEdge = 8;
};

/// `extinction_per_m`: of a grid value of 1. `thin` is subtracted from the values first, as much as noise eats on
/// average. Error::Cancelled when `progress` says so.
Result<FogTexels> lightFog(const volume::Dense& grid, float extinction_per_m, float thin, Vec3f towardsSun, int threads,
                           Progress* progress);

/// A cube of billowing noise that continues on its other side: three octaves of inverted cell noise (Worley 1996), 255
/// on the top of a billow; x fastest.
std::vector<uint8_t> billows(int edge);

}  // namespace sgm::render
