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

/// Radius of the circle in which two spheres meet whose centres lie `apart`; 0 where they don't.
float meetingRadius(float a, float b, float apart) {
    float along = (apart * apart + a * a - b * b) / (2.0 * apart);
    if (along <= 0.0 || along >= apart) return min(a, b);
    return sqrt(max(a * a - along * along, 0.0));
}

/// Whether nothing nearer than `near` to the way of a stride can have been missed between two free radii.
bool sawAll(float stride, float free, float next, float near) {
    return stride <= free || (stride < free + next && meetingRadius(free, next, stride) >= near);
}

const int ofDisc = 0, ofPart = 1, ofSky = 2;
const float partOffset = 0.4, partRadius = 0.6;  // of a disc's parts beside its middle, in radii of the disc

/// What a ray into a disc of light tells: as DiscWalk.
struct DiscSeen {
    float clearance;  // -1: hidden by far; 1: free
    float freeUntil;  // metres along the ray; -1: all of it
    bool soft;        // what comes into the disc is far enough away for its soft edge to be seen
};

/// What steps and offsets are shares of: the scene, or as much of it as a picture shows whose pixels are so wide, so that
/// reliefs of a house cast shadows in a town too.
float shownSize(float pixel) { return min(sceneSize, 1500.0 * pixel); }

/// How near solid must be to tell something new, in radii of the disc.
float matters(DiscSeen seen) { return seen.soft ? max(seen.clearance, 0.0) : 1.0; }

/// How clear of solid a disc of light of half angle `radius` (radians) about `direction` is at p, by the least distance to
/// solid along the ray in units of the disc's radius there. Strides grow with the slope; they are taken back where the radii
/// at both ends leave room for what would come into the disc. Where the last place was nearer to solid than those beside
/// it, the least between is asked for. Where the least clearance is in doubt and no solid behind it, the way is walked
/// again and every small value looked behind.
DiscSeen lookAtDisc(vec3 p, vec3 direction, float radius, float pixel, int of, float from) {
    vec3 inverseDirection = inverseOf(direction);
    vec2 span = boundsSpan(p, inverseDirection);
    float size = shownSize(pixel), start = max(max(span.x, 3e-4 * size), from), into = max(4e-6 * sceneSize, 0.05 * pixel);
    float dark = of == ofPart ? 0.05 : -0.9, finest = (of == ofSky ? 1e-3 : 2e-4) * size;
    float t = start, free = 0.0, stride = 0.0, slope = -1.0, within = 0.0;
    float passed = 0.0, before = 0.0, passedStride = 0.0;  // the last values, and how far apart
    float turn = 0.0, ahead = 0.0;                         // a place beside the last one, and the value at the next
    bool turning = false, turned = false, careful = false;
    DiscSeen seen = DiscSeen(1.0, -1.0, of == ofPart);
    vec4 doubted = vec4(-1.0);  // where the least clearance was found, if in doubt, and the value there
    for (int step = 0;; ++step) {
        bool ended = step >= 128 || t + stride > span.y || (seen.clearance <= dark && doubted.w < 0.0);
        if (ended && doubted.w < 0.0) break;
        vec3 q = ended ? doubted.xyz : p + (t + (turning ? turn : stride)) * direction;
        float value = doubted.w, next = 0.0, disc = 1.0, least = 0.0;
        bool probing = ended;
        if (!ended) {
            Cell cell = cellAt(q);
            // Nothing of the cell comes into the disc, or nearer to its middle than what did before.
            float near = min(matters(seen) * radius * (t + stride + 2.0 * cell.edge), margin);
            if (cell.least >= near && !turning) {
                // From within solid the way leads out of it.
                if (passed >= 0.0 && !sawAll(stride, free, cell.least * inverseLipschitz, near)) {
                    stride = 0.9 * free;
                    continue;
                }
                t += stride + cellExit(cell, q, inverseDirection);
                free = stride = passed = before = passedStride = 0.0;
                slope = -1.0;
                continue;
            }
            value = cell.state == cellNear ? side * fieldBy(cell.tape, q) : cell.state == cellInside ? -margin : margin;
            if (turning) {
                turning = false;
                float between = value / min(radius * t, margin);
                if (!cell.doubtful && between < seen.clearance) {
                    seen.clearance = between;
                    doubted = vec4(-1.0);
                }
                value = ahead;
                q = p + (t + stride) * direction;
            }
            next = abs(value) * inverseLipschitz;
            disc = min(radius * (t + stride), margin);
            least = max((of == ofSky ? 0.5 : 0.25) * disc, max(finest, disc < pixel ? 1.4 * pixel : 0.0));
            bool sure = !cell.doubtful || value <= -0.25 * into;
            if (of == ofPart && sure && value < 0.0) {
                seen.clearance = 0.0;
                break;
            }
            if (stride > least && !(value < 0.0 ? stride <= free + next : sawAll(stride, free, next, matters(seen) * disc))) {
                stride = max(0.9 * free, least);
                slope = -1.0;
                continue;
            }
            if (of != ofSky && !turned && !cell.doubtful && disc >= pixel && passed > 0.0 && passed <= seen.clearance * disc && passed < min(before, value)) {
                float slopeBefore = (before - passed) / passedStride, slopeAfter = (value - passed) / stride;
                turn = 0.5 * (stride - slopeAfter * (passedStride + stride) / (slopeBefore + slopeAfter));
                ahead = value;
                turning = turned = true;
                continue;
            }
            turned = false;
            if (value < disc) {
                if (seen.freeUntil < 0.0) seen.freeUntil = t;
                seen.soft = seen.soft || disc >= pixel;
            }
            probing = !sure && careful && value / disc < seen.clearance;
            if (value / disc < seen.clearance && !probing) {
                seen.clearance = value / disc;
                doubted = sure ? vec4(-1.0) : vec4(q, max(value, 0.0));
            }
        }
        bool solid = probing && solidBehind(q, value, into, vec3(0.0));
        if (ended) {
            if (solid) break;
            careful = true;
            doubted = vec4(-1.0);
            t = start;
            free = stride = within = passed = before = passedStride = 0.0;
            slope = -1.0;
            turning = turned = false;
            seen = DiscSeen(1.0, -1.0, of == ofPart);
            step = -1;
            continue;
        }
        if (solid) seen.clearance = value / disc;
        // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the
        // solid counts as half as much depth.
        within = value < 0.0 ? within + stride : 0.0;
        if (value < 0.0 && disc < pixel && -0.5 * within / disc < seen.clearance) {
            seen.clearance = -0.5 * within / disc;
            doubted.w = -1.0;
        }
        before = passed;
        passed = value;
        passedStride = stride;
        slope = stride > 0.0 ? (next - free) / stride : -1.0;
        t += stride;
        free = next;
        stride = max(free > 2.0 * matters(seen) * disc ? 1.6 * free / (1.0 - min(slope, 0.5)) : 0.9 * free, least);
        if (t + stride > span.y) stride = max(0.9 * free, least);  // perhaps past a last surface
    }
    return seen;
}

