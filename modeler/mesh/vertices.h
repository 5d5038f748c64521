// Vertices on the grid edges that the surface cuts: found on the edge, refined against the field, with normal and
// origin. Enters: cut edges with the samples at their ends, the brick's tape. Leaves: position and gradient of each.
// Assumes the two ends of a cut edge differ in sign. Linear interpolation is Lorensen & Cline 1987. A refinement
// evaluates value and derivatives together and takes Newton's step, or halves the bracket where that would leave it.
// Newton's step and the secant through the bracket's other end enclose the root where the field is convex or concave
// between them, so a vertex is done once the two agree; or once a parabola through three of its four samples and the
// slope agrees with the fourth, which it would not over a crease: then it goes to the parabola's root. An expensive
// field has creases everywhere, and its derivatives cost three times its value: there the secant alone goes on, and
// Newton's step comes last.
#pragma once

#include <vector>

#include "modeler/core/pages.h"
#include "modeler/core/stopwatch.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/edge_loops.h"

namespace sgm::mesh {

/// The loops for the widest vectors this processor has.
const EdgeLoops& edgeLoops();

/// Cut edges of one brick and what is found on them.
class CutEdges {
public:
    size_t size = 0;
    size_t flat = 0;            ///< entries whose normal is zero
    PageVector<uint32_t> list;  ///< which edges they are, for the user

    /// Makes room for n entries; never shrinks.
    void reserve(size_t n);
    /// Valid until the next `reserve`.
    EdgeArrays arrays{};

private:
    PageVector<float> memory_;
};

/// How vertices are looked for.
struct VertexSearch {
    size_t refineSteps = 3;
    bool expensive = false;  ///< the tape is, see isExpensive
    bool normals = true;     ///< where nobody wants them dx, dy, dz hold anything
    bool exact = false;      ///< blocks around an edge find the same bits, see evaluateGradient; never expensive
    SumOfTimes* fieldTime = nullptr;  ///< adds up what evaluations take, if it is there
};

/// Moves all vertices to the surface in at most `refineSteps` evaluations each (0: the line between the samples), and
/// leaves in dx, dy, dz the unit normal where the field was last evaluated, zero where it has none. `scratch` grows to
/// a list a step. Returns how many evaluations refined.
uint64_t findVertices(const eval::Tape& tape, const VertexSearch& search, eval::Workspace& workspace,
                      std::vector<CutEdges>& scratch, CutEdges& edges);

}  // namespace sgm::mesh
