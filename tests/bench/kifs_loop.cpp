// The folds of modeler/field/kifs.h by hand, in AVX-512 with fused operations: two vectors at a time stay in registers
// from the first pass to the last.
#include "tests/bench/kifs.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>

namespace sgm::bench {

#if defined(__x86_64__)
#define SGM_AVX512 __attribute__((target("avx512f,avx512dq,fma"), always_inline)) inline

namespace {

struct Numbers {
    __m512 scale, moveX, moveY, lastFold, fold[9];
};

SGM_AVX512 __m512 all(float f) { return _mm512_set1_ps(f); }

template <bool turned>
SGM_AVX512 void pass(const Numbers& n, __m512& x, __m512& y, __m512& z) {
    const __m512 ax = _mm512_abs_ps(x), ay = _mm512_abs_ps(y), az = _mm512_abs_ps(z);
    const __m512 big = _mm512_max_ps(ax, ay), small = _mm512_min_ps(ax, ay), rest = _mm512_min_ps(big, az);
    __m512 px = _mm512_max_ps(big, az), py = _mm512_max_ps(small, rest), pz = _mm512_min_ps(small, rest);
    if constexpr (turned) {
        const auto row = [&](int r) __attribute__((target("avx512f,avx512dq,fma"))) {
            return _mm512_fmadd_ps(n.fold[r], px, _mm512_fmadd_ps(n.fold[3 + r], py, _mm512_mul_ps(n.fold[6 + r], pz)));
        };
        const __m512 qx = row(0), qy = row(1);
        pz = row(2), px = qx, py = qy;
    }
    x = _mm512_fmadd_ps(px, n.scale, n.moveX);
    y = _mm512_fmadd_ps(py, n.scale, n.moveY);
    z = _mm512_sub_ps(n.lastFold, _mm512_abs_ps(_mm512_fmsub_ps(pz, n.scale, n.lastFold)));
}

template <bool turned>
__attribute__((target("avx512f,avx512dq,fma"))) void run(const Fractal& f, eval::Points points, float* out) {
    const Vec3f c = f.scaleCentre, half = f.box.half, m = f.box.centre;
    const float reach = maxComponent(c), less = f.scale - 1, least = std::min(half.x, std::min(half.y, half.z));
    Numbers n{all(f.scale), all(-c.x * less), all(-c.y * less), all(c.z * less * 0.5f), {}};
    for (int i = 0; i < 9; ++i) n.fold[i] = all(f.fold[i]);
    const __m512 unscale = all(least / (reach * std::pow(f.scale, static_cast<float>(f.passes))));
    constexpr size_t lanes = 16, together = 2;
    for (size_t i = 0; i + lanes * together <= points.n; i += lanes * together) {
        __m512 x[together], y[together], z[together];
        for (size_t k = 0; k < together; ++k) {
            x[k] =
                _mm512_mul_ps(_mm512_sub_ps(_mm512_loadu_ps(points.x + i + k * lanes), all(m.x)), all(reach / half.x));
            y[k] =
                _mm512_mul_ps(_mm512_sub_ps(_mm512_loadu_ps(points.y + i + k * lanes), all(m.y)), all(reach / half.y));
            z[k] =
                _mm512_mul_ps(_mm512_sub_ps(_mm512_loadu_ps(points.z + i + k * lanes), all(m.z)), all(reach / half.z));
        }
        for (int p = 0; p < f.passes; ++p)
            for (size_t k = 0; k < together; ++k) pass<turned>(n, x[k], y[k], z[k]);
        for (size_t k = 0; k < together; ++k) {
            const __m512 cube = _mm512_sub_ps(
                _mm512_max_ps(_mm512_abs_ps(x[k]), _mm512_max_ps(_mm512_abs_ps(y[k]), _mm512_abs_ps(z[k]))),
                all(reach));
            const __m512 square = _mm512_fmadd_ps(x[k], x[k], _mm512_fmadd_ps(y[k], y[k], _mm512_mul_ps(z[k], z[k])));
            const __m512 ball = _mm512_sub_ps(_mm512_sqrt_ps(square), all(2));
            const auto beyond = [&](const float* at, float centre, float size)
                __attribute__((target("avx512f,avx512dq,fma"))) {
                return _mm512_sub_ps(_mm512_abs_ps(_mm512_sub_ps(_mm512_loadu_ps(at + i + k * lanes), all(centre))),
                                     all(size));
            };
            const __m512 qx = beyond(points.x, m.x, half.x), qy = beyond(points.y, m.y, half.y),
                         qz = beyond(points.z, m.z, half.z), none = all(0);
            const __m512 ox = _mm512_max_ps(qx, none), oy = _mm512_max_ps(qy, none), oz = _mm512_max_ps(qz, none);
            const __m512 outside =
                _mm512_sqrt_ps(_mm512_fmadd_ps(ox, ox, _mm512_fmadd_ps(oy, oy, _mm512_mul_ps(oz, oz))));
            const __m512 box = _mm512_add_ps(outside, _mm512_min_ps(_mm512_max_ps(qx, _mm512_max_ps(qy, qz)), none));
            _mm512_storeu_ps(out + i + k * lanes, _mm512_max_ps(_mm512_mul_ps(f.cubes ? cube : ball, unscale), box));
        }
    }
}

}  // namespace

bool foldByHand(const Fractal& fractal, eval::Points points, float* out) {
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512dq")) return false;
    fractal.turned ? run<true>(fractal, points, out) : run<false>(fractal, points, out);
    return true;
}
#else
bool foldByHand(const Fractal&, eval::Points, float*) { return false; }
#endif

}  // namespace sgm::bench
