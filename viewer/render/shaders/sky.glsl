// The sky: a gradient from a pale horizon to blue, with a sun. Directions are unit vectors, colours linear RGB.
uniform vec3 sunDirection;
uniform int hasGround;  // without one, what floats has sky below it too

const vec3 sunColor = vec3(4.7, 4.05, 3.15);
const vec3 horizonColor = vec3(0.60, 0.80, 1.04);
const vec3 zenithColor = vec3(0.06, 0.20, 0.60);

/// The sky without the sun's disc: what lights surfaces and what they mirror.
vec3 skyColor(vec3 direction) {
    // Without a ground the eye is high up, and looks down to a horizon that lies far below.
    float height = hasGround != 0 ? 4.0 * max(direction.y, 0.0) : 1.5 * max(direction.y + 0.62, 0.0);
    vec3 gradient = mix(horizonColor, zenithColor, 1.0 - exp(-height));
    float towardsSun = max(dot(direction, sunDirection), 0.0);
    return gradient + vec3(0.34, 0.24, 0.12) * pow(towardsSun, 16.0);
}

/// Mean of the sky over the half-space above `normal`, with light thrown back from below: by the ground, or by haze.
vec3 ambientColor(vec3 normal) {
    vec3 above = hasGround != 0 ? vec3(0.36, 0.49, 0.72) : vec3(0.62, 0.78, 1.00);
    vec3 below = hasGround != 0 ? vec3(0.26, 0.225, 0.185) : vec3(0.44, 0.56, 0.74);
    return mix(below, above, 0.5 + 0.5 * normal.y);
}

/// The sky as the eye sees it: with the sun's disc and the glow of the air about it.
vec3 skySeen(vec3 direction) {
    float away2 = 2.0 * (1.0 - dot(direction, sunDirection));  // the angle to the sun, squared
    return skyColor(direction) + vec3(1.0, 0.92, 0.78) * (9.0 * smoothstep(1.9e-4, 1.1e-4, away2) + 0.5 * exp(-110.0 * away2));
}
