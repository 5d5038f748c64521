// Sky and ground behind a mesh.
out vec4 color;
uniform vec3 tileCorner;  // the target's lower left pixel in the picture, from its bottom left

void main() {
    vec2 fromBottom = gl_FragCoord.xy + tileCorner.xy;
    vec3 direction = viewDirection(vec2(fromBottom.x, pictureSize.y - fromBottom.y));
    float t = groundDistance(eye, direction);
    vec3 light = skySeen(direction);
    if (t >= 0.0) {
        const vec3 up = vec3(0.0, 1.0, 0.0);
        vec3 p = eye + t * direction;
        float away = length(max(abs(p - sceneCentre) - sceneHalf, vec3(0.0)).xz);
        light = shadeGround(p, -direction, t, sunlightAt(p, up), opennessAt(p, up, away));
    }
    color = vec4(tonemap(light), 1.0);
}
