#include "modeler/mesh/brick.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace sgm::mesh {
namespace {

constexpr uint16_t allCells = 0xff;

/// Signs of the nine samples from `f` on.
uint32_t signs(const float* f) {
#if defined(__SSE2__)
    const __m128 zero = _mm_setzero_ps();
    const int low = _mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(f), zero));
    const int high = _mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(f + 4), zero));
    return static_cast<uint32_t>(low | high << 4 | (f[8] < 0) << 8);
#else
    uint32_t bits = 0;
    for (int i = 0; i < brickCorners; ++i) bits |= static_cast<uint32_t>(f[i] < 0) << i;
    return bits;
#endif
}

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

BitRows insideRows(const float* corner) {
    BitRows rows{};
    for (int k = 0; k < brickCorners; ++k)
        for (int j = 0; j < brickCorners; ++j)
            rows[j + brickCorners * k] = static_cast<uint16_t>(signs(corner + blockCorners * (j + blockCorners * k)));
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
