// How a surface answers light: Lambert plus a GGX lobe (Walter et al. 2007) with Schlick's Fresnel term (1994).
struct Surface {
    vec3 position, normal;
    vec3 color;        // linear RGB
    float roughness;   // 0 … 1
    float metallic;    // 0 … 1
};

uniform vec3 lampPosition;
uniform float lampReach;  // metres; 0 without a lamp

/// Share of light mirrored head-on: 4 % by what is matt, 14 % by the panes of smooth glazing, the colour itself by metal.
vec3 normalReflectance(Surface s) {
    float polish = pow(1.0 - s.roughness, 6.0);
    return mix(vec3(mix(0.04, 0.14, polish)), s.color, s.metallic);
}

/// Light thrown towards `toEye` for one unit of light from `toLight`, cosine included.
vec3 reflected(Surface s, vec3 toEye, vec3 toLight) {
    float nl = max(dot(s.normal, toLight), 0.0), nv = max(dot(s.normal, toEye), 1e-3);
    vec3 h = normalize(toEye + toLight);
    float nh = max(dot(s.normal, h), 0.0), vh = max(dot(toEye, h), 0.0);
    float a = max(s.roughness * s.roughness, 0.02), a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (3.14159265 * d * d);
    float visibility = 0.5 / mix(2.0 * nl * nv, nl + nv, a);
    vec3 f0 = normalReflectance(s);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    vec3 diffuse = s.color * (1.0 - s.metallic) / 3.14159265;
    return (diffuse * (1.0 - fresnel) + fresnel * distribution * visibility) * nl;
}

/// What a mirror shows: the sky, and below the horizon the ground.
vec3 environmentColor(vec3 direction) {
    vec3 sky = skyColor(vec3(direction.x, max(direction.y, 0.0), direction.z));
    // Haze and thin cloud brighten what is mirrored, or metal looks as if it stood in a blue room.
    sky = mix(sky, vec3(1.25 * dot(sky, vec3(0.2126, 0.7152, 0.0722)) + 0.18), 0.5);
    vec3 below = hasGround != 0 ? vec3(0.48, 0.47, 0.44) : skyColor(direction);
    return mix(below, sky, smoothstep(-0.06, 0.02, direction.y));
}

/// All light a surface throws towards the eye. `sunlight`, `openness` and `daylight` are shares in 0 … 1; the last says,
/// in a hollow with its lamp, how much of the sky gets in.
vec3 shade(Surface s, vec3 toEye, float sunlight, float openness, float daylight) {
    vec3 light = reflected(s, toEye, sunDirection) * sunColor * sunlight;

    vec3 f0 = normalReflectance(s);
    float grazing = pow(1.0 - max(dot(s.normal, toEye), 0.0), 5.0);
    vec3 mirror = f0 + max(vec3(1.0 - s.roughness) - f0, 0.0) * grazing;
    // Light that bounces inside a crevice takes the surface's own colour, so dark corners stay warm.
    vec3 open = openness / (1.0 - s.color * (1.0 - openness) * 0.8);
    light += s.color * (1.0 - s.metallic) * ambientColor(s.normal) * open;
    vec3 gloss = mix(environmentColor(reflect(-toEye, s.normal)), ambientColor(s.normal), s.roughness);
    light += mirror * gloss * openness;

    if (lampReach > 0.0) {
        vec3 toLamp = lampPosition - s.position;
        float distance2 = dot(toLamp, toLamp) / (lampReach * lampReach);
        vec3 lamp = vec3(8.6, 7.0, 5.3) * open / (0.4 + 3.0 * distance2);
        // What the walls around throw back comes from everywhere: no side of a bulge is black.
        light = light * daylight + reflected(s, toEye, normalize(toLamp)) * lamp + s.color * (1.0 - s.metallic) * 0.035 * lamp;
    }
    return light;
}
