// The field at the corners of blocks of 32³ cells (viewer/blocks_scene.h).
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Blocks { ivec4 blocks[]; };  // index of the block, texel where its tape starts
layout(std430, binding = 2) writeonly buffer Values { float values[]; };
uniform uint firstJob, jobCount;
uniform vec3 gridOrigin;  // metres
uniform float cellEdge;   // metres
uniform vec3 gridCells;   // along each axis

void main() {
    if (gl_GlobalInvocationID.x >= jobCount) return;
    uint i = firstJob + gl_GlobalInvocationID.x, corner = i % 35937u;
    ivec4 block = blocks[i / 35937u];
    ivec3 at = block.xyz * 32 + ivec3(corner % 33u, corner / 33u % 33u, corner / 1089u);
    float value = 1.0;
    if (all(lessThanEqual(vec3(at), gridCells))) {
        value = evaluateField(uint(block.w), gridOrigin + cellEdge * vec3(at));
        // What sticks out of the grid is cut off at its border.
        if (any(equal(at, ivec3(0))) || any(equal(vec3(at), gridCells))) value = max(value, 0.0);
    }
    values[i] = value;
}
