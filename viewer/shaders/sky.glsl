// The sky: a gradient from a pale horizon to blue, with a sun. Directions are unit vectors, colours linear RGB.
uniform vec3 sunDirection;

const vec3 sunColor = vec3(4.1, 3.62, 2.95);
const vec3 horizonColor = vec3(0.86, 0.90, 0.93);
const vec3 zenithColor = vec3(0.20, 0.38, 0.68);

/// The sky without the sun's disc: what lights surfaces and what they mirror.
vec3 skyColor(vec3 direction) {
    float height = max(direction.y, 0.0);
    vec3 gradient = mix(horizonColor, zenithColor, 1.0 - exp(-2.6 * height));
    float towardsSun = max(dot(direction, sunDirection), 0.0);
    return gradient + vec3(0.30, 0.22, 0.12) * pow(towardsSun, 24.0);
}

/// Mean of the sky over the half-space above `normal`, with light thrown back by the ground from below.
vec3 ambientColor(vec3 normal) {
    const vec3 above = vec3(0.43, 0.50, 0.61);
    const vec3 below = vec3(0.27, 0.24, 0.205);
    return mix(below, above, 0.5 + 0.5 * normal.y);
}
