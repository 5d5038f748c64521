// Where a mesh has triangles of which part.
// Enters: a mesh with origins. Leaves: answers about places. Assumes triangles that are hardly larger than a cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grammar/derive/shapes.h"
#include "modeler/core/provenance.h"
#include "modeler/field/hash_index.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// Triangles of thin parts, by the cells of the mesh that they reach.
class Presence {
public:
    /// What is asked of a part.
    struct Query {
        enum class Extent : uint8_t { Nothing, NearPoints, All } extent = Extent::Nothing;
        float reach_m = 0;  ///< how near a triangle has to be
    };
    /// O(triangles of those parts + points) on `threads` threads. `queries` is by part. Of parts that are asked about
    /// near points only the triangles within a cell of one of `points` count.
    Presence(const mesh::Mesh& mesh, std::span<const Query> queries, std::span<const Vec3f> points, float cell_m,
             int threads);
    /// Whether a triangle of the part lies within its reach.
    bool isNear(Vec3f p, OriginId part) const;
    /// Whether a line through p along `along`, of length 1, passes one within a fifth of that reach.
    bool isNearAlong(Vec3f p, Vec3f along, OriginId part) const;
    /// Whether triangles of the part lie along every line through its scope, which is thinner than a cell of `cell_m`
    /// there: then nothing of it is missing, whatever the field says.
    bool isWhole(const derive::Scope& scope, OriginId part, double cell_m) const;

private:
    struct Triangle {
        Vec3f a, b, c;
    };
    /// A triangle of those that reach a cell.
    struct Entry {
        uint32_t triangle, next;
    };
    /// A cell of one part that a triangle reaches.
    struct Cell {
        uint64_t key;
        uint32_t newest;  ///< of its entries
    };

    /// The triangles of some parts, those with one remainder of their number; filled by one thread.
    struct Shard {
        std::vector<Triangle> triangles;
        std::vector<Entry> entries;
        std::vector<Cell> cells;
        field::HashIndex index;  ///< of cells

        void enter(uint64_t key, uint32_t triangle);
        uint32_t find(uint64_t key) const {
            return index.find(key, [&](uint32_t cell) { return cells[cell].key == key; });
        }
    };

    void addTriangle(const Triangle& triangle, OriginId part, Shard& shard) const;
    size_t shardOf(OriginId part) const { return part % shards_.size(); }
    template <class IsNear>
    bool isAny(Vec3f p, OriginId part, IsNear&& isNear) const;

    std::vector<float> reach_m_;  ///< by part
    float perMetre_;              ///< cells
    std::vector<Shard> shards_;
};

}  // namespace sgm::lower
