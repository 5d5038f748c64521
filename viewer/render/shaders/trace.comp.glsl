// Sphere tracing (Hart 1996) with strides that adapt to the slope (Keinert et al., "Enhanced Sphere Tracing", 2014; Bán and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). Cells without surface are crossed in one step. A ray
// that goes ahead of others says how far the cone of theirs is free (as Amanatides, "Ray tracing with
// cones", 1984): they start there.
layout(local_size_x = 64) in;
struct Ray {
    uint pixel, which;           // x | y << 16, sample
    float start, guess, beside;  // as in viewer/tracer.h
};
layout(std430, binding = 1) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 2) writeonly buffer Hits { vec4 hits[]; };   // position, kind
layout(std430, binding = 3) writeonly buffer Free { float freeBeside[]; };  // metres
uniform uint firstJob, jobCount;

/// What may be stepped over unseen at t, metres.
float gapAt(float t) { return 0.3 * pixelAngle * t; }

/// Distance to the first surface along the ray, −1 when there is none; `beside` becomes the distance up to which the cone
/// beside it is free. `free` is a radius about the ray's point at t that
/// holds no surface; a step may be longer than it while the next point's radius reaches back over the gap, and its length
/// follows the slope met so far. A ray that grazes a surface for long takes it from farther away.
float trace(vec3 origin, vec3 direction, Ray ray, out float beside) {
    vec3 inverseDirection = inverseOf(direction);
    vec2 span = boundsSpan(origin, inverseDirection);
    float tolerance = 2e-6 * sceneSize;
    float t = max(span.x, ray.start), free = 0.0, slope = -1.0, stride = 0.0, near = 0.1 * pixelAngle;
    beside = t;
    if (ray.guess > 0.0) {
        Cell cell = cellAt(origin + ray.guess * direction);
        if (cell.state == cellNear) {
            float value = side * fieldBy(cell.tape, origin + ray.guess * direction), pixel = pixelAngle * ray.guess;
            if (value > -max(tolerance, 0.05 * pixel) && value < max(tolerance, 0.35 * pixel)) return ray.guess;
        }
    }
    for (int step = 0; step < 512 && t + stride <= span.y; ++step) {
        Cell cell = cellAt(origin + (t + stride) * direction);
        if (cell.least > 0.0 && stride <= free + cell.least * inverseLipschitz) {
            t += stride;
            while (cell.least > 0.0 && t <= span.y) {
                float from = t;
                t += cellExit(cell, origin + t * direction, inverseDirection);
                float spare = cell.least * inverseLipschitz - ray.beside * t;  // of a ball about any of the way
                if (spare >= 0.0 && from - spare <= beside + gapAt(from)) beside = max(beside, t);
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
        if (stride > free + abs(next) + gapAt(t) && stride > 0.0) {  // back to the safe step
            stride = free;
            slope = -1.0;
            continue;
        }
        if (stride > 0.0) slope = mix(slope, (next - free) / stride, 0.4);
        t += stride;
        if (value < max(tolerance, near * t)) {  // one more safe step, or back out by the secant
            float into = max(tolerance, 0.05 * pixelAngle * t);
            if (!cell.doubtful || value <= -0.25 * into || solidBehind(origin + t * direction, value, into, direction))
                return max(t + (next < 0.0 && stride > 0.0 ? stride * next / (free - next) : next), 0.0);
            t += max(2.0 * gapAt(t), 2.0 * tolerance);
            free = stride = 0.0;
            slope = -1.0;
            continue;
        }
        free = next;
        float aside = ray.beside * (t + free);
        if (free > aside) {
            float reach = sqrt(free * free - aside * aside);
            if (t - reach <= beside + gapAt(t - reach)) beside = max(beside, t + reach);
        }
        stride = max(free, (2.0 * free + gapAt(t)) / (1.0 - min(slope, 0.6)));
        if (t + stride > span.y) stride = free;  // the long step would leave the box, perhaps past a last surface
    }
    return t + stride <= span.y ? t : -1.0;
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    Ray ray = rays[i];
    vec3 direction = viewDirection(samplePosition(uvec2(ray.pixel, ray.which)));
    float beside, t = trace(eye, direction, ray, beside), below = groundDistance(eye, direction);
    float kind = hitObject;
    if (below >= 0.0 && (t < 0.0 || below < t)) {
        t = below;
        kind = hitGround;
    }
    hits[i] = t < 0.0 ? vec4(direction, hitSky) : vec4(eye + t * direction, kind);
    freeBeside[i] = beside;
    atomicAdd(counts[0], evaluations);
    atomicAdd(counts[2], instructions);
}
