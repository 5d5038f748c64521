// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// use an inline function that doesn't depend on Arch: the linker might keep the copy this machine can't run.
#include "modeler/mesh/edge_loops.h"

#include "modeler/eval/values_simd.h"

namespace sgm::mesh {
namespace {

#if defined(__AVX512BW__)
using Arch = xsimd::avx512bw;
#elif defined(__AVX2__)
using Arch = xsimd::avx2;
#else
using Arch = xsimd::default_arch;
#endif
using Float = eval::Lanes<Arch>;
using Mask = Float::Mask;
static_assert(edgeVector % Float::size == 0);

/// Newton's step and the secant agree when they differ by less than this share of the edge: the margin that vertices
/// are moved by anyway. On a smooth field the vertex is then far closer to the root, for Newton's error goes with the
/// square of the step.
constexpr float agreement = edgeMargin;
/// A longer step may have crossed a crease, beyond which the normal is another.
constexpr float longStep = 0x1.0p-4f;

/// As wholeVectors: the compiler sees that no entries are left over.
inline size_t whole(size_t n) { return (n + edgeVector - 1) / edgeVector * edgeVector; }

/// Sends a NaN (from infinite values) to the margin.
inline Float withinEdge(Float t) {
    const Float least = edgeMargin, most = 1.0f - edgeMargin;
    const Float low = select(t > least, t, least);
    return select(low < most, low, most);
}

/// 0, 1, 2, …: numbers of entries, which floats hold exactly.
inline Float ascending() {
    alignas(64) float numbers[Float::size];
    for (size_t i = 0; i < Float::size; ++i) numbers[i] = static_cast<float>(i);
    return Float::load(numbers);
}

inline size_t sum(Float v) {
    alignas(64) float lanes[Float::size];
    v.store(lanes);
    float total = 0;
    for (const float lane : lanes) total += lane;
    return static_cast<size_t>(total);
}

/// Which of the entries from `first` on lie along x and along z.
struct Axes {
    Mask x, z;
    Axes(const EdgeArrays& e, Float number)
        : x(number < Float(static_cast<float>(e.yBegin))), z(number >= Float(static_cast<float>(e.zBegin))) {}
};

/// Moves entries from i on to `at`, along their edges.
inline void moveTo(const EdgeArrays& e, size_t i, Axes along, Float at) {
    select(along.x, at, Float::load(e.x + i)).store(e.x + i);
    select(along.x | along.z, Float::load(e.y + i), at).store(e.y + i);
    select(along.z, at, Float::load(e.z + i)).store(e.z + i);
}

#if defined(__AVX512F__)

/// Coordinates by permutation: all of a brick's fit into a vector.
void place(const EdgeEnds& ends, const uint32_t* codes, size_t n, const EdgeArrays& e, uint32_t* places) {
    const __m512 xs = _mm512_loadu_ps(ends.coordinates[0]), ys = _mm512_loadu_ps(ends.coordinates[1]),
                 zs = _mm512_loadu_ps(ends.coordinates[2]);
    const auto number = [](size_t v) { return _mm512_set1_epi32(static_cast<int>(v)); };
    const __m512i row = number(ends.strides[1]), layer = number(ends.strides[2]), byte = number(255), one = number(1);
    const __m512i yBegin = number(e.yBegin), zBegin = number(e.zBegin);
    __m512i entry = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (size_t at = 0; at < n; at += edgeVector, entry = _mm512_add_epi32(entry, number(edgeVector))) {
        const __mmask16 notX = _mm512_cmpge_epi32_mask(entry, yBegin), alongZ = _mm512_cmpge_epi32_mask(entry, zBegin);
        const auto ofAxis = [&](auto blend, auto x, auto y, auto z) { return blend(alongZ, blend(notX, x, y), z); };
        const auto floats = [](__mmask16 m, __m512 a, __m512 b) { return _mm512_mask_blend_ps(m, a, b); };
        const auto ints = [](__mmask16 m, __m512i a, __m512i b) { return _mm512_mask_blend_epi32(m, a, b); };
        const __m512i code = _mm512_loadu_si512(codes + at);
        const __m512i i = _mm512_and_si512(code, byte), j = _mm512_and_si512(_mm512_srli_epi32(code, 8), byte),
                      k = _mm512_srli_epi32(code, 16);
        const __m512 x = _mm512_permutexvar_ps(i, xs), y = _mm512_permutexvar_ps(j, ys),
                     z = _mm512_permutexvar_ps(k, zs);
        const __m512 low = ofAxis(floats, x, y, z);
        const __m512 high = ofAxis(floats, _mm512_permutexvar_ps(_mm512_add_epi32(i, one), xs),
                                   _mm512_permutexvar_ps(_mm512_add_epi32(j, one), ys),
                                   _mm512_permutexvar_ps(_mm512_add_epi32(k, one), zs));
        const __m512i corner =
            _mm512_add_epi32(i, _mm512_add_epi32(_mm512_mullo_epi32(j, row), _mm512_mullo_epi32(k, layer)));
        const __m512i other = _mm512_add_epi32(corner, ofAxis(ints, one, row, layer));
        const __m512i axis = ofAxis(ints, number(0), one, number(2));
        _mm512_store_ps(e.x + at, x);
        _mm512_store_ps(e.y + at, y);
        _mm512_store_ps(e.z + at, z);
        _mm512_store_ps(e.base + at, low);
        _mm512_store_ps(e.span + at, _mm512_sub_ps(high, low));
        _mm512_store_ps(e.fIn + at, _mm512_i32gather_ps(corner, ends.values, 4));
        _mm512_store_ps(e.fOut + at, _mm512_i32gather_ps(other, ends.values, 4));
        _mm512_storeu_si512(places + at, _mm512_add_epi32(_mm512_mullo_epi32(corner, number(3)), axis));
    }
}

#else

void place(const EdgeEnds& ends, const uint32_t* codes, size_t n, const EdgeArrays& e, uint32_t* places) {
    for (size_t at = 0; at < n; ++at) {
        const uint32_t axis = at < e.yBegin ? 0 : at < e.zBegin ? 1 : 2;
        const uint32_t i = codes[at] & 255, j = codes[at] >> 8 & 255, k = codes[at] >> 16;
        const uint32_t corner = i + j * ends.strides[1] + k * ends.strides[2];
        const float* const along = ends.coordinates[axis] + (axis == 0 ? i : axis == 1 ? j : k);
        e.x[at] = ends.coordinates[0][i];
        e.y[at] = ends.coordinates[1][j];
        e.z[at] = ends.coordinates[2][k];
        e.base[at] = along[0];
        e.span[at] = along[1] - along[0];
        e.fIn[at] = ends.values[corner];
        e.fOut[at] = ends.values[corner + ends.strides[axis]];
        places[at] = 3 * corner + axis;
    }
    for (size_t at = n; at < whole(n); ++at)  // numbers like the others
        for (float* const to : {e.x, e.y, e.z, e.base, e.span, e.fIn, e.fOut}) to[at] = to[n - 1];
}

#endif

void interpolate(const EdgeArrays& e, size_t n) {
    Float number = ascending();
    for (size_t i = 0; i < n; i += Float::size, number = number + Float(static_cast<float>(Float::size))) {
        const Float low = Float::load(e.fIn + i), high = Float::load(e.fOut + i);
        const Mask inside = low < Float(0.0f);
        const Float t0 = select(inside, Float(0.0f), Float(1.0f)), t1 = Float(1.0f) - t0;
        const Float f0 = select(inside, low, high), f1 = select(inside, high, low);
        const Float t = withinEdge(t0 + (t1 - t0) * (f0 / (f0 - f1)));
        t0.store(e.tIn + i), f0.store(e.fIn + i);
        t1.store(e.tOut + i), f1.store(e.fOut + i);
        t.store(e.t + i);
        moveTo(e, i, Axes(e, number), Float::load(e.base + i) + t * Float::load(e.span + i));
    }
}

size_t step(const EdgeArrays& e, size_t n) {
    Float open = 0.0f, number = ascending();
    const Float end = static_cast<float>(n);
    for (size_t i = 0; i < n; i += Float::size, number = number + Float(static_cast<float>(Float::size))) {
        const Axes along(e, number);
        const Float t = Float::load(e.t + i), f = Float::load(e.f + i), span = Float::load(e.span + i);
        const Float slope =
            select(along.x, Float::load(e.dx + i), select(along.z, Float::load(e.dz + i), Float::load(e.dy + i)));
        const Mask inside = f < Float(0.0f);
        const Float t0 = select(inside, t, Float::load(e.tIn + i)), f0 = select(inside, f, Float::load(e.fIn + i));
        const Float t1 = select(inside, Float::load(e.tOut + i), t), f1 = select(inside, Float::load(e.fOut + i), f);
        const Float secant = t0 + (t1 - t0) * (f0 / (f0 - f1));
        const Float newton = t - f / (slope * span);
        const Float low = min(t0, t1), high = max(t0, t1);
        const Mask kept = (newton >= low) & (newton <= high);
        const Float apart = abs(newton - secant), way = abs(newton - t);
        const Mask done = (kept & (apart <= Float(agreement)) & (way <= Float(longStep))) |
                          (high - low <= Float(agreement)) | (number >= end);
        t0.store(e.tIn + i), f0.store(e.fIn + i);
        t1.store(e.tOut + i), f1.store(e.fOut + i);
        const Float moved = withinEdge(select(kept, newton, Float(0.5f) * (t0 + t1)));
        moved.store(e.t + i);
        moveTo(e, i, along, Float::load(e.base + i) + moved * span);
        const Float again = select(done, Float(0.0f), Float(1.0f));
        again.store(e.open + i);
        open = open + again;
    }
    return sum(open);
}

size_t normalize(const EdgeArrays& e, size_t n) {
    Float without = 0.0f, number = ascending();
    const Float end = static_cast<float>(n);
    for (size_t i = 0; i < n; i += Float::size, number = number + Float(static_cast<float>(Float::size))) {
        const Float x = Float::load(e.dx + i), y = Float::load(e.dy + i), z = Float::load(e.dz + i);
        const Float squared = x * x + y * y + z * z, zero = 0.0f, one = 1.0f;
        const Mask usable = (squared > Float(1e-30f)) & (squared < Float(1e30f));
        const Float scale = one / sqrt(select(usable, squared, one));
        select(usable, x * scale, zero).store(e.dx + i);
        select(usable, y * scale, zero).store(e.dy + i);
        select(usable, z * scale, zero).store(e.dz + i);
        without = without + select(usable | (number >= end), zero, one);
    }
    return sum(without);
}

/// Without a branch: which entries are open follows no pattern.
size_t listOpen(const float* __restrict open, size_t n, uint32_t* __restrict list) {
    size_t listed = 0;
#if defined(__AVX512F__)
    __m512i at = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (size_t i = 0; i < n; i += edgeVector, at = _mm512_add_epi32(at, _mm512_set1_epi32(edgeVector))) {
        // `step` left nothing open beyond the last entry.
        const __mmask16 mask = _mm512_cmp_ps_mask(_mm512_loadu_ps(open + i), _mm512_setzero_ps(), _CMP_NEQ_OQ);
        _mm512_storeu_si512(list + listed, _mm512_maskz_compress_epi32(mask, at));
        listed += static_cast<size_t>(__builtin_popcount(mask));
    }
#else
    for (size_t i = 0; i < n; ++i) {
        list[listed] = static_cast<uint32_t>(i);
        listed += open[i] != 0.0f;
    }
#endif
    for (size_t i = listed; i < whole(listed); ++i) list[i] = 0;
    return listed;
}

void pickArray(const float* __restrict from, const uint32_t* __restrict list, size_t n, float* __restrict to) {
    for (size_t i = 0; i < n; ++i) to[i] = from[static_cast<int32_t>(list[i])];
}

void pick(const EdgeArrays& from, const uint32_t* list, size_t n, const EdgeArrays& to) {
    constexpr size_t few = edgeVector / 2;  // to be gathered one by one
    const size_t count = n <= few ? n : whole(n);
    pickArray(from.x, list, count, to.x);
    pickArray(from.y, list, count, to.y);
    pickArray(from.z, list, count, to.z);
    pickArray(from.base, list, count, to.base);
    pickArray(from.span, list, count, to.span);
    pickArray(from.t, list, count, to.t);
    pickArray(from.tIn, list, count, to.tIn);
    pickArray(from.fIn, list, count, to.fIn);
    pickArray(from.tOut, list, count, to.tOut);
    pickArray(from.fOut, list, count, to.fOut);
}

void putBackArray(const float* __restrict from, const uint32_t* __restrict list, size_t n, float* __restrict to) {
    for (size_t i = 0; i < n; ++i) to[list[i]] = from[i];
}

void putBack(const EdgeArrays& from, const uint32_t* list, size_t n, const EdgeArrays& to) {
    putBackArray(from.x, list, n, to.x);
    putBackArray(from.y, list, n, to.y);
    putBackArray(from.z, list, n, to.z);
    putBackArray(from.dx, list, n, to.dx);
    putBackArray(from.dy, list, n, to.dy);
    putBackArray(from.dz, list, n, to.dz);
}

void interleave(const float* __restrict x, const float* __restrict y, const float* __restrict z, size_t n,
                float* __restrict points) {
    for (size_t i = 0; i < n; ++i) {
        points[3 * i] = x[i];
        points[3 * i + 1] = y[i];
        points[3 * i + 2] = z[i];
    }
}

}  // namespace

namespace SGM_ISA {
const EdgeLoops loops{place, interpolate, step, normalize, listOpen, pick, putBack, interleave};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
