// The ground: a pale plane that takes shadow and melts into the horizon.
uniform float groundHeight;   // metres
uniform float sceneSize;      // diagonal of the bounds, metres
uniform vec3 sceneCentre, sceneHalf;  // of the bounds

const vec3 groundColor = vec3(0.42, 0.41, 0.36);

/// Where a ray meets the ground, as a distance along it; −1 when it doesn't.
float groundDistance(vec3 origin, vec3 direction) {
    if (hasGround == 0 || direction.y > -1e-4 || origin.y < groundHeight) return -1.0;
    float t = (groundHeight - origin.y) / direction.y;
    return t < 60.0 * sceneSize ? t : -1.0;
}

/// `color` of something `distance` away through haze, in front of the sky's colour in that direction.
vec3 hazed(vec3 color, float distance, vec3 sky) {
    return mix(sky, color, exp(-max(distance / sceneSize - 1.5, 0.0) * 0.10));
}

vec3 shadeGround(vec3 position, vec3 toEye, float distance, float sunlight, float openness) {
    vec3 direction = -toEye;
    Surface s = Surface(position, vec3(0.0, 1.0, 0.0), groundColor, 0.95, 0.0);
    float aside = length(position.xz - sceneCentre.xz) / sceneSize;
    vec3 sky = skyColor(normalize(vec3(direction.x, 0.0, direction.z) + vec3(0.0, 1e-3, 0.0)));
    float fade = 1.0 - exp(-max(aside - 0.6, 0.0) * 0.45);
    return mix(shade(s, toEye, sunlight, openness, lampReach == 0.0 ? 1.0 : 0.12), sky, fade);
}
