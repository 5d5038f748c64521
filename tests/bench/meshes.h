// Meshes as `sgm build` makes them, held against exact constructive solid geometry.
// Enters: buildings whose solid trees are exact. Leaves: figures, as a table and as JSON. Assumes the repository's root
// as the working folder; exact models need node and npm's manifold-3d, and stay in build/exact.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/stopwatch.h"
#include "tests/exact/quality.h"

namespace sgm::bench {

struct MeshesOptions {
    std::vector<std::string>
        scenes;                    ///< of tower, palace, apartment, cloister, hall, terrace, or files; empty: those six
    std::vector<int> resolutions;  ///< cells along the longest side; empty: 128, 256, 512
    int sides = 512;  ///< of round solids for distances, a multiple of 4 greater than 128; volumes are extrapolated
    int repeats = 3;  ///< of every mesh; the best time counts
    bool crossings = false;  ///< whether CGAL counts crossing pairs of triangles
    Running running;
};

/// One mesh. Without an exact model `quality` is unset.
struct MeshRow {
    std::string scene;
    int resolution = 0;
    uint64_t triangles = 0, exactTriangles = 0;  ///< exact: with round solids of 128 sides, after planar merge
    double seconds = 0;                          ///< field to simplified crisp mesh
    double cubesSeconds = 0;                     ///< field to mesh by marching cubes alone
    double crispSeconds = 0;                     ///< field to crisp mesh, not simplified
    uint64_t glbBytes = 0;
    double ownersDiffer = 0;   ///< share of the exact surface that looks otherwise in the field
    double exactBorder_m = 0;  ///< length of the exact borders between looks
    std::optional<exact::Quality> quality;
    double borderRatio() const { return quality && exactBorder_m > 0 ? quality->border_m / exactBorder_m : 0; }
};

/// Markdown: the head of the table, and a row.
std::string meshesHeader();
std::string meshesRow(const MeshRow& row);
std::string meshesJson(const std::vector<MeshRow>& rows, const MeshesOptions& options);

/// Measures and prints one row after the other. Error::Input where a grammar can't be read or isn't exactly a solid
/// tree.
Result<std::vector<MeshRow>> measureMeshes(const MeshesOptions& options);

}  // namespace sgm::bench
