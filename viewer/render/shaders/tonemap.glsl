// A gentle filmic curve: linear below the shoulder, then an exponential roll-off to 1; half of it works on luminance, which
// keeps bright colours from turning pale.
vec3 shoulder(vec3 x) {
    const float start = 0.55;
    vec3 rolled = start + (1.0 - start) * (1.0 - exp(-(x - start) / (1.0 - start)));
    return mix(x, rolled, step(start, x));
}

/// Scene light to display light, still linear, in 0 … 1.
vec3 tonemap(vec3 light) {
    const float exposure = 0.80;
    vec3 x = max(light, 0.0) * exposure;
    float luminance = dot(x, vec3(0.2126, 0.7152, 0.0722));
    vec3 hueKept = x * (shoulder(vec3(luminance)).x / max(luminance, 1e-4));
    return clamp(mix(shoulder(x), shoulder(hueKept), 0.5), 0.0, 1.0);
}
