#include <algorithm>
#include <cmath>

#include "tests/bench/reference.h"

#define SGM_INLINE [[gnu::always_inline]] inline  // into the function of each instruction set

namespace sgm::bench {
namespace {

constexpr size_t batch = 64;  ///< points whose values stay in registers or next to them

constexpr float farAway = 1e30f;

/// Coordinates and values of a batch.
struct Batch {
    float x[batch], y[batch], z[batch], part[batch], value[batch], before[batch];
};

SGM_INLINE float ball(float x, float y, float z, const Primitive& p) {
    return std::sqrt(x * x + y * y + z * z) - p.half.x;
}
SGM_INLINE float box(float x, float y, float z, const Primitive& p) {
    const float qx = std::abs(x) - p.half.x, qy = std::abs(y) - p.half.y, qz = std::abs(z) - p.half.z;
    const float ox = std::max(qx, 0.0f), oy = std::max(qy, 0.0f), oz = std::max(qz, 0.0f);
    return std::sqrt(ox * ox + oy * oy + oz * oz) + std::min(std::max(qx, std::max(qy, qz)), 0.0f);
}
SGM_INLINE float morph(float x, float y, float z, const Primitive& p) {
    const float a = ball(x, y, z, p), b = box(x, y, z, p);
    return a + p.amount * (b - a);
}
SGM_INLINE float roof(float x, float y, float z, const Primitive& p) {
    const float rise = 2 * p.half.y, foot = y + p.half.y;
    const float sx = ((std::abs(x) - p.half.x) * rise + foot * p.half.x) / std::sqrt(rise * rise + p.half.x * p.half.x);
    const float sz = ((std::abs(z) - p.half.z) * rise + foot * p.half.z) / std::sqrt(rise * rise + p.half.z * p.half.z);
    const float ux = x / p.half.x, uy = foot / rise, uz = z / p.half.z;
    const float dome = (std::sqrt(ux * ux + uy * uy + uz * uz) - 1) * std::min(std::min(p.half.x, p.half.z), rise);
    const float sides = std::max(sx, sz);
    return std::max(sides + p.amount * (dome - sides), box(x, y, z, p));
}

/// Puts a solid into the part, or cuts it from what is there.
template <float (*distance)(float, float, float, const Primitive&)>
SGM_INLINE void join(Batch& b, const Primitive& p, bool cut) {
    if (cut)
        for (size_t i = 0; i < batch; ++i)
            b.part[i] =
                std::max(b.part[i], -distance(b.x[i] - p.centre.x, b.y[i] - p.centre.y, b.z[i] - p.centre.z, p));
    else
        for (size_t i = 0; i < batch; ++i)
            b.part[i] = distance(b.x[i] - p.centre.x, b.y[i] - p.centre.y, b.z[i] - p.centre.z, p);
}

/// One pass after another over the whole batch: folds of the sponge, rotation, scaling, last fold.
template <bool turned>
SGM_INLINE void evaluateFractal(const Fractal& f, Batch& b) {
    const Vec3f c = f.scaleCentre, half = f.box.half, m = f.box.centre;
    const float reach = std::max(c.x, std::max(c.y, c.z)), s = f.scale, less = s - 1, h = c.z * less * 0.5f;
    const float* r = f.fold;
    float x[batch], y[batch], z[batch];
    for (size_t i = 0; i < batch; ++i) {
        x[i] = (b.x[i] - m.x) * (reach / half.x);
        y[i] = (b.y[i] - m.y) * (reach / half.y);
        z[i] = (b.z[i] - m.z) * (reach / half.z);
    }
    for (int pass = 0; pass < f.passes; ++pass)
        for (size_t i = 0; i < batch; ++i) {
            const float ax = std::abs(x[i]), ay = std::abs(y[i]), az = std::abs(z[i]);
            const float big = std::max(ax, ay), small = std::min(ax, ay), rest = std::min(big, az);
            float px = std::max(big, az), py = std::max(small, rest), pz = std::min(small, rest);
            if constexpr (turned) {
                const float qx = r[0] * px + r[3] * py + r[6] * pz, qy = r[1] * px + r[4] * py + r[7] * pz;
                pz = r[2] * px + r[5] * py + r[8] * pz;
                px = qx, py = qy;
            }
            x[i] = px * s - c.x * less;
            y[i] = py * s - c.y * less;
            z[i] = h - std::abs(pz * s - h);
        }
    const float unscale =
        std::min(half.x, std::min(half.y, half.z)) / (reach * std::pow(s, static_cast<float>(f.passes)));
    for (size_t i = 0; i < batch; ++i) {
        const float ball = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]) - 2;
        const float cube = std::max(std::abs(x[i]), std::max(std::abs(y[i]), std::abs(z[i]))) - reach;
        b.value[i] = std::max((f.cubes ? cube : ball) * unscale, box(b.x[i] - m.x, b.y[i] - m.y, b.z[i] - m.z, f.box));
    }
}

SGM_INLINE void evaluateBatch(const Reference& r, Batch& b) {
    if (r.fractal)
        return r.fractal->turned ? evaluateFractal<true>(*r.fractal, b) : evaluateFractal<false>(*r.fractal, b);
    std::fill(std::begin(b.value), std::end(b.value), farAway);
    for (size_t k = 0; k + 1 < r.first.size(); ++k) {
        if (k > 0 && k == r.morphTo) {
            std::copy_n(b.value, batch, b.before);
            std::fill_n(b.value, batch, farAway);
        }
        for (size_t i = r.first[k]; i < r.first[k + 1]; ++i) {
            const Primitive& p = r.primitives[i];
            const bool cut = i != r.first[k];
            switch (p.kind) {
                case Primitive::Kind::Box:
                    join<box>(b, p, cut);
                    break;
                case Primitive::Kind::Ball:
                    join<ball>(b, p, cut);
                    break;
                case Primitive::Kind::Morph:
                    join<morph>(b, p, cut);
                    break;
                case Primitive::Kind::Roof:
                    join<roof>(b, p, cut);
                    break;
            }
        }
        for (size_t i = 0; i < batch; ++i) b.value[i] = std::min(b.value[i], b.part[i]);
    }
    if (r.morphTo > 0)
        for (size_t i = 0; i < batch; ++i) b.value[i] = b.before[i] + r.amount * (b.value[i] - b.before[i]);
}

using BatchLoop = void (*)(const Reference&, Batch&);
void batchPortable(const Reference& r, Batch& b) { evaluateBatch(r, b); }
#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void batchAvx2(const Reference& r, Batch& b) { evaluateBatch(r, b); }
__attribute__((target("avx512f,avx512cd,avx512dq,avx512bw,avx512vl,fma"))) void batchAvx512(const Reference& r,
                                                                                            Batch& b) {
    evaluateBatch(r, b);
}
#endif

BatchLoop batchLoop() {
#if defined(__x86_64__)
    if (eval::bestIsa() == eval::Isa::Avx512) return batchAvx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return batchAvx2;
#endif
    return batchPortable;
}

}  // namespace

void evaluate(const Reference& reference, eval::Points points, float* out) {
    const BatchLoop loop = batchLoop();
    Batch b;
    for (size_t first = 0; first < points.n; first += batch) {
        const size_t n = std::min(batch, points.n - first);
        for (size_t i = 0; i < batch; ++i) {
            const size_t from = first + std::min(i, n - 1);
            b.x[i] = points.x[from], b.y[i] = points.y[from], b.z[i] = points.z[from];
        }
        loop(reference, b);
        std::copy_n(b.value, n, out + first);
    }
}

}  // namespace sgm::bench
