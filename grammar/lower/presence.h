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

/// Quarters of the mesh's cells that hold triangles of thin parts.
class Presence {
public:
    /// How much of a part is asked for.
    enum class Extent : uint8_t { Nothing, NearPoints, All };
    /// O(triangles of those parts + points). Of parts that are asked about near points only the triangles within a cell
    /// of one of `points` count. Cells in metres.
    Presence(const mesh::Mesh& mesh, std::span<const Extent> extents, std::span<const Vec3f> points, float cell_m);
    /// Whether a triangle of the part lies within a quarter of a cell to a half.
    bool isNear(Vec3f p, OriginId part) const;
    /// Whether triangles of the part lie along every line through its scope, which is thinner than a cell of `cell_m`
    /// there: then nothing of it is missing, whatever the field says.
    bool isWhole(const derive::Scope& scope, OriginId part, double cell_m) const;

private:
    void addTriangle(Vec3f p, Vec3f q, Vec3f r, OriginId part);
    static Vec3i cellOf(Vec3f p, float perMetre);
    static uint64_t keyOf(Vec3i cell, OriginId part);

    const float perMetre_;
    NumberSet cells_;
    uint64_t last_ = 0;  ///< added to `cells_`
};

}  // namespace sgm::lower
