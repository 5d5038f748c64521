// Shadow and sky visibility of a mesh: depth maps of the sun, and an exponential map (Annen et al. 2008) for each of
// many directions of sky, whose blur makes many sharp shadows one soft one.
uniform sampler2DArray sunMaps;      // depths, wide maps first
uniform int sunCount;
uniform mat4 sunFromWorld[3];        // to 0 … 1 in all three; narrow maps first
uniform float sunSpan[3];            // metres across
uniform float mapSpan;               // metres across a map of all of the mesh, and along its depth
uniform float widestPenumbra;        // metres
uniform sampler2DArray skyMaps;      // mean of exp(skySharpness · depth)
const float skySharpness = 80.0;
layout(std430, binding = 6) readonly buffer SkyMatrices { mat4 skyFromWorld[]; };
uniform int skyCount;                // 0: everything is open

/// 0 … 1, another one at every pixel (interleaved gradient noise: Jimenez 2014).
float pixelNoise() { return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))); }

/// Whether a place is so far within a map.
bool isWithin(vec2 at, float margin) { return all(greaterThan(at, vec2(margin))) && all(lessThan(at, vec2(1.0 - margin))); }

vec2 turned(float angle) { return vec2(cos(angle), sin(angle)); }

const float sunRadius = 0.035;   // radians
const float leastHeight = 10.0;  // of what casts a shadow, times how far it is aside: lower is the surface itself

/// Share of the sun's disc that p sees: the mean height of what stands before it sets how soft the edge is
/// (Fernando, "Percentage-Closer Soft Shadows", 2005), over points of Vogel's spiral. Points at which something rises a
/// little tell nothing where others do: that may be the surface itself, or the foot of what hides the sun.
float sunlightAt(vec3 p, vec3 normal) {
    const int searched = 16, asked = 32;
    for (int map = 0; map < sunCount; ++map) {
        float span = sunSpan[map], texel = span / float(textureSize(sunMaps, 0).x), layer = float(sunCount - 1 - map);
        vec3 at = (sunFromWorld[map] * vec4(p + normal * (1.5 * texel), 1.0)).xyz;
        at.z = min(at.z, 1.0);
        float search = clamp(sunRadius * at.z * mapSpan, texel, widestPenumbra);
        if (!isWithin(at.xy, search / span)) continue;
        float blockers = 0.0, height = 0.0, turn = 6.2831853 * pixelNoise();
        for (int i = 0; i < searched; ++i) {  // denser about the middle: what is low casts a sharp shadow
            float aside = search * pow(float(i) / float(searched - 1), 1.5);
            float above = (at.z - texture(sunMaps, vec3(at.xy + aside / span * turned(turn + float(i) * 2.399963), layer)).x) * mapSpan;
            if (above > 0.25 * texel && sunRadius * above + texel > aside && above > leastHeight * (aside - texel)) {
                blockers += 1.0;
                height += above;
            }
        }
        if (blockers == 0.0) return 1.0;
        float radius = clamp(sunRadius * height / blockers, 1.2 * texel, search), open = 0.0, hidden = 0.0;
        for (int i = 0; i < asked; ++i) {
            float aside = radius * sqrt((float(i) + 0.5) / float(asked));
            float above = (at.z - texture(sunMaps, vec3(at.xy + aside / span * turned(turn + float(i) * 2.399963), layer)).x) * mapSpan;
            if (above > max(0.25 * texel, leastHeight * (aside - texel))) hidden += 1.0;
            else if (above <= 0.25 * texel) open += 1.0;
        }
        return hidden == 0.0 ? 1.0 : open / (open + hidden);
    }
    return 1.0;
}

/// How much of direction i of the sky a place of its map sees: of each of the four texels around it, then between them. Between
/// their numbers, which differ by powers, texels would show as blocks.
float skySeen(vec3 at, int i) {
    const float shift = 0.003;  // of the map's depth, towards the light
    if (!isWithin(at.xy, 0.0)) return 1.0;
    vec2 part = fract(at.xy * vec2(textureSize(skyMaps, 0).xy) - 0.5);
    vec4 seen = textureGather(skyMaps, vec3(at.xy, float(i))) * exp(-skySharpness * (min(at.z, 1.0) - shift));
    seen = min(seen * sqrt(seen), 1.0);  // half as sharp again: what touches hides more
    return mix(mix(seen.w, seen.z, part.x), mix(seen.x, seen.y, part.x), part.y);
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
        vec3 start = p + normal * (1.5e-3 * mapSpan);
        if (softness > 0.0) {
            float turn = 6.2831853 * fract(noise + 0.61803399 * float(i)), far = softness * sqrt(fract(noise * 7.0 + 0.75487767 * float(i)));
            start += far * vec3(cos(turn), 0.0, sin(turn));
        }
        open += cosine * skySeen((m * vec4(start, 1.0)).xyz, i);
        all += cosine;
    }
    return mix(0.06, 1.0, open / all);
}
