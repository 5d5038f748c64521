// Heights over a lattice of squares in the plan, as words of a SampledGrid that the op `heights` reads.
// Enters: heights at the corners of the squares. Leaves: an immutable block of words with the least and greatest height
// of ever larger squares behind the samples, so that ranges over any rectangle cost the same. Assumes nothing of what
// the heights are of.
#pragma once

#include "modeler/field/sampled_grid.h"

namespace sgm::field {

/// Where the words of such a grid say what. The first twelve are SampledGrid's, its x and y being x and z of the plan.
struct HeightWords {
    static constexpr size_t steepness = SampledGrid::firstSample;  ///< greatest |∇h|
    static constexpr size_t lowest = steepness + 1, highest = steepness + 2;
    /// Squares of 2, 4, 8 … cells: how many levels there are, and of each where its pairs of (least, greatest) begin
    /// and how many squares a row has.
    static constexpr size_t levels = steepness + 3, firstOf = levels + 1;
    static constexpr size_t mostLevels = 16, widthOf = firstOf + mostLevels;
    static constexpr size_t firstHeight = widthOf + mostLevels;
};

/// The most heights that a grid may hold: its words are counted in floats.
inline constexpr size_t mostHeights = size_t{1} << 22;

/// `heights` at (lowX + cell_m · i, lowZ + cell_m · k), k in the outer loop; at least two along each axis, and
/// mostHeights at most. Between them they are bilinear, beyond the lattice those of its border go on.
SampledGridPtr heightGrid(float lowX, float lowZ, float cell_m, int columns, int rows,
                          const std::vector<float>& heights);

/// The height at a place, by the very operations of the op.
float heightAt(const SampledGrid& grid, float x, float z);

/// The least and the greatest height.
struct HeightRange {
    float least = 0, greatest = 0;
};
/// An enclosure of all heights over a rectangle: those of squares of up to twice its size.
HeightRange heightsOver(const SampledGrid& grid, float lowX, float lowZ, float highX, float highZ);
/// Greatest |∇h|.
inline float steepnessOf(const SampledGrid& grid) { return grid.words()[HeightWords::steepness]; }

}  // namespace sgm::field
