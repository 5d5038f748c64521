// The last pass: the colour of what the rays met, in the light that comes there.
layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer Hits { vec4 hits[]; };
layout(std430, binding = 3) readonly buffer Lits { vec4 lits[]; };  // two a hit: normal, openness; sunlight, daylight
layout(std430, binding = 4) readonly buffer MaterialOfHit { uint materialOfHit[]; };
layout(std430, binding = 5) readonly buffer Materials { vec4 materials[]; };  // two a material: colour, roughness; metallic
layout(std430, binding = 6) writeonly buffer Colors { vec4 colors[]; };       // display light, 0 … 1, linear
uniform uint firstJob, jobCount;

vec3 colorOf(uint i) {
    vec4 hit = hits[i], lit = lits[2u * i], more = lits[2u * i + 1u];
    if (hit.w == hitSky) return skySeen(hit.xyz);
    vec3 toEye = normalize(eye - hit.xyz);
    float distance = length(eye - hit.xyz);
    if (hit.w == hitGround) return shadeGround(hit.xyz, toEye, distance, more.x, lit.w);
    uint m = materialOfHit[i] * 2u;
    Surface s = Surface(hit.xyz, lit.xyz, materials[m].rgb, materials[m].a, materials[m + 1u].x);
    return hazed(shade(s, toEye, more.x, lit.w, more.y), distance, skyColor(-toEye));
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    colors[i] = vec4(tonemap(colorOf(i)), 1.0);
}
