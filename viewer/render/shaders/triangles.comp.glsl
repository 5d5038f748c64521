// Marching cubes over the corners' values with linear interpolation (Lorensen and Cline 1987; SG-M III-G), by the CPU's
// table of 256 cases. Asked first for the number of triangles alone: then there is no room for any.
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Blocks { ivec4 blocks[]; };
layout(std430, binding = 2) readonly buffer Values { float values[]; };
layout(std430, binding = 3) readonly buffer Cases { uint cases[]; };  // 16 a case: triangles, their edges
layout(std430, binding = 4) buffer Count { uint count; };
layout(std430, binding = 5) writeonly buffer Positions { float positions[]; };
layout(std430, binding = 6) writeonly buffer Normals { float normals[]; };
layout(std430, binding = 8) writeonly buffer Indices { uint indices[]; };
uniform uint firstJob, jobCount, room;  // room: triangles
uniform vec3 gridOrigin, gridCells;
uniform float cellEdge;
uniform float nearestToCorner;  // share of an edge that a vertex keeps from its ends

float f[8];

/// Derivative of the trilinear interpolation in the cell; p in 0 … 1.
vec3 slopeAt(vec3 p) {
    vec3 q = 1.0 - p;
    return vec3(mix(mix(f[1] - f[0], f[3] - f[2], p.y), mix(f[5] - f[4], f[7] - f[6], p.y), p.z),
                mix(mix(f[2] - f[0], f[3] - f[1], p.x), mix(f[6] - f[4], f[7] - f[5], p.x), p.z),
                mix(mix(f[4] - f[0], f[5] - f[1], p.x), mix(f[6] - f[2], f[7] - f[3], p.x), p.y));
}

/// Where the surface crosses edge e of the cell, in 0 … 1 (edges as in modeler/mesh/marching_cubes.h).
vec3 crossing(uint e) {
    uint axis = e >> 2, a = e & 1u, b = (e >> 1) & 1u;
    uint corner = axis == 0u ? a << 1 | b << 2 : axis == 1u ? a | b << 2 : a | b << 1;
    float low = f[corner], high = f[corner | 1u << axis];
    float t = low < 0.0 ? low / (low - high) : 1.0 - high / (high - low);
    vec3 p = vec3(corner & 1u, corner >> 1 & 1u, corner >> 2 & 1u);
    p[axis] = clamp(t, nearestToCorner, 1.0 - nearestToCorner);
    return p;
}

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x, cell = i & 32767u;
    ivec3 in32 = ivec3(cell & 31u, cell >> 5 & 31u, cell >> 10);
    ivec3 at = blocks[i >> 15].xyz * 32 + in32;
    if (any(greaterThanEqual(vec3(at), gridCells))) return;
    uint base = (i >> 15) * 35937u + uint(in32.x + 33 * in32.y + 1089 * in32.z), mask = 0u;
    for (uint c = 0u; c < 8u; ++c) {
        f[c] = values[base + (c & 1u) + 33u * (c >> 1 & 1u) + 1089u * (c >> 2)];
        mask |= uint(f[c] < 0.0) << c;
    }
    uint triangles = cases[mask * 16u];
    if (triangles == 0u) return;
    uint first = atomicAdd(count, triangles) * 3u;
    for (uint v = 0u; v < triangles * 3u && first + v < room * 3u; ++v) {
        vec3 p = crossing(cases[mask * 16u + 1u + v]), n = normalize(slopeAt(p) + vec3(0.0, 1e-20, 0.0));
        vec3 place = gridOrigin + cellEdge * (vec3(at) + p);
        for (uint k = 0u; k < 3u; ++k) {
            positions[(first + v) * 3u + k] = place[k];
            normals[(first + v) * 3u + k] = n[k];
        }
        indices[first + v] = first + v;
    }
}
