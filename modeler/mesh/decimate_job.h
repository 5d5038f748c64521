// One job of decimation: a patch of curved regions of some thousand triangles.
// Enters: triangles. Leaves: fewer. Vertices with a triangle outside of the patch stay. For decimate.cpp alone.
#pragma once

#include "modeler/mesh/decimate.h"
#include "modeler/mesh/decimate_fan.h"

namespace sgm::mesh {

/// Reused from patch to patch by one worker.
class DecimationJob {
public:
    /// `incident` by vertex: its triangles in all patches; `pass` counts from 0.
    DecimationJob(Decimation& all, std::span<const uint32_t> incident, size_t pass)
        : all_(all), incident_(incident), pass_(static_cast<uint8_t>(pass)) {}

    /// Decimates some of `all`'s triangles; writes to nothing of `all` but what belongs to vertices that it removes.
    DecimatedPatch run(std::span<const uint32_t> triangles, const Progress* progress);

private:
    static constexpr uint32_t none = 0xffffffffu;
    static constexpr int mostAround = Fan::mostCorners;  ///< triangles around a vertex that is to go
    enum class Kind : uint8_t { Inner, Chain, Node };

    /// A vertex, a point (an original vertex that is gone), or an original vertex outside of the patch.
    struct Local {
        Vec3f position;       ///< from the patch's first vertex
        uint32_t vertex;      ///< in the mesh
        uint32_t half;        ///< a half-edge that leaves it
        uint32_t next;        ///< point of the same triangle
        uint32_t neighbours;  ///< in neighbours_, up to the next one's
        uint32_t stamp;       ///< of the check that has seen it
        Kind kind;
        bool whole;            ///< whether all its triangles are in the patch
        bool dirty;            ///< whether it is to be looked at
        bool changed;          ///< whether its star isn't the original one
        uint32_t touched = 0;  ///< the sweep in which its star changed
    };

    // load: decimate_load.cpp
    void load(std::span<const uint32_t> triangles);
    uint32_t localOf(uint32_t vertex);
    void growTable();
    void loadPoints(std::span<const uint32_t> triangles);
    void loadNeighbours();
    void matchHalves();
    DecimatedPatch store();

    // collapses: decimate_job.cpp
    size_t sweep(float tolerance);
    bool isFree(uint32_t v) const;
    bool gatherStar(uint32_t u);
    bool tryCollapse(uint32_t u, float tolerance);
    bool splitAtChain(uint32_t u);
    bool findNormals();
    void gatherPoints();
    float cost(size_t target) const;
    bool tryInto(uint32_t u, size_t target, float tolerance);
    bool keepsManifold(uint32_t u, size_t target);
    bool sharePlane(uint32_t a, uint32_t b) const;
    bool chainStays(uint32_t u, float tolerance) const;
    bool fits(uint32_t u, size_t target, size_t side, float tolerance);
    bool edgesFit(size_t side, float tolerance);
    bool edgesFitOver(uint32_t triangle, float tolerance);
    bool edgesFitFrom(uint32_t v, float tolerance);
    void collapse(uint32_t u, size_t target);
    void glue(uint32_t triangle, uint32_t u, uint32_t v);

    /// Whether a pass before this one has looked at a vertex.
    bool isSettled(uint32_t vertex) const { return all_.settled[vertex] - 1u < pass_; }
    bool traversable(uint32_t v) const { return locals_[v].whole && locals_[v].kind != Kind::Node; }
    uint32_t chainPlace(uint32_t v) const {
        return all_.input.chains.placeOf[all_.input.regions.ofVertex[locals_[v].vertex] & ~SurfaceRegions::borderBit];
    }
    uint32_t from(uint32_t half) const { return corners_[half]; }
    uint32_t to(uint32_t half) const { return corners_[ahead(half)]; }
    static uint32_t ahead(uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }
    static uint32_t behind(uint32_t half) { return half % 3 == 0 ? half + 2 : half - 1; }
    template <class Visit>
    bool anyTriangle(uint32_t v, Visit&& visit) const;
    template <class Visit>
    bool anyNeighbour(uint32_t v, Visit&& visit) const;

    Decimation& all_;
    std::span<const uint32_t> incident_;
    uint8_t pass_;

    std::vector<Local> locals_;
    size_t vertexCount_ = 0, pointCount_ = 0;  ///< vertices first, then points, then the others
    std::vector<uint32_t> table_;              ///< local numbers by hash of the vertex
    std::vector<uint32_t> neighbours_;
    std::vector<uint32_t> corners_, opposite_;    ///< by half-edge; 3 · triangle + corner it leaves
    std::vector<uint32_t> regions_, firstPoint_;  ///< by triangle
    std::vector<uint32_t> triangleStamps_;        ///< by triangle: of the check that has seen it
    std::vector<bool> dead_;
    std::vector<uint32_t> unlinked_;                       ///< places in the chains
    std::vector<uint32_t> counts_, begin_, next_, byLow_;  ///< while a patch is loaded
    Vec3f origin_;
    uint32_t lastNeighbours_ = 0;
    uint32_t stamp_ = 0, sweep_ = 0;

    // The star of the vertex looked at: neighbours in order, and half-edges that leave it, triangle after triangle. It
    // has one side, or for a vertex on a chain between two curved regions two.
    std::vector<uint32_t> ring_, star_;
    bool closed_ = false;
    struct Side {
        size_t from,
            to;  ///< in ring_; the second side of a closed star ends at ring_.size(), which stands for ring_[0]
        Vec3f normal;
        std::vector<Vec3f> corners;  ///< of the polygon, the target first
        std::vector<uint32_t>
            triangles;  ///< half-edges of star_ whose triangles the fan's take the place of, from 1 on
    };
    std::array<Side, 2> sides_;
    size_t sideCount_ = 0;
    struct Point {
        uint32_t local;
        uint16_t side, over;
    };
    std::vector<Point> points_;
    std::array<float, 6> quadric_{};
    float area_ = 0;
    Fan fan_;
    std::vector<uint32_t> fanCorners_;
    uint32_t gone_ = none;  ///< the vertex that the fan is without
    uint16_t uOver_ = 0;    ///< triangle of the fan that the vertex itself lies over
};

}  // namespace sgm::mesh
