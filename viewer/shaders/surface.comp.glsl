// The second pass: normals of what the rays met, or by those shadow and occlusion from the field.
layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer Hits { vec4 hits[]; };
layout(std430, binding = 3) buffer Lits { vec4 lits[]; };  // two a hit: normal, openness; sunlight, daylight
uniform uint firstJob, jobCount;
uniform int what;  // 0: normals where hits are; 1: means over some of a pixel; 2: the rest

/// Tetrahedral differences; the cell's tape is exact a little beyond the cell.
vec3 normalAt(vec3 p, float h) {
    Cell cell = cellAt(p);
    if (cell.state != cellNear) return vec3(0.0, 1.0, 0.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 corner = vec3(float(((i + 3) >> 1) & 1), float((i >> 1) & 1), float(i & 1)) * 2.0 - 1.0;
        sum += corner * fieldBy(cell.tape, p + corner * h);
    }
    return side * normalize(sum + vec3(0.0, 1e-20, 0.0));
}

/// Share that p sees of a disc of light of half angle `radius` (radians) about `direction`: along the ray, the least
/// clearance in units of the disc's radius there. Strides are relaxed as in trace.comp.glsl: away from
/// the penumbra one and a half times the free radius, taken back when the two radii leave a gap.
float discSeen(vec3 p, vec3 direction, float radius, float pixel) {
    vec3 inverseDirection = inverseOf(direction);
    vec2 span = boundsSpan(p, inverseDirection);
    float t = max(span.x, 3e-4 * sceneSize), clearance = 1.0, free = 0.0, stride = 0.0, within = 0.0;
    for (int step = 0; step < 128 && t + stride <= span.y && clearance > -0.9; ++step) {
        vec3 q = p + (t + stride) * direction;
        Cell cell = cellAt(q);
        // Nothing of the cell comes into the disc.
        if (cell.least >= margin || cell.least >= radius * (t + stride + 2.0 * cell.edge)) {
            t += stride + cellExit(cell, q, inverseDirection);
            free = stride = 0.0;
            continue;
        }
        float value = cell.state == cellInside ? -margin : side * fieldBy(cell.tape, q);
        float next = abs(value) * inverseLipschitz;
        float disc = min(radius * (t + stride), margin), least = max(0.5 * disc, max(1e-3 * sceneSize, disc < pixel ? 1.4 * pixel : 0.0));
        if (stride > max(free + next, least)) {
            stride = max(free, least);
            continue;
        }
        clearance = min(clearance, value / disc);
        // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the
        // solid counts as half as much depth.
        within = value < 0.0 ? within + stride : 0.0;
        if (value < 0.0 && disc < pixel) clearance = min(clearance, -0.5 * within / disc);
        t += stride;
        free = next;
        stride = max(free > 2.0 * disc ? 1.5 * free : 0.9 * free, least);
    }
    // Area of a disc left of a chord, as a smooth step.
    clearance = clamp(0.5 + 0.5 * clearance, 0.0, 1.0);
    return clearance * clearance * (3.0 - 2.0 * clearance);
}

/// Share of the sky that p sees, from the field at growing distances along the normal.
float opennessAt(vec3 p, vec3 normal) {
    float hidden = 0.0, weight = 0.0;
    float reach = 0.07 * sceneSize;
    for (int i = 0; i < 4; ++i) {
        float w = 1.0;
        float enough = min(reach, margin);
        float free = clamp(distanceAt(p + normal * reach, enough) / enough, 0.0, 1.0);
        hidden += w * (1.0 - free);
        weight += w;
        reach *= 0.4;
    }
    // A little stays even where things touch: light creeps in.
    return mix(0.08, 1.0, 1.0 - hidden / weight);
}

/// Share of the day that comes into a hollow to p: wide discs of the upper sky.
float daylightAt(vec3 p, vec3 normal, float pixel) {
    if (side < 0.0) return 0.0;
    float seen = 0.0;
    for (int i = 0; i < 5; ++i) {
        float angle = 1.5707963 * float(i);
        vec3 direction = i == 4 ? vec3(0.0, 1.0, 0.0) : vec3(0.7 * cos(angle), 0.714, 0.7 * sin(angle));
        float cosine = dot(normal, direction);
        if (cosine > 0.0) seen += cosine * discSeen(p, direction, 0.3, pixel);
    }
    return min(0.4 * seen, 1.0);
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    vec4 hit = hits[i];
    float pixel = pixelAngle * length(eye - hit.xyz);
    if (what < 2) {
        vec3 normal = vec3(0.0, 1.0, 0.0);
        if (hit.w == hitObject) normal = normalAt(hit.xyz + normalize(eye - hit.xyz) * (0.05 * pixel), max(2e-5 * sceneSize, (what == 0 ? 0.02 : 0.1) * pixel));
        lits[2u * i] = vec4(normal, 0.0);
    } else {
        vec3 normal = lits[2u * i].xyz;
        vec3 start = hit.xyz + normal * max(1e-4 * sceneSize, 0.5 * pixel);
        float sunlight = 0.0, daylight = 1.0;
        if ((lampReach == 0.0 || side > 0.0) && dot(normal, sunDirection) > 0.0) sunlight = discSeen(start, sunDirection, 0.035, pixel);
        if (lampReach > 0.0 && hit.w == hitObject) daylight = daylightAt(start, normal, pixel);
        lits[2u * i] = vec4(normal, opennessAt(hit.xyz, normal));
        lits[2u * i + 1u] = vec4(sunlight, daylight, 0.0, 0.0);
    }
    atomicAdd(counts[1], evaluations);
    atomicAdd(counts[2], instructions);
}
