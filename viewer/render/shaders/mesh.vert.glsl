layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float curvature;  // mean, 1/m
uniform mat4 clipFromWorld;
out vec3 worldPosition, worldNormal;
out float meanCurvature;
invariant gl_Position;  // depths that were drawn before are met again

void main() {
    worldPosition = position;
    worldNormal = normal;
    meanCurvature = curvature;
    gl_Position = clipFromWorld * vec4(position, 1.0);
}
