// Display light of a target to sRGB, turned over so that the top row comes first.
out vec4 color;
uniform sampler2D light;

void main() {
    ivec2 size = textureSize(light, 0), at = ivec2(gl_FragCoord.xy);
    vec3 x = clamp(texelFetch(light, ivec2(at.x, size.y - 1 - at.y), 0).rgb, 0.0, 1.0);
    vec3 curve = 1.055 * pow(max(x, 1e-6), vec3(1.0 / 2.4)) - 0.055;
    // Interleaved gradient noise (Jimenez 2014) against banding, as in the pictures.
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    color = vec4(mix(curve, 12.92 * x, lessThanEqual(x, vec3(0.0031308))) + (noise - 0.5) / 255.0, 1.0);
}
