// A segment as a quad of a width in pixels, a little nearer to the eye than the surface that it lies on.
layout(std430, binding = 5) readonly buffer Ends { float ends[]; };  // six a segment
uniform int firstSegment;
uniform mat4 clipFromWorld;
uniform vec3 eyeAt;
uniform float nearest;    // distance of the near plane
uniform vec3 targetSize;  // pixels, x and y
uniform float lineWidth;  // pixels
out vec3 worldPosition;

vec3 endOf(int segment, int end) {
    int at = 6 * segment + 3 * end;
    return vec3(ends[at], ends[at + 1], ends[at + 2]);
}

vec4 clipOf(vec3 world) { return clipFromWorld * vec4(mix(world, eyeAt, 0.0015), 1.0); }

void main() {
    int segment = firstSegment + gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    corner = corner > 2 ? 6 - corner : corner;  // 0 1 2, 3 2 1
    int end = corner / 2, side = corner % 2;
    vec3 here = endOf(segment, end), there = endOf(segment, 1 - end);
    vec4 a = clipOf(here), b = clipOf(there);
    // What lies behind the eye has no place in the picture: the segment ends at the near plane.
    if (a.w < nearest && b.w > nearest) a = mix(a, b, (nearest - a.w) / (b.w - a.w));
    if (b.w < nearest && a.w > nearest) b = mix(b, a, (nearest - b.w) / (a.w - b.w));
    worldPosition = here;
    vec2 way = (b.xy / b.w - a.xy / a.w) * targetSize.xy;
    way = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
    // Seen from the other end left is right.
    vec2 across = vec2(-way.y, way.x) * ((side == 0) == (end == 0) ? 1.0 : -1.0);
    gl_Position = a;
    gl_Position.xy += (across - way) * (lineWidth / targetSize.xy) * a.w;
}
