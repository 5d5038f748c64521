// Where a picture shows the mesh, from the eye.
in vec3 worldPosition;
out vec4 place;
uniform vec3 eye;

void main() { place = vec4(worldPosition - eye, 1.0); }