/// Share of a part that counts as free, all or nothing but for a smooth step: 0 … 1 of its radius.
float shareOfPart(float clearance) { return smoothstep(0.0, 1.0, clearance); }

/// Share of a disc that is free, by how far a straight edge is from its middle.
float shareOfDisc(float clearance) { return shareOfPart(0.5 + 0.5 * clearance); }

/// What a place above a hit tells of the sky that is hidden there: `nearness` is 0 where solid is as far away as the hit, 1 on
/// a surface and 2 as deep in solid. Beside a wall half of the sky is seen; in a gap nothing.
float hiddenShare(float nearness) {
    return nearness < 1.0 ? 0.65 * max(nearness, 0.0) : min(0.65 + 0.35 * (nearness - 1.0), 1.0);
}

/// Share of the sky that p sees, from the field at growing distances along the normal.
float opennessAt(vec3 p, vec3 normal, float pixel) {
    float hidden = 0.0;
    float reach = 0.07 * sceneSize;
    for (int i = 0; i < 4; ++i) {
        float enough = min(reach, margin);
        // Beyond the bounds nothing lies: what is near there is near their nearest place.
        vec3 place = p + normal * reach, within = clamp(place, boundsLow, boundsHigh);
        float beyond = length(place - within);
        if (beyond < enough)
            hidden += 0.25 * hiddenShare(1.0 - (beyond + distanceAt(within, enough - beyond, pixel)) / enough);
        reach *= 0.4;
    }
    // A little stays even where things touch: light creeps in.
    return mix(0.08, 1.0, 1.0 - hidden);
}

/// Shares that p sees of the sun, and of the day that comes into a hollow, by wide discs of the upper sky. What solid
/// hides of the sun no one ray tells, for depth in a thin body is no distance to its outline: a sun that is neither whole
/// nor hidden for certain is looked at by its parts, three beside the middle.
vec2 sunAndDayAt(vec3 p, vec3 normal, float pixel, bool sun, bool day) {
    const int parts = 3, firstSky = 1 + parts, above = firstSky + 4;
    const float sunRadius = 0.035, share = 1.0 / float(1 + parts);
    vec3 u = normalize(cross(sunDirection, vec3(0.0, 1.0, 0.0))), v = cross(u, sunDirection);
    float sunlight = 0.0, seen = 0.0, from = 0.0;
    bool inParts = false;
    for (int i = sun ? 0 : firstSky; i < (day ? above + 1 : firstSky); ++i) {
        bool part = i > 0 && i < firstSky;
        if (part && !inParts) continue;
        float turn = part ? 2.0943951 * float(i - 1) : 1.5707963 * float(i - firstSky);
        vec3 direction = i == above ? vec3(0.0, 1.0, 0.0) : vec3(0.7 * cos(turn), 0.714, 0.7 * sin(turn));
        if (i == 0) direction = sunDirection;
        if (part) direction = normalize(sunDirection + partOffset * sunRadius * (u * cos(turn) + v * sin(turn)));
        float cosine = dot(normal, direction), size = part ? partRadius : 1.0;
        if (cosine <= 0.0 && !part) continue;
        DiscSeen s = lookAtDisc(p, direction, i < firstSky ? size * sunRadius : 0.3, size * pixel, part ? ofPart : i == 0 ? ofDisc : ofSky, part ? from : 0.0);
        if (part) {
            sunlight += share * shareOfPart(s.clearance);
        } else if (i == 0) {
            inParts = s.soft && s.clearance > -0.9 && s.clearance < 1.0;
            sunlight = inParts ? share * shareOfPart(s.clearance / partRadius) : shareOfDisc(s.clearance);
            from = s.freeUntil;
        } else {
            seen += cosine * shareOfDisc(s.clearance);
        }
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
        vec3 start = hit.xyz + normal * max(1e-4 * shownSize(pixel), 0.5 * pixel);
        bool byDay = lampReach > 0.0 && hit.w == hitObject;
        vec2 light = sunAndDayAt(start, normal, pixel, lampReach == 0.0 || side > 0.0, byDay && side > 0.0);
        lits[2u * i] = vec4(normal, opennessAt(hit.xyz, normal, pixel));
        lits[2u * i + 1u] = vec4(light.x, byDay ? light.y : 1.0, 0.0, 0.0);
    }
    atomicAdd(counts[1], evaluations);
    atomicAdd(counts[2], instructions);
}
