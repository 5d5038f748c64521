// The interpreter alone: one value a point.
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Points { vec4 points[]; };
layout(std430, binding = 2) writeonly buffer Values { float values[]; };
uniform uint firstJob, jobCount, tapeStart;

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x;
    values[i] = evaluateField(tapeStart, points[i].xyz);
}
