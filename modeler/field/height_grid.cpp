#include "modeler/field/height_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/field/heights_op.h"

namespace sgm::field {
namespace {

/// |∇h|² of a bilinear patch is convex along each axis, so it is greatest at a corner of a cell.
float steepest(int columns, int rows, float cell_m, const std::vector<float>& h) {
    float most = 0;
    const auto at = [&](int i, int k) {
        return h[static_cast<size_t>(k) * static_cast<size_t>(columns) + static_cast<size_t>(i)];
    };
    for (int k = 0; k + 1 < rows; ++k)
        for (int i = 0; i + 1 < columns; ++i) {
            const float a = at(i + 1, k) - at(i, k), b = at(i + 1, k + 1) - at(i, k + 1), c = at(i, k + 1) - at(i, k),
                        d = at(i + 1, k + 1) - at(i + 1, k);
            const float x = std::max(a * a, b * b), z = std::max(c * c, d * d);
            most = std::max(most, x + z);
        }
    return std::sqrt(most) / cell_m * 1.0001f;
}

/// Squares of one level with the least and the greatest height of each.
struct Level {
    int width = 0, depth = 0;
    std::vector<float> pairs;
};

/// Squares of two cells a side.
Level firstLevel(int columns, int rows, const std::vector<float>& h) {
    Level level{columns / 2, rows / 2, {}};  // (columns − 1) cells, rounded up
    for (int k = 0; k < level.depth; ++k)
        for (int i = 0; i < level.width; ++i) {
            float least = 3e38f, most = -3e38f;
            for (int dk = 0; dk <= 2; ++dk)
                for (int di = 0; di <= 2; ++di) {
                    const int x = std::min(2 * i + di, columns - 1), z = std::min(2 * k + dk, rows - 1);
                    const float v = h[static_cast<size_t>(z) * static_cast<size_t>(columns) + static_cast<size_t>(x)];
                    least = std::min(least, v), most = std::max(most, v);
                }
            level.pairs.push_back(least), level.pairs.push_back(most);
        }
    return level;
}

Level nextLevel(const Level& below) {
    Level level{(below.width + 1) / 2, (below.depth + 1) / 2, {}};
    for (int k = 0; k < level.depth; ++k)
        for (int i = 0; i < level.width; ++i) {
            float least = 3e38f, most = -3e38f;
            for (int dk = 0; dk < 2; ++dk)
                for (int di = 0; di < 2; ++di) {
                    const int x = std::min(2 * i + di, below.width - 1), z = std::min(2 * k + dk, below.depth - 1);
                    const size_t at =
                        2 * (static_cast<size_t>(z) * static_cast<size_t>(below.width) + static_cast<size_t>(x));
                    least = std::min(least, below.pairs[at]), most = std::max(most, below.pairs[at + 1]);
                }
            level.pairs.push_back(least), level.pairs.push_back(most);
        }
    return level;
}

/// A box of one plan coordinate.
struct Range {
    using Value = float;
    float lo = 0, hi = 0;
};

}  // namespace

SampledGridPtr heightGrid(float lowX, float lowZ, float cell_m, int columns, int rows,
                          const std::vector<float>& heights) {
    std::vector<float> words(HeightWords::firstHeight - SampledGrid::firstSample);
    const auto word = [&](size_t at) -> float& { return words[at - SampledGrid::firstSample]; };
    const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
    word(HeightWords::steepness) = steepest(columns, rows, cell_m, heights);
    word(HeightWords::lowest) = *least, word(HeightWords::highest) = *most;
    words.insert(words.end(), heights.begin(), heights.end());
    size_t count = 0;
    for (Level level = firstLevel(columns, rows, heights);; level = nextLevel(level)) {
        word(HeightWords::firstOf + count) = static_cast<float>(SampledGrid::firstSample + words.size());
        word(HeightWords::widthOf + count) = static_cast<float>(level.width);
        words.insert(words.end(), level.pairs.begin(), level.pairs.end());
        ++count;
        if (level.width == 1 && level.depth == 1) break;
    }
    word(HeightWords::levels) = static_cast<float>(count);
    const Box3f bounds{
        {lowX, *least, lowZ},
        {lowX + cell_m * static_cast<float>(columns - 1), *most, lowZ + cell_m * static_cast<float>(rows - 1)}};
    return std::make_shared<const SampledGrid>(Vec3f{lowX, lowZ, 0}, cell_m, Vec3i{columns, rows, 1}, words, bounds);
}

float heightAt(const SampledGrid& grid, float x, float z) {
    const std::array args{x, z};
    return ops::Heights::apply(std::span<const float>(args), grid.words().data());
}

HeightRange heightsOver(const SampledGrid& grid, float lowX, float lowZ, float highX, float highZ) {
    const std::array args{Range{lowX, highX}, Range{lowZ, highZ}};
    const Range all = ops::Heights::interval(std::span<const Range>(args), grid.words().data());
    return {all.lo, all.hi};
}

}  // namespace sgm::field
