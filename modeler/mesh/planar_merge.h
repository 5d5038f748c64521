// Planar regions triangulated anew from simplified borders.
// Enters: planes, chains, and what decimation has left of the chains beside curved regions. Leaves: triangles by planar
// region. A chain is simplified once, for both its sides.
#pragma once

#include "modeler/core/progress.h"
#include "modeler/mesh/decimate.h"

namespace sgm::mesh {

class PlanarMerge {
public:
    /// Chains between planar regions may move by `chain_m`, or where that fails by `rounding_m` at least.
    PlanarMerge(const DecimationInput& input, double chain_m, double rounding_m);

    /// Simplifies chains and triangulates all planar regions on `threads` threads (0: all). A region whose border
    /// crosses itself gets back points of its chains, and so do its neighbours; those of chains beside curved regions
    /// are kept in `curved`, and then the result is true: decimate again and call this again. A region that can't be
    /// helped stays as it is.
    bool run(Decimation& curved, int threads, Progress* progress);

    /// Gives a region's chains points back, or leaves the region as it is; false when it was left so before.
    bool refine(uint32_t region, Decimation& curved);
    /// Gives each edge of a triangle of the region that stands for several of a chain between planar regions its
    /// farthest point back; false where there is none.
    bool splitEdges(uint32_t region, const Triangle& triangle);

    /// Whether a planar region keeps its original triangles.
    bool isLeft(uint32_t region) const { return left_[region] != 0; }
    /// By region: 1 where its triangles are those of its plane's triangulation, which meet nowhere but in common
    /// vertices and edges.
    std::vector<uint8_t> triangulated() const;
    /// The triangles of a planar region that doesn't.
    const std::vector<Triangle>& triangles(uint32_t region) const { return triangles_[region]; }

private:
    bool isPlanar(uint32_t region) const { return input_.planes[region].planar(); }
    void simplifyChain(uint32_t chain, const Decimation& curved);
    void findBoundary(uint32_t region, std::vector<std::array<uint32_t, 2>>& boundary) const;
    void triangulate(std::span<const uint32_t> regions, int threads, Progress* progress);

    const DecimationInput input_;
    const double chain_m_, rounding_m_;
    std::vector<uint8_t> keep_;                     ///< by place in the chains
    std::vector<uint8_t> given_;                    ///< by place in the chains: kept at every level
    std::vector<uint8_t> levels_;                   ///< by chain: how often it was refined
    std::vector<uint8_t> left_, failed_;            ///< by region
    std::vector<std::vector<Triangle>> triangles_;  ///< by region
};

}  // namespace sgm::mesh
