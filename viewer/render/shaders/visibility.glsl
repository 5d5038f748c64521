// Shadow and sky visibility of a mesh: a depth map of the sun, and an exponential map (Annen et al. 2008) for each of
// many directions of sky, whose blur makes many sharp shadows one soft one.
uniform sampler2DArray sunMap;   // depth, one layer
uniform sampler2DArray skyMaps;  // mean of exp(skySharpness · depth)
uniform mat4 sunFromWorld;          // to 0 … 1 in all three
const float skySharpness = 80.0;
layout(std430, binding = 6) readonly buffer SkyMatrices { mat4 skyFromWorld[]; };
uniform int skyCount;               // 0: everything is open
uniform float mapSpan;              // metres across a map, and along its depth

bool outsideMap(vec3 at) { return any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0))); }

/// 0 … 1, another one at every pixel (interleaved gradient noise: Jimenez 2014).
float pixelNoise() { return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))); }

/// Place i of n of Vogel's spiral over the unit disc, turned by `turn` radians.
vec2 vogel(int i, float n, float turn) {
    float angle = turn + float(i) * 2.399963;
    return sqrt((float(i) + 0.5) / n) * vec2(cos(angle), sin(angle));
}

/// Share of the sun's disc that p sees: the mean height of what stands before it sets how soft the edge is
/// (Fernando, "Percentage-Closer Soft Shadows", 2005), over points of Vogel's spiral.
float sunlightAt(vec3 p) {
    const float sunRadius = 0.035;  // radians
    vec3 at = (sunFromWorld * vec4(p, 1.0)).xyz;
    if (outsideMap(at)) return 1.0;
    at.z = min(at.z, 1.0);
    float search = 0.012, blockers = 0.0, height = 0.0, turn = 6.2831853 * pixelNoise();
    for (int i = 0; i < 16; ++i) {
        float depth = texture(sunMap, vec3(at.xy + search * vogel(i, 16.0, turn), 0.0)).x;
        if (depth < at.z - 1e-3) {
            blockers += 1.0;
            height += at.z - depth;
        }
    }
    if (blockers == 0.0) return 1.0;
    float radius = clamp(sunRadius * height / blockers, 0.0006, search);
    float open = 0.0;
    for (int i = 0; i < 32; ++i)
        open += step(at.z - 8e-4 - radius * 0.3, texture(sunMap, vec3(at.xy + radius * vogel(i, 32.0, turn), 0.0)).x);
    return open / 32.0;
}

/// Share of the sky over `normal` that p sees, weighted by the cosine. A direction stands for a patch of sky, so what is
/// `away` metres from p or farther casts a soft shadow, not a sharp one: each direction is asked at a place of its own within
/// that softness, level with p, other ones at every pixel.
float opennessAt(vec3 p, vec3 normal, float away) {
    if (skyCount == 0) return 0.85;
    float open = 0.0, all = 1e-4;
    float softness = away * sqrt(2.0 / float(skyCount)), noise = pixelNoise();
    for (int i = 0; i < skyCount; ++i) {
        mat4 m = skyFromWorld[i];
        // The third row points away from the light, 1 / mapSpan long.
        float cosine = -dot(normal, vec3(m[0].z, m[1].z, m[2].z)) * mapSpan;
        if (cosine <= 0.0) continue;
        vec3 start = p;
        if (softness > 0.0) {
            float turn = 6.2831853 * fract(noise + 0.61803399 * float(i)), far = softness * sqrt(fract(noise * 7.0 + 0.75487767 * float(i)));
            start += far * vec3(cos(turn), 0.0, sin(turn));
        }
        vec3 at = (m * vec4(start, 1.0)).xyz;
        float seen = 1.0;
        if (!outsideMap(at)) seen = min(texture(skyMaps, vec3(at.xy, float(i))).x * exp(-skySharpness * (min(at.z, 1.0) - 0.01)), 1.0);
        open += cosine * seen;
        all += cosine;
    }
    return mix(0.06, 1.0, open / all);
}
