// One job of decimation: a patch of curved regions of some thousand triangles.
// Enters: triangles. Leaves: fewer. Vertices with a triangle outside of the patch stay. For decimate.cpp alone.
#pragma once

#include "modeler/mesh/decimate_fan.h"
#include "modeler/mesh/loaded_patch.h"

namespace sgm::mesh {

/// Reused from patch to patch by one worker.
class DecimationJob {
public:
    /// `incident` by vertex: its triangles in all patches; `pass` counts from 0.
    DecimationJob(Decimation& all, std::span<const uint32_t> incident, size_t pass)
        : all_(all), patch_(all, incident, pass) {}

    /// Decimates some of `all`'s triangles; writes to nothing of `all` but what belongs to vertices that it removes.
    DecimatedPatch run(std::span<const uint32_t> triangles, const Progress* progress);

private:
    using Kind = PatchVertex::Kind;
    static constexpr uint32_t none = LoadedPatch::none;
    static constexpr int mostAround = Fan::mostCorners;  ///< triangles around a vertex that is to go

    // decimate_job.cpp
    size_t sweep(float tolerance);
    bool isFree(uint32_t v) const;
    bool gatherStar(uint32_t u);
    bool tryCollapse(uint32_t u, float tolerance);
    bool splitAtChain(uint32_t u);
    bool findNormals();
    float cost(size_t target) const;
    bool tryInto(uint32_t u, size_t target, float tolerance);
    void collapse(uint32_t u, size_t target);
    void glue(uint32_t triangle, uint32_t u, uint32_t v);

    // decimate_check.cpp
    void gatherPoints();
    bool keepsManifold(uint32_t u, size_t target);
    bool sharePlane(uint32_t a, uint32_t b) const;
    bool chainStays(uint32_t u, float tolerance) const;
    bool fits(uint32_t u, size_t target, size_t side, float tolerance);
    bool edgesFit(size_t side, float tolerance);
    bool edgesFitOver(uint32_t triangle, float tolerance);
    bool edgesFitFrom(uint32_t v, float tolerance);

    struct Side {
        size_t from,
            to;  ///< in the ring; the second side of a closed star ends at its size, which stands for its first
        Vec3f normal;
        float leastFacing = 0;       ///< cosine between that and a triangle that comes
        std::vector<Vec3f> corners;  ///< of the polygon, the target first
        std::vector<uint32_t>
            triangles;  ///< half-edges of the star whose triangles the fan's take the place of, from 1 on
    };
    /// The star of the vertex looked at. It has one side, or for a vertex on a chain between two curved regions two.
    struct Star {
        std::vector<uint32_t> ring;    ///< neighbours in order
        std::vector<uint32_t> halves;  ///< half-edges that leave it, triangle after triangle
        bool closed = false;
        std::array<Side, 2> sides;
        size_t sideCount = 0;
        std::array<float, 6> quadric{};
        float area = 0;
    };
    /// A point over the star, and the triangle of a side's fan that it lies over.
    struct Point {
        uint32_t local;
        uint16_t side, over;
    };

    Decimation& all_;
    LoadedPatch patch_;
    std::vector<uint32_t> unlinked_;  ///< places in the chains
    uint32_t stamp_ = 0, sweep_ = 0;
    Star star_;
    std::vector<Point> points_;
    Fan fan_;
    std::vector<uint32_t> fanCorners_;
    uint32_t gone_ = none;  ///< the vertex that the fan is without
    uint16_t uOver_ = 0;    ///< triangle of the fan that the vertex itself lies over
};

}  // namespace sgm::mesh
