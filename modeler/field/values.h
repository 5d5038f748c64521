// The value interface: what the body of an op may say, and its plain float form.
// Enters: nothing. Leaves: `float` as a value type. The others are in modeler/eval/values_*.h: Lanes (SIMD), Dual
// (derivatives), Interval (enclosures), GlslText (shader text). All give the same bits where they compute a value.
//
// A value type V is made from a float and has + − × ÷, unary −, and by argument-dependent lookup
//   min max abs sqrt floor                 min(a, b) is a < b ? a : b, so the second operand wins ties and NaN
//   a < b, a <= b, a > b, a >= b           → MaskOf<V>;  & | ! on masks;  any(mask) is true when one lane is
//   select(mask, a, b)                     a where the mask holds, else b
//   toInt(v) → IntOf<V>                    for |v| ≤ 2³⁰ (clamped beyond) and v already whole (see floor)
//   toFloat(i) → V                         of a signed 32-bit number, exact below 2²⁴
//   powerOfTwo(v) → V                      2ᵛ for whole v in [−126, 127]
//   gather(table, i) → V                   table[i], for i below 2³¹
// IntOf<V> is 32 bits, made from a uint32_t, wraps, and has + − × ^ & | and << >> by an int (>> shifts in zeros).
// Interval has no masks and no integers: rows that need them give their own `interval`.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace sgm::field::ops {

inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline float abs(float a) { return std::fabs(a); }
inline float sqrt(float a) { return std::sqrt(a); }
/// Never −0, so that every instruction set agrees.
inline float floor(float a) { return std::floor(a) + 0.0f; }
inline float select(bool mask, float a, float b) { return mask ? a : b; }
inline bool any(bool mask) { return mask; }
inline uint32_t toInt(float v) {
    constexpr float limit = 1073741824.0f;
    return static_cast<uint32_t>(static_cast<int32_t>(max(min(v, limit), -limit)));
}
inline float toFloat(uint32_t i) { return static_cast<float>(static_cast<int32_t>(i)); }
inline float gather(const float* table, uint32_t i) { return table[i]; }
inline float powerOfTwo(float v) { return std::bit_cast<float>((toInt(v) + 127u) << 23); }

/// The companions of a value type: specialised beside each of them.
template <class V>
struct Companions {
    using Int = typename V::Int;
    using Mask = typename V::Mask;
};
template <>
struct Companions<float> {
    using Int = uint32_t;
    using Mask = bool;
};
/// 32-bit integers, one beside each float of a V.
template <class V>
using IntOf = typename Companions<V>::Int;
/// Truth, one beside each float of a V.
template <class V>
using MaskOf = typename Companions<V>::Mask;

inline constexpr int leaf = 0;       ///< arity of x, y, z, literals and slots
inline constexpr int variadic = -1;  ///< arity of ops over a span of operands

/// Whose surface it is where an op meets several: the first operand that has an owner, the least, the greatest, or for
/// a morph the nearer of two.
enum class Owner { First, Least, Greatest, Nearer };

/// How an op names the piece of surface that its value lies on: by the names of all operands together, as pieces of its
/// own (the faces of a box, the two sides of a mirror), as one piece with what it joins, by those of the nearer of two,
/// or not at all.
enum class Pieces : uint8_t { OfOperands, Faces, Sides, Joined, OfNearer, Forgotten };

/// A number of a row's, as the place of an operand, for its shader text.
struct GlslNumber {
    std::string_view name;
    size_t number;
};

// For rows that enclose themselves. I is an interval: members `lo` and `hi` of type I::Value, I{lo, hi}, lo ≤ hi. A
// result with a NaN bound means "anything, NaN included".

/// The middle of an interval.
template <class I>
auto centre(const I& i) {
    return (i.lo + i.hi) * 0.5f;
}

/// At least the distance from centre(i) to either end, rounding included.
template <class I>
auto radius(const I& i) {
    const auto c = centre(i);
    return max(i.hi - c, c - i.lo) * 1.000001f;
}

/// value ± reach, clipped to [least, most]: the enclosure of an opaque op. `reach` must include the op's rounding.
template <class I>
I around(const typename I::Value& value, const typename I::Value& reach, float least, float most) {
    using V = typename I::Value;
    // NaN, as the second operand, survives.
    return I{min(V(most), max(V(least), value - reach)), max(V(least), min(V(most), value + reach))};
}

}  // namespace sgm::field::ops
