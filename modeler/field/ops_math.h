// sin, cos, exp and atan2 from + − × ÷ alone, so that every machine gives the same bits.
// Enters: radians (|a| up to 10⁴ keeps the errors below). Leaves: values within `mathError`, which a test holds.
// Method: range reduction by parts (Cody & Waite, "Software Manual for the Elementary Functions", 1980), then Taylor
// polynomials; atan by an odd least-squares polynomial of our own on |t| ≤ tan(π/8).
#pragma once

#include "modeler/field/values.h"

namespace sgm::field::ops {

/// Largest error of the functions below inside their domain: absolute, but relative for exponential.
inline constexpr float mathError = 1e-6f;

/// sin(a + quarters·π/2); one quarter gives the cosine.
template <class V>
V sine(V a, float quarters) {
    // a = n·π/2 + r, |r| ≤ π/4; π/2 in three parts, so that n times the first two is exact.
    const V n = floor(a * 0.636619772f + 0.5f);
    const V r = ((a - n * 1.5703125f) - n * 4.837512969970703125e-4f) - n * 7.54978995489188216e-8f;
    const V s = r * r;
    const V sin_r = r + r * s * (-1.66666667e-1f + s * (8.33333333e-3f + s * (-1.98412698e-4f + s * 2.75573192e-6f)));
    const V cos_r = 1.0f + s * (-0.5f + s * (4.16666667e-2f + s * (-1.38888889e-3f + s * 2.48015873e-5f)));
    const V turn = n + quarters;
    const V half = floor(turn * 0.5f);
    const V value = select(turn - 2.0f * half > 0.5f, cos_r, sin_r);
    return select(half - 2.0f * floor(half * 0.5f) > 0.5f, -value, value);
}

/// eᵃ; a is clamped to this range, where the result is a normal float.
inline constexpr float leastExponent = -87, mostExponent = 88;
template <class V>
V exponential(V a) {
    const V x = min(V(mostExponent), max(V(leastExponent), a));
    // a = n·ln 2 + r, |r| ≤ ln 2 / 2.
    const V n = floor(x * 1.44269504f + 0.5f);
    const V r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
    const V tail = 1.66666667e-1f + r * (4.16666667e-2f + r * (8.33333333e-3f + r * 1.38888889e-3f));
    return (1.0f + r * (1.0f + r * (0.5f + r * tail))) * powerOfTwo(n);
}

/// Angle of (x, y) in (−π, π]; 0 at the origin.
template <class V>
V angleOf(V y, V x) {
    const V ax = abs(x), ay = abs(y);
    const V most = max(ax, ay);
    const V t = select(most > 0.0f, min(ax, ay) / select(most > 0.0f, most, V(1.0f)), V(0.0f));  // 0 … 1
    // atan t = π/4 + atan((t − 1)/(t + 1)) above tan(π/8).
    const auto steep = t > 0.414213562f;
    const V u = select(steep, (t - 1.0f) / (t + 1.0f), t);
    const V s = u * u;
    const V atan_u =
        u + u * s * (-3.333271605e-01f + s * (1.997066057e-01f + s * (-1.381322619e-01f + s * 7.870114699e-02f)));
    const V low = select(steep, atan_u + 0.785398163f, atan_u);
    const V first = select(ay > ax, 1.57079633f - low, low);
    const V right = select(x < 0.0f, 3.14159265f - first, first);
    return select(y < 0.0f, -right, right);
}

}  // namespace sgm::field::ops
