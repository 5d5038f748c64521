// How a surface answers light: Lambert plus a GGX lobe (Walter et al. 2007) with Schlick's Fresnel term (1994).
struct Surface {
    vec3 position, normal;
    vec3 color;        // linear RGB
    float roughness;   // 0 … 1
    float metallic;    // 0 … 1
};

uniform vec3 lampPosition;
uniform float lampReach;  // metres; 0 without a lamp

/// Light thrown towards `toEye` for one unit of light from `toLight`, cosine included.
vec3 reflected(Surface s, vec3 toEye, vec3 toLight) {
    float nl = max(dot(s.normal, toLight), 0.0), nv = max(dot(s.normal, toEye), 1e-3);
    vec3 h = normalize(toEye + toLight);
    float nh = max(dot(s.normal, h), 0.0), vh = max(dot(toEye, h), 0.0);
    float a = max(s.roughness * s.roughness, 0.02), a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (3.14159265 * d * d);
    float visibility = 0.5 / mix(2.0 * nl * nv, nl + nv, a);
    vec3 f0 = mix(vec3(0.04), s.color, s.metallic);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    vec3 diffuse = s.color * (1.0 - s.metallic) / 3.14159265;
    return (diffuse * (1.0 - fresnel) + fresnel * distribution * visibility) * nl;
}

/// All light a surface throws towards the eye. `sunlight` and `openness` are shares in 0 … 1. With a lamp, which means in
/// a hollow, the sky only fills the dark a little.
vec3 shade(Surface s, vec3 toEye, float sunlight, float openness) {
    vec3 light = reflected(s, toEye, sunDirection) * sunColor * sunlight;

    vec3 f0 = mix(vec3(0.04), s.color, s.metallic);
    float grazing = pow(1.0 - max(dot(s.normal, toEye), 0.0), 5.0);
    vec3 mirror = f0 + max(vec3(1.0 - s.roughness) - f0, 0.0) * grazing;
    // Light that bounces inside a crevice takes the surface's own colour, so dark corners stay warm.
    vec3 open = openness / (1.0 - s.color * (1.0 - openness) * 0.8);
    light += s.color * (1.0 - s.metallic) * ambientColor(s.normal) * open;
    vec3 gloss = mix(skyColor(reflect(-toEye, s.normal)), ambientColor(s.normal), s.roughness);
    light += mirror * gloss * openness;

    if (lampReach > 0.0) {
        vec3 toLamp = lampPosition - s.position;
        float distance2 = dot(toLamp, toLamp) / (lampReach * lampReach);
        vec3 lamp = vec3(8.6, 7.0, 5.3) * open / (0.4 + 3.0 * distance2);
        light = light * 0.12 + reflected(s, toEye, normalize(toLamp)) * lamp;
    }
    return light;
}
