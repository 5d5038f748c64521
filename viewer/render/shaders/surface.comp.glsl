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
/// clearance in units of the disc's radius there. Strides are relaxed as in trace.comp.glsl: away from the penumbra one and
/// a half times the free radius, taken back when the two radii leave a gap. Where the least clearance is in doubt and no
/// solid behind it, the way is walked again and every small value looked behind.
float discSeen(vec3 p, vec3 direction, float radius, float pixel) {
    vec3 inverseDirection = inverseOf(direction), away;
    vec2 span = boundsSpan(p, inverseDirection);
    float start = max(span.x, 3e-4 * sceneSize), into = max(4e-6 * sceneSize, 0.05 * pixel);
    float t = start, clearance = 1.0, free = 0.0, stride = 0.0, within = 0.0;
    vec4 doubted = vec4(-1.0);  // where the least clearance was found, if in doubt, and the value there
    bool careful = false;
    for (int step = 0;; ++step) {
        bool ended = step >= 128 || t + stride > span.y || clearance <= -0.9;
        if (ended && doubted.w < 0.0) break;
        vec3 q = ended ? doubted.xyz : p + (t + stride) * direction;
        float value = doubted.w, next = 0.0, disc = 1.0, least = 0.0;
        bool probing = ended;
        if (!ended) {
            Cell cell = cellAt(q);
            // Nothing of the cell comes into the disc.
            if (cell.least >= margin || cell.least >= radius * (t + stride + 2.0 * cell.edge)) {
                t += stride + cellExit(cell, q, inverseDirection);
                free = stride = 0.0;
                continue;
            }
            value = cell.state == cellInside ? -margin : side * fieldBy(cell.tape, q);
            next = abs(value) * inverseLipschitz;
            disc = min(radius * (t + stride), margin);
            least = max(0.5 * disc, max(1e-3 * sceneSize, disc < pixel ? 1.4 * pixel : 0.0));
            if (stride > max(free + next, least)) {
                stride = max(free, least);
                continue;
            }
            bool doubtful = cell.doubtful && value > -0.25 * into;
            probing = doubtful && careful && value / disc < clearance;
            if (value / disc < clearance && !probing) {
                clearance = value / disc;
                doubted = doubtful ? vec4(q, max(value, 0.0)) : vec4(-1.0);
            }
        }
        bool solid = probing && solidBehind(q, value, into, vec3(0.0), away);
        if (ended) {
            if (solid) break;
            careful = true;
            doubted = vec4(-1.0);
            t = start;
            clearance = 1.0;
            free = stride = within = 0.0;
            step = -1;
            continue;
        }
        if (solid) clearance = value / disc;
        // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the
        // solid counts as half as much depth.
        within = value < 0.0 ? within + stride : 0.0;
        if (value < 0.0 && disc < pixel && -0.5 * within / disc < clearance) {
            clearance = -0.5 * within / disc;
            doubted.w = -1.0;
        }
        t += stride;
        free = next;
        stride = max(free > 2.0 * disc ? 1.5 * free : 0.9 * free, least);
    }
    // Area of a disc left of a chord, as a smooth step.
    clearance = clamp(0.5 + 0.5 * clearance, 0.0, 1.0);
    return clearance * clearance * (3.0 - 2.0 * clearance);
}

/// Share of the sky that p sees, from the field at growing distances along the normal.
float opennessAt(vec3 p, vec3 normal, float pixel) {
    float hidden = 0.0, weight = 0.0;
    float reach = 0.07 * sceneSize;
    for (int i = 0; i < 4; ++i) {
        float w = 1.0;
        float enough = min(reach, margin);
        float free = clamp(distanceAt(p + normal * reach, enough, pixel) / enough, 0.0, 1.0);
        hidden += w * (1.0 - free);
        weight += w;
        reach *= 0.4;
    }
    // A little stays even where things touch: light creeps in.
    return mix(0.08, 1.0, 1.0 - hidden / weight);
}

/// Shares that p sees of the sun, and of the day that comes into a hollow, by wide discs of the upper sky.
vec2 sunAndDayAt(vec3 p, vec3 normal, float pixel, bool sun, bool day) {
    float sunlight = 0.0, seen = 0.0;
    for (int i = sun ? 0 : 1; i < (day ? 6 : 1); ++i) {
        float angle = 1.5707963 * float(i - 1);
        vec3 direction = i == 0 ? sunDirection : i == 5 ? vec3(0.0, 1.0, 0.0) : vec3(0.7 * cos(angle), 0.714, 0.7 * sin(angle));
        float cosine = dot(normal, direction);
        if (cosine <= 0.0) continue;
        float open = discSeen(p, direction, i == 0 ? 0.035 : 0.3, pixel);
        if (i == 0) sunlight = open;
        else seen += cosine * open;
    }
    return vec2(sunlight, min(0.4 * seen, 1.0));
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
        bool byDay = lampReach > 0.0 && hit.w == hitObject;
        vec2 light = sunAndDayAt(start, normal, pixel, lampReach == 0.0 || side > 0.0, byDay && side > 0.0);
        lits[2u * i] = vec4(normal, opennessAt(hit.xyz, normal, pixel));
        lits[2u * i + 1u] = vec4(light.x, byDay ? light.y : 1.0, 0.0, 0.0);
    }
    atomicAdd(counts[1], evaluations);
    atomicAdd(counts[2], instructions);
}
