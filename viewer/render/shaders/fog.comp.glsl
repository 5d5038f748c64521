// Fog: single scattering with Henyey and Greenstein's phase function (1941) and Beer's law towards the sun, plus octaves
// that stand for light scattered several times (Wrenninge et al., "Oz: The Great and Volumetric", 2013). The depth of fog
// before the sun and what is seen of the sky were swept through the grid beforehand (viewer/fog_light.h).
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Jobs { uvec2 jobs[]; };
layout(std430, binding = 5) writeonly buffer Colors { vec4 colors[]; };  // display light, 0 … 1, linear
uniform uint firstJob, jobCount;
uniform sampler3D fogGrid;   // depth into the edge 0 … 1; root of the sun's depth; sky above; what lies below
uniform sampler3D bricks;    // of 8³ voxels: bricks to the next fog, in 255ths
uniform sampler3D billowing; // a tile of noise
uniform vec3 fogLow;         // corner of the first voxel, metres
uniform vec3 fogCount;       // voxels
uniform float voxel;         // metres
uniform float extinction;    // of full density, 1/m
uniform float wisps;         // share of the edge that noise eats
uniform float lump;          // edge of the noise's tile, metres
uniform float mostSunDepth;

const int octaves = 6;

vec4 gridAt(vec3 p) { return texture(fogGrid, (p - fogLow) / (voxel * fogCount)); }

/// Share of full density at p; the edge is eaten between billows, deep inside nothing is.
float densityAt(float ramp, vec3 p) {
    if (ramp <= 0.0) return 0.0;
    if (ramp >= 0.999) return 1.0;
    vec3 q = p / lump;
    float billow = 0.60 * texture(billowing, q).x + 0.26 * texture(billowing, q * 3.1 + 0.37).x
                   + 0.14 * texture(billowing, q * 8.3 + 0.71).x;
    float eaten = wisps * clamp(0.5 + 3.4 * (0.52 - billow), 0.0, 1.0);  // the noise's usual range, stretched to all of it
    float left = clamp((ramp - eaten) / (1.0 - eaten), 0.0, 1.0);
    return left;
}

float phase(float cosine, float g) {
    float k = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (k * sqrt(k));  // times 1/4π, which the sun's strength holds
}

/// Depth of fog between p and the sun: the first steps through the fog as it is, then what was swept.
float sunDepth(vec3 p) {
    float depth = 0.0, reach = 0.0, stride = 0.7 * voxel;
    for (int i = 0; i < 3; ++i) {
        vec3 q = p + sunDirection * (reach + 0.5 * stride);
        depth += stride * extinction * densityAt(gridAt(q).x, q);
        reach += stride;
        stride *= 2.0;
    }
    float root = gridAt(p + sunDirection * reach).y;
    return depth + root * root * mostSunDepth;
}

/// Adds the fog along a ray to what lies behind it.
vec3 throughFog(vec3 origin, vec3 direction, float far, vec3 behind, float jitter) {
    vec3 inverse = 1.0 / mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
    vec3 a = (fogLow - origin) * inverse, b = (fogLow + voxel * fogCount - origin) * inverse;
    vec3 lower = min(a, b), upper = max(a, b);
    float t = max(max(max(lower.x, lower.y), lower.z), 0.0), end = min(min(min(upper.x, upper.y), upper.z), far);
    float cosine = dot(direction, sunDirection);
    float phases[octaves];
    float anisotropy = 1.0;
    for (int i = 0; i < octaves; ++i) {
        phases[i] = mix(phase(cosine, 0.8 * anisotropy), phase(cosine, -0.25 * anisotropy), 0.3);
        anisotropy *= 0.5;
    }
    float stride = 0.6 * voxel, clear = 1.0;
    vec3 light = vec3(0.0);
    t += stride * jitter;
    for (int step = 0; step < 1024 && t < end && clear > 0.004; ++step) {
        vec3 p = origin + t * direction;
        vec3 brick = floor((p - fogLow) / (8.0 * voxel));
        float away = 255.0 * texelFetch(bricks, ivec3(brick), 0).x;
        if (away > 0.5) {  // across the cube of bricks that hold nothing
            vec3 low = fogLow + (brick - (away - 1.0)) * 8.0 * voxel, high = low + (2.0 * away - 1.0) * 8.0 * voxel;
            vec3 leave = max((low - p) * inverse, (high - p) * inverse);
            t += stride * ceil(max(min(min(leave.x, leave.y), leave.z) / stride, 1.0));
            continue;
        }
        vec4 here = gridAt(p);
        float density = densityAt(here.x, p);
        if (density > 0.0) {
            float depth = sunDepth(p), strength = 1.0, thickness = 1.0;
            float sun = 0.0;
            for (int i = 0; i < octaves; ++i) {
                sun += strength * phases[i] * exp(-thickness * depth);
                strength *= 0.55;
                thickness *= 0.45;
            }
            vec3 scattered = vec3(0.92, 0.83, 0.71) * sun + vec3(0.33, 0.47, 0.74) * here.z + vec3(0.15, 0.19, 0.25) * here.w;
            float kept = exp(-density * extinction * stride);
            light += clear * (1.0 - kept) * scattered;
            clear *= kept;
        }
        t += stride;
    }
    return light + max(clear - 0.004, 0.0) / 0.996 * behind;
}

/// Share of the sun that reaches a place outside the fog: the swept depth where its ray enters the grid.
float sunlightBelow(vec3 p) {
    vec3 a = (fogLow - p) / sunDirection, b = (fogLow + voxel * fogCount - p) / sunDirection;
    vec3 lower = min(a, b), upper = max(a, b);
    float enter = max(max(max(lower.x, lower.y), lower.z), 0.0), leave = min(min(upper.x, upper.y), upper.z);
    if (enter >= leave) return 1.0;
    float root = gridAt(p + (enter + 0.5 * voxel) * sunDirection).y;
    return exp(-0.35 * root * root * mostSunDepth);
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    vec2 pixel = samplePosition(jobs[i]);
    vec3 direction = viewDirection(pixel);
    float below = groundDistance(eye, direction), far = 1e30;
    vec3 behind = skySeen(direction);
    if (below >= 0.0) {
        vec3 p = eye + below * direction;
        behind = shadeGround(p, -direction, below, sunlightBelow(p), 0.9);
        far = below;
    }
    float jitter = fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));  // Jimenez 2014
    colors[i] = vec4(tonemap(throughFog(eye, direction, far, behind, jitter)), 1.0);
}
