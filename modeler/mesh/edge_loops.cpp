// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// use an inline function from a header: the linker might keep the copy this machine can't run.
#include "modeler/mesh/edge_loops.h"

namespace sgm::mesh {
namespace {

/// Newton's step and the secant agree when they differ by less than this share of the edge: the margin that vertices
/// are moved by anyway. On a smooth field the vertex is then far closer to the root, for Newton's error goes with the
/// square of the step.
constexpr float agreement = edgeMargin;
/// A longer step may have crossed a crease, beyond which the normal is another.
constexpr float longStep = 0x1.0p-4f;

inline float magnitude(float a) { return a < 0 ? -a : a; }

/// Sends a NaN (from infinite values) to the margin.
inline float withinEdge(float t) {
    const float low = t > edgeMargin ? t : edgeMargin;
    return low < 1.0f - edgeMargin ? low : 1.0f - edgeMargin;
}

// Compilers take a promise that arrays don't overlap from parameters only.
void interpolate(size_t n, const float* __restrict base, const float* __restrict span, float* __restrict tIn,
                 float* __restrict fIn, float* __restrict tOut, float* __restrict fOut, float* __restrict ts,
                 float* __restrict place) {
    for (size_t i = 0; i < n; ++i) {
        const float low = fIn[i], high = fOut[i];
        const bool inside = low < 0;
        const float t0 = inside ? 0.0f : 1.0f, f0 = inside ? low : high, f1 = inside ? high : low;
        const float t1 = 1.0f - t0, t = withinEdge(t0 + (t1 - t0) * (f0 / (f0 - f1)));
        tIn[i] = t0, fIn[i] = f0;
        tOut[i] = t1, fOut[i] = f1;
        ts[i] = t;
        place[i] = base[i] + t * span[i];
    }
}

size_t step(size_t n, const float* __restrict base, const float* __restrict span, const float* __restrict slope,
            float* __restrict tIn, float* __restrict fIn, float* __restrict tOut, float* __restrict fOut,
            float* __restrict ts, float* __restrict fs, float* __restrict place) {
    int open = 0;
    for (size_t i = 0; i < n; ++i) {
        const float t = ts[i], f = fs[i];
        const bool inside = f < 0;
        const float t0 = inside ? t : tIn[i], f0 = inside ? f : fIn[i];
        const float t1 = inside ? tOut[i] : t, f1 = inside ? fOut[i] : f;
        const float secant = t0 + (t1 - t0) * (f0 / (f0 - f1));
        const float newton = t - f / (slope[i] * span[i]);
        const float low = t0 < t1 ? t0 : t1, high = t0 < t1 ? t1 : t0;
        const bool kept = (newton >= low) & (newton <= high);
        const float apart = magnitude(newton - secant), way = magnitude(newton - t);
        const bool done = (kept & (apart <= agreement) & (way <= longStep)) | (high - low <= agreement);
        tIn[i] = t0, fIn[i] = f0;
        tOut[i] = t1, fOut[i] = f1;
        const float moved = withinEdge(kept ? newton : 0.5f * (t0 + t1));
        ts[i] = moved;
        place[i] = base[i] + moved * span[i];
        fs[i] = done ? 0.0f : 1.0f;
        open += done ? 0 : 1;
    }
    return static_cast<size_t>(open);
}

size_t normalize(float* __restrict x, float* __restrict y, float* __restrict z, size_t n) {
    int without = 0;
    for (size_t i = 0; i < n; ++i) {
        const float squared = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        const bool usable = (squared > 1e-30f) & (squared < 1e30f);
        const float length = __builtin_sqrtf(usable ? squared : 1.0f), scale = usable ? 1.0f / length : 0.0f;
        x[i] = usable ? x[i] * scale : 0.0f;
        y[i] = usable ? y[i] * scale : 0.0f;
        z[i] = usable ? z[i] * scale : 0.0f;
        without += usable ? 0 : 1;
    }
    return static_cast<size_t>(without);
}

/// Without a branch: which entries are open follows no pattern.
size_t listOpen(const float* __restrict f, size_t begin, size_t end, uint32_t* __restrict list) {
    size_t n = 0;
    for (size_t i = begin; i < end; ++i) {
        list[n] = static_cast<uint32_t>(i);
        n += f[i] != 0.0f;
    }
    return n;
}

void pick(const float* __restrict from, const uint32_t* __restrict list, size_t n, float* __restrict to) {
    for (size_t i = 0; i < n; ++i) to[i] = from[list[i]];
}

void putBack(const float* __restrict from, const uint32_t* __restrict list, size_t n, float* __restrict to) {
    for (size_t i = 0; i < n; ++i) to[list[i]] = from[i];
}

void interpolateAll(const EdgeArrays& e, size_t n) {
    interpolate(n, e.base, e.span, e.tIn, e.fIn, e.tOut, e.fOut, e.t, e.place);
}
size_t stepAll(const EdgeArrays& e, size_t n) {
    return step(n, e.base, e.span, e.slope, e.tIn, e.fIn, e.tOut, e.fOut, e.t, e.f, e.place);
}

}  // namespace

namespace SGM_ISA {
const EdgeLoops loops{interpolateAll, stepAll, normalize, listOpen, pick, putBack};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
