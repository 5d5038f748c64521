// The kaleidoscopic iterated function system for shaders: the same steps in the same order as Kifs::apply.
// Enters: operands by arg(first + i), their places and the bits of `data` by the names in Kifs::glslNumbers. Leaves: a
// GLSL function's body.
#pragma once

#include <string_view>

namespace sgm::field::ops {

inline constexpr std::string_view kifsGlsl =
    "vec3 p = arg3(first + atPosition) * arg3(first + atStretch), c = arg3(first + atCentre);\n"
    "float s = arg(first + atScale), scales = 1.0;\n"
    "mat3 r2 = mat3(1.0), r1 = mat3(1.0);\n"
    "for (uint i = 0u; i < 9u; ++i) {\n"
    "    if ((data & hasFold) != 0u) r2[i / 3u][i % 3u] = arg(first + atFold + i);\n"
    "    if ((data & hasTurn) != 0u) r1[i / 3u][i % 3u] = arg(first + atTurn + i);\n"
    "}\n"
    "float limit = arg(first + atBailout), h = c.z * (s - 1.0) * 0.5;\n"
    "for (uint pass = 0u; pass < (data & passesMask); ++pass) {\n"
    "    p = abs(r1 * p);\n"
    "    p.xy = vec2(max(p.x, p.y), min(p.x, p.y));\n"
    "    p.xz = vec2(max(p.x, p.z), min(p.x, p.z));\n"
    "    p.yz = vec2(max(p.y, p.z), min(p.y, p.z));\n"
    "    p = r2 * p * s;\n"
    "    p.xy -= c.xy * (s - 1.0);\n"
    "    p.z = (data & jumps) == 0u ? h - abs(p.z - h) : p.z > h ? p.z - (h + h) : p.z;\n"
    "    scales *= s;\n"
    "    if ((data & bailsOut) != 0u && dot(p, p) > limit) break;\n"
    "}\n"
    "vec3 q = abs(p);\n"
    "float d = (data & isCube) != 0u ? max(max(q.x, q.y), q.z) - max(max(c.x, c.y), c.z) : length(p) - 2.0;\n"
    "return d / scales;";

}  // namespace sgm::field::ops
