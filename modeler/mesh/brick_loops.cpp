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

void gatherRow(CornerRow row, const float* __restrict xs, float y0, float z0, float* __restrict x, float* __restrict y,
               float* __restrict z) {
    for (int i = 0; i < copied; ++i) x[i] = xs[row.i + i];
    for (int i = 0; i < copied; ++i) y[i] = y0;
    for (int i = 0; i < copied; ++i) z[i] = z0;
}

void gather(const CornerRow* rows, size_t n, const float* __restrict xs, const float* __restrict ys,
            const float* __restrict zs, float* __restrict x, float* __restrict y, float* __restrict z) {
    for (size_t r = 0; r < n; ++r) {
#if defined(__AVX512F__)
        // Most rows lack the first corner, which a lower brick has: two of them make a vector.
        const auto rest = [&](size_t row) { return rows[row].i == 1 && rows[row].count == corners - 1; };
        if (r + 1 < n && rest(r) && rest(r + 1)) {
            const auto both = [](const float* from, int a, int b) {
                return _mm512_mask_blend_ps(0xff00, _mm512_set1_ps(from[a]), _mm512_set1_ps(from[b]));
            };
            const __m512 eight = _mm512_castps256_ps512(_mm256_loadu_ps(xs + 1));
            _mm512_storeu_ps(x, _mm512_shuffle_f32x4(eight, eight, 0x44));
            _mm512_storeu_ps(y, both(ys, rows[r].j, rows[r + 1].j));
            _mm512_storeu_ps(z, both(zs, rows[r].k, rows[r + 1].k));
            x += 16, y += 16, z += 16, ++r;
            continue;
        }
#endif
        gatherRow(rows[r], xs, ys[rows[r].j], zs[rows[r].k], x, y, z);
        x += rows[r].count, y += rows[r].count, z += rows[r].count;
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

uint32_t cut(const uint16_t* __restrict inside, int up, int shift, const uint16_t* __restrict edges,
             uint16_t* __restrict cut) {
    uint32_t groups = 0;
#if defined(__AVX512BW__)
    constexpr int atOnce = 32;
    const __m128i by = _mm_cvtsi32_si128(shift);
    for (int row = 0; row < cutRows; row += atOnce) {
        const __m512i low = _mm512_loadu_si512(inside + row), high = _mm512_loadu_si512(inside + row + up);
        const __m512i ends = _mm512_xor_si512(low, _mm512_srl_epi16(high, by));
        const __m512i some = _mm512_and_si512(ends, _mm512_loadu_si512(edges + row));
        _mm512_storeu_si512(cut + row, some);
        groups |= static_cast<uint32_t>(_mm512_test_epi64_mask(some, some)) << row / 4;
    }
#else
    for (int row = 0; row < cutRows; ++row)
        cut[row] = static_cast<uint16_t>((inside[row] ^ inside[row + up] >> shift) & edges[row]);
    for (int group = 0; group < cutRows / 4; ++group) {
        uint64_t word;
        __builtin_memcpy(&word, cut + 4 * group, sizeof word);
        groups |= static_cast<uint32_t>(word != 0) << group;
    }
#endif
    return groups;
}

/// Eight rows of bytes from row r on.
inline uint64_t eightRows(const uint8_t* bytes, int r) {
    uint64_t word;
    __builtin_memcpy(&word, bytes + r, sizeof word);
    return word;
}

/// Corner c of the cells in layer k: bit i + 8 j of a word.
struct CellCorners {
    uint64_t words[8];
    CellCorners(const uint8_t* low, const uint8_t* high, int k) {
        for (int c = 0; c < 8; ++c) words[c] = eightRows(c & 1 ? high : low, (c >> 1 & 1) + corners * (k + (c >> 2)));
    }
};

/// The code of the lowest own edge along each axis.
constexpr uint32_t firstOwn[] = {0x00010100u, 0x01010001u, 0x02000101u};
/// Rows of bytes from which own edges go up along each axis, beside those where their other ends are.
constexpr int rowsBelow[] = {corners + 1, corners, 1}, rowsAbove = corners + 1;

#if defined(__AVX512BW__)

/// Calls visit(k, j, mask) for bits (0 … 7, j), (0 … 7, j + 1) of each word k that `groups` names, four groups a word:
/// most often there are few, and which follows no pattern.
template <class Visit>
inline void forEachTwoRows(const uint64_t* words, uint32_t groups, Visit&& visit) {
    for (; groups != 0; groups &= groups - 1) {
        const auto at = static_cast<uint32_t>(__builtin_ctz(groups));
        visit(at >> 2, at % 4 * 2, static_cast<__mmask16>(words[at >> 2] >> at % 4 * 16));
    }
}

size_t ownEdges(const uint8_t* low, const uint8_t* high, uint32_t* __restrict codes) {
    const __m512i layers =
        _mm512_setr_epi64(0, corners, 2 * corners, 3 * corners, 4 * corners, 5 * corners, 6 * corners, 7 * corners);
    const __m512i twoRows = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 256, 257, 258, 259, 260, 261, 262, 263);
    const __m512i above = _mm512_i64gather_epi64(layers, high + rowsAbove, 1);
    size_t n = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const __m512i below = _mm512_i64gather_epi64(layers, (axis == 0 ? low : high) + rowsBelow[axis], 1);
        const __m512i cut = _mm512_xor_si512(below, above);
        alignas(64) uint64_t words[8];
        _mm512_store_si512(words, cut);
        forEachTwoRows(words, _mm512_test_epi16_mask(cut, cut), [&](uint32_t k, uint32_t j, __mmask16 mask) {
            const __m512i here = _mm512_set1_epi32(static_cast<int>(firstOwn[axis] + (j << 8 | k << 16)));
            _mm512_storeu_si512(codes + n, _mm512_maskz_compress_epi32(mask, _mm512_add_epi32(twoRows, here)));
            n += static_cast<size_t>(__builtin_popcount(mask));
        });
    }
    _mm512_storeu_si512(codes + n, _mm512_setzero_si512());
    return n;
}

