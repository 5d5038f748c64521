// A patch of curved regions as decimation works on it: its triangles by half-edges, and the points over them.
// Enters: triangles of a Decimation. Leaves: local numbers for its vertices, and what is beside what. For
// decimate_job.cpp and its checks alone.
#pragma once

#include "modeler/mesh/decimate.h"

namespace sgm::mesh {

/// A vertex of a patch, a point (an original vertex that is gone), or an original vertex outside of the patch.
struct PatchVertex {
    enum class Kind : uint8_t { Inner, Chain, Node };

    Vec3f position;       ///< from the patch's first vertex
    uint32_t vertex;      ///< in the mesh
    uint32_t half;        ///< a half-edge that leaves it
    uint32_t next;        ///< point of the same triangle
    uint32_t neighbours;  ///< in LoadedPatch::neighbours, up to the next one's
    uint32_t stamp;       ///< of the check that has seen it
    Kind kind;
    bool whole;            ///< whether all its triangles are in the patch
    bool dirty;            ///< whether it is to be looked at
    bool changed;          ///< whether its star isn't the original one
    uint32_t touched = 0;  ///< the sweep in which its star changed
};

/// Reused from patch to patch by one worker.
class LoadedPatch {
public:
    static constexpr uint32_t none = 0xffffffffu;

    /// `incident` by vertex: its triangles in all patches; `pass` counts from 0.
    LoadedPatch(Decimation& all, std::span<const uint32_t> incident, size_t pass)
        : all_(all), incident_(incident), pass_(static_cast<uint8_t>(pass)) {}

    void load(std::span<const uint32_t> triangles);
    /// What is left, without the chains' vertices; marks those of its vertices that were looked at as settled.
    DecimatedPatch store();

    /// Whether a pass before this one has looked at a vertex of the mesh.
    bool isSettled(uint32_t vertex) const { return all_.settled[vertex] - 1u < pass_; }
    bool traversable(uint32_t v) const { return vertices[v].whole && vertices[v].kind != PatchVertex::Kind::Node; }
    uint32_t chainPlace(uint32_t v) const {
        return all_.input.chains.placeOf[all_.input.regions.ofVertex[vertices[v].vertex] & ~SurfaceRegions::borderBit];
    }
    uint32_t from(uint32_t half) const { return corners[half]; }
    uint32_t to(uint32_t half) const { return corners[ahead(half)]; }
    static uint32_t ahead(uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }
    static uint32_t behind(uint32_t half) { return half % 3 == 0 ? half + 2 : half - 1; }
    /// Calls visit with the triangles around a vertex, as far as its first half-edge leads, until one returns true;
    /// whether one did.
    template <class Visit>
    bool anyTriangle(uint32_t v, Visit&& visit) const {
        const uint32_t start = vertices[v].half;
        for (uint32_t h = start;;) {
            if (visit(h / 3)) return true;
            h = opposite[behind(h)];
            if (h == start) return false;
            if (h == none) break;
        }
        for (uint32_t h = start; opposite[h] != none;) {
            h = ahead(opposite[h]);
            if (visit(h / 3)) return true;
        }
        return false;
    }
    /// The same for neighbours.
    template <class Visit>
    bool anyNeighbour(uint32_t v, Visit&& visit) const {
        return anyTriangle(v, [&](uint32_t t) {
            for (uint32_t h = 3 * t; h < 3 * t + 3; ++h)
                if (corners[h] != v && visit(corners[h])) return true;
            return false;
        });
    }

    /// What belongs to a triangle.
    struct Triangles {
        std::vector<uint32_t> regions, firstPoint;
        std::vector<uint32_t> stamps;  ///< of the check that has seen it
        std::vector<bool> dead;
    };
    std::vector<PatchVertex> vertices;        ///< those of the patch first, then points, then the others
    size_t vertexCount = 0, pointCount = 0;   ///< where vertices and points end
    std::vector<uint32_t> corners, opposite;  ///< by half-edge; 3 · triangle + corner it leaves
    Triangles triangles;
    std::vector<uint32_t> neighbours;
    uint32_t lastNeighbours = 0;

private:
    uint32_t localOf(uint32_t vertex);
    void growTable();
    void loadPoints(std::span<const uint32_t> from);
    void loadNeighbours();
    void matchHalves();

    Decimation& all_;
    std::span<const uint32_t> incident_;
    uint8_t pass_;
    Vec3f origin_;
    std::vector<uint32_t> table_;  ///< local numbers by hash of the vertex
    /// While a patch is loaded.
    struct Scratch {
        std::vector<uint32_t> counts, begin, next, byLow;
    };
    Scratch scratch_;
};

}  // namespace sgm::mesh
