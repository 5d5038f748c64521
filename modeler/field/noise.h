// Value noise as an op, in octaves: billow Σ 2⁻ⁱ|vᵢ| and fbm Σ 2⁻ⁱ vᵢ, both divided by Σ 2⁻ⁱ, v in [−1, 1].
// Enters: operands x, y, z in lattice cells; `data` from `Noise::pack`. Leaves: billow in [0, 1], fbm in [−1, 1].
// Assumes |coordinates| < 2²² in the last octave, where cells still have fractions. Lattice values are integer hashes,
// the same on every machine; mixer: lowbias32 (Wellons, "Prospecting for Hash Functions", 2018); fade: Perlin,
// "Improving Noise", 2002.
#pragma once

#include <span>
#include <string_view>

#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Noise {
    static constexpr std::string_view name = "noise";
    static constexpr int arity = variadic;
    static constexpr size_t operandCount = 3, varyingOperands = 3;
    static constexpr int maxOctaves = 8;
    /// Bits of `data`.
    enum Bits : uint32_t { octavesMask = 7, fbmBit = 8, seedShift = 4 };
    static constexpr uint32_t cost(uint32_t, uint32_t data) { return 170 * ((data & octavesMask) + 1); }

    /// The `data` of a node: octaves 1 … 8, kind, and a seed of which 28 bits are kept.
    static constexpr uint32_t pack(bool fbm, int octaves, uint32_t seed) {
        return static_cast<uint32_t>(octaves - 1) | (fbm ? uint32_t{fbmBit} : 0) | (mixed(seed) << seedShift);
    }

    /// Lipschitz bound per lattice cell. One octave of v: the greatest slope of a trilinear patch with corners ±1 under
    /// the fade is 2 · 15/8 = 3.75, across a step from −1 to 1 (found over all 2⁸ corners and a fine grid of places).
    /// Octave i is 2ⁱ times as steep and 2⁻ⁱ times as high.
    static constexpr float lipschitz(int octaves) {
        float weights = 0, weight = 1;
        for (int i = 0; i < octaves; ++i, weight *= 0.5f) weights += weight;
        return 3.7501f * static_cast<float>(octaves) / weights;
    }

    static constexpr GlslNumber glslNumbers[] = {
        {"atPosition", 0}, {"octavesMask", octavesMask}, {"fbmBit", fbmBit}, {"seedShift", seedShift}};
    static constexpr std::string_view glsl =
        "vec3 p = arg3(first + atPosition);\n"
        "uint seed = data >> seedShift;\n"
        "float total = 0.0, weights = 0.0, weight = 1.0;\n"
        "for (uint octave = 0u; octave <= (data & octavesMask); ++octave) {\n"
        "    vec3 cell = floor(p), t = p - cell, w = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);\n"
        "    uvec3 at = uvec3(ivec3(cell)) * uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);\n"
        "    float corner[8];\n"
        "    for (uint i = 0u; i < 8u; ++i) {\n"
        "        uvec3 to = at + uvec3(i & 1u, (i >> 1) & 1u, i >> 2) * uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);\n"
        "        uint h = to.x ^ to.y ^ to.z ^ seed;\n"
        "        h = (h ^ (h >> 16)) * 0x7feb352du;\n"
        "        h = (h ^ (h >> 15)) * 0x846ca68bu;\n"
        "        h ^= h >> 16;\n"
        "        corner[i] = float(int(h >> 8)) * 1.1920929e-7 - 1.0;\n"
        "    }\n"
        "    vec4 y = vec4(corner[0], corner[2], corner[4], corner[6]);\n"
        "    y += w.x * (vec4(corner[1], corner[3], corner[5], corner[7]) - y);\n"
        "    float low = y.x + w.y * (y.y - y.x), high = y.z + w.y * (y.w - y.z), v = low + w.z * (high - low);\n"
        "    total += weight * ((data & fbmBit) != 0u ? v : abs(v));\n"
        "    weights += weight;\n"
        "    weight *= 0.5;\n"
        "    p = p * 2.0 + 0.371;\n"
        "    seed += 0x9e3779b9u;\n"
        "}\n"
        "return total / weights;";

    template <class V>
    static V apply(std::span<const V> args, uint32_t data) {
        return octaves<V>({args[0], args[1], args[2]}, data,
                          [](const Place<V>& at, uint32_t seed) { return patch(at, seed).value; });
    }

    /// Opaque: value at the centre ± L·r, clipped to the range.
    template <class I>
    static I interval(std::span<const I> args, uint32_t data) {
        using V = typename I::Value;
        const V centres[] = {centre(args[0]), centre(args[1]), centre(args[2])};
        const V rx = radius(args[0]), ry = radius(args[1]), rz = radius(args[2]);
        // Rounding: of the fractions (ulps of the coordinates, as steep as the noise) and of the sums.
        const V ulps = (abs(centres[0]) + abs(centres[1]) + abs(centres[2])) * 2e-7f;
        const V reach = (sqrt(rx * rx + ry * ry + rz * rz) * 1.000001f + ulps) * lipschitz(octavesOf(data)) + 4e-6f;
        return around<I>(apply<V>(centres, data), reach, isFbm(data) ? -1.000001f : 0.0f, 1.000001f);
    }

    template <class D>
    static D gradient(std::span<const D> args, uint32_t data) {
        using V = typename D::Value;
        const D& x = args[0];
        const D& y = args[1];
        const D& z = args[2];
        return octaves<D>({x, y, z}, data, [](const Place<D>& at, uint32_t seed) {
            const Patch<V> p = patch(Place<V>{at.x.value, at.y.value, at.z.value}, seed);
            const auto along = [&](const V& dx, const V& dy, const V& dz) { return p.dx * dx + p.dy * dy + p.dz * dz; };
            return D{p.value, along(at.x.dx, at.y.dx, at.z.dx), along(at.x.dy, at.y.dy, at.z.dy),
                     along(at.x.dz, at.y.dz, at.z.dz)};
        });
    }

