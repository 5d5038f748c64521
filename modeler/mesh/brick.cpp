#include "modeler/mesh/brick.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// Edges along each axis, by axis and mask of sides.
using EdgeTable = std::array<std::array<BitRows, 8>, 3>;

/// The edges from corner `at` along `axis` for which belongs(axis, sides, at) holds.
template <class Belongs>
EdgeTable edgesWhere(Belongs belongs) {
    EdgeTable table{};
    for (int axis = 0; axis < 3; ++axis)
        for (int sides = 0; sides < 8; ++sides)
            for (int row = 0; row < brickRows; ++row)
                for (int i = 0; i < brickCorners; ++i)
                    if (belongs(axis, sides, std::array{i, rowJ(row), rowK(row)}))
                        table[axis][sides][row] |= static_cast<uint16_t>(1 << i);
    return table;
}

/// Edges on low sides of the block: that of an axis in the mask `sides` is the brick's own low side, and on another low
/// side of the brick a lower brick takes care of them.
bool onLowSide(int axis, int sides, std::array<int, 3> at) {
    bool onLow = false, lower = at[axis] == brickCells;
    for (int other = 0; other < 3; ++other) {
        if (other == axis || at[other] > 0) continue;
        (sides >> other & 1 ? onLow : lower) = true;
    }
    return onLow && !lower;
}

/// Own edges on the high sides of the block that the brick touches.
bool onHighSide(int axis, int sides, std::array<int, 3> at) {
    bool onHigh = false, own = at[axis] < brickCells;
    for (int other = 0; other < 3; ++other) {
        if (other == axis) continue;
        own = own && at[other] > 0;
        onHigh = onHigh || ((sides >> other & 1) && at[other] == brickCells);
    }
    return onHigh && own;
}

SparseRows cutAmong(const BitRows& inside, int axis, const BitRows& edges) {
    const int up = axis == 0 ? 0 : axis == 1 ? 1 : brickCorners;
    const int shift = axis == 0 ? 1 : 0;
    SparseRows cut;
    cut.groups = brickLoops().cut(inside.data(), up, shift, edges.data(), cut.rows.data());
    return cut;
}

}  // namespace

const BrickLoops& brickLoops() {
#if defined(SGM_X86_KERNELS)
    static const BrickLoops& best = eval::bestIsa() == eval::Isa::Avx512 ? avx512::brickLoops
                                    : eval::bestIsa() == eval::Isa::Avx2 ? avx2::brickLoops
                                                                         : portable::brickLoops;
    return best;
#else
    return portable::brickLoops;
#endif
}

BrickSigns::BrickSigns(const BrickValues& values) {
    std::fill(rows.begin() + brickRows, rows.end(), uint16_t{0});
    brickLoops().inside(values.corner, values.row, values.layer, rows.data());
    for (int row = 0; row < paddedRows; ++row) {
        low[row] = static_cast<uint8_t>(rows[row]);
        high[row] = static_cast<uint8_t>(rows[row] >> 1);
    }
}

SparseRows cutsOnLowSides(const BrickSigns& signs, int axis, int sides) {
    static const EdgeTable edges = edgesWhere(onLowSide);
    return cutAmong(signs.rows, axis, edges[axis][sides]);
}

SparseRows cutsOnHighSides(const BrickSigns& signs, int axis, int sides) {
    static const EdgeTable edges = edgesWhere(onHighSide);
    return cutAmong(signs.rows, axis, edges[axis][sides]);
}

}  // namespace sgm::mesh
