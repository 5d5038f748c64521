// Space cut into a tree of cells, 4 × 4 × 4 a node, each leaf with a tape shortened for it (viewer/cells.h).
uniform usamplerBuffer tree;   // 64 words a node: state in the two top bits, tape start or node below
uniform vec3 rootLow;          // metres
uniform float rootEdge;
uniform vec3 boundsLow, boundsHigh;
uniform float side;            // 1, or −1 to stand inside the solid
uniform float inverseLipschitz;
uniform float margin;          // no surface is nearer than this from a far cell, metres

const uint cellOutside = 0u, cellNear = 1u, cellInside = 2u, cellNode = 3u;

struct Cell {
    uint state;   // never cellNode
    uint tape;    // of a near cell
    vec3 low;     // metres
    float edge;   // metres
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
    return Cell(state, word & 0x3fffffffu, rootLow + low * rootEdge, edge * rootEdge);
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

/// Distance bound at p: exact near the surface, ±margin elsewhere.
float distanceAt(vec3 p) {
    if (any(lessThan(p, boundsLow)) || any(greaterThan(p, boundsHigh)))
        return margin;
    Cell cell = cellAt(p);
    if (cell.state != cellNear) return cell.state == cellInside ? -margin : margin;
    return side * evaluateField(cell.tape, p);
}