/// Cases of 64 cells at a time, a byte each.
size_t cells(const uint8_t* low, const uint8_t* high, int corner, int rowStride, int layerStride,
             SurfaceCell* __restrict list) {
    alignas(64) uint8_t cases[8][64];
    uint64_t cut[8];
    uint32_t groups = 0;
    for (int k = 0; k < 8; ++k) {
        const CellCorners at(low, high, k);
        __m512i sum = _mm512_setzero_si512();
        for (int c = 0; c < 8; ++c)
            sum = _mm512_or_si512(sum, _mm512_maskz_set1_epi8(at.words[c], static_cast<char>(1 << c)));
        _mm512_store_si512(cases[k], sum);
        cut[k] = _mm512_test_epi8_mask(sum, sum) & _mm512_cmpneq_epi8_mask(sum, _mm512_set1_epi8(-1));
        const __m128i word = _mm_cvtsi64_si128(static_cast<long long>(cut[k]));
        groups |= static_cast<uint32_t>(_mm_test_epi16_mask(word, word)) << 4 * k;
    }
    const __m512i column = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    const __m512i twoRows = _mm512_mask_add_epi32(column, 0xff00, column, _mm512_set1_epi32(rowStride));
    size_t n = 0;
    forEachTwoRows(cut, groups, [&](uint32_t k, uint32_t j, __mmask16 mask) {
        const int first = corner + static_cast<int>(j) * rowStride + static_cast<int>(k) * layerStride;
        const __m128i here = _mm_load_si128(reinterpret_cast<const __m128i*>(cases[k] + 8 * j));
        const __m512i pairs = _mm512_or_si512(_mm512_add_epi32(twoRows, _mm512_set1_epi32(first)),
                                              _mm512_slli_epi32(_mm512_cvtepu8_epi32(here), 16));
        _mm512_storeu_si512(list + n, _mm512_maskz_compress_epi32(mask, pairs));
        n += static_cast<size_t>(__builtin_popcount(mask));
    });
    return n;
}

#else

size_t ownEdges(const uint8_t* low, const uint8_t* high, uint32_t* __restrict codes) {
    size_t n = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 8; ++k) {
            const uint64_t below = eightRows(axis == 0 ? low : high, rowsBelow[axis] + corners * k);
            for (uint64_t cut = below ^ eightRows(high, rowsAbove + corners * k); cut != 0; cut &= cut - 1) {
                const int bit = __builtin_ctzll(cut);
                codes[n++] = firstOwn[axis] + static_cast<uint32_t>((bit & 7) | bit >> 3 << 8 | k << 16);
            }
        }
    for (size_t i = n; i < n + rowPadding; ++i) codes[i] = 0;
    return n;
}

size_t cells(const uint8_t* low, const uint8_t* high, int corner, int rowStride, int layerStride,
             SurfaceCell* __restrict list) {
    size_t n = 0;
    for (int k = 0; k < 8; ++k) {
        const CellCorners at(low, high, k);
        uint64_t some = 0, all = ~uint64_t{0};
        for (const uint64_t word : at.words) some |= word, all &= word;
        for (uint64_t cut = some & ~all; cut != 0; cut &= cut - 1) {
            const int bit = __builtin_ctzll(cut);
            unsigned inside = 0;
            for (int c = 0; c < 8; ++c) inside |= static_cast<unsigned>(at.words[c] >> bit & 1) << c;
            list[n++] = {static_cast<uint16_t>(corner + (bit & 7) + (bit >> 3) * rowStride + k * layerStride),
                         static_cast<uint16_t>(inside)};
        }
    }
    return n;
}

#endif

