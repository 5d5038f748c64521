// Space cut into a tree of cells, 4 × 4 × 4 a node, each leaf with a tape shortened for it (viewer/cells.h).
uniform usamplerBuffer tree;   // 64 words a node: state in the two top bits, leaf or node below
uniform usamplerBuffer leaves; // tape start, least and most of the field, bits of viewer::SmallValues
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
    bool doubtful;  // the field may be small where no surface is near
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
    bool doubtful = false;
    if (state == cellNear) {
        uvec4 leaf = texelFetch(leaves, int(word & 0x3fffffffu));
        tape = leaf.x;
        least = side > 0.0 ? uintBitsToFloat(leaf.y) : -uintBitsToFloat(leaf.z);
        doubtful = (leaf.w & (side > 0.0 ? 1u : 2u)) != 0u;
    }
    return Cell(state, tape, rootLow + low * rootEdge, edge * rootEdge, least, doubtful);
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

/// The field at p, ±margin far from its surface.
float valueAt(vec3 p) {
    Cell cell = cellAt(p);
    if (cell.state != cellNear) return cell.state == cellInside ? -margin : margin;
    return side * fieldBy(cell.tape, p);
}

/// Whether solid lies behind a small value of the field at p, `into` metres deep: as SolidProbe. The field is asked in
/// one place, for compilers copy the interpreter to each.
bool solidBehind(vec3 p, float value, float into, vec3 direction) {
    vec3 slope = vec3(0.0), q = p + direction * (max(value, 0.0) + into);
    for (int i = direction == vec3(0.0) ? 0 : -1; i < 12; ++i) {
        int step = i & 3;  // three differences, then the foot
        if (step < 3) q = p + into * vec3(step == 0, step == 1, step == 2);
        float here = valueAt(q);
        if (step < 3) {
            slope[step] = (here - value) / into;
            if (step < 2) continue;
            float steep = length(slope);
            vec3 up = slope / max(steep, 1e-6);
            q = p - up * ((value + into) / max(steep, 0.25));
            continue;
        }
        if (here < -0.25 * into) return true;
        if (i < 0) continue;
        p = q;
        value = here;
    }
    return false;
}

/// Distance to solid at p within the bounds: exact near the surface, ±margin elsewhere. Where it is at least `enough`,
/// that may be all it says.
float distanceAt(vec3 p, float enough, float pixel) {
    Cell cell = cellAt(p);
    if (cell.least >= enough) return cell.least;
    if (cell.state != cellNear) return cell.state == cellInside ? -margin : margin;
    float value = side * fieldBy(cell.tape, p);
    if (!cell.doubtful || value < 0.0 || value > 0.95 * enough) return value;
    // As ClearanceWalk: where the field behind the surface that its value tells of is large, there is none.
    float into = max(4e-6 * sceneSize, 0.05 * pixel), depth = enough, open = 1.0, steep = 0.0;
    vec3 slope = vec3(0.0), up = vec3(0.0);
    for (int i = 0; i < 9 && open > 0.0; ++i) {
        vec3 q = p + into * vec3(i == 0, i == 1, i == 2);
        if (i == 3) {
            steep = length(slope);
            up = slope / max(steep, 1e-6);
        }
        if (i > 2) q = i < 8 ? p - up * (value / max(steep, 0.25) + depth) : p + up * (enough - value);
        float here = valueAt(q);
        if (i < 3) {
            slope[i] = (here - value) / into;
        } else if (i < 8) {
            open = clamp(2.0 * here / depth, 0.0, open);
            depth *= 0.5;
        } else {
            value = mix(value, max(value, min(here, enough)), smoothstep(0.0, 1.0, open));
        }
    }
    return value;
}
