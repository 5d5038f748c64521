"use strict";

const surfaceVertex = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 octahedral;
layout(location = 2) in vec2 metres;
uniform mat4 camera, light;
out vec3 place, normal;
out vec2 tile;
out vec4 lit;
void main() {
  vec3 n = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  normal = normalize(n);
  place = position;
  tile = metres;
  lit = light * vec4(position, 1.0);
  gl_Position = camera * vec4(position, 1.0);
}`;

const shadowed = `
uniform highp sampler2DShadow depths;
uniform float shadows;
float reached(vec4 lit, float bias) {
  vec3 p = lit.xyz * 0.5 + 0.5;
  if (shadows == 0.0 || any(greaterThan(abs(lit.xy), vec2(0.995)))) return 1.0;
  float sum = 0.0;
  for (int i = -1; i <= 1; ++i)
    for (int k = -1; k <= 1; ++k) sum += texture(depths, vec3(p.xy + vec2(i, k) / 2048.0, p.z - bias));
  return mix(1.0, sum / 9.0, shadows);
}`;

// A sun with a lobe by roughness (GGX), a sky that is lighter above, and what polished metal sees of it.
const surfaceFragment = `#version 300 es
precision highp float;
in vec3 place, normal;
in vec4 lit;
in vec2 tile;
uniform vec3 eye, sun, color, marked;
uniform vec2 finish, tiles;
uniform vec4 section;
uniform sampler2D colorMap, normalMap, roughnessMap;
uniform vec3 mapped;
uniform float flat_;
out vec4 picture;
${shadowed}
/** The normal that a normal map gives, u and v being where the texture coordinates grow. */
vec3 relief(vec3 n, vec2 at) {
  vec3 dx = dFdx(place), dy = dFdy(place);
  vec2 ux = dFdx(tile), uy = dFdy(tile);
  vec3 u = dx * uy.y - dy * ux.y, v = dy * ux.x - dx * uy.x;
  float area = ux.x * uy.y - uy.x * ux.y;
  vec3 t = 2.0 * texture(normalMap, at).xyz - 1.0;
  if (mapped.y == 0.0 || area == 0.0) return n;
  return normalize(normalize(u * sign(area)) * t.x + normalize(v * sign(area)) * t.y + n * max(t.z, 0.05));
}
vec3 sky(vec3 d) { return mix(vec3(0.24, 0.22, 0.20), vec3(0.62, 0.72, 0.86), smoothstep(-0.4, 0.7, d.y)); }
void main() {
  if (dot(place, section.xyz) > section.w) discard;
  vec2 at = vec2(tile.x, -tile.y) * tiles;
  vec3 c = mapped.x > 0.0 ? texture(colorMap, at).rgb : color, rough = texture(roughnessMap, at).rgb;
  vec2 finished = mapped.z > 0.0 ? vec2(rough.g, finish.y * rough.b) : finish;
  c = mix(c, marked, marked.r > 0.0 ? 0.55 : 0.0);
  if (!gl_FrontFacing) { picture = vec4(pow(vec3(0.32, 0.28, 0.26), vec3(1.0 / 2.2)), 1.0); return; }
  if (flat_ > 0.0) { picture = vec4(c, flat_); return; }
  vec3 n = relief(normalize(normal), at), v = normalize(eye - place), h = normalize(sun + v);
  float nl = max(dot(n, sun), 0.0), nv = max(dot(n, v), 1e-3), nh = max(dot(n, h), 0.0);
  float a = max(finished.x * finished.x, 0.03), d = nh * nh * (a * a - 1.0) + 1.0;
  vec3 f0 = mix(vec3(0.04), c, finished.y), f = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, v), 0.0), 5.0);
  float lobe = a * a / (3.14159 * d * d) / (4.0 * mix(nl * nv, 1.0, a) + 1e-3);
  vec3 diffuse = c * (1.0 - finished.y);
  float s = reached(lit, 0.0003 + 0.001 * (1.0 - nl));
  vec3 light = (diffuse / 3.14159 + f * lobe) * nl * s * vec3(2.9, 2.75, 2.5);
  light += diffuse * sky(n) * 0.72 + f0 * sky(reflect(-v, n)) * (1.0 - 0.6 * finished.x);
  light = light / (1.0 + 0.28 * dot(light, vec3(0.2126, 0.7152, 0.0722))) * 1.12;
  picture = vec4(pow(light, vec3(1.0 / 2.2)), 1.0);
}`;

const depthFragment = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 section;
void main() { if (dot(place, section.xyz) > section.w) discard; }`;

// Planes: the ground with the model's shadow, and what a section cuts open, hatched.
const planeVertex = `#version 300 es
uniform mat4 camera, light;
uniform vec3 middle, along, across;
out vec3 place;
out vec2 at;
out vec4 lit;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  place = middle + at.x * along + at.y * across;
  lit = light * vec4(place, 1.0);
  gl_Position = camera * vec4(place, 1.0);
}`;

const groundFragment = `#version 300 es
precision highp float;
in vec2 at;
in vec4 lit;
out vec4 picture;
${shadowed}
void main() {
  float fade = 1.0 - smoothstep(0.25, 1.0, length(at));
  picture = vec4(0.12, 0.13, 0.17, (1.0 - reached(lit, 0.0005)) * 0.42 * fade);
}`;

const capFragment = `#version 300 es
precision highp float;
uniform vec3 hatch;
out vec4 picture;
void main() {
  float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 9.0);
  picture = vec4(stripe < 1.4 ? vec3(0.38, 0.30, 0.27) : hatch, 1.0);
}`;
