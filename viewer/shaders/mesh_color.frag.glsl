// A triangle of the mesh: its origin's material under the scene's light. Seen from behind it turns its normal to the eye.
in vec3 worldPosition, worldNormal;
out vec4 color;
layout(std430, binding = 4) readonly buffer Materials { vec4 materials[]; };  // two a material: colour, roughness; metallic
uniform usamplerBuffer materialOfTriangle;
uniform int firstTriangle;

void main() {
    vec3 toEye = normalize(eye - worldPosition);
    float distance = length(eye - worldPosition);
    vec3 normal = normalize(worldNormal) * (gl_FrontFacing ? 1.0 : -1.0);
    int m = int(texelFetch(materialOfTriangle, firstTriangle + gl_PrimitiveID).x) * 2;
    Surface s = Surface(worldPosition, normal, materials[m].rgb, materials[m].a, materials[m + 1].x);
    vec3 start = worldPosition + normal * (1.5e-3 * mapSpan);
    float sunlight = lampReach == 0.0 && dot(normal, sunDirection) > 0.0 ? sunlightAt(start) : 0.0;
    vec3 light = shade(s, toEye, sunlight, opennessAt(start, normal), lampReach == 0.0 ? 1.0 : 0.12);
    color = vec4(tonemap(hazed(light, distance, skyColor(-toEye))), 1.0);
}
