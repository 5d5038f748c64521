// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// use an inline function of the project's headers: the linker might keep the copy this machine can't run.
#include "modeler/mesh/coarse_loops.h"

#if defined(__AVX512BW__)
#include <immintrin.h>
#endif

namespace sgm::mesh {
namespace {

constexpr int corners = 9, evens = coarseCorners;
constexpr unsigned coarseBits = 0x155, allBits = 0x1ff;

/// Rows of coarse corners, and room so that the rows beside the last one can be read.
constexpr int rowsOfCoarse = evens * evens, roomForRows = 48;
/// Bits by row of coarse corners, for the three distances.
struct Coarse {
    uint8_t near[3][roomForRows];    ///< nearer to the surface, or NaN
    uint8_t inside[3][roomForRows];  ///< farther away, inside
};

#if defined(__AVX512BW__)

/// Two rows of coarse corners at a time.
void compare(const float* coarse, size_t rowStride, size_t layerStride, const float far[3], Coarse& to) {
    constexpr __mmask8 five = (1 << evens) - 1;
    constexpr __mmask16 both = five | five << 8;
    for (int r = 0; r < rowsOfCoarse; r += 2) {
        const auto row = [&](int n) {
            return _mm256_maskz_loadu_ps(five, coarse + static_cast<size_t>(n / evens) * layerStride +
                                                   static_cast<size_t>(n % evens) * rowStride);
        };
        const __m512 f = _mm512_insertf32x8(_mm512_castps256_ps512(row(r)), row(r + 1 < rowsOfCoarse ? r + 1 : r), 1);
        const __m512 size = _mm512_abs_ps(f);
        for (int d = 0; d < 3; ++d) {
            const __mmask16 near = _mm512_mask_cmp_ps_mask(both, size, _mm512_set1_ps(far[d]), _CMP_NGT_UQ);
            const __mmask16 inside = _mm512_mask_cmp_ps_mask(both, f, _mm512_set1_ps(-far[d]), _CMP_LT_OQ);
            __builtin_memcpy(to.near[d] + r, &near, sizeof near);
            __builtin_memcpy(to.inside[d] + r, &inside, sizeof inside);
        }
    }
}

/// Rows of bits in 16 bits each.
using Rows = __m512i;
inline Rows rowsFrom(const uint8_t* row) {
    return _mm512_cvtepu8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(row)));
}
inline Rows constant(int bits) { return _mm512_set1_epi16(static_cast<short>(bits)); }
/// (rows | rows << by) & bits.
template <int by>
inline Rows apart(Rows rows, int bits) {
    return _mm512_and_si512(_mm512_or_si512(rows, _mm512_slli_epi16(rows, by)), constant(bits));
}
/// Every bit to twice its place.
inline Rows spread(Rows rows) { return apart<1>(apart<2>(apart<4>(rows, 0x10f), 0x133), coarseBits); }

struct All {
    static Rows join(Rows a, Rows b) { return _mm512_and_si512(a, b); }
    static Rows between(Rows rows) { return join(rows, _mm512_srli_epi16(rows, 1)); }
};
struct Some {
    static Rows join(Rows a, Rows b) { return _mm512_or_si512(a, b); }
    static Rows between(Rows rows) { return _mm512_and_si512(join(rows, _mm512_srli_epi16(rows, 1)), constant(15)); }
};

/// Where the rows of a brick come from: coarse row j/2 + 5 (k/2), 32 after 32 by the parity of j + 2k.
struct Sources {
    alignas(64) uint16_t at[3][32];
};
constexpr Sources sources() {
    Sources s{};
    for (int row = 0; row < corners * corners; ++row) {
        const int j = row % corners, k = row / corners;
        s.at[row / 32][row % 32] = static_cast<uint16_t>(32 * ((j & 1) + 2 * (k & 1)) + j / 2 + evens * (k / 2));
    }
    return s;
}

