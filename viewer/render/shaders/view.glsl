// The eye and its rays.
uniform vec3 eye;
uniform vec3 viewForward;  // unit
uniform vec3 viewRight;    // half the picture's width at distance 1
uniform vec3 viewUp;       // half the picture's height at distance 1
uniform vec3 pictureSize;  // pixels: width, height, 0
uniform float pixelAngle;  // radians a pixel

/// Unit direction through a point of the picture, in pixels from its top left corner.
vec3 viewDirection(vec2 pixel) {
    vec2 s = 2.0 * pixel / pictureSize.xy - 1.0;
    return normalize(viewForward + viewRight * s.x - viewUp * s.y);
}