private:
    template <class V>
    struct Place {
        V x, y, z;
    };
    /// A value and its derivatives by lattice coordinates.
    template <class V>
    struct Patch {
        V value, dx, dy, dz;
    };

    static constexpr uint32_t primes[] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu};

    static constexpr int octavesOf(uint32_t data) { return static_cast<int>(data & octavesMask) + 1; }
    static constexpr bool isFbm(uint32_t data) { return (data & fbmBit) != 0; }

    /// lowbias32.
    template <class U>
    static constexpr U mixed(U h) {
        h = (h ^ (h >> 16)) * U(0x7feb352du);
        h = (h ^ (h >> 15)) * U(0x846ca68bu);
        return h ^ (h >> 16);
    }

    template <class V, class Octave>
    static V octaves(Place<V> at, uint32_t data, const Octave& octave) {
        uint32_t seed = data >> 4;
        V total = 0.0f;
        float weights = 0, weight = 1;
        for (int i = 0; i < octavesOf(data); ++i) {
            const V v = octave(at, seed);
            total = total + (isFbm(data) ? v : abs(v)) * V(weight);
            weights += weight;
            weight *= 0.5f;
            at = {at.x * V(2.0f) + V(0.371f), at.y * V(2.0f) + V(0.371f), at.z * V(2.0f) + V(0.371f)};
            seed += 0x9e3779b9u;
        }
        return total / V(weights);
    }

    /// One octave: lattice values in [−1, 1) interpolated by the quintic fade.
    template <class V>
    static Patch<V> patch(const Place<V>& p, uint32_t seed) {
        using Int = IntOf<V>;
        const V cx = floor(p.x), cy = floor(p.y), cz = floor(p.z);
        const V tx = p.x - cx, ty = p.y - cy, tz = p.z - cz;
        const Int x0 = toInt(cx) * Int(primes[0]), y0 = toInt(cy) * Int(primes[1]), z0 = toInt(cz) * Int(primes[2]);
        const Int x1 = x0 + Int(primes[0]), y1 = y0 + Int(primes[1]), z1 = z0 + Int(primes[2]);
        const auto corner = [&](const Int& x, const Int& y, const Int& z) {
            return toFloat(mixed(x ^ y ^ z ^ Int(seed)) >> 8) * V(0x1p-23f) - V(1.0f);
        };
        const V wx = fade(tx), wy = fade(ty), wz = fade(tz);
        // Along x on the four edges, then along y on the two faces, then along z.
        const V v00 = corner(x0, y0, z0), v10 = corner(x0, y1, z0), v01 = corner(x0, y0, z1), v11 = corner(x0, y1, z1);
        const V d00 = corner(x1, y0, z0) - v00, d10 = corner(x1, y1, z0) - v10;
        const V d01 = corner(x1, y0, z1) - v01, d11 = corner(x1, y1, z1) - v11;
        const V e00 = v00 + wx * d00, e10 = v10 + wx * d10, e01 = v01 + wx * d01, e11 = v11 + wx * d11;
        const V low = e00 + wy * (e10 - e00), high = e01 + wy * (e11 - e01);
        const V dxLow = d00 + wy * (d10 - d00), dxHigh = d01 + wy * (d11 - d01);
        const V dyLow = e10 - e00, dyHigh = e11 - e01;
        return {low + wz * (high - low), steepness(tx) * (dxLow + wz * (dxHigh - dxLow)),
                steepness(ty) * (dyLow + wz * (dyHigh - dyLow)), steepness(tz) * (high - low)};
    }

    /// 6t⁵ − 15t⁴ + 10t³ and its derivative 30t²(t − 1)².
    template <class V>
    static V fade(const V& t) {
        return t * t * t * (t * (t * V(6.0f) - V(15.0f)) + V(10.0f));
    }
    template <class V>
    static V steepness(const V& t) {
        const V u = t * (t - V(1.0f));
        return u * u * V(30.0f);
    }
};

}  // namespace sgm::field::ops
