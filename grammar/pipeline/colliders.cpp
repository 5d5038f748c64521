#include "grammar/pipeline/colliders.h"

#include <algorithm>

#include "grammar/lower/convex_parts.h"
#include "modeler/mesh/simplify.h"

namespace sgm::pipeline {
namespace {

exporter::Collider colliderOf(const mesh::ConvexPolyhedron& piece) {
    exporter::Collider collider;
    piece.triangulate(collider.positions, collider.triangles);
    return collider;
}

exporter::Collider colliderOf(const mesh::Mesh& mesh) {
    exporter::Collider collider;
    collider.convex = false;
    for (const mesh::Chunk& c : mesh.chunks) {
        collider.positions.insert(collider.positions.end(), c.positions.begin(), c.positions.end());
        for (const mesh::Triangle& t : c.triangles) collider.triangles.push_back(c.inMesh(t));
    }
    return collider;
}

/// A twentieth of the triangles, but not below some thousands.
Result<Colliders> fromMesh(const mesh::Mesh& mesh, Progress* progress) {
    constexpr double share = 0.002;  // of the extent
    const auto extent = static_cast<double>(maxComponent(mesh.bounds().size()));
    auto coarse = mesh::simplify(mesh, {share * extent, 0}, progress);
    if (!coarse.ok()) return coarse.error();
    return Colliders{{colliderOf(*coarse)}, {}};
}

}  // namespace

Result<Colliders> makeColliders(const std::string& kind, const Model& model, const mesh::Mesh& mesh,
                                Progress* progress) {
    if (kind == "mesh") return fromMesh(mesh, progress);
    const auto parts = lower::convexParts(model.derivation, *model.lowered, progress);
    if (!parts.ok()) return parts.error();
    Colliders colliders;
    colliders.notes = parts->notes;
    if (kind == "boxes")
        for (const mesh::ConvexPolyhedron& box : lower::boxesOf(model.derivation, *parts))
            colliders.all.push_back(colliderOf(box));
    else
        for (const lower::ConvexPiece& piece : parts->pieces) colliders.all.push_back(colliderOf(piece.polyhedron));
    return colliders;
}

}  // namespace sgm::pipeline
