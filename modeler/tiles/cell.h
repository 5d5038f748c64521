// Cells of the ground: squares whose side doubles from level to level, four of one level in one of the next.
// Enters: places in metres. Leaves: cells and their names. Assumes x east and z south, level 0 the finest.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::tiles {

/// A half-open square [x · s, (x + 1) · s) × [z · s, (z + 1) · s), s being the side of level 0 times 2^level.
struct Cell {
    int level = 0, x = 0, z = 0;
    friend auto operator<=>(const Cell&, const Cell&) = default;

    double side_m(double finest_m) const { return finest_m * static_cast<double>(1 << level); }
    /// Of its middle, at height 0.
    Vec3d centre(double finest_m) const;
    /// The cell one level up that it lies in.
    Cell parent() const { return {level + 1, x >> 1, z >> 1}; }
    /// "0/3_-2".
    std::string name() const;
    /// The place in Morton order among the cells of its level, so that neighbours come close to each other.
    uint64_t morton() const;
};

/// The cell of level 0 that a place lies in.
Cell cellAt(double x_m, double z_m, double finest_m);
/// The cell of a name; nothing for any other text.
std::optional<Cell> cellNamed(std::string_view name);
/// All cells of levels 0 … levels − 1 that hold one of `finest`, the coarsest level last, each level in Morton order.
std::vector<Cell> pyramidOver(std::vector<Cell> finest, int levels);

/// "i/N": which of N tasks, from 1.
struct Share {
    int task = 1, of = 1;
    /// Which of `count` things in a row are its own: [first, last).
    std::pair<size_t, size_t> range(size_t count) const;
    /// The task of N that has number `index` of `count`.
    static int taskOf(size_t index, size_t count, int of);
};
/// Reads "3/64"; nothing for what isn't one of 1 … N, N at most 1,000,000.
std::optional<Share> parseShare(std::string_view text);
/// "3,7,12-15": numbers in ascending order, as job arrays take them.
std::string arrayNotation(const std::vector<int>& numbers);

}  // namespace sgm::tiles
