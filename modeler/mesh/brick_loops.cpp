// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// use an inline function of the project's headers: the linker might keep the copy this machine can't run.
#include "modeler/mesh/brick_loops.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace sgm::mesh {
namespace {

constexpr int corners = 9;
/// Copied of a row whatever its length: a whole number of short vectors.
constexpr int copied = 12;
static_assert(copied <= rowPadding);

void gather(const CornerRow* rows, size_t n, const float* __restrict xs, const float* __restrict ys,
            const float* __restrict zs, float* __restrict x, float* __restrict y, float* __restrict z) {
    for (size_t r = 0; r < n; ++r) {
        const float* const from = xs + rows[r].i;
        const float yHere = ys[rows[r].j], zHere = zs[rows[r].k];
        const size_t count = rows[r].count;
        for (int i = 0; i < copied; ++i) x[i] = from[i];
        for (int i = 0; i < copied; ++i) y[i] = yHere;
        for (int i = 0; i < copied; ++i) z[i] = zHere;
        x += count, y += count, z += count;
    }
}

void scatter(const CornerRow* rows, size_t n, const float* __restrict f, float* __restrict values) {
    for (size_t r = 0; r < n; ++r) {
        float* const to = values + rows[r].corner;
        const int count = rows[r].count;
        if (count >= corners - 1) {
            for (int i = 0; i < corners - 1; ++i) to[i] = f[i];
            if (count == corners) to[corners - 1] = f[corners - 1];
        } else {
            for (int i = 0; i < count; ++i) to[i] = f[i];
        }
        f += count;
    }
}

/// Signs of the nine samples from `f` on.
unsigned signs(const float* f) {
#if defined(__AVX512F__)
    return _mm512_cmp_ps_mask(_mm512_loadu_ps(f), _mm512_setzero_ps(), _CMP_LT_OQ) & 0x1ffu;
#elif defined(__SSE2__)
    const __m128 zero = _mm_setzero_ps();
    const int low = _mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(f), zero));
    const int high = _mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(f + 4), zero));
    return static_cast<unsigned>(low | high << 4 | (f[8] < 0) << 8);
#else
    unsigned bits = 0;
    for (int i = 0; i < corners; ++i) bits |= static_cast<unsigned>(f[i] < 0) << i;
    return bits;
#endif
}

void inside(const float* corner, size_t rowStride, size_t layerStride, uint16_t* __restrict bits) {
    for (int k = 0; k < corners; ++k, corner += layerStride) {
        const float* row = corner;
        for (int j = 0; j < corners; ++j, row += rowStride) *bits++ = static_cast<uint16_t>(signs(row));
    }
}

}  // namespace

namespace SGM_ISA {
const BrickLoops brickLoops{gather, scatter, inside};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
