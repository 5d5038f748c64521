// Sphere tracing (Hart 1996) with strides that adapt to the slope (Keinert et al., "Enhanced Sphere Tracing", 2014; Bán and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). Cells without surface are crossed in one step.
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Jobs { uvec2 jobs[]; };   // pixel x | y << 16, sample
layout(std430, binding = 2) writeonly buffer Hits { vec4 hits[]; };   // position, kind
uniform uint firstJob, jobCount;

/// Distance to the first surface along the ray, −1 when there is none. `free` is a radius about the ray's point at t that
/// holds no surface; a step may be longer than it while the next point's radius reaches back over the gap, and its length
/// follows the slope met so far. A ray that grazes a surface for long takes it from farther away.
float trace(vec3 origin, vec3 direction) {
    vec3 inverseDirection = inverseOf(direction);
    vec2 span = boundsSpan(origin, inverseDirection);
    float tolerance = 2e-6 * sceneSize;
    float t = span.x, free = 0.0, slope = -1.0, stride = 0.0, near = 0.1 * pixelAngle;
    for (int step = 0; step < 512 && t + stride <= span.y; ++step) {
        Cell cell = cellAt(origin + (t + stride) * direction);
        if (cell.least > 0.0 && stride <= free + cell.least * inverseLipschitz) {
            t += stride;
            while (cell.least > 0.0 && t <= span.y) {
                t += cellExit(cell, origin + t * direction, inverseDirection);
                cell = cellAt(origin + t * direction);
            }
            free = stride = 0.0;
            slope = -1.0;
            if (t > span.y) break;
        }
        float value = margin;
        if (cell.state == cellInside) value = -margin;
        else if (cell.state == cellNear) {
            value = side * fieldBy(cell.tape, origin + (t + stride) * direction);
            near = min(near + 0.015 * pixelAngle, 0.3 * pixelAngle);
        }
        float next = value * inverseLipschitz;
        if (stride > free + abs(next) && stride > 0.0) {  // a gap: back to the safe step
            stride = free;
            slope = -1.0;
            continue;
        }
        if (stride > 0.0) slope = mix(slope, (next - free) / stride, 0.4);
        t += stride;
        free = next;
        if (value < max(tolerance, near * t)) return max(t + free, 0.0);  // one more safe step, or back out
        stride = max(free, 2.0 * free / (1.0 - min(slope, 0.6)));
        if (t + stride > span.y) stride = free;  // the long step would leave the box, perhaps past a last surface
    }
    return t + stride <= span.y ? t : -1.0;
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    vec3 direction = viewDirection(samplePosition(jobs[i]));
    float t = trace(eye, direction), below = groundDistance(eye, direction);
    float kind = hitObject;
    if (below >= 0.0 && (t < 0.0 || below < t)) {
        t = below;
        kind = hitGround;
    }
    hits[i] = t < 0.0 ? vec4(direction, hitSky) : vec4(eye + t * direction, kind);
    atomicAdd(counts[0], evaluations);
    atomicAdd(counts[2], instructions);
}
