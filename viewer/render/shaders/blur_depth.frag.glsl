// One layer of a depth map as an exponential map: the mean of exp(sharpness · depth) over 5 × 5 pixels.
out vec4 value;
uniform sampler2DArray depthMap;

void main() {
    float sum = 0.0;
    ivec2 last = textureSize(depthMap, 0).xy - 1;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            sum += exp(80.0 * texelFetch(depthMap, ivec3(clamp(ivec2(gl_FragCoord.xy) + ivec2(x, y), ivec2(0), last), 0), 0).x);
    value = vec4(sum / 25.0);
}
