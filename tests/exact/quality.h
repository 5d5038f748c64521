// A mesh held against the exact model: creases, corners, borders, volume, edges.
// Enters: a mesh with origins, their looks, and the exact model. Leaves: figures; distances in cells of the mesh.
#pragma once

#include <optional>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/mesh/mesh.h"
#include "tests/exact/exact_model.h"

namespace sgm::exact {

/// Mean and 99th percentile of some distances; `count` of them, none: zeros.
struct Spread {
    double mean = 0, p99 = 0, most = 0;
    uint64_t count = 0;
};
Spread spreadOf(std::vector<double> values);

/// Points every half cell along the creases of an exact model, told apart by the thickness of the feature they are on:
/// the least of the solid and of the air before and behind either face beside the crease, of the width of these faces
/// across it, and of the crease's own length from corner to corner. Faces that meet the crease at a corner don't count,
/// so that a pyramid isn't thin at its apex.
struct CreaseSamples {
    std::vector<Vec3d> thick;  ///< features of at least two cells
    std::vector<Vec3d> thin;
    double thickShare() const {
        const size_t all = thick.size() + thin.size();
        return all ? static_cast<double>(thick.size()) / static_cast<double>(all) : 0;
    }
};
CreaseSamples sampleCreases(const ExactModel& model, double cell_m);

/// Corners of the model with no thin sample within a cell; an apex without creases counts by its solid's thickness.
std::vector<Vec3d> thickCorners(const ExactModel& model, const CreaseSamples& samples, double cell_m);

struct Quality {
    double cell_m = 0;
    double thickShare = 0;  ///< of the creases' length, on features of at least two cells: the share that is measured
    Spread everyCorner;     ///< as `corner`, of thin features too
    Spread everyCrease;     ///< as `crease`, of thin features too
    Spread crease;          ///< from points on exact creases to the mesh's surface, cells
    Spread stray;   ///< from points on the mesh's own creases to the exact ones, where the nearest isn't thin, cells
    Spread corner;  ///< from exact corners to the nearest vertex of the mesh, cells
    double border_m = 0;     ///< edges of the mesh between two looks
    double volumeError = 0;  ///< relative, positive: too large
    uint64_t boundaryEdges = 0, nonmanifoldEdges = 0;
    std::optional<uint64_t> crossings;  ///< pairs of triangles, where asked for
};

/// `count`: whether crossing pairs are counted, which takes seconds per million triangles.
Quality measureQuality(const mesh::Mesh& mesh, const Provenance& provenance, const ExactModel& model, double cell_m,
                       bool count);

}  // namespace sgm::exact
