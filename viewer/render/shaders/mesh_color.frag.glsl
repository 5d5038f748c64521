// A triangle of the mesh: its origin's material under the scene's light, or a colour that tells something of it. Seen
// from behind it turns its normal to the eye; behind a section it is the cut.
in vec3 worldPosition, worldNormal;
in float meanCurvature;
out vec4 color;
layout(std430, binding = 4) readonly buffer Materials { vec4 materials[]; };  // two a material: colour, roughness; metallic
uniform usamplerBuffer ownerOfTriangle;  // material, rule, component, smooth piece
uniform int firstTriangle;
struct Frame { vec4 u, v, more; };  // metres to tiles with a layer of colours; the same, of normals; layer of roughness, what both begin with
layout(std430, binding = 5) readonly buffer Frames { Frame frames[]; };
uniform int textured;                   // whether any triangle is
uniform usamplerBuffer frameOfTriangle;  // and how, from 1
uniform sampler2DArray colorPictures, numberPictures;
uniform int meshLook;  // as viewer::MeshLook
uniform int wire;
const int lookMaterials = 0, lookNormals = 1, lookCurvature = 2, lookOrigin = 3, lookComponents = 4, lookLabels = 5, lookCreases = 6;

/// Colours that differ much from one number to the next: hues a golden ratio apart.
vec3 distinct(uint n) {
    vec3 hue = clamp(abs(mod(6.0 * fract(0.08 + 0.61803399 * float(n)) + vec3(0.0, 4.0, 2.0), 6.0) - 3.0) - 1.0, 0.0, 1.0);
    return mix(vec3(0.62), hue, 0.62) * (n % 3u == 1u ? 0.62 : 0.9);
}

/// Hollow blue, flat grey, bulging red.
vec3 curvatureColor(float k) {
    float s = k / (abs(k) + 12.0 / sceneSize);
    return mix(vec3(0.62), s > 0.0 ? vec3(0.80, 0.10, 0.05) : vec3(0.05, 0.20, 0.75), abs(s));
}

/// Plain light from the eye, for colours that tell something.
vec3 told(vec3 told, vec3 normal, vec3 toEye) { return told * (0.25 + 0.75 * max(dot(normal, toEye), 0.0)); }

/// What the triangle's texture changes.
void cover(int triangle, inout Surface s) {
    vec3 right = dFdx(worldPosition), up = dFdy(worldPosition);
    if (textured == 0) return;
    int number = int(texelFetch(frameOfTriangle, triangle).x);
    if (number == 0) return;
    Frame f = frames[number - 1];
    vec2 at = vec2(dot(s.position, f.u.xyz), dot(s.position, f.v.xyz)) - f.more.yz;
    vec2 dx = vec2(dot(right, f.u.xyz), dot(right, f.v.xyz)), dy = vec2(dot(up, f.u.xyz), dot(up, f.v.xyz));
    if (f.u.w >= 0.0) s.color = textureGrad(colorPictures, vec3(at, f.u.w), dx, dy).rgb;
    if (f.more.x >= 0.0) {
        vec3 told = textureGrad(numberPictures, vec3(at, f.more.x), dx, dy).rgb;
        s.roughness = told.g;
        s.metallic *= told.b;
    }
    if (f.v.w >= 0.0) {
        vec3 t = 2.0 * textureGrad(numberPictures, vec3(at, f.v.w), dx, dy).xyz - 1.0;
        s.normal = normalize(normalize(f.u.xyz) * t.x + normalize(f.v.xyz) * t.y + s.normal * max(t.z, 0.05));
    }
}

vec3 materialLight(int triangle, vec3 normal, vec3 toEye) {
    int m = int(texelFetch(ownerOfTriangle, triangle).x) * 2;
    Surface s = Surface(worldPosition, normal, materials[m].rgb, materials[m].a, materials[m + 1].x);
    cover(triangle / 4, s);
    float sunlight = lampReach == 0.0 && dot(s.normal, sunDirection) > 0.0 ? sunlightAt(worldPosition, normal) : 0.0;
    vec3 light = shade(s, toEye, sunlight, opennessAt(worldPosition, normal, 0.0), lampReach == 0.0 ? 1.0 : 0.12);
    return tonemap(hazed(light, length(eye - worldPosition), skyColor(-toEye)));
}

void main() {
    if (isCutAway(worldPosition)) discard;
    if (wire != 0) {
        // The offset of lines grows with the slope: those of triangles seen from their edge would show through others.
        if (abs(dot(normalize(worldNormal), normalize(eye - worldPosition))) < 0.08) discard;
        color = vec4(0.01, 0.015, 0.02, 0.45);
        return;
    }
    vec3 toEye = normalize(eye - worldPosition);
    vec3 normal = normalize(worldNormal) * (gl_FrontFacing ? 1.0 : -1.0);
    int triangle = 4 * (firstTriangle + gl_PrimitiveID);
    vec3 display;
    if (showsCut()) display = vec3(0.55, 0.16, 0.09);
    else if (meshLook == lookMaterials) display = materialLight(triangle, normal, toEye);
    else if (meshLook == lookNormals) display = 0.5 + 0.5 * normal;
    else if (meshLook == lookCurvature) display = told(curvatureColor(meanCurvature), normal, toEye);
    else if (meshLook == lookCreases) display = told(vec3(0.80), normal, toEye);
    else {
        int word = meshLook == lookOrigin ? 1 : meshLook == lookComponents ? 2 : 3;
        display = told(distinct(texelFetch(ownerOfTriangle, triangle + word).x), normal, toEye);
    }
    color = vec4(display, 1.0);
}