/// Of the corners between coarse ones, what holds for all (some) of their coarse neighbours. `coarse` by how far those
/// are. False where nothing does.
template <class Join>
bool joined(const uint8_t (&coarse)[3][roomForRows], uint16_t* to) {
    const auto beside = [](Rows rows, const uint8_t* row, int step) { return Join::join(rows, rowsFrom(row + step)); };
    const auto odd = [](Rows rows) { return _mm512_slli_epi16(spread(Join::between(rows)), 1); };
    const auto both = [&](Rows even, Rows further) { return _mm512_or_si512(spread(even), odd(further)); };
    const uint8_t *const edge = coarse[0], *const face = coarse[1], *const middle = coarse[2];
    const Rows own = odd(rowsFrom(edge));
    const Rows along = both(beside(rowsFrom(edge), edge, 1), beside(rowsFrom(face), face, 1));
    const Rows up = both(beside(rowsFrom(edge), edge, evens), beside(rowsFrom(face), face, evens));
    const auto four = [&](const uint8_t* row) {
        return beside(beside(beside(rowsFrom(row), row, 1), row, evens), row, evens + 1);
    };
    const Rows across = both(four(face), four(middle));
    static constexpr Sources from = sources();
    Rows any = _mm512_setzero_si512();
    for (int v = 0; v < 3; ++v) {
        const Rows at = _mm512_load_si512(from.at[v]);
        const Rows low = _mm512_permutex2var_epi16(own, at, along), high = _mm512_permutex2var_epi16(up, at, across);
        const Rows rows = _mm512_mask_blend_epi16(_mm512_test_epi16_mask(at, constant(64)), low, high);
        _mm512_storeu_si512(to + 32 * v, rows);
        any = _mm512_or_si512(any, v < 2 ? rows : _mm512_maskz_mov_epi16((1u << (corners * corners - 64)) - 1, rows));
    }
    return _mm512_test_epi16_mask(any, any) != 0;
}

#else

void compare(const float* coarse, size_t rowStride, size_t layerStride, const float far[3], Coarse& to) {
    for (int r = 0; r < rowsOfCoarse; ++r) {
        const float* const row =
            coarse + static_cast<size_t>(r / evens) * layerStride + static_cast<size_t>(r % evens) * rowStride;
        for (int d = 0; d < 3; ++d) {
            unsigned near = 0, inside = 0;
            for (int i = 0; i < evens; ++i) {
                near |= static_cast<unsigned>(!(row[i] > far[d] || row[i] < -far[d])) << i;
                inside |= static_cast<unsigned>(row[i] < -far[d]) << i;
            }
            to.near[d][r] = static_cast<uint8_t>(near), to.inside[d][r] = static_cast<uint8_t>(inside);
        }
    }
}

/// Every bit to twice its place.
inline unsigned spread(unsigned bits) {
    bits = (bits | bits << 4) & 0x10f;
    bits = (bits | bits << 2) & 0x133;
    return (bits | bits << 1) & coarseBits;
}

struct All {
    static unsigned join(unsigned a, unsigned b) { return a & b; }
    static unsigned between(unsigned row) { return row & row >> 1; }
};
struct Some {
    static unsigned join(unsigned a, unsigned b) { return a | b; }
    static unsigned between(unsigned row) { return (row | row >> 1) & 15; }
};

/// Of the corners between coarse ones, what holds for all (some) of their coarse neighbours. `coarse` by how far those
/// are. False where nothing does.
template <class Join>
bool joined(const uint8_t (&coarse)[3][roomForRows], uint16_t* to) {
    unsigned any = 0;
    for (int k = 0; k < corners; ++k)
        for (int j = 0; j < corners; ++j) {
            const int step = j & 1, stepUp = (k & 1) * evens, away = (j & 1) + (k & 1);
            const auto four = [&](const uint8_t* all) {
                const uint8_t* const row = all + j / 2 + evens * (k / 2);
                return Join::join(Join::join(row[0], row[step]), Join::join(row[stepUp], row[step + stepUp]));
            };
            const unsigned even = away == 0 ? 0 : spread(four(coarse[away - 1]));
            const unsigned row = even | spread(Join::between(four(coarse[away]))) << 1;
            to[j + corners * k] = static_cast<uint16_t>(row);
            any |= row;
        }
    return any != 0;
}

#endif

bool find(const float* coarse, size_t rowStride, size_t layerStride, FarFrom far, Between& between) {
    Coarse bits;
    const float distances[] = {far.edge, far.face, far.middle};
    compare(coarse, rowStride, layerStride, distances, bits);
    joined<Some>(bits.inside, between.inside);
    return joined<All>(bits.near, between.needed);
}

