#include "modeler/mesh/brick.h"

namespace sgm::mesh {
namespace {

constexpr uint16_t allCells = 0xff;

/// Which edges along each axis a brick on the low sides `lowSides` of its block takes care of.
std::array<BitRows, 3> handledEdges(int lowSides) {
    const bool withX = lowSides & 1, withY = lowSides & 2, withZ = lowSides & 4;
    const auto acrossX = static_cast<uint16_t>(withX ? 0x1ff : 0x1fe);
    std::array<BitRows, 3> handled{};
    for (int row = 0; row < brickRows; ++row) {
        const int j = rowJ(row), k = rowK(row);
        if ((j > 0 || withY) && (k > 0 || withZ)) handled[0][row] = allCells;
        if (j < brickCells && (k > 0 || withZ)) handled[1][row] = acrossX;
        if ((j > 0 || withY) && k < brickCells) handled[2][row] = acrossX;
    }
    return handled;
}

const BitRows& handledEdges(int axis, int lowSides) {
    static const auto table = [] {
        std::array<std::array<BitRows, 3>, 8> all;
        for (int sides = 0; sides < 8; ++sides) all[sides] = handledEdges(sides);
        return all;
    }();
    return table[lowSides][axis];
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

BitRows insideRows(const float* corner) {
    BitRows rows{};
    brickLoops().inside(corner, blockCorners, blockCorners * blockCorners, rows.data());
    return rows;
}

BitRows cutRows(const BitRows& inside, int axis, int lowSides) {
    const BitRows& handled = handledEdges(axis, lowSides);
    const int up = axis == 0 ? 0 : axis == 1 ? 1 : brickCorners;
    const int shift = axis == 0 ? 1 : 0;
    BitRows cut{};
    for (int row = 0; row < brickRows; ++row)
        cut[row] = static_cast<uint16_t>((inside[row] ^ inside[row + up] >> shift) & handled[row]);
    return cut;
}

BitRows surfaceRows(const BitRows& inside) {
    BitRows mixed{};
    for (int k = 0; k < brickCells; ++k)
        for (int j = 0; j < brickCells; ++j) {
            const int row = j + brickCorners * k;
            const int a = inside[row], b = inside[row + 1], c = inside[row + brickCorners],
                      d = inside[row + brickCorners + 1];
            const int any = a | b | c | d, all = a & b & c & d;
            mixed[row] = static_cast<uint16_t>((any | any >> 1) & ~(all & all >> 1) & allCells);
        }
    return mixed;
}

}  // namespace sgm::mesh
