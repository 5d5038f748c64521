// Exact distances from the voxels of a leaf to the triangles around it. No OpenVDB here.
// Enters: the isosurface in the leaf and those about it. Leaves: distances in voxels. One worker, one object.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "modeler/volume/isosurface.h"

namespace sgm::volume {

inline constexpr int widestBand = 24;  ///< voxels to each side: rows of cells around a leaf have a bit each

class LeafDistances {
public:
    /// `halfWidth` in voxels, 1 … widestBand: how far distances are wanted.
    explicit LeafDistances(int halfWidth);

    /// How many leaves away triangles may still be within the band.
    static int reach(int halfWidth) { return (halfWidth + 8) / 8; }

    /// Begins a leaf.
    void clear();
    /// Adds the triangles of the leaf `leaves` leaves away, 0 for this one. Facets of the same leaf come only once.
    void add(const LeafSurface& surface, Vec3i leaves);
    bool empty() const { return facets_.empty(); }
    /// Distances of the leaf's voxels to the nearest triangle, in voxels; infinite where that is no less than the
    /// half width. Voxel (i, j, k) at (i · 8 + j) · 8 + k, as in an OpenVDB leaf.
    const std::array<float, 512>& distances();

private:
    struct Range {
        uint32_t begin = 0, end = 0;
    };
    /// A row of cells along z, seen from a voxel.
    struct Row {
        int i, j;
        float squared;  ///< of the least distance across the row
        int run;        ///< cells k from −run − 1 to run are within the band
    };

    size_t row(int i, int j) const { return static_cast<size_t>((i + margin_) * window_ + j + margin_); }
    uint64_t within(int i, int j) const;
    float squaredAt(Vec3i voxel) const;

    int halfWidth_, margin_, window_;
    std::vector<Row> rows_;           ///< those that may be within the band, the nearest first
    std::vector<float> gaps_;         ///< square of the least distance along z to cell k, at k + margin_
    std::vector<uint64_t> occupied_;  ///< by row: the cells with triangles, cell k at bit k + margin_
    std::vector<Range> cells_;        ///< the triangles of every cell that is occupied
    std::vector<Facet> facets_;
    std::array<float, 512> distances_;
};

}  // namespace sgm::volume