void joinByPlaces(const SurfaceCell* cells, size_t n, const uint32_t* __restrict number, const PlacedCase* cases,
                  uint32_t* __restrict to) {
    for (const SurfaceCell* const end = cells + n; cells != end; ++cells) {
        const PlacedCase& placed = cases[cells->inside];
        const uint32_t* const at = number + 3 * cells->corner;
        for (const int16_t *e = placed.edges, *const last = e + 3 * placed.triangles; e != last; ++e) *to++ = at[*e];
    }
}

void join(const SurfaceCell* cells, size_t n, const uint32_t* __restrict number, [[maybe_unused]] size_t rowStride,
          [[maybe_unused]] size_t layerStride, const PlacedCase* cases, uint32_t* __restrict to) {
#if defined(__AVX512F__)
    // All that a cell's triangles can ask for lies in four vectors of eight: one permutation makes them. A whole vector
    // is stored, and the next cells write over what is too much; the last ones would not.
    constexpr size_t last = 5;
    const size_t row = 3 * rowStride, layer = 3 * layerStride;
    for (; n > last; --n, ++cells) {
        const PlacedCase& placed = cases[cells->inside];
        const uint32_t* const at = number + 3 * cells->corner;
        const auto eight = [&](size_t by) { return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at + by)); };
        const __m512i low = _mm512_inserti64x4(_mm512_castsi256_si512(eight(0)), eight(row), 1);
        const __m512i high = _mm512_inserti64x4(_mm512_castsi256_si512(eight(layer)), eight(layer + row), 1);
        const __m512i lanes = _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(placed.lanes)));
        _mm512_storeu_si512(to, _mm512_permutex2var_epi32(low, lanes, high));
        to += 3 * placed.triangles;
    }
#endif
    joinByPlaces(cells, n, number, cases, to);
}

constexpr uint32_t ghostMark = 0x80000000u;

#if defined(__AVX512F__) && defined(__AVX512DQ__)

/// Every third of 48 numbers, from the first, second or third on.
inline __m512i everyThird(const __m512i numbers[3], int first) {
    const __m512i at = _mm512_add_epi32(_mm512_set1_epi32(first),
                                        _mm512_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36, 39, 42, 45));
    const __mmask16 late = _mm512_cmpgt_epi32_mask(at, _mm512_set1_epi32(31));
    return _mm512_mask_permutexvar_epi32(_mm512_permutex2var_epi32(numbers[0], at, numbers[1]), late, at, numbers[2]);
}

void owners(const uint32_t* triangles, size_t n, const uint32_t* origins, uint32_t own, uint32_t* to) {
    const __m512i number = _mm512_set1_epi32(static_cast<int>(~ghostMark)),
                  behind = _mm512_set1_epi32(static_cast<int>(own));
    const auto firstOf = [](size_t count) { return static_cast<__mmask16>(count < 16 ? (1u << count) - 1 : 0xffffu); };
    for (size_t t = 0; t < n; t += 16) {
        const size_t left = n - t;
        __m512i numbers[3];
        for (size_t v = 0; v < 3; ++v)
            numbers[v] = _mm512_maskz_loadu_epi32(firstOf(3 * left > 16 * v ? 3 * left - 16 * v : 0),
                                                  triangles + 3 * t + 16 * v);
        const __mmask16 some = firstOf(left);
        __m512i of[3];
        for (int c = 0; c < 3; ++c) {
            const __m512i corner = everyThird(numbers, c), place = _mm512_and_si512(corner, number);
            const __m512i at = _mm512_mask_add_epi32(place, _mm512_movepi32_mask(corner), place, behind);
            of[c] = _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), some, at, origins, 4);
        }
        const __m512i least = _mm512_min_epu32(of[0], _mm512_min_epu32(of[1], of[2]));
        const auto same = [&](int a, int b) { return _mm512_cmpeq_epi32_mask(of[a], of[b]); };
        const __m512i most = _mm512_mask_mov_epi32(_mm512_mask_mov_epi32(least, same(1, 2), of[1]),
                                                   static_cast<__mmask16>(same(0, 1) | same(0, 2)), of[0]);
        _mm512_mask_storeu_epi32(to + t, some, most);
    }
}

#else

void owners(const uint32_t* triangles, size_t n, const uint32_t* origins, uint32_t own, uint32_t* to) {
    // Without a branch: which corners are ghostMark follows no pattern.
    const auto of = [=](uint32_t corner) { return origins[(corner & ~ghostMark) + ((0u - (corner >> 31)) & own)]; };
    for (size_t t = 0; t < n; ++t, triangles += 3) {
        const uint32_t a = of(triangles[0]), b = of(triangles[1]), c = of(triangles[2]);
        const uint32_t ab = a < b ? a : b, least = ab < c ? ab : c, ofTwo = b == c ? b : least;
        to[t] = ((a == b) | (a == c)) ? a : ofTwo;
    }
}

#endif

}  // namespace

namespace SGM_ISA {
const BrickLoops brickLoops{gather, scatter, inside, cut, ownEdges, cells, join, owners};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
