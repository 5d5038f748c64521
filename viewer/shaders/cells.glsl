// Space cut into a tree of cells, 4 × 4 × 4 a node, each leaf with a tape shortened for it (viewer/cells.h).
uniform usamplerBuffer tree;   // 64 words a node: state in the two top bits, leaf or node below
uniform usamplerBuffer leaves; // tape start, least and most of the field
uniform vec3 rootLow;          // metres
uniform float rootEdge;
uniform vec3 boundsLow, boundsHigh;
uniform float side;            // 1, or −1 to stand inside the solid
uniform float inverseLipschitz;
uniform float margin;          // no surface is nearer than this from a far cell, metres

const uint cellOutside = 0u, cellNear = 1u, cellInside = 2u, cellNode = 3u;

layout(std430, binding = 7) buffer Counts { uint counts[]; };  // evaluations for hits, for light; their instructions
uint evaluations = 0u, instructions = 0u;  // of this invocation

/// The field at p by the tape of a near cell; counted.
float fieldBy(uint tape, vec3 p) {
    ++evaluations;
    instructions += texelFetch(tapes, int(tape)).x - tape - 1u;
    return evaluateField(tape, p);
}

struct Cell {
    uint state;   // never cellNode
    uint tape;    // of a near cell
    vec3 low;     // metres
    float edge;   // metres
    float least;  // of the field in the cell: what lies farther than a ray asks for needs no evaluation
};

Cell cellAt(vec3 p) {
    vec3 q = clamp((p - rootLow) / rootEdge, 0.0, 0.9999999);
    vec3 low = vec3(0.0);
    float edge = 1.0;
    uint word = 0xc0000000u;
    while ((word >> 30) == cellNode) {
        edge *= 0.25;
        vec3 k = clamp(floor((q - low) / edge), 0.0, 3.0);
        low += k * edge;
        word = texelFetch(tree, int((word & 0x3fffffffu) * 64u + uint(k.x + 4.0 * k.y + 16.0 * k.z))).x;
    }
    uint state = word >> 30;
    if (side < 0.0 && state != cellNear) state = cellInside - state;
    uint tape = 0u;
    float least = state == cellOutside ? margin : -margin;
    if (state == cellNear) {
        uvec4 leaf = texelFetch(leaves, int(word & 0x3fffffffu));
        tape = leaf.x;
        least = side > 0.0 ? uintBitsToFloat(leaf.y) : -uintBitsToFloat(leaf.z);
    }
    return Cell(state, tape, rootLow + low * rootEdge, edge * rootEdge, least);
}

/// Distance along the ray from p to where it leaves the cell.
float cellExit(Cell cell, vec3 p, vec3 inverseDirection) {
    vec3 far = max((cell.low - p) * inverseDirection, (cell.low + cell.edge - p) * inverseDirection);
    return max(min(min(far.x, far.y), far.z), 0.0) + cell.edge * 1e-3;
}

/// The span of a ray inside the bounds; empty (x > y) when it misses them.
vec2 boundsSpan(vec3 origin, vec3 inverseDirection) {
    vec3 a = (boundsLow - origin) * inverseDirection, b = (boundsHigh - origin) * inverseDirection;
    vec3 near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), far.z));
}

vec3 inverseOf(vec3 direction) {
    return 1.0 / mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
}

/// Distance bound at p: exact near the surface, ±margin elsewhere. Where it is at least `enough`, that may be all it says.
float distanceAt(vec3 p, float enough) {
    if (any(lessThan(p, boundsLow)) || any(greaterThan(p, boundsHigh)))
        return margin;
    Cell cell = cellAt(p);
    if (cell.least >= enough) return cell.least;
    if (cell.state != cellNear) return cell.state == cellInside ? -margin : margin;
    return side * fieldBy(cell.tape, p);
}
