// Where a mesh has triangles of which part.
// Enters: a mesh with origins. Leaves: answers about places. Assumes triangles no larger than a cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grammar/derive/shapes.h"
#include "modeler/core/number_set.h"
#include "modeler/core/provenance.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// Small cells that hold triangles of thin parts.
class Presence {
public:
    /// What is asked of a part.
    struct Query {
        enum class Extent : uint8_t { Nothing, NearPoints, All } extent = Extent::Nothing;
        float reach_m = 0;  ///< how near a triangle has to be, to twice as much
    };
    /// O(triangles of those parts + points). `queries` is by part. Of parts that are asked about near points only the
    /// triangles within a cell of one of `points` count.
    Presence(const mesh::Mesh& mesh, std::span<const Query> queries, std::span<const Vec3f> points, float cell_m);
    /// Whether a triangle of the part lies within its reach, to twice that.
    bool isNear(Vec3f p, OriginId part) const;
    /// Whether triangles of the part lie along every line through its scope, which is thinner than a cell of `cell_m`
    /// there: then nothing of it is missing, whatever the field says.
    bool isWhole(const derive::Scope& scope, OriginId part, double cell_m) const;

private:
    void addTriangle(Vec3f p, Vec3f q, Vec3f r, OriginId part);
    Vec3i cellOf(Vec3f p, OriginId part) const { return cellOf(p, perMetre_[part]); }
    static Vec3i cellOf(Vec3f p, float perMetre);
    static uint64_t keyOf(Vec3i cell, OriginId part);

    std::vector<float> perMetre_;  ///< cells of a reach, by part
    NumberSet cells_;
    uint64_t last_ = 0;  ///< added to `cells_`
};

}  // namespace sgm::lower
