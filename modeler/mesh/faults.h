// What is wrong with a closed surface: crossings, edges that are there twice and vertices where fans meet.
// Enters: triangles. Leaves: those at fault. Assumes that each region's own triangles wind one way.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/mesh/compose.h"

namespace sgm::mesh {

/// Finds faults of one surface after another over the same vertices: triangles that the last one had too and that were
/// sound there aren't compared with each other again.
class FaultFinder {
public:
    /// On `threads` threads (0: all). `positions` have to stay.
    FaultFinder(std::span<const Vec3f> positions, int threads, const Progress* progress)
        : positions_(positions), threads_(threads), progress_(progress) {}

    /// The triangles that meet another one elsewhere than in common vertices and edges, or whose edge another triangle
    /// runs along the same way, or which stand around a vertex together with another fan; ascending. Exact on the
    /// coordinates given. Triangles are compared by a hierarchy of boxes. `soundRegions`, by region or empty: other
    /// than 0 where triangles of the region are known not to meet each other wrongly, as what was triangulated in a
    /// plane; those aren't compared. O(n log n) as a rule.
    std::vector<uint32_t> find(std::span<const SimpleTriangle> triangles, std::span<const uint8_t> soundRegions = {});

private:
    std::vector<uint8_t> findFresh(std::span<const SimpleTriangle> triangles) const;
    void remember(std::span<const SimpleTriangle> triangles, std::span<const uint32_t> faults);

    const std::span<const Vec3f> positions_;
    const int threads_;
    const Progress* const progress_;
    bool isFirst_ = true;
    std::vector<uint32_t> soundBegin_;  ///< by vertex and one more: triangles of the last surface that begin there
    std::vector<std::array<uint32_t, 2>> sound_;  ///< their other corners
};

}  // namespace sgm::mesh
