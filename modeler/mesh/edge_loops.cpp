// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// use an inline function that doesn't depend on Arch: the linker might keep the copy this machine can't run.
#include "modeler/mesh/edge_loops.h"

#include "modeler/eval/source_arch.h"
#include "modeler/eval/values_simd.h"

namespace sgm::mesh {
namespace {

using Arch = eval::SourceArch;
using Float = eval::Lanes<Arch>;
using Mask = Float::Mask;
static_assert(edgeVector % Float::size == 0);

/// Newton's step and the secant agree when they differ by less than this share of the edge: the margin that vertices
/// are moved by anyway. On a smooth field the vertex is then far closer to the root, for Newton's error goes with the
/// square of the step.
constexpr float agreement = edgeMargin;
/// Where they differ more, but by no more than this, the vertex is done if a parabola fits the bracket.
constexpr float mostBent = 16 * agreement;
/// A longer step may have crossed a crease, beyond which the normal is another.
constexpr float longStep = 0x1.0p-4f;

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

/// Which of the entries from i on lie along x and along z.
struct Axes {
    Mask x, z;
    Axes(const EdgeArrays& e, size_t i)
        : x(Float::load(e.axis + i) < Float(1.0f)), z(Float::load(e.axis + i) > Float(1.0f)) {}
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
    const __m512i numberRow = number(ends.numbers[1]), numberLayer = number(ends.numbers[2]);
    for (size_t at = 0; at < n; at += edgeVector) {
        const __m512i code = _mm512_loadu_si512(codes + at), axis = _mm512_srli_epi32(code, 24);
        const __mmask16 notX = _mm512_cmpgt_epi32_mask(axis, _mm512_setzero_si512()),
                        alongZ = _mm512_cmpgt_epi32_mask(axis, one);
        const auto ofAxis = [&](auto blend, auto x, auto y, auto z) { return blend(alongZ, blend(notX, x, y), z); };
        const auto floats = [](__mmask16 m, __m512 a, __m512 b) { return _mm512_mask_blend_ps(m, a, b); };
        const auto ints = [](__mmask16 m, __m512i a, __m512i b) { return _mm512_mask_blend_epi32(m, a, b); };
        const __m512i i = _mm512_and_si512(code, byte), j = _mm512_and_si512(_mm512_srli_epi32(code, 8), byte),
                      k = _mm512_and_si512(_mm512_srli_epi32(code, 16), byte);
        const __m512 x = _mm512_permutexvar_ps(i, xs), y = _mm512_permutexvar_ps(j, ys),
                     z = _mm512_permutexvar_ps(k, zs);
        const __m512 low = ofAxis(floats, x, y, z);
        const __m512 high = ofAxis(floats, _mm512_permutexvar_ps(_mm512_add_epi32(i, one), xs),
                                   _mm512_permutexvar_ps(_mm512_add_epi32(j, one), ys),
                                   _mm512_permutexvar_ps(_mm512_add_epi32(k, one), zs));
        const auto counted = [&](__m512i byJ, __m512i byK) {
            return _mm512_add_epi32(i, _mm512_add_epi32(_mm512_mullo_epi32(j, byJ), _mm512_mullo_epi32(k, byK)));
        };
        const __m512i corner = counted(row, layer);
        const __m512i other = _mm512_add_epi32(corner, ofAxis(ints, one, row, layer));
        _mm512_storeu_ps(e.x + at, x);
        _mm512_storeu_ps(e.y + at, y);
        _mm512_storeu_ps(e.z + at, z);
        _mm512_storeu_ps(e.axis + at, _mm512_cvtepi32_ps(axis));
        _mm512_storeu_ps(e.base + at, low);
        _mm512_storeu_ps(e.span + at, _mm512_sub_ps(high, low));
        _mm512_storeu_ps(e.fIn + at, _mm512_i32gather_ps(corner, ends.values, 4));
        _mm512_storeu_ps(e.fOut + at, _mm512_i32gather_ps(other, ends.values, 4));
        _mm512_storeu_si512(places + at,
                            _mm512_add_epi32(_mm512_mullo_epi32(counted(numberRow, numberLayer), number(3)), axis));
    }
}

#else

void place(const EdgeEnds& ends, const uint32_t* codes, size_t n, const EdgeArrays& e, uint32_t* places) {
    for (size_t at = 0; at < n; ++at) {
        const uint32_t i = codes[at] & 255, j = codes[at] >> 8 & 255, k = codes[at] >> 16 & 255, axis = codes[at] >> 24;
        const uint32_t corner = i + j * ends.strides[1] + k * ends.strides[2];
        const float* const along = ends.coordinates[axis] + (axis == 0 ? i : axis == 1 ? j : k);
        e.x[at] = ends.coordinates[0][i];
        e.y[at] = ends.coordinates[1][j];
        e.z[at] = ends.coordinates[2][k];
        e.axis[at] = static_cast<float>(axis);
        e.base[at] = along[0];
        e.span[at] = along[1] - along[0];
        e.fIn[at] = ends.values[corner];
        e.fOut[at] = ends.values[corner + ends.strides[axis]];
        places[at] = 3 * (i + j * ends.numbers[1] + k * ends.numbers[2]) + axis;
    }
    const size_t whole = (n + edgeVector - 1) / edgeVector * edgeVector;  // not by wholeVectors, an inline function
    for (size_t at = n; at < whole; ++at)                                 // numbers like the others
        for (float* const to : {e.x, e.y, e.z, e.axis, e.base, e.span, e.fIn, e.fOut}) to[at] = to[n - 1];
}

#endif

void interpolate(const EdgeArrays& e, size_t n) {
    for (size_t i = 0; i < n; i += Float::size) {
        const Float low = Float::load(e.fIn + i), high = Float::load(e.fOut + i);
        const Mask inside = low < Float(0.0f);
        const Float t0 = select(inside, Float(0.0f), Float(1.0f)), t1 = Float(1.0f) - t0;
        const Float f0 = select(inside, low, high), f1 = select(inside, high, low);
        const Float t = withinEdge(t0 + (t1 - t0) * (f0 / (f0 - f1)));
        t0.store(e.tIn + i), f0.store(e.fIn + i);
        t1.store(e.tOut + i), f1.store(e.fOut + i);
        t.store(e.t + i);
        moveTo(e, i, Axes(e, i), Float::load(e.base + i) + t * Float::load(e.span + i));
    }
}

/// The parabola through where the field was last evaluated, with its slope there, and through one end of the bracket.
/// The other end tells how well it fits.
class Parabola {
public:
    Parabola(Float t, Float f, Float slope, Float tIn, Float fIn, Float tOut, Float fOut) : t_(t), slope_(slope) {
        const Mask inside = f < Float(0.0f);
        const Float across = select(inside, tOut, tIn) - t, fAcross = select(inside, fOut, fIn);
        const Float behind = select(inside, tIn, tOut) - t, fBehind = select(inside, fIn, fOut);
        // How far the tangent misses each end; over the distance's square that is how much the field bends.
        missedAcross_ = fAcross - f - slope * across, missedBehind_ = fBehind - f - slope * behind;
        across_ = across * across, behind_ = behind * behind;
    }
    /// True where the two ends' bends differ by so little that it doesn't show as far as `way`. Over a crease they do.
    Mask fits(Float way) const {
        return abs(missedAcross_ * behind_ - missedBehind_ * across_) * way <=
               Float(agreement) * abs(slope_) * (across_ * behind_);
    }
    /// Near Newton's step.
    Float root(Float newton) const {
        const Float way = newton - t_;
        return newton - way * way * missedAcross_ / (slope_ * across_);
    }

private:
    Float t_, slope_, missedAcross_, missedBehind_, across_, behind_;
};

/// The line between the bracket's ends; where one end was moved twice and the other never, the value there counts half
/// (the Illinois method of Dowell & Jarratt 1971), if `weaken` says so.
void narrow(const EdgeArrays& e, size_t n, bool weaken) {
    const Float one = 1.0f, share = weaken ? 0.5f : 1.0f;
    for (size_t i = 0; i < n; i += Float::size) {
        const Float t = Float::load(e.t + i), f = Float::load(e.f + i);
        const Mask inside = f < Float(0.0f);
        const Float t0 = select(inside, t, Float::load(e.tIn + i)), f0 = select(inside, f, Float::load(e.fIn + i));
        const Float t1 = select(inside, Float::load(e.tOut + i), t), f1 = select(inside, Float::load(e.fOut + i), f);
        const Float other = select(inside, t1, t0);
        const Float weight = select((other <= Float(0.0f)) | (other >= one), share, one);
        const Float g0 = select(inside, f0, f0 * weight), g1 = select(inside, f1 * weight, f1);
        const Float moved = withinEdge(t0 + (t1 - t0) * (g0 / (g0 - g1)));
        t0.store(e.tIn + i), f0.store(e.fIn + i);
        t1.store(e.tOut + i), f1.store(e.fOut + i);
        moved.store(e.t + i);
        moveTo(e, i, Axes(e, i), Float::load(e.base + i) + moved * Float::load(e.span + i));
    }
}

/// Newton's step; where it is not to be trusted, the middle of the bracket, or nowhere if it is the last one.
template <bool last>
size_t stepOrStay(const EdgeArrays& e, size_t n) {
    Float open = 0.0f, number = ascending();
    const Float end = static_cast<float>(n);
    for (size_t i = 0; i < n; i += Float::size, number = number + Float(static_cast<float>(Float::size))) {
        const Axes along(e, i);
        const Float t = Float::load(e.t + i), f = Float::load(e.f + i), span = Float::load(e.span + i);
        const Float slope =
            select(along.x, Float::load(e.dx + i), select(along.z, Float::load(e.dz + i), Float::load(e.dy + i)));
        const Mask inside = f < Float(0.0f);
        const Float tIn = Float::load(e.tIn + i), fIn = Float::load(e.fIn + i), tOut = Float::load(e.tOut + i),
                    fOut = Float::load(e.fOut + i);
        const Float t0 = select(inside, t, tIn), f0 = select(inside, f, fIn);
        const Float t1 = select(inside, tOut, t), f1 = select(inside, fOut, f);
        const Float secant = t0 + (t1 - t0) * (f0 / (f0 - f1));
        const Float rise = slope * span, newton = t - f / rise;
        const Float low = min(t0, t1), high = max(t0, t1);
        const Mask kept = (newton >= low) & (newton <= high);
        const Float apart = abs(newton - secant), way = abs(newton - t);
        const Mask agreed = apart <= Float(agreement), bends = !agreed & (apart <= Float(mostBent));
        Float root = newton;
        Mask fits = agreed;
        if (any(bends)) {  // a field of planes and creases never does
            const Parabola bent(t, f, rise, tIn, fIn, tOut, fOut);
            const Mask smooth = bends & bent.fits(way);
            root = select(smooth, bent.root(newton), root);
            fits = fits | smooth;
        }
        const Mask trusted = kept & fits & (way <= Float(longStep));
        const Mask done = trusted | (high - low <= Float(agreement)) | (number >= end);
        t0.store(e.tIn + i), f0.store(e.fIn + i);
        t1.store(e.tOut + i), f1.store(e.fOut + i);
        const Float moved =
            last ? select(trusted, withinEdge(root), t) : withinEdge(select(kept, root, Float(0.5f) * (t0 + t1)));
        moved.store(e.t + i);
        moveTo(e, i, along, Float::load(e.base + i) + moved * span);
        const Float again = select(done, Float(0.0f), Float(1.0f));
        again.store(e.open + i);
        open = open + again;
    }
    return sum(open);
}
size_t step(const EdgeArrays& e, size_t n) { return stepOrStay<false>(e, n); }
void settle(const EdgeArrays& e, size_t n) { stepOrStay<true>(e, n); }

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

constexpr float* EdgeArrays::*pickedRows[] = {&EdgeArrays::x,    &EdgeArrays::y,    &EdgeArrays::z,   &EdgeArrays::base,
                                              &EdgeArrays::span, &EdgeArrays::t,    &EdgeArrays::tIn, &EdgeArrays::fIn,
                                              &EdgeArrays::tOut, &EdgeArrays::fOut, &EdgeArrays::axis};
constexpr float* EdgeArrays::*foundRows[] = {&EdgeArrays::x,  &EdgeArrays::y,  &EdgeArrays::z,
                                             &EdgeArrays::dx, &EdgeArrays::dy, &EdgeArrays::dz};

// Which entries are open follows no pattern: hence no branches. `step` left nothing open beyond the last entry.
#if defined(__AVX512F__)

inline __mmask16 openOnes(const EdgeArrays& e, size_t at) {
    return _mm512_cmp_ps_mask(_mm512_load_ps(e.open + at), _mm512_setzero_ps(), _CMP_NEQ_OQ);
}
inline size_t countOf(unsigned mask) { return static_cast<size_t>(__builtin_popcount(mask)); }
size_t pick(const EdgeArrays& from, size_t n, const EdgeArrays& to) {
    size_t picked = 0;
    for (size_t at = 0; at < n; at += edgeVector) {
        const __mmask16 open = openOnes(from, at);
        for (const auto row : pickedRows)
            _mm512_storeu_ps(to.*row + picked, _mm512_maskz_compress_ps(open, _mm512_load_ps(from.*row + at)));
        picked += countOf(open);
    }
    return picked;
}

void putBack(const EdgeArrays& from, size_t n, const EdgeArrays& to) {
    size_t taken = 0;
    for (size_t at = 0; at < n; at += edgeVector) {
        const __mmask16 open = openOnes(to, at);
        for (const auto row : foundRows)
            _mm512_store_ps(to.*row + at, _mm512_mask_expand_ps(_mm512_load_ps(to.*row + at), open,
                                                                _mm512_loadu_ps(from.*row + taken)));
        taken += countOf(open);
    }
}

#else

size_t pick(const EdgeArrays& from, size_t n, const EdgeArrays& to) {
    size_t picked = 0;
    for (const auto row : pickedRows) {
        picked = 0;
        for (size_t i = 0; i < n; ++i) {
            (to.*row)[picked] = (from.*row)[i];
            picked += from.open[i] != 0.0f;
        }
        for (size_t i = picked; picked > 0 && i % edgeVector != 0; ++i) (to.*row)[i] = (to.*row)[picked - 1];
    }
    return picked;
}

void putBack(const EdgeArrays& from, size_t n, const EdgeArrays& to) {
    for (const auto row : foundRows) {
        size_t taken = 0;
        for (size_t i = 0; i < n; ++i) {
            (to.*row)[i] = to.open[i] != 0.0f ? (from.*row)[taken] : (to.*row)[i];
            taken += to.open[i] != 0.0f;
        }
    }
}

#endif

void interleave(const float* __restrict x, const float* __restrict y, const float* __restrict z, size_t n,
                float* __restrict points) {
#if defined(__AVX512F__)
    // Three vectors of 16 points: lanes of x and y by one permutation, those of z put between them.
    constexpr int y0 = 16, gap = 0;
    const __m512i fromXy[] = {
        _mm512_setr_epi32(0, y0, gap, 1, y0 + 1, gap, 2, y0 + 2, gap, 3, y0 + 3, gap, 4, y0 + 4, gap, 5),
        _mm512_setr_epi32(y0 + 5, gap, 6, y0 + 6, gap, 7, y0 + 7, gap, 8, y0 + 8, gap, 9, y0 + 9, gap, 10, y0 + 10),
        _mm512_setr_epi32(gap, 11, y0 + 11, gap, 12, y0 + 12, gap, 13, y0 + 13, gap, 14, y0 + 14, gap, 15, y0 + 15,
                          gap)};
    const __m512i fromZ[] = {_mm512_setr_epi32(0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0),
                             _mm512_setr_epi32(0, 5, 0, 0, 6, 0, 0, 7, 0, 0, 8, 0, 0, 9, 0, 0),
                             _mm512_setr_epi32(10, 0, 0, 11, 0, 0, 12, 0, 0, 13, 0, 0, 14, 0, 0, 15)};
    constexpr __mmask16 isZ[] = {0x4924, 0x2492, 0x9249};
    for (size_t i = 0; i < n; i += edgeVector) {
        const size_t count = 3 * (n - i);
        const uint64_t some = count < 3 * edgeVector ? (uint64_t{1} << count) - 1 : ~uint64_t{0};
        const __m512 xs = _mm512_loadu_ps(x + i), ys = _mm512_loadu_ps(y + i), zs = _mm512_loadu_ps(z + i);
        for (size_t v = 0; v < 3; ++v) {
            const __m512 xy = _mm512_permutex2var_ps(xs, fromXy[v], ys);
            _mm512_mask_storeu_ps(points + 3 * i + v * edgeVector, static_cast<__mmask16>(some >> v * edgeVector),
                                  _mm512_mask_permutexvar_ps(xy, isZ[v], fromZ[v], zs));
        }
    }
#else
    for (size_t i = 0; i < n; ++i) {
        points[3 * i] = x[i];
        points[3 * i + 1] = y[i];
        points[3 * i + 2] = z[i];
    }
#endif
}

}  // namespace

namespace SGM_ISA {
const EdgeLoops loops{place, interpolate, narrow, step, settle, normalize, pick, putBack, interleave};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