void fill(const float* coarse, size_t rowStride, size_t layerStride, const Between& between, float* values,
          size_t valueRow, size_t valueLayer) {
    constexpr float outside = 1e15f;  // of which the square is no infinity
    for (int k = 0; k < corners; ++k)
        for (int j = 0; j < corners; ++j) {
            const int r = j + corners * k;
            const unsigned known = (j | k) & 1 ? 0 : coarseBits, rest = allBits & ~known & ~between.needed[r];
            const float* const row =
                coarse + static_cast<size_t>(k / 2) * layerStride + static_cast<size_t>(j / 2) * rowStride;
            float* const to = values + static_cast<size_t>(k) * valueLayer + static_cast<size_t>(j) * valueRow;
#if defined(__AVX512BW__)
            const __m512 signs =
                _mm512_mask_blend_ps(between.inside[r], _mm512_set1_ps(outside), _mm512_set1_ps(-outside));
            const auto mask = static_cast<__mmask16>(known);
            const __m512 all = _mm512_mask_expand_ps(signs, mask, _mm512_maskz_loadu_ps((1 << evens) - 1, row));
            _mm512_mask_storeu_ps(to, static_cast<__mmask16>(known | rest), all);
#else
            for (int i = 0; i < corners; ++i) {
                if (rest >> i & 1) to[i] = between.inside[r] >> i & 1 ? -outside : outside;
                if (known >> i & 1) to[i] = row[i / 2];
            }
#endif
        }
}

/// Calls visit(mask, j, k) for rows with needed corners: which those are follows no pattern.
template <class Visit>
inline void forEachRow(const Between& between, Visit&& visit) {
#if defined(__AVX512BW__)
    for (int first = 0; first < corners * corners; first += 32) {
        const __m512i rows = _mm512_loadu_si512(between.needed + first);
        const int count = corners * corners - first;
        uint32_t rest = _mm512_test_epi16_mask(rows, rows) & (count < 32 ? (1u << count) - 1 : ~0u);
        for (; rest != 0; rest &= rest - 1) {
            const int row = first + __builtin_ctz(rest), k = row * 57 >> 9;  // row / 9
            visit(static_cast<unsigned>(between.needed[row]), row - corners * k, k);
        }
    }
#else
    for (int k = 0; k < corners; ++k)
        for (int j = 0; j < corners; ++j)
            if (const unsigned mask = between.needed[j + corners * k]; mask != 0) visit(mask, j, k);
#endif
}

size_t gather(const Between& between, const float* xs, const float* ys, const float* zs, float* __restrict x,
              float* __restrict y, float* __restrict z) {
    size_t n = 0;
#if defined(__AVX512BW__)
    const __m512 row = _mm512_maskz_loadu_ps(allBits, xs);
    forEachRow(between, [&](unsigned mask, int j, int k) {
        _mm512_storeu_ps(x + n, _mm512_maskz_compress_ps(static_cast<__mmask16>(mask), row));
        _mm512_storeu_ps(y + n, _mm512_set1_ps(ys[j]));
        _mm512_storeu_ps(z + n, _mm512_set1_ps(zs[k]));
        n += static_cast<size_t>(__builtin_popcount(mask));
    });
#else
    forEachRow(between, [&](unsigned mask, int j, int k) {
        for (; mask != 0; mask &= mask - 1, ++n) x[n] = xs[__builtin_ctz(mask)], y[n] = ys[j], z[n] = zs[k];
    });
#endif
    return n;
}

void scatter(const Between& between, const float* __restrict f, float* __restrict values, size_t valueRow,
             size_t valueLayer) {
    forEachRow(between, [&](unsigned mask, int j, int k) {
        float* const to = values + static_cast<size_t>(k) * valueLayer + static_cast<size_t>(j) * valueRow;
#if defined(__AVX512BW__)
        const auto m = static_cast<__mmask16>(mask);
        _mm512_mask_storeu_ps(to, m, _mm512_maskz_expand_ps(m, _mm512_loadu_ps(f)));
        f += __builtin_popcount(mask);
#else
        for (; mask != 0; mask &= mask - 1) to[__builtin_ctz(mask)] = *f++;
#endif
    });
}

}  // namespace

namespace SGM_ISA {
const CoarseLoops coarseLoops{find, fill, gather, scatter};
}  // namespace SGM_ISA

}  // namespace sgm::mesh
