// A hard edge, where no section cuts it away.
in vec3 worldPosition;
out vec4 color;
uniform vec3 sectionNormal;  // zero without a section
uniform float sectionOffset;

void main() {
    if (dot(sectionNormal, worldPosition) > sectionOffset && sectionNormal != vec3(0.0)) discard;
    color = vec4(0.01, 0.015, 0.02, 1.0);
}
