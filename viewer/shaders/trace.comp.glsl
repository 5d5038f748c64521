// Sphere tracing (Hart 1996): every step is the field's value over its Lipschitz bound; far cells are crossed in one.
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Jobs { uvec2 jobs[]; };   // pixel x | y << 16, sample
layout(std430, binding = 2) writeonly buffer Hits { vec4 hits[]; };   // position, kind
uniform uint firstJob, jobCount;

/// Distance to the first surface along the ray, −1 when there is none.
float trace(vec3 origin, vec3 direction) {
    vec3 inverseDirection = inverseOf(direction);
    vec2 span = boundsSpan(origin, inverseDirection);
    float t = span.x;
    float tolerance = 2e-6 * sceneSize;
    for (int step = 0; step < 384 && t <= span.y; ++step) {
        Cell cell = cellAt(origin + t * direction);
        while (cell.state == cellOutside && t <= span.y) {
            t += cellExit(cell, origin + t * direction, inverseDirection);
            cell = cellAt(origin + t * direction);
        }
        if (t > span.y) break;
        if (cell.state == cellInside) return t;
        float value = side * evaluateField(cell.tape, origin + t * direction);
        float near = max(tolerance, 0.2 * pixelAngle * t);
        if (value < near) return max(t + value * inverseLipschitz, 0.0);
        t += value * inverseLipschitz;
    }
    return t <= span.y ? t : -1.0;
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
}
