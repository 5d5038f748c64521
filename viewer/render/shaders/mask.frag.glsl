// Nearest depth where nothing more is to be drawn.
uniform usamplerBuffer wanted;  // a word a pixel of the target, bottom row first; 0: not wanted
uniform int columns;            // of the target

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (texelFetch(wanted, at.y * columns + at.x).x != 0u) discard;
    gl_FragDepth = 0.0;
}
