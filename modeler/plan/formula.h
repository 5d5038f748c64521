// The monotone formula of a footprint: every edge's half-plane once, joined by maxima at convex and minima at reflex
// corners. Enters: a sound footprint (validate.h). Leaves: a tree as a flat list. Assumes edges that don't cross.
// Source: D. Dobkin, L. Guibas, J. Hershberger, J. Snoeyink, "An efficient algorithm for finding the CSG representation
// of a simple polygon", SIGGRAPH 1988: a chain whose end edges go on as rays is split at a corner of its convex hull,
// again and again. Signs of the formula are those of the polygon exactly, in exact arithmetic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// An edge's half-plane, or the maximum or minimum of two nodes before this one.
struct FormulaNode {
    enum class Kind : uint8_t { Edge, Max, Min } kind = Kind::Edge;
    uint32_t first = 0;   ///< of Edge: its number in edgesOf(); else a node
    uint32_t second = 0;  ///< of Max and Min: a node
    friend bool operator==(const FormulaNode&, const FormulaNode&) = default;
};

/// Φ over all edges: < 0 inside, > 0 outside, |Φ| at most the distance to the outline, gradient of length 1 almost
/// everywhere. Nodes come after their operands; the last one is the root.
struct Formula {
    std::vector<FormulaNode> nodes;
    friend bool operator==(const Formula&, const Formula&) = default;
};

/// Polygons are joined by minima; a court is the formula of the hole, negated. O(n · depth): n log n for plans as they
/// are built, n² for combs and spirals (.3 s for 10⁴ edges).
/// Error::Input with the fault's sentence where edges cross or a ring is none.
Result<Formula> monotoneFormula(const Footprint& footprint);
/// The same of a footprint that firstFault found sound, which isn't looked at again.
Formula formulaOfSound(const Footprint& footprint);

/// a·x + b·z + c.
struct Linear {
    double a = 0, b = 0, c = 0;
    double at(Vec2 p) const { return a * p.x + b * p.z + c; }
};
/// The signed distance to each edge's line, > 0 outside, by number.
std::vector<Linear> distancesOf(const Footprint& footprint);

/// The formula's value at a point with any functions for its leaves. O(n).
double valueOf(const Formula& formula, std::span<const Linear> leaves, Vec2 p);
/// The formula's least value where Φ ≤ 0, which `outline` tells (distancesOf), to at most `tolerance` too low and never
/// too high, by branch and bound: what the height of a roof is found with. `leaves` are at most `slope` steep. O(n ·
/// boxes).
double leastInside(const Formula& formula, std::span<const Linear> leaves, std::span<const Linear> outline, Box2 box,
                   double tolerance);

/// The point that is deepest inside, and its depth −Φ, metres. A search finds it to a thousandth of the footprint's
/// width; the edges around that place tell it exactly.
struct Deepest {
    Vec2 at;
    double depth = 0;
};
Deepest deepestPoint(const Footprint& footprint, const Formula& formula);
/// Where inside the footprint the formula is least with these leaves, a point of a roof's ridge,
/// whatever its pitches. As exact as deepestPoint.
Vec2 leastPoint(const Footprint& footprint, const Formula& formula, std::span<const Linear> leaves);

/// How far the slope of an edge reaches inward, square to the edge, from the point at `share` (0 … 1) of its length: to
/// the ridge, hip or valley where another leaf takes over. `leaves` rise over the edges: distancesOf() for equal
/// pitches, else times each pitch's tangent. Metres in plan; 0 where the slope isn't at that point at all. O(n²) at
/// worst.
double slopeDepth(const Footprint& footprint, const Formula& formula, std::span<const Linear> leaves, uint32_t edge,
                  double share);

/// Edges at which a gable stands: those whose two corners are convex and whose ridge ends over them (their face of the
/// straight skeleton is a triangle), short ones first, no two side by side; none of a pyramid or cone but on a square.
/// Ascending numbers. O(n²) at worst.
std::vector<uint32_t> gableEnds(const Footprint& footprint, const Formula& formula);

}  // namespace sgm::plan
