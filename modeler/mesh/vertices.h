// Vertices on the grid edges that the surface cuts: found on the edge, refined against the field, with normal and
// origin. Enters: cut edges with the samples at their ends, the brick's tape. Leaves: position and gradient of each.
// Assumes the two ends of a cut edge differ in sign. Linear interpolation is Lorensen & Cline 1987. A refinement
// evaluates value and derivatives together and takes Newton's step, or halves the bracket where that would leave it.
// Newton's step and the secant through the bracket's other end enclose the root where the field is convex or concave
// between them, so a vertex is done once the two agree.
#pragma once

#include <array>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/core/vec.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/edge_loops.h"

namespace sgm::mesh {

/// Cut edges of one brick, an entry each, grouped by axis; and what is found on them. Names as in EdgeArrays.
struct CutEdges {
    PageVector<float> x, y, z;     ///< where the field is evaluated and, at last, the vertex; metres
    PageVector<float> dx, dy, dz;  ///< derivatives where last evaluated; at last the normal
    PageVector<float> base, span, slope, tIn, fIn, tOut, fOut, t, f, place;
    PageVector<uint32_t> slot;          ///< the caller's
    std::array<size_t, 4> axisBegin{};  ///< entries [axisBegin[a], axisBegin[a + 1]) lie along axis a
    size_t flat = 0;                    ///< entries whose normal is zero

    size_t size() const { return axisBegin[3]; }
    /// Makes room for n entries; never shrinks.
    void reserve(size_t n);
    /// Writes entry i: an edge from (x, y, z), its low end on its own axis, its length, and the samples at its ends.
    void set(size_t i, Vec3f low, float base_m, float span_m, float fLow, float fHigh, uint32_t where) {
        x[i] = low.x, y[i] = low.y, z[i] = low.z;
        base[i] = base_m, span[i] = span_m;
        fIn[i] = fLow, fOut[i] = fHigh;  // as EdgeLoops::interpolate wants them
        slot[i] = where;
    }
};

/// Moves all vertices to the surface in at most `refineSteps` evaluations each (0: the line between the samples), and
/// leaves in dx, dy, dz the unit normal where the field was last evaluated, zero where it has none. `scratch` grows to
/// a list a step. Returns how many evaluations refined.
uint64_t findVertices(const eval::Tape& tape, size_t refineSteps, eval::Workspace& workspace,
                      std::vector<CutEdges>& scratch, CutEdges& edges);

}  // namespace sgm::mesh
